"""Surfaces of pulleys: the smooth circle, and kinds that depend on the pulley angle, one per file.

Importing a kind here registers it.  A drive whose pulleys are all round has a system of its own type, whose
kernels know of nothing else.
"""

from collections.abc import Callable
from math import cos, sin
from typing import Any, NamedTuple

from beltdyn.arrays import FloatArray, Records
from beltdyn.contact.surface.kind import KINDS as KINDS
from beltdyn.contact.surface.kind import Gap as Gap
from beltdyn.contact.surface.kind import SurfaceKind as SurfaceKind
from beltdyn.contact.surface.polygon import Polygon as Polygon
from beltdyn.contact.surface.polygon import PolygonRims as PolygonRims
from beltdyn.contact.surface.polygon import polygon_at, polygon_gap, polygon_reach
from beltdyn.contact.surface.polygon import polygon_seat as polygon_seat
from beltdyn.contact.surface.toothed import TEETH as TEETH
from beltdyn.contact.surface.toothed import MeshingRims as MeshingRims
from beltdyn.contact.surface.toothed import Toothed as Toothed
from beltdyn.contact.surface.toothed import ToothedRims as ToothedRims
from beltdyn.contact.surface.toothed import meshing_at, toothed_at
from beltdyn.kernel import KindRows, by_type, choice, kernel

SHAPES = KindRows(KINDS, lambda kind: kind.constants, reach="f8")
"""Rows of surfaces: how far each goes beyond the effective radius (m), its kind, and the parameters of that."""
SHAPE = SHAPES.row_type()
"""The row of a surface of the package."""


class RoundRims(NamedTuple):
    """Surfaces of pulleys, all smooth circles."""

    radius: FloatArray
    """Effective radii, m, shape (P,)."""


class ShapedRims(NamedTuple):
    """Surfaces of pulleys, some of them shaped."""

    radius: FloatArray
    """Effective radii, m, shape (P,)."""
    table: Records
    """Rows of `SHAPE`, shape (P,)."""


class Round(NamedTuple):
    """A smooth circle."""

    radius: float
    """Effective radius R, m."""


class Shaped(NamedTuple):
    """A surface of any kind, at an angle of its pulley."""

    radius: float
    """Effective radius R, m."""
    table: Records
    """Rows of `SHAPE`."""
    row: int
    """Its row."""
    cosine: float
    """Of the angle of the pulley."""
    sine: float


@kernel
def _round_at(rims: RoundRims, pulley: int, angle: float, passed: float = 0.0) -> Round:
    return Round(rims.radius[pulley])


@kernel
def _shaped_at(rims: ShapedRims, pulley: int, angle: float, passed: float = 0.0) -> Shaped:
    return Shaped(rims.radius[pulley], rims.table, pulley, cos(angle), sin(angle))


surface_at: Callable[..., Any] = by_type(
    {
        RoundRims: _round_at,
        ShapedRims: _shaped_at,
        ToothedRims: toothed_at,
        PolygonRims: polygon_at,
        MeshingRims: meshing_at,
    },
    "surface_at",
)
"""Surface of a pulley at an angle, rad, when a length of belt (m) has passed the mesh."""


@kernel(inline=True)
def _no_start(rims: Any, element: int) -> float:
    return 0.0


@kernel(inline=True)
def _start(rims: Any, element: int) -> float:
    return float(rims.start[element])


element_start: Callable[[Any, int], float] = by_type(
    {RoundRims: _no_start, ShapedRims: _no_start, ToothedRims: _start, PolygonRims: _start, MeshingRims: _start},
    "element_start",
)
"""Material coordinate at which an element begins, m; zero where there are no teeth that ask for it."""


@kernel(inline=True)
def _move_none(rims: Any, element: int, start: float) -> None:
    """No teeth ask for it."""


@kernel(inline=True)
def _move_start(rims: Any, element: int, start: float) -> None:
    rims.start[element] = start


move_start: Callable[[Any, int, float], None] = by_type(
    {
        RoundRims: _move_none,
        ShapedRims: _move_none,
        ToothedRims: _move_start,
        PolygonRims: _move_start,
        MeshingRims: _move_start,
    },
    "move_start",
)
"""Let an element begin at another material coordinate, m."""


def with_own_starts(rims: Any) -> Any:
    """The same rims with an array of their own of the coordinates at which elements begin, if they have one."""
    return rims if isinstance(rims, RoundRims | ShapedRims) else rims._replace(start=rims.start.copy())


@kernel(inline=True)
def _own_unknown(rims: Any, pulley: int, unknown: int) -> int:
    return unknown


@kernel(inline=True)
def _unknown_of_leader(rims: MeshingRims, pulley: int, unknown: int) -> int:
    return rims.kept.shape[0] - 1 if pulley == rims.leader else unknown


rim_unknown: Callable[[Any, int, int], int] = by_type(
    {
        RoundRims: _own_unknown,
        ShapedRims: _own_unknown,
        ToothedRims: _own_unknown,
        PolygonRims: _own_unknown,
        MeshingRims: _unknown_of_leader,
    },
    "rim_unknown",
)
"""Place of a rim's unknown in the border, from that of its body: the last one of the pulley that leads a mesh."""


@kernel
def _circle_reach(surface: Any) -> float:
    return surface.radius


@kernel
def _shaped_reach(surface: Shaped) -> float:
    return surface.radius + surface.table[surface.row].reach


@kernel
def _toothed_reach(surface: Toothed) -> float:
    return surface.radius + (surface.height if surface.stiffness > 0.0 else 0.0)


outer_radius: Callable[[Any], float] = by_type(
    {Round: _circle_reach, Shaped: _shaped_reach, Toothed: _toothed_reach, Polygon: polygon_reach}, "outer_radius"
)
"""Radius of the circle around a surface, about the shaft, m; teeth reach out of it."""


gap_of_kind = choice("gap_of_kind", KINDS.functions("gap"), ["x", "y", "radius"])


@kernel
def _turned_gap(surface: Shaped, x: float, y: float) -> Gap:
    """Gap of a point against a surface of any kind."""
    c, s = surface.cosine, surface.sine
    own = gap_of_kind(surface.table[surface.row], c * x + s * y, c * y - s * x, surface.radius)
    nx, ny = own.normal_x, own.normal_y
    return Gap(own.penetration, c * nx - s * ny, s * nx + c * ny, own.curvature)


shaped_gap: Callable[[Any, float, float], Gap] = by_type({Shaped: _turned_gap, Polygon: polygon_gap}, "shaped_gap")
"""Gap of a point against a surface that has turned with its pulley, from its place against the shaft, m."""

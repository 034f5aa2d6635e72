"""Surfaces of pulleys: the smooth circle, and kinds that depend on the pulley angle, one per file.

Importing a kind here registers it.  A drive whose pulleys are all round has a system of its own type, whose
kernels know of nothing else.
"""

from collections.abc import Callable
from math import cos, sin
from typing import Any, NamedTuple

from beltdyn.arrays import FloatArray
from beltdyn.contact.surface import circle as circle
from beltdyn.contact.surface import eccentric as eccentric
from beltdyn.contact.surface.kind import KINDS as KINDS
from beltdyn.contact.surface.kind import Gap as Gap
from beltdyn.contact.surface.kind import SurfaceKind as SurfaceKind
from beltdyn.kernel import KindRows, by_type, choice, kernel
from beltdyn.records import Records

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
def _round_at(rims: RoundRims, pulley: int, angle: float) -> Round:
    return Round(rims.radius[pulley])


@kernel
def _shaped_at(rims: ShapedRims, pulley: int, angle: float) -> Shaped:
    return Shaped(rims.radius[pulley], rims.table, pulley, cos(angle), sin(angle))


surface_at: Callable[[Any, int, float], Any] = by_type({RoundRims: _round_at, ShapedRims: _shaped_at}, "surface_at")
"""Surface of a pulley at an angle, rad."""


@kernel
def _circle_reach(surface: Round) -> float:
    return surface.radius


@kernel
def _shaped_reach(surface: Shaped) -> float:
    return surface.radius + surface.table[surface.row].reach


outer_radius: Callable[[Any], float] = by_type({Round: _circle_reach, Shaped: _shaped_reach}, "outer_radius")
"""Radius of the circle around a surface, about the shaft, m."""


gap_of_kind = choice("gap_of_kind", KINDS.functions("gap"), ["x", "y", "radius"])


@kernel
def shaped_gap(surface: Shaped, x: float, y: float) -> Gap:
    """Gap of a point against a surface that has turned with its pulley.

    Parameters
    ----------
    surface
        The surface at an angle.
    x, y
        Place against the shaft, m.
    """
    c, s = surface.cosine, surface.sine
    own = gap_of_kind(surface.table[surface.row], c * x + s * y, c * y - s * x, surface.radius)
    nx, ny = own.normal_x, own.normal_y
    return Gap(own.penetration, c * nx - s * ny, s * nx + c * ny, own.curvature)

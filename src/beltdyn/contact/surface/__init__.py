"""Surfaces of pulleys: the smooth circle, and kinds that depend on the pulley angle, one per file.

Importing a kind here puts it on the list.  A drive whose pulleys are all round has a system of its own type, whose
kernels know of nothing else.
"""

from collections.abc import Callable
from functools import reduce
from math import cos, sin
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.surface import circle as circle
from beltdyn.contact.surface import eccentric as eccentric
from beltdyn.contact.surface.kind import KINDS as KINDS
from beltdyn.contact.surface.kind import Gap as Gap
from beltdyn.contact.surface.kind import SurfaceKind as SurfaceKind
from beltdyn.kernel import by_type, kernel
from beltdyn.records import Records, record

SHAPE = record(
    kind="i8",  # number of the kind in the list
    reach="f8",  # how far the surface goes beyond it, m
    **{parameter.name: "f8" for kind in KINDS.values() for parameter in kind.parameters},
)
"""The surface of a pulley; only the parameters of its kind are used."""


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


def _either(others: Any, numbered: tuple[int, Any]) -> Any:
    """Kernel of one kind where it is the one, and of the others elsewhere."""
    number, gap = numbered

    @kernel
    def choose(x: float, y: float, radius: float, shape: np.record) -> Gap:
        found: Gap = gap(x, y, radius, shape) if shape.kind == number else others(x, y, radius, shape)
        return found

    return choose


_GAPS = [kind.gap for kind in KINDS.values()]
_gap_of_kind = reduce(_either, list(enumerate(_GAPS))[1:], _GAPS[0])


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
    own = _gap_of_kind(c * x + s * y, c * y - s * x, surface.radius, surface.table[surface.row])
    nx, ny = own.normal_x, own.normal_y
    return Gap(own.penetration, c * nx - s * ny, s * nx + c * ny, own.curvature)

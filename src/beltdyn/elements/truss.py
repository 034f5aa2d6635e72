"""Truss element of Leamy and Wasfy: a straight link between two points, with the belt's stretch law."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import ElementKind, Section
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.quadrature import Quadrature
from beltdyn.stretch import StretchParameters, stretching

_CIRCLE = 48.0
"""A straight link over the angle a misses a circle by R a^2 / 8, a cubic over b by R b^4 / 384."""


class Truss(NamedTuple):
    """What the kernels of truss elements get."""

    section: Section
    elastic: Quadrature


@kernel
def link_energy(e: FloatArray, i: int, law: StretchParameters, length: float) -> float:
    """Strain energy L W(G) of the link between two points, with G = |r_j - r_i|^2 / L^2.

    `e`: places of points in turn, m; `i`: index of the first coordinate of point i; those of point j follow; `length`:
    reference length L of the link, m. Returns J.
    """
    x, y = e[i + 2] - e[i], e[i + 3] - e[i + 1]
    return length * stretching(law, (x * x + y * y) / (length * length)).energy


@kernel
def add_link(
    e: FloatArray, i: int, law: StretchParameters, length: float, gradient: FloatArray, tangent: FloatArray
) -> None:
    """Add gradient and exact tangent of `link_energy`.

    `e`, `i`, `law`, `length`: as for `link_energy`; `gradient`: dU/de, N; `tangent`: d2U/de2, N/m.
    """
    x, y = e[i + 2] - e[i], e[i + 3] - e[i + 1]
    square = length * length
    along = stretching(law, (x * x + y * y) / square)
    factor, steep = 2.0 * along.slope / length, 4.0 * along.curvature / (length * square)
    xx, xy, yy = factor + steep * x * x, steep * x * y, factor + steep * y * y
    for a in range(2):
        sign, p = 2.0 * a - 1.0, i + 2 * a
        gradient[p] += sign * factor * x
        gradient[p + 1] += sign * factor * y
        for b in range(2):
            both, q = sign * (2.0 * b - 1.0), i + 2 * b
            tangent[p, q] += both * xx
            tangent[p, q + 1] += both * xy
            tangent[p + 1, q] += both * xy
            tangent[p + 1, q + 1] += both * yy


@kernel
def truss_energy(truss: Truss, e: FloatArray, length: float) -> float:
    """Strain energy of an element; see `ElementKind.energy`."""
    return link_energy(e, 0, truss.section.stretch, length)


@kernel
def truss_force(truss: Truss, e: FloatArray, length: float, _wanted: bool, work: np.record) -> None:
    """Elastic force of an element with its tangent; see `ElementKind.force`."""
    work.gradient[:] = 0.0
    work.tangent[:] = 0.0
    add_link(e, 0, truss.section.stretch, length, work.gradient, work.tangent)


def lumped_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrix of a link, half of its mass at each end, shape (..., 4, 4), kg."""
    return np.asarray(0.5 * section.mass * np.asarray(length)[..., None, None] * np.eye(4))


def straight_control(length: FloatArray | float) -> FloatArray:
    """Control points of a straight curve from its ends, shape (..., 1, 2, 2)."""
    return np.broadcast_to(np.eye(2), (*np.shape(length), 1, 2, 2))


def link_cubic_angle(angle: FloatArray) -> FloatArray:
    """Angle of a cubic with the same deviation from a circle as a link over a given angle, rad."""
    return np.sqrt(angle) * _CIRCLE**0.25


TRUSS = register(
    ElementKind(
        name="truss",
        meaning="straight links without bending stiffness, for comparison",
        element=Truss,
        coordinates=("r_x", "r_y"),
        vectors=(0, 2),
        shift=(1.0, 1.0),
        control=straight_control,
        scale=lambda _length: (1.0, 1.0),
        mass=lumped_mass,
        nodal=lambda place, _slope, _bend: place,
        energy=truss_energy,
        force=truss_force,
        cubic_angle=link_cubic_angle,
    )
)

"""Three-node beam element of Leamy and Wasfy: two straight links, and torsional springs between links.

A node has the places of two points. The element between the points p0, p1 of a node and p2, p3 of the next consists of
the links p0-p1 and p1-p2 and of the springs at p1 and p2, so that elements put together make the whole belt.
"""

from math import atan2
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import ElementKind, Section
from beltdyn.elements.truss import add_link, link_cubic_angle, link_energy
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.quadrature import Quadrature

# Torsional spring between two links: the bending stiffness of a three-node beam element without rotations


class Direction(NamedTuple):
    """Derivatives of the direction angle of a vector with respect to its components."""

    x: float
    y: float
    xx: float
    """Minus the derivative yy."""
    xy: float


@kernel
def bend_angle(e: FloatArray, i: int) -> float:
    """Angle from the link between points i and j to that between j and k, rad, -pi to pi.

    `e`: places of points in turn, m; `i`: index of the first coordinate of point i; those of j and k follow.
    """
    ax, ay, bx, by = e[i + 2] - e[i], e[i + 3] - e[i + 1], e[i + 4] - e[i + 2], e[i + 5] - e[i + 3]
    return atan2(ax * by - ay * bx, ax * bx + ay * by)


@kernel
def spring_energy(e: FloatArray, i: int, stiffness: float) -> float:
    """Energy stiffness phi^2 / 2 of the spring at point j, J; stiffness in N m."""
    angle = bend_angle(e, i)
    return 0.5 * stiffness * angle * angle


@kernel
def add_spring(e: FloatArray, i: int, stiffness: float, gradient: FloatArray, tangent: FloatArray) -> None:
    """Add gradient and exact tangent of `spring_energy`.

    `e`, `i`: as for `bend_angle`; `stiffness`: EI / L, N m; `gradient`: dU/de, N; `tangent`: d2U/de2, N/m.
    """
    before = _direction(e[i + 2] - e[i], e[i + 3] - e[i + 1])
    after = _direction(e[i + 4] - e[i + 2], e[i + 5] - e[i + 3])
    slope = (before.x, before.y, -before.x - after.x, -before.y - after.y, after.x, after.y)
    moment = stiffness * bend_angle(e, i)
    for a in range(6):
        gradient[i + a] += moment * slope[a]
        for b in range(6):
            tangent[i + a, i + b] += stiffness * slope[a] * slope[b]
    _add_curvature(i, -moment, before, tangent)
    _add_curvature(i + 2, moment, after, tangent)


@kernel(inline=True)
def _direction(x: float, y: float) -> Direction:
    """Derivatives of atan2(y, x)."""
    square = x * x + y * y
    fourth = square * square
    return Direction(-y / square, x / square, 2.0 * x * y / fourth, (y * y - x * x) / fourth)


@kernel(inline=True)
def _add_curvature(i: int, factor: float, direction: Direction, tangent: FloatArray) -> None:
    """Add factor times the second derivatives of the direction of the link that begins at coordinate i."""
    xx, xy = factor * direction.xx, factor * direction.xy
    for a in range(2):
        for b in range(2):
            sign, p, q = (2.0 * a - 1.0) * (2.0 * b - 1.0), i + 2 * a, i + 2 * b
            tangent[p, q] += sign * xx
            tangent[p, q + 1] += sign * xy
            tangent[p + 1, q] += sign * xy
            tangent[p + 1, q + 1] -= sign * xx


LINKS = 2
"""Links of an element."""


class ThreeNodeBeam(NamedTuple):
    """What the kernels of three-node beam elements get."""

    section: Section
    elastic: Quadrature


@kernel
def beam_energy(beam: ThreeNodeBeam, e: FloatArray, length: float) -> float:
    """Strain energy of an element; see `ElementKind.energy`."""
    link, total = length / LINKS, 0.0
    for k in range(LINKS):
        total += link_energy(e, 2 * k, beam.section.stretch, link)
        total += spring_energy(e, 2 * k, beam.section.bending / link)
    return total


@kernel
def beam_force(beam: ThreeNodeBeam, e: FloatArray, length: float, _wanted: bool, work: np.record) -> None:
    """Elastic force of an element with its tangent; see `ElementKind.force`."""
    work.gradient[:] = 0.0
    work.tangent[:] = 0.0
    link = length / LINKS
    for k in range(LINKS):
        add_link(e, 2 * k, beam.section.stretch, link, work.gradient, work.tangent)
        add_spring(e, 2 * k, beam.section.bending / link, work.gradient, work.tangent)


def lumped_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrix of two links, half of the mass of each at its ends and none at p3, shape (..., 8, 8), kg."""
    at_points = np.diag(np.repeat([0.5, 1.0, 0.5, 0.0], 2))
    return np.asarray(section.mass / LINKS * np.asarray(length)[..., None, None] * at_points)


def _control(length: FloatArray | float) -> FloatArray:
    """Control points of both links from p0, p1 and p2, shape (..., 2, 2, 3)."""
    both = np.array([[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]])
    return np.broadcast_to(both, (*np.shape(length), *both.shape))


THREE_NODE_BEAM = register(
    ElementKind(
        name="three-node-beam",
        meaning="pairs of links with torsional springs, for comparison",
        element=ThreeNodeBeam,
        coordinates=("r_x", "r_y"),
        points=LINKS,
        vectors=(0, 2, 4),
        shift=(1.0, 1.0, 1.0),
        control=_control,
        scale=lambda _length: (1.0,) * (2 * LINKS),
        mass=lumped_mass,
        nodal=lambda place, _slope, _bend: place.reshape(-1, 2 * LINKS),
        energy=beam_energy,
        force=beam_force,
        has_ends=False,
        cubic_angle=lambda angle: link_cubic_angle(angle / LINKS),
    )
)

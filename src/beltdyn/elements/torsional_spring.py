"""Torsional spring between two links: the bending stiffness of a three-node beam element without rotations.

The spring of stiffness EI / L at a point where links of length L meet resists the angle phi between them: its energy
is that of the curvature phi / L over the length L.
"""

from math import atan2
from typing import NamedTuple

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel


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

    Parameters
    ----------
    e : ndarray
        Places of points in turn, m.
    i
        Index of the first coordinate of point i; those of j and k follow.
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

    Parameters
    ----------
    e, i
        As for `bend_angle`.
    stiffness
        EI / L, N m.
    gradient : ndarray
        dU/de, N.
    tangent : ndarray
        d2U/de2, N/m.
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

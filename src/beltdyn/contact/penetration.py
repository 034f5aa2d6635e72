"""Penetration, normal and tangent of a centreline point against a pulley (Eqs. 18, 19, 21 and 22)."""

from math import sqrt
from typing import NamedTuple

from beltdyn.contact.law import PulleyState
from beltdyn.kernel import kernel


class Approach(NamedTuple):
    """How a belt point stands and moves against a pulley."""

    distance: float
    """rho = |r - O|, m."""
    penetration: float
    """d = R - rho, m; positive when the point is inside the pulley (Eq. 18)."""
    normal_x: float
    """Outward unit normal n (Eq. 19)."""
    normal_y: float
    radial: float
    """n . dr/dt against the centre, m/s; the penetration grows at the opposite rate."""
    circumferential: float
    """t . dr/dt against the centre, with t = (-n_y, n_x) (Eq. 21), m/s."""


@kernel
def approach(x: float, y: float, velocity_x: float, velocity_y: float, pulley: PulleyState) -> Approach:
    """Place a centreline point against a pulley (Eqs. 18, 19 and 21).

    Parameters
    ----------
    x, y
        Position r of the point, m.
    velocity_x, velocity_y
        Its velocity, m/s.
    pulley
        The pulley, whose centre may move.
    """
    dx, dy = x - pulley.center_x, y - pulley.center_y
    vx, vy = velocity_x - pulley.velocity_x, velocity_y - pulley.velocity_y
    distance = sqrt(dx * dx + dy * dy)
    nx, ny = dx / distance, dy / distance
    return Approach(
        distance,
        pulley.radius - distance,
        nx,
        ny,
        nx * vx + ny * vy,
        nx * vy - ny * vx,
    )


@kernel
def slip_velocity(point: Approach, pulley: PulleyState) -> float:
    """Slip velocity v_t = t . dr/dt - omega R (Eq. 22), m/s; published with R, not with the radius of the point."""
    return point.circumferential - pulley.speed * pulley.radius

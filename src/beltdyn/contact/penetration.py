"""Penetration, normal and tangent of a centerline point against a pulley (Eqs. 18, 19, 21 and 22).

With p = r - O the place against the shaft, n the normal of the surface and t = (-n_y, n_x), a point of the pulley at p
moves with omega (-p_y, p_x), that is omega (p . n) along t and -omega (p . t) along n.  On a smooth circle p . t = 0.
"""

from collections.abc import Callable
from math import sqrt
from typing import Any, NamedTuple

from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import Polygon, Round, Shaped, Toothed, polygon_seat, shaped_gap
from beltdyn.kernel import by_type, kernel


class Approach(NamedTuple):
    """Position and motion of a belt point relative to a pulley."""

    penetration: float
    """d, the distance inside the surface, m; R - rho of a smooth circle, with rho = |r - O| (Eq. 18)."""
    normal_x: float
    """Outward unit normal n (Eq. 19)."""
    normal_y: float
    curvature: float
    """How n turns along t at the point, 1/m; 1 / rho of a smooth circle."""
    lever: float
    """Arm p . n of a force along t about the shaft, m; rho of a smooth circle."""
    rim: float
    """The arm with which slip is taken: that of the surface below the point, p . n + d, m; R of a smooth circle,
    times `PulleyState.rim_ratio`; less d where it is taken at the cord."""
    sinking: float
    """By how much `rim` falls with the penetration: `PulleyState.cord`."""
    offset: float
    """Arm p . t of a force along n about the shaft, m; zero of a smooth circle."""
    turn: float
    """How n turns with the pulley where the point stays, 1 - curvature (p . n); zero of a smooth circle."""
    radial: float
    """n . dr/dt against the surface, m/s; the penetration grows at the opposite rate."""
    circumferential: float
    """t . dr/dt against the shaft (Eq. 21), m/s."""


@kernel
def approach(x: float, y: float, velocity_x: float, velocity_y: float, pulley: PulleyState) -> Approach:
    """Position and motion of a centerline point relative to a pulley (Eqs. 18, 19 and 21).

    `x`, `y`: position r of the point, m; `velocity_x`, `velocity_y`: its velocity, m/s; `pulley`: the pulley, whose
    shaft may move.
    """
    dx, dy = x - pulley.center_x, y - pulley.center_y
    vx, vy = velocity_x - pulley.velocity_x, velocity_y - pulley.velocity_y
    return _approach(pulley.surface, dx, dy, vx, vy, pulley)


@kernel(inline=True)
def _to_circle(surface: Any, dx: float, dy: float, vx: float, vy: float, pulley: PulleyState) -> Approach:
    """A smooth circle, whose angle does not matter."""
    distance = sqrt(dx * dx + dy * dy)
    nx, ny = dx / distance, dy / distance
    return Approach(
        penetration=surface.radius - distance,
        normal_x=nx,
        normal_y=ny,
        curvature=1.0 / distance,
        lever=distance,
        rim=surface.radius * pulley.rim_ratio - pulley.cord * (surface.radius - distance),
        sinking=pulley.cord,
        offset=0.0,
        turn=0.0,
        radial=nx * vx + ny * vy,
        circumferential=nx * vy - ny * vx,
    )


@kernel
def _to_shape(surface: Any, dx: float, dy: float, vx: float, vy: float, pulley: PulleyState) -> Approach:
    """A surface that turns with its pulley."""
    gap = shaped_gap(surface, dx, dy)
    nx, ny = gap.normal_x, gap.normal_y
    lever, offset = dx * nx + dy * ny, dy * nx - dx * ny
    return Approach(
        penetration=gap.penetration,
        normal_x=nx,
        normal_y=ny,
        curvature=gap.curvature,
        lever=lever,
        rim=lever + (1.0 - pulley.cord) * gap.penetration,
        sinking=pulley.cord,
        offset=offset,
        turn=1.0 - gap.curvature * lever,
        radial=nx * vx + ny * vy + pulley.speed * offset,
        circumferential=nx * vy - ny * vx,
    )


_approach: Callable[..., Approach] = by_type(
    {Round: _to_circle, Shaped: _to_shape, Toothed: _to_circle, Polygon: _to_shape}, "approach"
)


@kernel(inline=True)
def _rim_seat(surface: Any) -> float:
    return float(surface.radius)


_seat: Callable[[Any], float] = by_type({Round: _rim_seat, Toothed: _rim_seat, Polygon: polygon_seat}, "seat")


@kernel
def tooth_approach(x: float, y: float, velocity_x: float, velocity_y: float, pulley: PulleyState) -> Approach:
    """Position and motion of the middle of a tooth against its seat, about the shaft; see `approach`."""
    dx, dy = x - pulley.center_x, y - pulley.center_y
    vx, vy = velocity_x - pulley.velocity_x, velocity_y - pulley.velocity_y
    return _to_circle(Round(_seat(pulley.surface)), dx, dy, vx, vy, pulley)


@kernel
def slip_velocity(point: Approach, pulley: PulleyState) -> float:
    """Slip velocity v_t = t . dr/dt - omega a, m/s: with R as published (Eq. 22), or with the radius of the cord.

    Rubber that sticks to the rim follows its rotation, and the cord above it has no slip at the speed omega rho.
    """
    return point.circumferential - pulley.speed * point.rim

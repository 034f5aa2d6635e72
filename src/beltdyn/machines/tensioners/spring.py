"""The force of spring-loaded tensioners: spring, viscous damper, dry friction and stops."""

from math import tanh
from typing import NamedTuple

import numpy as np

from beltdyn.kernel import kernel
from beltdyn.records import record

SPRING = record(
    preload="f8",  # spring force at q = 0
    rate="f8",  # spring force lost in a unit of q
    damping="f8",  # viscous damping
    tensioning_friction="f8",  # dry friction while q grows
    yielding_friction="f8",  # dry friction while q falls
    creep_speed="f8",  # speed over which dry friction builds up
    lower="f8",  # lower stop, -inf where there is none
    upper="f8",  # upper stop, inf where there is none
    stop_stiffness="f8",  # stiffness of the stops
    stop_damping="f8",  # damping of the stops
)
"""Constants of a spring-loaded tensioner; q is in m or rad, forces in N or N m."""


class TensionerForce(NamedTuple):
    """Generalised force of a tensioner on its coordinate, positive where it lengthens the path, without weight."""

    force: float
    """N or N m."""
    by_position: float
    by_velocity: float
    energy: float
    """Stored since q = 0, J."""
    loss: float
    """Power lost, W."""


@kernel
def spring_force(constants: np.record, q: float, velocity: float) -> TensionerForce:
    """Force preload - k q - c v - dry friction + stops.

    Parameters
    ----------
    constants
        A row with a field `spring`, a row of `SPRING`.
    q, velocity
        Coordinate and its rate v, m and m/s, or rad and rad/s.
    """
    spring = constants.spring
    friction, friction_slope = dry_friction(spring, velocity)
    force = spring.preload - spring.rate * q - spring.damping * velocity - friction
    energy = (0.5 * spring.rate * q - spring.preload) * q
    by_position, by_velocity = -spring.rate, -spring.damping - friction_slope
    loss = (spring.damping * velocity + friction) * velocity
    if q > spring.upper:
        depth, side = q - spring.upper, 1.0
    elif q < spring.lower:
        depth, side = spring.lower - q, -1.0
    else:
        return TensionerForce(force, by_position, by_velocity, energy, loss)
    elastic, approach = spring.stop_stiffness * depth, side * velocity
    stop = elastic + spring.stop_damping * approach
    energy += 0.5 * elastic * depth
    if stop <= 0.0:
        return TensionerForce(force, by_position, by_velocity, energy, loss - elastic * approach)
    return TensionerForce(
        force - side * stop,
        by_position - spring.stop_stiffness,
        by_velocity - spring.stop_damping,
        energy,
        loss + spring.stop_damping * velocity * velocity,
    )


@kernel
def dry_friction(spring: np.record, velocity: float) -> tuple[float, float]:
    """Dry friction against the motion of a tensioner: f tanh(v / v_c), with an f for each sense.

    Parameters
    ----------
    spring
        A row of `SPRING`.
    velocity
        v, m/s or rad/s, positive where the path gets longer.

    Returns
    -------
    friction, slope : float
        Friction, N or N m, which has the sign of the velocity, and its derivative, that for positive ones at zero.
    """
    largest = spring.tensioning_friction if velocity >= 0.0 else spring.yielding_friction
    rise = tanh(velocity / spring.creep_speed)
    return largest * rise, largest * (1.0 - rise * rise) / spring.creep_speed

"""Pulleys as contact meets them at a state: turning, and moving where a tensioner carries them."""

from beltdyn.arrays import FloatArray
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import surface_at
from beltdyn.kernel import interpreted, kernel
from beltdyn.machines.tensioners.registry import tensioner_center
from beltdyn.system.arrays import System


@kernel
def tensioner_coordinate(system: System, tensioner: int) -> int:
    """Place of a tensioner's coordinate in the state."""
    return system.first_body + system.bodies.size - system.tensioners.size + tensioner


@kernel
def pulley_state(system: System, pulley: int, position: FloatArray, velocity: FloatArray) -> PulleyState:
    """A pulley at a state.

    Parameters
    ----------
    system
        The system.
    pulley
        Which one.
    position, velocity : ndarray, shape (n N + D,)
        The state.
    """
    item, body = system.pulleys[pulley], system.first_body + pulley
    carrier, speed = item.carrier, velocity[body]
    surface = surface_at(system.rims, pulley, position[body])
    if carrier < 0:
        return PulleyState(item.center[0], item.center[1], surface, speed, item.friction, 0.0, 0.0, item.rolling)
    at = tensioner_coordinate(system, carrier)
    center = tensioner_center(system.tensioners[carrier], position[at])
    vx, vy = velocity[at] * center.dx, velocity[at] * center.dy
    return PulleyState(center.x, center.y, surface, speed, item.friction, vx, vy, item.rolling)


def pulley_center(system: System, pulley: int, position: FloatArray) -> tuple[float, float]:
    """Where the shaft of a pulley is at a position of shape (n N + D,), m."""
    item = system.pulleys[pulley]
    if item.carrier < 0:
        return float(item.center[0]), float(item.center[1])
    place = position[interpreted(tensioner_coordinate)(system, item.carrier)]
    center = interpreted(tensioner_center)(system.tensioners[item.carrier], place)
    return float(center.x), float(center.y)


def pulley_speeds(system: System, velocity: FloatArray) -> FloatArray:
    """Speeds of all rims, rad/s, shape (..., pulleys), from the rates of states, shape (..., n N + D)."""
    return velocity[..., system.first_body : system.first_body + len(system.pulleys)]

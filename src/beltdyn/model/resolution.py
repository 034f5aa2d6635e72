"""How many elements smooth contact forces need, from what an element misses the circle of a pulley by."""

import math

from beltdyn.model.belt import Belt

MISS_LIMIT = 0.1
"""Largest distance between element and circle, over the penetration, that leaves contact forces smooth."""


def arc_angle(belt: Belt, radius: float) -> float:
    """Angle of a pulley that one element covers, rad."""
    return belt.length / (belt.elements * radius)


def arc_error(belt: Belt, radius: float) -> float:
    """Distance by which a cubic Hermite curve over the angle phi misses the circle, R phi^4 / 384, m.

    A straight link misses it by R phi^2 / 8.
    """
    if belt.links:
        return radius * (belt.length / (belt.links * radius)) ** 2 / 8
    return radius * arc_angle(belt, radius) ** 4 / 384


def elements_needed(belt: Belt, radius: float, penetration: float) -> int:
    """Number of elements that the belt can have for which the miss falls to `MISS_LIMIT` of the penetration.

    Parameters
    ----------
    belt
        The belt.
    radius, penetration
        Of the pulley and of the belt in it, m.
    """
    ratio = arc_error(belt, radius) / (MISS_LIMIT * penetration)
    count = belt.elements * float(ratio ** (0.5 if belt.links else 0.25))
    return math.ceil(count / belt.multiple) * belt.multiple

"""The open belt around two pulleys: lengths and angles."""

from math import asin, cos, pi, sqrt
from typing import NamedTuple


class OpenBelt(NamedTuple):
    """Path of an open (not crossed) belt around two pulleys."""

    span: float
    """Length of each span, m."""
    tilt: float
    """Angle between the spans and the line of centers, positive towards the second pulley, rad."""
    wrap: tuple[float, float]
    """Wrap angles, rad."""
    length: float
    """m."""


def open_belt(distance: float, radii: tuple[float, float]) -> OpenBelt:
    """Path of length 2 D cos b + R1 (pi - 2 b) + R2 (pi + 2 b) around two pulleys, sin b = (R2 - R1) / D.

    Examples
    --------
    >>> round(bd.theory.path.open_belt(distance=0.4, radii=(0.05, 0.1)).length, 4)
    1.2775
    """
    tilt = asin((radii[1] - radii[0]) / distance)
    span = sqrt(distance**2 - (radii[1] - radii[0]) ** 2)
    wrap = (pi - 2.0 * tilt, pi + 2.0 * tilt)
    return OpenBelt(span, tilt, wrap, 2.0 * span + radii[0] * wrap[0] + radii[1] * wrap[1])


_CLEAR = 1.05
"""Least center distance over that of touching pulleys."""


def center_distance(length: float, radii: tuple[float, float]) -> float | None:
    """Center distance at which the path around two pulleys has a length, m; None if the pulleys would touch.

    By Newton's method: the path grows by twice the cosine of the tilt.

    Examples
    --------
    >>> round(bd.theory.path.center_distance(1.2775, radii=(0.05, 0.1)), 3)
    0.4
    """
    least = _CLEAR * sum(radii)
    if open_belt(least, radii).length > length:
        return None
    distance = 0.5 * (length - pi * sum(radii))
    for _ in range(20):
        path = open_belt(max(distance, least), radii)
        step = (length - path.length) / (2.0 * cos(path.tilt))
        distance = max(distance, least) + step
        if abs(step) < 1e-12:
            break
    return distance

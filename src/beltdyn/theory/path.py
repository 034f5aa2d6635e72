"""The open belt around two pulleys: lengths and angles."""

from math import asin, pi, sqrt
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

"""Circular rims: centered, and eccentric."""

from collections.abc import Mapping
from math import cos, sin, sqrt

import numpy as np

from beltdyn.contact.surface.kind import Gap, SurfaceKind
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


@kernel
def circle_gap(_surface: np.record, x: float, y: float, radius: float) -> Gap:
    """Gap of a point at x, y against the shaft (m) against a circle of the effective radius R (m)."""
    distance = sqrt(x * x + y * y)
    return Gap(radius - distance, x / distance, y / distance, 1.0 / distance)


register(SurfaceKind("circle", circle_gap, lambda _: 0.0, ()))


@kernel
def eccentric_gap(surface: np.record, x: float, y: float, radius: float) -> Gap:
    """Kernel of `SurfaceKind.gap`: as on a circle about its own center, off the shaft by `eccentricity`."""
    dx = x - surface.eccentricity * cos(surface.eccentric_angle)
    dy = y - surface.eccentricity * sin(surface.eccentric_angle)
    distance = sqrt(dx * dx + dy * dy)
    return Gap(radius - distance, dx / distance, dy / distance, 1.0 / distance)


def _reach(parameters: Mapping[str, float]) -> float:
    return parameters["eccentricity"]


_KEYS = (
    Parameter("eccentricity", "m", "the distance of the rim's center from the shaft", example=1e-3),
    Parameter(
        "eccentric_angle", "rad", "the direction of the rim's center at the start", above=None, default=0.0, example=0.3
    ),
)
register(SurfaceKind("eccentric", eccentric_gap, _reach, _KEYS))

"""The contract of shaped pulley surfaces, their registry, and circular rims: centered, and eccentric."""

from collections.abc import Callable, Mapping
from math import cos, sin, sqrt
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import record
from beltdyn.kernel import KernelKinds, kernel
from beltdyn.kinds import Parameter, register


class Gap(NamedTuple):
    """Position of a point relative to a surface."""

    penetration: float
    """Distance from the surface, m, positive inside."""
    normal_x: float
    """Unit normal of the surface at its nearest point, outward."""
    normal_y: float
    curvature: float
    """How the normal turns along the line through the point at that distance, 1/m: 1 / (R - d) of a circle."""


class SurfaceKind(NamedTuple):
    """A kind of pulley surface, for `register`."""

    name: str
    """Its name in a drive file."""
    gap: Callable[[Any, float, float, float], Gap]
    """Kernel: the gap of a point from the parameters as fields of a record, its place x, y against the shaft in the
    frame that turns with the pulley (m), and the effective radius (m)."""
    reach: Callable[[Mapping[str, float]], float]
    """Largest deviation beyond the effective radius, m, from the parameters."""
    parameters: tuple[Parameter, ...]
    """Its keys in a drive file, and the fields of the record."""

    @property
    def constants(self) -> np.dtype[np.void]:
        """The record of its parameters."""
        return record(**{parameter.name: "f8" for parameter in self.parameters} or {"unused": "f8"})


KINDS = KernelKinds[SurfaceKind]("surface", SurfaceKind)
"""All kinds of surfaces by their names."""


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

"""A rim with lobes: rho = R + a cos(k phi)."""

from collections.abc import Mapping
from math import atan2, cos, floor, sin, sqrt

import numpy as np

from beltdyn.extend import Gap, Parameter, SurfaceKind, kernel, register

_STEPS = 8


@kernel
def lobed_gap(surface: np.record, x: float, y: float, radius: float) -> Gap:
    """Gap of a point at x, y (m) in the frame of the pulley; `lobe_height` is a (m), and `lobes` k, a whole number."""
    height, count = surface.lobe_height, floor(surface.lobes + 0.5)
    angle = atan2(y, x)
    for step in range(_STEPS + 1):
        c, s = cos(angle), sin(angle)
        rho = radius + height * cos(count * angle)
        slope, bend = -count * height * sin(count * angle), -count * count * height * cos(count * angle)
        dx, dy = rho * c - x, rho * s - y
        tx, ty = slope * c - rho * s, slope * s + rho * c
        if step < _STEPS:
            ax, ay = (bend - rho) * c - 2.0 * slope * s, (bend - rho) * s + 2.0 * slope * c
            angle -= (dx * tx + dy * ty) / (tx * tx + ty * ty + dx * ax + dy * ay)
    size = sqrt(tx * tx + ty * ty)
    nx, ny = ty / size, -tx / size
    depth = dx * nx + dy * ny
    curvature = (rho * rho + 2.0 * slope * slope - rho * bend) / size**3
    return Gap(depth, nx, ny, curvature / (1.0 - curvature * depth))


def _reach(parameters: Mapping[str, float]) -> float:
    return parameters["lobe_height"]


_KEYS = (
    Parameter("lobe_height", "m", "the height of the lobes above the mean radius", example=1e-3),
    Parameter("lobes", "", "the number of lobes", example=6.0),
)
register(SurfaceKind("lobed", lobed_gap, _reach, _KEYS))

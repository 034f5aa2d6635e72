"""The smooth circle, whose angle does not matter (Eqs. 18 and 19)."""

from math import sqrt

import numpy as np

from beltdyn.contact.surface.kind import Gap, SurfaceKind
from beltdyn.kernel import kernel
from beltdyn.kinds import register


@kernel
def circle_gap(_surface: np.record, x: float, y: float, radius: float) -> Gap:
    """Gap of a point at x, y against the shaft (m) against a circle of the effective radius R (m)."""
    distance = sqrt(x * x + y * y)
    return Gap(radius - distance, x / distance, y / distance, 1.0 / distance)


register(SurfaceKind("circle", circle_gap, lambda _: 0.0, ()))

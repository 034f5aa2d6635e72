"""A direction in the plane of the drive."""

from typing import Annotated

import numpy as np
from pydantic import AfterValidator

from beltdyn.parts.quantity import Ratio

_ROUNDING = 4 * np.finfo(float).eps


def _unit(vector: tuple[float, float]) -> tuple[float, float]:
    """Make a vector one metre long; one that is so already stays as it is."""
    length = float(np.hypot(*vector))
    if length == 0:
        raise ValueError("has zero length: at least one component must differ from zero")
    if abs(length - 1) <= _ROUNDING:
        return vector
    return vector[0] / length, vector[1] / length


Direction = Annotated[tuple[Ratio, Ratio], AfterValidator(_unit)]

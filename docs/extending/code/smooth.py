"""Smooth friction: f_t = -mu f_n tanh(v_t / v_c)."""

from math import atanh, tanh
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.extend import FrictionLaw, Parameter, kernel, register

_FULL = atanh(0.99)
"""Slip velocity over v_c at which 99 % of mu f_n are reached."""


class Smooth(NamedTuple):
    """Parameters of smooth friction."""

    smoothing_velocity: float
    """v_c, m/s."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity at which friction is fully used, whatever the normal force and the speed, m/s."""
        return np.full(np.broadcast_shapes(*map(np.shape, (normal, friction, rim))), _FULL * self.smoothing_velocity)

    def smoothed(self, factor: float) -> "Smooth":
        """Fully used at a slip velocity that is larger by a factor."""
        return Smooth(self.smoothing_velocity * factor)


@kernel
def smooth(law: Smooth, slip: float, normal: float, friction: float, rim: float) -> tuple[float, float, float, float]:
    """Friction force (N/m), and its derivatives by slip velocity (N s/m^2), normal force and speed of the rim."""
    part = tanh(slip / law.smoothing_velocity)
    slope = friction * normal * (1.0 - part * part) / law.smoothing_velocity
    return -friction * normal * part, -slope, -friction * part, 0.0


_KEY = Parameter("smoothing_velocity", "m/s", "the slip velocity over which smooth friction builds up", example=0.05)
register(FrictionLaw("smooth", Smooth, smooth, (_KEY,)))

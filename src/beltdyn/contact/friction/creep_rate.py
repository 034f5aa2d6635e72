"""Friction regularized by the creep rate: by the relative creep, and the paper's two slopes.

Coulomb friction, regularized below a creep velocity proportional to rim speed.

f_t = -mu f_n clip(v_t / v_c, -1, 1) with v_c = sqrt((s v_r)^2 + v_0^2), where v_r is the speed of the rim.  Elastic
creep is a fraction of the belt's speed too, so that one creep ratio s serves from a crawl to full speed.
"""

from math import sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


class RelativeCreep(NamedTuple):
    """Parameters of friction with a creep ratio."""

    creep_ratio: float
    """s."""
    standstill_creep: float
    """v_0, m/s."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity v_c whatever the normal force, m/s."""
        creep = np.hypot(np.multiply(self.creep_ratio, rim), self.standstill_creep)
        return np.broadcast_to(creep, np.broadcast_shapes(np.shape(creep), np.shape(normal), np.shape(friction)))

    def smoothed(self, factor: float) -> "RelativeCreep":
        """The law with its saturation at a slip velocity larger by a factor."""
        return RelativeCreep(self.creep_ratio * factor, self.standstill_creep * factor)


@kernel(inline=True)
def creep_velocity(law: Any, rim: float) -> float:
    """The velocity v_c of a law with both keys at a speed of the rim, m/s."""
    scaled = law.creep_ratio * rim
    return sqrt(scaled * scaled + law.standstill_creep * law.standstill_creep)


@kernel
def relative_creep(
    law: RelativeCreep, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of `FrictionLaw.force`: friction saturates at v_c = sqrt((s v_r)^2 + v_0^2)."""
    creep = creep_velocity(law, rim)
    if slip > creep:
        return -friction * normal, 0.0, -friction, 0.0
    if slip < -creep:
        return friction * normal, 0.0, friction, 0.0
    share = friction / creep
    force = -share * slip * normal
    return force, -share * normal, -share * slip, -force * law.creep_ratio * (law.creep_ratio * rim) / (creep * creep)


CREEP_KEYS = (
    Parameter(
        "creep_ratio", "", "the slip velocity at which friction saturates, over the rim speed", found=True, example=0.01
    ),
    Parameter("standstill_creep", "m/s", "the same slip velocity on a pulley at standstill", found=True, example=0.001),
)
"""The keys of a creep velocity that is proportional to the rim speed."""
register(FrictionLaw("relative_creep", RelativeCreep, relative_creep, CREEP_KEYS))


class CoefficientSlope(NamedTuple):
    """Parameters of the friction law of Leamy and Wasfy."""

    creep_velocity: float
    """v_c, m/s."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity v_c whatever the normal force, m/s."""
        return np.full(np.broadcast_shapes(*map(np.shape, (normal, friction, rim))), self.creep_velocity)

    def smoothed(self, factor: float) -> "CoefficientSlope":
        """The law with its saturation at a slip velocity larger by a factor."""
        return CoefficientSlope(self.creep_velocity * factor)


@kernel
def coefficient_slope(
    law: CoefficientSlope, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of `FrictionLaw.force`: friction saturates at the slip velocity v_c, whatever the speed of the rim."""
    if slip > law.creep_velocity:
        return -friction * normal, 0.0, -friction, 0.0
    if slip < -law.creep_velocity:
        return friction * normal, 0.0, friction, 0.0
    ratio = friction / law.creep_velocity
    return -ratio * slip * normal, -ratio * normal, -ratio * slip, 0.0


_VELOCITY = Parameter("creep_velocity", "m/s", "the slip velocity at which friction saturates", example=0.01)
register(FrictionLaw("coefficient_slope", CoefficientSlope, coefficient_slope, (_VELOCITY,)))


class ForceSlope(NamedTuple):
    """Parameters of the paper's friction law."""

    creep_rate_factor: float
    """nu_s, kg/(m s)."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity mu f_n / nu_s, m/s."""
        creep = np.multiply(friction, normal) / self.creep_rate_factor
        return np.broadcast_to(creep, np.broadcast_shapes(np.shape(creep), np.shape(rim)))

    def smoothed(self, factor: float) -> "ForceSlope":
        """The law with its saturation at a slip velocity larger by a factor."""
        return ForceSlope(self.creep_rate_factor / factor)


@kernel
def force_slope(
    law: ForceSlope, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of `FrictionLaw.force` (Eq. 20): the force rises by nu_s up to mu f_n, whatever the speed of the rim."""
    creep, limit = law.creep_rate_factor * slip, friction * normal
    if abs(creep) < limit:
        return -creep, -law.creep_rate_factor, 0.0, 0.0
    sign = 1.0 if creep > 0.0 else -1.0 if creep < 0.0 else 0.0
    return -sign * limit, 0.0, -sign * friction, 0.0


_FACTOR = Parameter("creep_rate_factor", "kg/(m*s)", "slope of the friction force over slip velocity", example=1e5)
register(FrictionLaw("force_slope", ForceSlope, force_slope, (_FACTOR,)))

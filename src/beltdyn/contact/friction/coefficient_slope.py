"""Friction law of Leamy and Wasfy (2002): f_t = -mu f_n clip(v_t / v_c, -1, 1), v_c the creep velocity."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


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
    """Friction force and its derivatives.

    Parameters
    ----------
    law
        Parameters.
    slip
        Slip velocity v_t, m/s.
    normal
        Normal force f_n, N/m, not negative.
    friction
        Coulomb coefficient mu.
    rim
        Speed of the rim, m/s, which does not matter here.

    Returns
    -------
    tuple of 4 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n, df_t/dv_r (N s/m^2).
    """
    if slip > law.creep_velocity:
        return -friction * normal, 0.0, -friction, 0.0
    if slip < -law.creep_velocity:
        return friction * normal, 0.0, friction, 0.0
    ratio = friction / law.creep_velocity
    return -ratio * slip * normal, -ratio * normal, -ratio * slip, 0.0


_KEY = Parameter("creep_velocity", "m/s", "the slip velocity at which friction saturates", example=0.01)
register(FrictionLaw("coefficient_slope", CoefficientSlope, coefficient_slope, (_KEY,)))

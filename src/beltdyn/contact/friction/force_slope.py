"""The paper's friction law: f_t = -clip(nu_s v_t, -mu f_n, mu f_n), nu_s the slope of the force (Eq. 20, Fig. 3)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


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
    """Friction force and its derivatives (Eq. 20).

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
    creep, limit = law.creep_rate_factor * slip, friction * normal
    if abs(creep) < limit:
        return -creep, -law.creep_rate_factor, 0.0, 0.0
    sign = 1.0 if creep > 0.0 else -1.0 if creep < 0.0 else 0.0
    return -sign * limit, 0.0, -sign * friction, 0.0


_KEY = Parameter("creep_rate_factor", "kg/(m*s)", "the slope of the friction force over the slip velocity", example=1e5)
register(FrictionLaw("force_slope", ForceSlope, force_slope, (_KEY,)))

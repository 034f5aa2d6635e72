"""The paper's friction law: f_t = -clip(nu_s v_t, -mu f_n, mu f_n), nu_s the slope of the force (Eq. 20, Fig. 3)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw, register
from beltdyn.contact.parameter import Parameter
from beltdyn.kernel import kernel


class ForceSlope(NamedTuple):
    """Parameters of the paper's friction law."""

    creep_rate_factor: float
    """nu_s, kg/(m s)."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike) -> FloatArray:
        """Slip velocity mu f_n / nu_s, m/s."""
        return np.multiply(friction, normal) / self.creep_rate_factor

    def smoothed(self, factor: float) -> "ForceSlope":
        """Fully used at a slip velocity that is larger by a factor."""
        return ForceSlope(self.creep_rate_factor / factor)

    def softened(self, limit: float, slip: float) -> str:
        """Advice for full friction at a larger slip velocity."""
        return f"lower contact.creep_rate_factor below {limit / slip:.2g}"

    def steepened(self, slope: FloatArray, limit: FloatArray) -> str:
        """Advice for a steeper slope."""
        return f"raise contact.creep_rate_factor = {self.creep_rate_factor:g} to {slope.max():.1e} kg/(m s)"


@kernel
def force_slope(law: ForceSlope, slip: float, normal: float, friction: float) -> tuple[float, float, float]:
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

    Returns
    -------
    tuple of 3 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n.
    """
    creep, limit = law.creep_rate_factor * slip, friction * normal
    if abs(creep) < limit:
        return -creep, -law.creep_rate_factor, 0.0
    sign = 1.0 if creep > 0.0 else -1.0 if creep < 0.0 else 0.0
    return -sign * limit, 0.0, -sign * friction


_KEY = Parameter("creep_rate_factor", "kg/(m*s)", "the slope of the friction force over the slip velocity")
register(FrictionLaw("force_slope", ForceSlope, force_slope, (_KEY,)))

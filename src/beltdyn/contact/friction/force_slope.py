"""The paper's friction law: f_t = -clip(nu_s v_t, -mu f_n, mu f_n), nu_s the slope of the force (Eq. 20, Fig. 3)."""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel


@kernel
def force_slope(slip: float, normal: float, friction: float, creep_rate_factor: float) -> tuple[float, float, float]:
    """Friction force and its derivatives (Eq. 20).

    Parameters
    ----------
    slip
        Slip velocity v_t, m/s.
    normal
        Normal force f_n, N/m, not negative.
    friction
        Coulomb coefficient mu.
    creep_rate_factor
        nu_s, kg/(m s).

    Returns
    -------
    tuple of 3 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n.
    """
    creep, limit = creep_rate_factor * slip, friction * normal
    if abs(creep) < limit:
        return -creep, -creep_rate_factor, 0.0
    sign = 1.0 if creep > 0.0 else -1.0 if creep < 0.0 else 0.0
    return -sign * limit, 0.0, -sign * friction


def _saturation(normal: ArrayLike, friction: ArrayLike, creep_rate_factor: float) -> FloatArray:
    """Slip velocity mu f_n / nu_s, m/s."""
    return np.multiply(friction, normal) / creep_rate_factor


def _softened(limit: float, slip: float) -> str:
    return f"lower contact.creep_rate_factor below {limit / slip:.2g}"


LAW = FrictionLaw("force_slope", "creep_rate_factor", _saturation, _softened)

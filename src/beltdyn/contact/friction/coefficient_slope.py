"""Friction law of Leamy and Wasfy (2002): f_t = -mu f_n clip(v_t / v_c, -1, 1), v_c the creep velocity."""

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel


@kernel
def coefficient_slope(slip: float, normal: float, friction: float, creep_velocity: float) -> tuple[float, float, float]:
    """Friction force and its derivatives.

    Parameters
    ----------
    slip
        Slip velocity v_t, m/s.
    normal
        Normal force f_n, N/m, not negative.
    friction
        Coulomb coefficient mu.
    creep_velocity
        v_c, m/s.

    Returns
    -------
    tuple of 3 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n.
    """
    if slip > creep_velocity:
        return -friction * normal, 0.0, -friction
    if slip < -creep_velocity:
        return friction * normal, 0.0, friction
    ratio = friction / creep_velocity
    return -ratio * slip * normal, -ratio * normal, -ratio * slip


def _saturation(normal: ArrayLike, friction: ArrayLike, creep_velocity: float) -> FloatArray:
    """Slip velocity v_c whatever the normal force, m/s."""
    return np.full(np.broadcast_shapes(np.shape(normal), np.shape(friction)), creep_velocity)


def _softened(limit: float, slip: float) -> str:
    return f"raise contact.creep_velocity to {slip:g} m/s"


LAW = FrictionLaw("coefficient_slope", "creep_velocity", _saturation, _softened)

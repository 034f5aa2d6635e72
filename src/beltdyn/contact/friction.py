"""Friction force per length (Eqs. 20 and 22, Fig. 3): tri-linear creep-rate laws."""

from beltdyn.contact.law import COEFFICIENT_SLOPE, ContactLaw
from beltdyn.kernel import kernel


@kernel
def friction_force(slip: float, normal: float, law: ContactLaw) -> tuple[float, float, float]:
    """Friction force along the tangent t and its derivatives (Eq. 20).

    Parameters
    ----------
    slip
        Slip velocity v_t = t . dr/dt - omega R (Eq. 22), m/s.
    normal
        Normal force f_n, N/m; friction depends on its magnitude.
    law
        Contact constants, with the choice of law.

    Returns
    -------
    tuple of 3 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n.
    """
    pressure, sign = (normal, 1.0) if normal >= 0.0 else (-normal, -1.0)
    if law.friction_law == COEFFICIENT_SLOPE:
        force, by_slip, by_pressure = coefficient_slope(slip, pressure, law.friction, law.creep)
    else:
        force, by_slip, by_pressure = force_slope(slip, pressure, law.friction, law.creep)
    return force, by_slip, sign * by_pressure


@kernel
def force_slope(slip: float, normal: float, friction: float, creep_rate_factor: float) -> tuple[float, float, float]:
    """The paper's law: f_t = -clip(nu_s v_t, -mu f_n, mu f_n), nu_s the slope of the force (Fig. 3).

    Parameters
    ----------
    slip, normal
        As for `friction_force`.
    friction
        Coulomb coefficient mu.
    creep_rate_factor
        nu_s, kg/(m s).
    """
    creep, limit = creep_rate_factor * slip, friction * normal
    if abs(creep) < limit:
        return -creep, -creep_rate_factor, 0.0
    sign = 1.0 if creep > 0.0 else -1.0 if creep < 0.0 else 0.0
    return -sign * limit, 0.0, -sign * friction


@kernel
def coefficient_slope(slip: float, normal: float, friction: float, creep_velocity: float) -> tuple[float, float, float]:
    """Leamy and Wasfy's law: f_t = -mu f_n clip(v_t / v_c, -1, 1), v_c the creep velocity.

    Parameters
    ----------
    slip, normal
        As for `friction_force`.
    friction
        Coulomb coefficient mu.
    creep_velocity
        v_c, m/s.
    """
    if slip > creep_velocity:
        return -friction * normal, 0.0, -friction
    if slip < -creep_velocity:
        return friction * normal, 0.0, friction
    ratio = friction / creep_velocity
    return -ratio * slip * normal, -ratio * normal, -ratio * slip

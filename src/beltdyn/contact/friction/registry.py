"""All friction laws, and the force of the one that a drive has chosen (Eq. 20)."""

from typing import Final

from beltdyn.contact.friction import coefficient_slope as leamy_wasfy
from beltdyn.contact.friction import force_slope as published
from beltdyn.contact.friction.coefficient_slope import coefficient_slope
from beltdyn.contact.friction.force_slope import force_slope
from beltdyn.contact.law import ContactLaw
from beltdyn.kernel import kernel

LAWS: Final = (published.LAW, leamy_wasfy.LAW)
"""The laws; the number of a law is its place here, and `friction_force` calls it by that number."""


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
        Contact constants, with the number of the friction law.

    Returns
    -------
    tuple of 3 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n.
    """
    pressure, sign = (normal, 1.0) if normal >= 0.0 else (-normal, -1.0)
    if law.friction_law == 1:
        force, by_slip, by_pressure = coefficient_slope(slip, pressure, law.friction, law.creep)
    else:
        force, by_slip, by_pressure = force_slope(slip, pressure, law.friction, law.creep)
    return force, by_slip, sign * by_pressure

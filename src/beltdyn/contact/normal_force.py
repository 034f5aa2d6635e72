"""Normal contact force per length (Eq. 17)."""

from beltdyn.contact.law import ContactLaw
from beltdyn.kernel import kernel


@kernel
def normal_force(penetration: float, penetration_rate: float, law: ContactLaw) -> tuple[float, float]:
    """Penalty force f_n = max(k_p d + c_p dd/dt, 0) for d >= 0, else 0 (Eq. 17).

    The printed law has no max: a belt that leaves fast is then pulled back by the damper, which `law.may_pull` allows.

    Parameters
    ----------
    penetration
        d, m.
    penetration_rate
        dd/dt, m/s.
    law
        Contact constants.

    Returns
    -------
    force : float
        f_n along the outward normal, N per m of reference length.
    active : float
        1 where the force acts and 0 where it does not; the derivatives are active k_p and active c_p.
    """
    force = law.stiffness * penetration + law.damping * penetration_rate
    if penetration < 0.0 or (force <= 0.0 and not law.may_pull):
        return 0.0, 0.0
    return force, 1.0

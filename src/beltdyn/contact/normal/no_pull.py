"""Penalty force that is never tensile: f_n = max(k_p d + c_p dd/dt, 0) (Eq. 17 with a maximum)."""

from typing import NamedTuple

from beltdyn.contact.normal.law import NormalForce, NormalLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import register


class NoPull(NamedTuple):
    """Parameters of a penalty force that is never tensile."""

    stiffness: float
    """k_p, N/m per m of belt, that is N/m^2."""
    damping: float
    """c_p, N s/m per m of belt."""


@kernel
def no_pull(law: NoPull, penetration: float, rate: float) -> NormalForce:
    """Normal force and its derivatives.

    Parameters
    ----------
    law
        Parameters.
    penetration
        d, m, not negative.
    rate
        dd/dt, m/s.
    """
    elastic = law.stiffness * penetration
    force, energy = elastic + law.damping * rate, 0.5 * elastic * penetration
    if force <= 0.0:
        return NormalForce(0.0, 0.0, 0.0, elastic, energy)
    return NormalForce(force, law.stiffness, law.damping, elastic, energy)


register(NormalLaw("no_pull", NoPull, no_pull, ()))

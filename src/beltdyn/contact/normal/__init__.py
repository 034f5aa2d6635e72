"""Laws of the normal force, one per file (Eq. 17); importing one here registers it."""

from beltdyn.contact.normal.law import LAWS as LAWS
from beltdyn.contact.normal.law import NormalForce as NormalForce
from beltdyn.contact.normal.law import NormalLaw as NormalLaw
from beltdyn.contact.normal.law import NormalParameters as NormalParameters
from beltdyn.contact.normal.penalty import NoPull as NoPull
from beltdyn.contact.normal.penalty import Published as Published
from beltdyn.kernel import by_type, kernel

_pressed = by_type(LAWS.by_class("force"), "normal_force")


@kernel
def normal_force(law: NormalParameters, penetration: float, rate: float) -> NormalForce:
    """Normal force f_n at a penetration d, none at d < 0, and its derivatives (Eq. 17).

    Parameters
    ----------
    law
        Parameters of a law of the normal force.
    penetration
        d, m.
    rate
        dd/dt, m/s.
    """
    if penetration < 0.0:
        return NormalForce(0.0, 0.0, 0.0, 0.0, 0.0)
    return _pressed(law, penetration, rate)

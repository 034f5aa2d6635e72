"""Penalty laws of normal contact: the published one, and one that never pulls."""

from typing import NamedTuple

from beltdyn.contact.normal.law import NormalForce, NormalLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import register


class Published(NamedTuple):
    """Parameters of the penalty force as published."""

    stiffness: float
    """k_p, N/m per m of belt, that is N/m^2."""
    damping: float
    """c_p, N s/m per m of belt."""


@kernel
def published(law: Published, penetration: float, rate: float) -> NormalForce:
    """Kernel of `NormalLaw.force` (Eq. 17): k_p d + c_p dd/dt, which may pull."""
    elastic = law.stiffness * penetration
    return NormalForce(elastic + law.damping * rate, law.stiffness, law.damping, elastic, 0.5 * elastic * penetration)


register(NormalLaw("published", Published, published, ()))


class NoPull(NamedTuple):
    """Parameters of a penalty force that is never tensile."""

    stiffness: float
    """k_p, N/m per m of belt, that is N/m^2."""
    damping: float
    """c_p, N s/m per m of belt."""


@kernel
def no_pull(law: NoPull, penetration: float, rate: float) -> NormalForce:
    """Kernel of `NormalLaw.force`: k_p d + c_p dd/dt, and none where that would pull."""
    elastic = law.stiffness * penetration
    force, energy = elastic + law.damping * rate, 0.5 * elastic * penetration
    if force <= 0.0:
        return NormalForce(0.0, 0.0, 0.0, elastic, energy)
    return NormalForce(force, law.stiffness, law.damping, elastic, energy)


register(NormalLaw("no_pull", NoPull, no_pull, ()))

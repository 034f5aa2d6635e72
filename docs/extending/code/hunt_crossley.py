"""Normal force of Hunt and Crossley (1975): f_n = k_p d (1 + chi dd/dt), never pulling."""

from typing import NamedTuple

from beltdyn.extend import NormalForce, NormalLaw, Parameter, kernel, register


class HuntCrossley(NamedTuple):
    """Parameters of the law of Hunt and Crossley."""

    stiffness: float
    """k_p, N/m^2."""
    damping: float
    """c_p of a damper beside it, N s/m^2; zero in the published law."""
    impact_damping: float
    """chi, s/m."""


@kernel
def hunt_crossley(law: HuntCrossley, penetration: float, rate: float) -> NormalForce:
    """Normal force at a penetration (m, not negative) and its rate (m/s), with its derivatives."""
    elastic = law.stiffness * penetration
    damping = law.damping + law.impact_damping * elastic
    force, energy = elastic + damping * rate, 0.5 * elastic * penetration
    if force <= 0.0:
        return NormalForce(0.0, 0.0, 0.0, elastic, energy)
    slope = law.stiffness * (1.0 + law.impact_damping * rate)
    return NormalForce(force, slope, damping, elastic, energy)


_KEY = Parameter(
    "impact_damping", "s/m", "the part of the elastic contact force that a rate of 1 m/s adds to it", example=1.0
)
register(NormalLaw("hunt_crossley", HuntCrossley, hunt_crossley, (_KEY,)))

"""Friction that falls from its static coefficient mu to a kinetic one (Stribeck; Bo and Pavelescu 1982).

f_t = -mu f_n v_t / v_c up to the creep velocity v_c = sqrt((s v_r)^2 + v_0^2), beyond it

    f_t = -mu f_n sign(v_t) (r + (1 - r) exp(-(|v_t| - v_c) / v_s)).

The negative slope on sliding arcs drives stick-slip and squeal; a ratio r above 1 gives the rising friction of rubber.
"""

from math import exp
from typing import NamedTuple

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.creep_rate import CREEP_KEYS, RelativeCreep, creep_velocity, relative_creep
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


class Stribeck(NamedTuple):
    """Parameters of friction that falls with the slip velocity."""

    creep_ratio: float
    """s."""
    standstill_creep: float
    """v_0, m/s."""
    kinetic_ratio: float
    """r."""
    stribeck_velocity: float
    """v_s, m/s."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity v_c whatever the normal force, m/s."""
        return RelativeCreep(self.creep_ratio, self.standstill_creep).saturation(normal, friction, rim)

    def smoothed(self, factor: float) -> "Stribeck":
        """The law with its velocities larger by a factor."""
        return Stribeck(
            self.creep_ratio * factor,
            self.standstill_creep * factor,
            self.kinetic_ratio,
            self.stribeck_velocity * factor,
        )


@kernel
def stribeck(
    law: Stribeck, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of `FrictionLaw.force`: the coefficient falls from the static mu to r mu as the slip velocity rises."""
    creep = creep_velocity(law, rim)
    if abs(slip) <= creep:
        return relative_creep(RelativeCreep(law.creep_ratio, law.standstill_creep), slip, normal, friction, rim)
    sign = 1.0 if slip > 0.0 else -1.0
    fall = (1.0 - law.kinetic_ratio) * exp(-(abs(slip) - creep) / law.stribeck_velocity)
    by_normal = -sign * friction * (law.kinetic_ratio + fall)
    by_slip = friction * normal * fall / law.stribeck_velocity
    return by_normal * normal, by_slip, by_normal, -sign * by_slip * law.creep_ratio * (law.creep_ratio * rim) / creep


_KEYS = (  # defaults are those of a wet V-ribbed belt, see `beltdyn.model.friction_state`
    *CREEP_KEYS,
    Parameter("kinetic_ratio", "", "the kinetic over the static coefficient of friction", default=0.7, example=0.7),
    Parameter(
        "stribeck_velocity",
        "m/s",
        "the slip velocity over which friction falls to its kinetic value by 1/e",
        default=0.5,
        example=0.5,
    ),
)
register(FrictionLaw("stribeck", Stribeck, stribeck, _KEYS))

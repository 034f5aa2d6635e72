"""A fan or centrifugal pump by its catalogue: M = -M_n ((1 - b) (omega / omega_n)^2 + b) against the motion.

The quadratic part is the affinity law of turbomachines; the constant share b is friction of bearings and seals.
"""

from collections.abc import Mapping
from typing import Any, Literal

from pydantic import Field

from beltdyn.machines.loads.load import Load
from beltdyn.machines.loads.resistance import RESISTANCE, resistance
from beltdyn.parts.quantity import AngularSpeed, Power, Ratio


class Fan(Load):
    """A fan, blower or centrifugal pump, with a torque quadratic in speed plus friction.

    Examples
    --------
    >>> bd.Fan(kind="fan", rated_power="2 kW", rated_speed="1500 rpm").rated_power
    2000.0
    """

    constants = RESISTANCE
    torque_at = resistance

    kind: Literal["fan"] = Field(description="the kind of load")
    rated_power: Power = Field(gt=0, description="the shaft power at the rated speed, in W")
    rated_speed: AngularSpeed = Field(gt=0, description="the speed at rated power, in rad/s, of either sign")
    friction_share: Ratio = Field(
        0.0, ge=0, lt=1, description="the fraction of the rated torque that is friction, independent of speed"
    )
    creep_speed: AngularSpeed = Field(0.1, gt=0, description="the speed at which friction reaches 76 %, in rad/s")

    def values(self) -> Mapping[str, Any]:
        """Constants of a resistance."""
        rated = self.rated_power / self.rated_speed
        return {
            "constant": self.friction_share * rated,
            "creep_speed": self.creep_speed,
            "linear": 0.0,
            "quadratic": (1.0 - self.friction_share) * rated / self.rated_speed**2,
        }

"""A resistance that opposes the motion: -(c tanh(omega / omega_c) + l omega + q omega |omega|)."""

from collections.abc import Mapping
from math import tanh, tau
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.brake import BRAKE, braking_torque
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.machines.profiles import PressureProfile
from beltdyn.machines.profiles.profile import Profile
from beltdyn.parts.quantity import AngularSpeed, Power, QuadraticDamping, Ratio, Torque, TorsionalDamping, quantity

RESISTANCE = record(
    constant="f8",  # c, N m
    creep_speed="f8",  # omega_c, over which the constant part builds up (dry friction, regularized), rad/s
    linear="f8",  # l, N m s/rad
    quadratic="f8",  # q, N m s^2/rad^2
)


@kernel
def resistance(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at`: -(c tanh(omega / omega_c) + l omega + q omega |omega|), a row of `RESISTANCE`."""
    speed = shaft.speed
    rise, size = tanh(speed / constants.creep_speed), abs(speed)
    torque = constants.constant * rise + (constants.linear + constants.quadratic * size) * speed
    dry = constants.constant * (1.0 - rise * rise) / constants.creep_speed
    return LoadTorque(-torque, 0.0, -(dry + constants.linear + 2.0 * constants.quadratic * size), 0.0)


@register
class Resistance(Load):
    """A torque that opposes the motion of the shaft: constant (dry friction), linear or quadratic in speed.

    Examples
    --------
    >>> bd.model.Resistance(kind="resistance", constant="2 N m", linear=0.01).constant
    2.0
    """

    constants = RESISTANCE
    torque_at = resistance

    kind: Literal["resistance"] = Field(description="the kind of load")
    constant: Torque = Field(0.0, ge=0, description="the part independent of speed, in N*m")
    creep_speed: AngularSpeed = Field(
        0.1, gt=0, description="the speed at which the constant part reaches 76 %, in rad/s"
    )
    linear: TorsionalDamping = Field(0.0, ge=0, description="the part linear in speed, in N m s/rad")
    quadratic: QuadraticDamping = Field(0.0, ge=0, description="the part quadratic in speed, in N m s^2/rad^2")

    @model_validator(mode="after")
    def _resists(self) -> Self:
        if self.constant == self.linear == self.quadratic == 0:
            raise ValueError("has no resistance. Give constant, linear or quadratic")
        return self


# A fan or centrifugal pump by its catalogue: M = -M_n ((1 - b) (omega / omega_n)^2 + b) against the motion


@register
class Fan(Load):
    """A fan, blower or centrifugal pump, with a torque quadratic in speed plus friction.

    Examples
    --------
    >>> bd.model.Fan(kind="fan", rated_power="2 kW", rated_speed="1500 rpm").rated_power
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


# A displacement pump, as with gears, vanes or pistons: M = -p V / (2 pi eta), against the motion


@register
class Pump(Load):
    """A displacement pump (gear, vane or piston), whose torque follows the pressure at any speed.

    Examples
    --------
    >>> load = bd.model.Pump(
    ...     kind="pump", displacement="10 cm^3",
    ...     pressure={"kind": "constant", "value": 1e6}, efficiency=0.9
    ... )
    >>> load.efficiency
    0.9
    """

    constants = BRAKE
    torque_at = braking_torque

    kind: Literal["pump"] = Field(description="the kind of load")
    displacement: Annotated[float, quantity("m^3")] = Field(gt=0, description="the displaced volume per turn, in m^3")
    pressure: PressureProfile = Field(description="the pressure rise over time, in Pa")
    efficiency: Ratio = Field(gt=0, le=1, description="the hydraulic-mechanical efficiency, 0 to 1")
    creep_speed: AngularSpeed = Field(0.1, gt=0, description="the speed at which the torque reaches 76 %, in rad/s")

    def values(self) -> Mapping[str, Any]:
        """Torques over the pressure, and the creep speed."""
        arm = self.displacement / (tau * self.efficiency)
        return {"forward": arm, "backward": arm, "creep_speed": self.creep_speed}

    @property
    def command(self) -> Profile:
        """The pressure rise over time."""
        return self.pressure

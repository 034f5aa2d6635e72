"""A resistance that opposes the motion: -(c tanh(omega / omega_c) + l omega + q omega |omega|)."""

from math import tanh
from typing import Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.parts.quantity import AngularSpeed, QuadraticDamping, Torque, TorsionalDamping
from beltdyn.records import record

RESISTANCE = record(
    constant="f8",  # c, N m
    creep_speed="f8",  # omega_c, over which the constant part builds up (dry friction, regularised), rad/s
    linear="f8",  # l, N m s/rad
    quadratic="f8",  # q, N m s^2/rad^2
)


@kernel
def resistance(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Torque -(c tanh(omega / omega_c) + l omega + q omega |omega|).

    Parameters
    ----------
    constants
        A row of `RESISTANCE`.
    shaft
        Its speed omega counts.
    """
    speed = shaft.speed
    rise, size = tanh(speed / constants.creep_speed), abs(speed)
    torque = constants.constant * rise + (constants.linear + constants.quadratic * size) * speed
    dry = constants.constant * (1.0 - rise * rise) / constants.creep_speed
    return LoadTorque(-torque, 0.0, -(dry + constants.linear + 2.0 * constants.quadratic * size), 0.0)


class Resistance(Load):
    """A torque that opposes the motion of the shaft: constant (dry friction), linear or quadratic in speed.

    Examples
    --------
    >>> bd.Resistance(kind="resistance", constant="2 N m", linear=0.1).constant
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

"""A motor with permanent magnets: M = k clip((U - k omega) / R, -I, I)."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.extend import Load, LoadTorque, ShaftState, kernel, nearer_kink, quantity, record, register

PERMANENT_MAGNET_MOTOR = record(
    voltage="f8",  # U, V
    torque_constant="f8",  # k, N m/A, which is V s/rad too
    resistance="f8",  # R, ohm
    current_limit="f8",  # I, A
)


@kernel
def motor_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Torque over the speed; constants are a row of `PERMANENT_MAGNET_MOTOR`."""
    factor, limit = constants.torque_constant, constants.current_limit
    current = (constants.voltage - factor * shaft.speed) / constants.resistance
    if abs(current) > limit:
        return LoadTorque(factor * limit if current > 0.0 else -factor * limit, 0.0, 0.0, 0.0)
    return LoadTorque(factor * current, 0.0, -factor * factor / constants.resistance, 0.0)


@kernel
def limit_reached(constants: np.record, _numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """Next speed at which the current reaches its limit, or leaves it."""
    drop, nearest = constants.current_limit * constants.resistance, np.inf
    for side in (-1.0, 1.0):
        kink = (constants.voltage + side * drop) / constants.torque_constant
        nearest = nearer_kink(kink, nearest, shaft.speed, rising)
    return nearest


@register
class PermanentMagnetMotor(Load):
    """A motor with permanent magnets at constant voltage, whose supply limits its current."""

    constants = PERMANENT_MAGNET_MOTOR
    torque_at = motor_torque
    next_kink = limit_reached
    signed = ("voltage",)

    kind: Literal["permanent_magnet_motor"] = Field(description="the kind of load")
    voltage: Annotated[float, quantity("V")] = Field(description="the voltage, in V, of either sign")
    torque_constant: Annotated[float, quantity("N*m/A")] = Field(gt=0, description="the torque over current, in N*m/A")
    resistance: Annotated[float, quantity("ohm")] = Field(gt=0, description="the resistance, in ohm")
    current_limit: Annotated[float, quantity("A")] = Field(gt=0, description="the largest current, in A")

    @property
    def driven_speed(self) -> float:
        """The speed without load, rad/s."""
        return self.voltage / self.torque_constant

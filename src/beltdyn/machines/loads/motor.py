"""An induction motor: M = 2 M_b / (s / s_b + s_b / s), s = 1 - omega / omega_s (Kloss's formula).

Source: M. Kloss, "Drehmoment und Schlüpfung des Drehstrommotors", Archiv für Elektrotechnik 5 (1916).
"""

from typing import Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque
from beltdyn.parts.quantity import AngularSpeed, Ratio, Torque
from beltdyn.records import record

MOTOR = record(
    breakdown_torque="f8",  # M_b, the largest torque, N m
    breakdown_slip="f8",  # s_b, the slip at which it is reached
    synchronous_speed="f8",  # omega_s, rad/s, not zero; negative for a clockwise motor
)


@kernel
def kloss(constants: np.record, _points: FloatArray, _angle: float, speed: float) -> LoadTorque:
    """Torque in the sense of the synchronous speed: it drives below that speed, and brakes above.

    Parameters
    ----------
    constants
        A row of `MOTOR`.
    speed
        omega, rad/s.
    """
    breakdown = constants.breakdown_slip
    sense = 1.0 if constants.synchronous_speed > 0.0 else -1.0
    slip = 1.0 - speed / constants.synchronous_speed
    square = slip * slip + breakdown * breakdown
    top = 2.0 * sense * constants.breakdown_torque * breakdown
    by_slip = top * (breakdown * breakdown - slip * slip) / (square * square)
    return LoadTorque(top * slip / square, 0.0, -by_slip / constants.synchronous_speed)


class Motor(Load):
    """An induction motor after Kloss: it drives below its synchronous speed, and brakes above it."""

    constants = MOTOR
    torque_at = kloss

    kind: Literal["motor"] = Field(description="the kind of load")
    breakdown_torque: Torque = Field(gt=0, description="the largest torque, in N*m")
    breakdown_slip: Ratio = Field(gt=0, le=1, description="the slip at which the torque is largest, 0 to 1")
    synchronous_speed: AngularSpeed = Field(
        description="the speed without load, in rad/s, negative for a motor that turns clockwise"
    )

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if self.synchronous_speed == 0:
            raise ValueError("synchronous_speed = 0 leaves the slip undefined. Give another speed")
        return self

    @property
    def driven_speed(self) -> float:
        """The synchronous speed, rad/s."""
        return self.synchronous_speed

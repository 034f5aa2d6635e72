"""An induction motor: M = 2 M_b / (s / s_b + s_b / s), s = 1 - omega / omega_s (Kloss's formula).

Source: M. Kloss, "Drehmoment und Schlüpfung des Drehstrommotors", Archiv für Elektrotechnik 5 (1916).
"""

from typing import Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.parts.quantity import AngularSpeed, Ratio, Torque
from beltdyn.records import record

MOTOR = record(
    breakdown_torque="f8",  # M_b, the largest torque, N m
    breakdown_slip="f8",  # s_b, the slip at which it is reached
    synchronous_speed="f8",  # omega_s, rad/s, not zero; negative for a clockwise motor
)


@kernel
def kloss_over_slip(breakdown_torque: float, breakdown_slip: float, slip: float) -> tuple[float, float]:
    """Kloss's torque at a slip, and its derivative with respect to the slip, N m."""
    square = slip * slip + breakdown_slip * breakdown_slip
    top = 2.0 * breakdown_torque * breakdown_slip
    return top * slip / square, top * (breakdown_slip * breakdown_slip - slip * slip) / (square * square)


@kernel
def kloss(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Torque in the sense of the synchronous speed: it drives below that speed, and brakes above.

    Parameters
    ----------
    constants
        A row of `MOTOR`.
    shaft
        Its speed counts.
    """
    sense = 1.0 if constants.synchronous_speed > 0.0 else -1.0
    slip = 1.0 - shaft.speed / constants.synchronous_speed
    torque, by_slip = kloss_over_slip(sense * constants.breakdown_torque, constants.breakdown_slip, slip)
    return LoadTorque(torque, 0.0, -by_slip / constants.synchronous_speed, 0.0)


class Motor(Load):
    """An induction motor after Kloss, which drives below its synchronous speed and brakes above it.

    Examples
    --------
    >>> load = bd.Motor(
    ...     kind="motor", breakdown_torque="20 N m",
    ...     breakdown_slip=0.2, synchronous_speed="1500 rpm"
    ... )
    >>> load.breakdown_torque
    20.0
    """

    constants = MOTOR
    torque_at = kloss

    kind: Literal["motor"] = Field(description="the kind of load")
    breakdown_torque: Torque = Field(gt=0, description="the largest torque, in N*m")
    breakdown_slip: Ratio = Field(gt=0, le=1, description="the slip at the largest torque, 0 to 1")
    synchronous_speed: AngularSpeed = Field(description="the no-load speed, in rad/s, negative for clockwise rotation")

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if self.synchronous_speed == 0:
            raise ValueError("synchronous_speed = 0 leaves the slip undefined. Give a speed other than zero")
        return self

    @property
    def driven_speed(self) -> float:
        """The synchronous speed, rad/s."""
        return self.synchronous_speed

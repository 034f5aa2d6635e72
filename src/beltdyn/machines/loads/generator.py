"""A generator of regulated voltage: M = -P / (eta omega), as far as its full field allows.

Above the cut-in speed omega_0 the full field gives the power P_f = P_max (1 - omega_0 / |omega|), which claw-pole
alternators follow well: their current rises from zero at the cut-in speed towards its largest.
"""

from typing import Literal

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState, nearer_kink
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.profiles.registry import PowerProfile
from beltdyn.parts.quantity import AngularSpeed, Power, Ratio
from beltdyn.records import record

GENERATOR = record(
    cut_in_speed="f8",  # omega_0, rad/s
    full_field_power="f8",  # P_max, W
    efficiency="f8",  # eta
)


@kernel
def generator_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Torque against the motion.

    Parameters
    ----------
    constants
        A row of `GENERATOR`.
    shaft
        Its speed, and its command, the demanded electrical power, W.
    """
    speed, least = abs(shaft.speed), constants.cut_in_speed
    if speed <= least:
        return LoadTorque(0.0, 0.0, 0.0, 0.0)
    sense = 1.0 if shaft.speed > 0.0 else -1.0
    over = 1.0 / (constants.efficiency * speed)
    full = constants.full_field_power * (1.0 - least / speed)
    if shaft.command < full:
        return LoadTorque(-sense * shaft.command * over, 0.0, shaft.command * over / speed, -sense * over)
    by_speed = constants.full_field_power * over * (2.0 * least / speed - 1.0) / speed
    return LoadTorque(-sense * full * over, 0.0, -by_speed, 0.0)


@kernel
def next_end_of_regulation(constants: np.record, _numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """The next speed at which it cuts in or reaches the demanded power, in either sense."""
    nearest, least = np.inf, constants.cut_in_speed
    rest = 1.0 - shaft.command / constants.full_field_power
    for sense in (-1.0, 1.0):
        nearest = nearer_kink(sense * least, nearest, shaft.speed, rising)
        if rest > 0.0:
            nearest = nearer_kink(sense * least / rest, nearest, shaft.speed, rising)
    return nearest


@register
class Generator(Load):
    """A generator or alternator of regulated voltage, which draws the demanded power at any speed.

    Examples
    --------
    >>> load = bd.model.Generator(
    ...     kind="generator", power={"kind": "constant", "value": 1000.0}, efficiency=0.7,
    ...     cut_in_speed="1500 rpm", full_field_power="2 kW"
    ... )
    >>> load.full_field_power
    2000.0
    """

    constants = GENERATOR
    torque_at = generator_torque
    next_kink = next_end_of_regulation

    kind: Literal["generator"] = Field(description="the kind of load")
    power: PowerProfile = Field(description="the demanded electrical power over time, in W")
    efficiency: Ratio = Field(gt=0, le=1, description="the electrical power over the shaft power, 0 to 1")
    cut_in_speed: AngularSpeed = Field(gt=0, description="the least speed at which it gives power, in rad/s")
    full_field_power: Power = Field(gt=0, description="the electrical power at full field and high speed, in W")

    @property
    def command(self) -> Profile:
        """The electrical power over time."""
        return self.power

"""Brakes: a torque against the motion, possibly different in both senses, smoothed at standstill.

M = -M_+ tanh(omega / omega_c) for omega > 0, -M_- tanh(omega / omega_c) else.  Of a band that a force F pulls, wrapped
by phi (Euler-Eytelwein), M is F r (exp(mu phi) - 1) where the drum turns away from the force, F r (1 - exp(-mu phi))
else.
"""

from collections.abc import Mapping
from math import expm1, tanh
from typing import Any, Literal

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.machines.profiles import BrakingProfile, ForceProfile
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.profiles.ramps import Constant
from beltdyn.parts.quantity import Angle, AngularSpeed, Length, Ratio, Torque

BRAKE = record(
    forward="f8",  # torque over the command against a counter-clockwise motion, N m over the unit of the command
    backward="f8",  # the same against a clockwise motion
    creep_speed="f8",  # omega_c, rad/s
)


@kernel
def braking_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `BRAKE`: torque against the motion; the command clamps the brake."""
    rise = tanh(shaft.speed / constants.creep_speed)
    arm = constants.forward if shaft.speed > 0.0 else constants.backward
    by_speed = -arm * shaft.command * (1.0 - rise * rise) / constants.creep_speed
    return LoadTorque(-arm * shaft.command * rise, 0.0, by_speed, -arm * rise)


@kernel
def standstill(constants: np.record, _numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """Zero ahead, where the slope of a brake changes that differs in both senses; infinite behind."""
    ahead = (shaft.speed < 0.0) == rising and shaft.speed != 0.0
    return 0.0 if ahead and constants.forward != constants.backward else np.inf


@register
class Brake(Load):
    """A disc, shoe or plate brake, clamped over time, whose torque opposes the motion.

    Examples
    --------
    >>> bd.model.Brake(kind="brake", torque={"kind": "step", "time": 0.5, "value": 20.0}).torque.at([0.0, 1.0])
    array([ 0., 20.])
    """

    constants = BRAKE
    torque_at = braking_torque
    next_kink = standstill

    kind: Literal["brake"] = Field(description="the kind of load")
    torque: BrakingProfile = Field(description="the sliding torque of the brake over time, in N*m")
    backward_ratio: Ratio = Field(
        1.0, ge=0, description="the torque in clockwise rotation over that in counter-clockwise rotation"
    )
    creep_speed: AngularSpeed = Field(0.1, gt=0, description="the speed at which the torque reaches 76 %, in rad/s")

    def values(self) -> Mapping[str, Any]:
        """Torques over the command, and the creep speed."""
        return {"forward": 1.0, "backward": self.backward_ratio, "creep_speed": self.creep_speed}

    @property
    def command(self) -> Profile:
        """The torque over time."""
        return self.torque


@register
class BandBrake(Load):
    """A band brake on a drum on the shaft, with one end fixed and the other pulled over time.

    Examples
    --------
    >>> load = bd.model.BandBrake(
    ...     kind="band_brake", force={"kind": "constant", "value": 50.0}, radius="80 mm",
    ...     friction=0.3, wrap="270 deg"
    ... )
    >>> load.wrap
    4.71238898038469
    """

    constants = BRAKE
    torque_at = braking_torque
    next_kink = standstill

    kind: Literal["band_brake"] = Field(description="the kind of load")
    force: ForceProfile = Field(description="the force at the pulled end over time, in N")
    radius: Length = Field(gt=0, description="the radius of the drum, in m")
    friction: Ratio = Field(gt=0, description="the coefficient of friction between band and drum")
    wrap: Angle = Field(gt=0, description="the wrap angle, in rad")
    self_energizing: Literal["counter-clockwise", "clockwise"] = Field(
        "counter-clockwise", description="the self-energizing sense of rotation, away from the pulled end"
    )
    creep_speed: AngularSpeed = Field(0.1, gt=0, description="the speed at which the torque reaches 76 %, in rad/s")

    def values(self) -> Mapping[str, Any]:
        """Torques over the force, and the creep speed."""
        strong = self.radius * expm1(self.friction * self.wrap)
        weak = -self.radius * expm1(-self.friction * self.wrap)
        forward, backward = (strong, weak) if self.self_energizing == "counter-clockwise" else (weak, strong)
        return {"forward": forward, "backward": backward, "creep_speed": self.creep_speed}

    @property
    def command(self) -> Profile:
        """The force over time."""
        return self.force


@register
class Holdback(Load):
    """A holdback or backstop, which lets the shaft turn in one sense and holds it in the other.

    Examples
    --------
    >>> bd.model.Holdback(kind="holdback", torque="60 kN m").holds
    'clockwise'
    """

    constants = BRAKE
    torque_at = braking_torque
    next_kink = standstill

    kind: Literal["holdback"] = Field(description="the kind of load")
    torque: Torque = Field(gt=0, description="the largest torque that it holds, in N*m")
    holds: Literal["counter-clockwise", "clockwise"] = Field(
        "clockwise", description="the sense of rotation in which it holds the shaft"
    )
    creep_speed: AngularSpeed = Field(
        1e-3, gt=0, description="the speed in that sense at which it bears 76 % of its torque, in rad/s"
    )

    def values(self) -> Mapping[str, Any]:
        """Torques in both senses, and the creep speed."""
        forward, backward = (0.0, self.torque) if self.holds == "clockwise" else (self.torque, 0.0)
        return {"forward": forward, "backward": backward, "creep_speed": self.creep_speed}

    @property
    def command(self) -> Profile:
        """It acts at any time."""
        return Constant(value=1.0)

"""An induction motor: M = 2 M_b / (s / s_b + s_b / s), s = 1 - omega / omega_s (Kloss's formula).

Source: M. Kloss, "Drehmoment und Schlüpfung des Drehstrommotors", Archiv für Elektrotechnik 5 (1916).

A generator of regulated voltage: M = -P / (eta omega), as far as its full field allows.

Above the cut-in speed omega_0 the full field gives the power P_f = P_max (1 - omega_0 / |omega|), which claw-pole
alternators follow well: their current rises from zero at the cut-in speed towards its largest.
"""

from collections.abc import Mapping
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState, StateRate, nearer_kink
from beltdyn.machines.profiles import PowerProfile, SpeedProfile
from beltdyn.machines.profiles.profile import Profile
from beltdyn.parts.quantity import AngularSpeed, Power, Ratio, Time, Torque, TorsionalDamping

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
    """Kernel of `Load.torque_at` for a row of `MOTOR`: it drives below the synchronous speed, and brakes above."""
    sense = 1.0 if constants.synchronous_speed > 0.0 else -1.0
    slip = 1.0 - shaft.speed / constants.synchronous_speed
    torque, by_slip = kloss_over_slip(sense * constants.breakdown_torque, constants.breakdown_slip, slip)
    return LoadTorque(torque, 0.0, -by_slip / constants.synchronous_speed, 0.0)


@register
class Motor(Load):
    """An induction motor after Kloss, which drives below its synchronous speed and brakes above it.

    Examples
    --------
    >>> load = bd.model.Motor(
    ...     kind="motor", breakdown_torque="20 N m",
    ...     breakdown_slip=0.2, synchronous_speed="1500 rpm"
    ... )
    >>> load.breakdown_torque
    20.0
    """

    constants = MOTOR
    signed = ("synchronous_speed",)
    torque_at = kloss

    kind: Literal["motor"] = Field(description="the kind of load")
    breakdown_torque: Torque = Field(gt=0, description="the largest torque, in N*m")
    breakdown_slip: Ratio = Field(gt=0, le=1, description="the slip at the largest torque, 0 to 1")
    synchronous_speed: AngularSpeed = Field(description="the no-load speed, in rad/s, of either sign")

    @model_validator(mode="after")
    def _turns(self) -> Self:
        if self.synchronous_speed == 0:
            raise ValueError("synchronous_speed = 0 leaves the slip undefined. Give a speed other than zero")
        return self

    @property
    def driven_speed(self) -> float:
        """The synchronous speed, rad/s."""
        return self.synchronous_speed


# A motor with a speed controller: PI action, torque limit, anti-windup

SERVO_MOTOR = record(
    proportional_gain="f8",  # K_p, N m s/rad
    integral_gain="f8",  # K_p / T_i, N m/rad
    torque_limit="f8",  # of the inverter, N m
    stall_torque="f8",  # at standstill with full voltage, N m, infinite where the voltage does not limit the torque
    no_load_speed="f8",  # with full voltage, rad/s
)


@kernel
def servo_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `SERVO_MOTOR`; command: the set speed, rad/s; state: the angle z, rad."""
    gain, limit = constants.proportional_gain, constants.torque_limit
    wanted = gain * (shaft.command - shaft.speed) + constants.integral_gain * shaft.state
    sense = 1.0 if wanted >= 0.0 else -1.0
    slope = constants.stall_torque / constants.no_load_speed if constants.stall_torque < np.inf else 0.0
    by_voltage = constants.stall_torque - sense * slope * shaft.speed
    if sense * wanted <= min(limit, by_voltage):
        return LoadTorque(wanted, 0.0, -gain, gain)
    if limit <= by_voltage:
        return LoadTorque(sense * limit, 0.0, 0.0, 0.0)
    return LoadTorque(sense * by_voltage, 0.0, -slope, 0.0)


@kernel
def servo_rate(constants: np.record, numbers: FloatArray, shaft: ShaftState) -> StateRate:
    """Rate of the state z; arguments as for `servo_torque`."""
    gain, integral = constants.proportional_gain, constants.integral_gain
    found = servo_torque(constants, numbers, shaft)
    by_state = integral if found.by_command != 0.0 else 0.0  # at a limit the torque feels neither
    rate = (found.torque - integral * shaft.state) / gain
    return StateRate(rate, found.by_speed / gain, (by_state - integral) / gain, by_state)


@register
class ServoMotor(Load):
    """A servo motor, or any motor with a speed controller, which holds a set speed within its torque limit.

    Examples
    --------
    >>> load = bd.model.ServoMotor(
    ...     kind="servo_motor", speed={"kind": "constant", "value": 100.0}, proportional_gain=0.5,
    ...     integral_time="50 ms", torque_limit="10 N m"
    ... )
    >>> load.integral_time
    0.05
    """

    constants = SERVO_MOTOR
    signed = ("speed",)
    torque_at = servo_torque
    rate_at = servo_rate

    kind: Literal["servo_motor"] = Field(description="the kind of load")
    speed: SpeedProfile = Field(description="the set speed over time, in rad/s")
    proportional_gain: TorsionalDamping = Field(gt=0, description="the torque over the speed error, in N m s/rad")
    integral_time: Time = Field(
        gt=0, description="the integral time, after which a constant speed error doubles the torque, in s"
    )
    torque_limit: Torque = Field(gt=0, description="the largest torque in either sense, in N*m")
    stall_torque: Torque | None = Field(
        None, gt=0, description="the stall torque of a DC motor at full voltage, in N*m"
    )
    no_load_speed: AngularSpeed | None = Field(
        None, gt=0, description="the no-load speed of a DC motor at full voltage, in rad/s"
    )
    lag: Time = Field(1e-3, gt=0, description="the time constant of the integral part, as of a current loop, in s")

    @model_validator(mode="after")
    def _has_a_whole_line_of_voltage(self) -> Self:
        if (self.stall_torque is None) != (self.no_load_speed is None):
            raise ValueError("stall_torque and no_load_speed define one line together. Give both, or remove both")
        return self

    def values(self) -> Mapping[str, Any]:
        """Gains and limits."""
        return {
            "proportional_gain": self.proportional_gain,
            "integral_gain": self.proportional_gain / self.integral_time,
            "torque_limit": self.torque_limit,
            "stall_torque": np.inf if self.stall_torque is None else self.stall_torque,
            "no_load_speed": self.no_load_speed or 0.0,
        }

    @property
    def command(self) -> Profile:
        """The set speed."""
        return self.speed

    @property
    def state_lag(self) -> float:
        """Time constant of its integral part, s."""
        return self.lag

    @property
    def driven_speed(self) -> float:
        """The set speed of largest magnitude, rad/s."""
        return self.speed.extreme()


GENERATOR = record(
    cut_in_speed="f8",  # omega_0, rad/s
    full_field_power="f8",  # P_max, W
    efficiency="f8",  # eta
)


@kernel
def generator_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `GENERATOR`; the command is the demanded electrical power, W."""
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

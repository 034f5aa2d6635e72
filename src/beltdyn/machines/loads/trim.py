"""Control of web tension: PI control from a dancer or a load cell trims the speed or the torque of a motor.

The controller sees the coordinate of a tensioner: a dancer by its place, a load cell, which is a stiff spring, by its
force.  With the error e and the trim u = g e + z / T_i, limited, its state z has the rate u - z / T_i.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, SensorSlope, ShaftState, StateRate
from beltdyn.machines.profiles import SpeedProfile, TorqueProfile
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.tensioners.tensioner import MovingTensioner, SpringTensioner
from beltdyn.parts.quantity import Coordinate, Force, Name, Ratio, Time, TorsionalDamping, quantity

TRIM = record(
    gain="f8",  # g, trim over the error, 1/m or 1/N
    integral="f8",  # 1 / T_i, 1/s, or zero without an integral part
    largest_trim="f8",
    speed_gain="f8",  # torque over the speed error, N m s/rad
)


@kernel(inline=True)
def _trim(constants: np.record, shaft: ShaftState) -> tuple[float, float]:
    """The trim within its limit, and 1 below it or 0 at it."""
    wanted = constants.gain * shaft.error + constants.integral * shaft.state
    if abs(wanted) <= constants.largest_trim:
        return wanted, 1.0
    return (constants.largest_trim if wanted > 0.0 else -constants.largest_trim), 0.0


@kernel
def trimmed_speed(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `TRIM`: a motor that follows a trimmed speed.

    The command is the speed without trim, rad/s; the error is in m or N, the state in s.
    """
    factor, gain = 1.0 + _trim(constants, shaft)[0], constants.speed_gain
    return LoadTorque(gain * (factor * shaft.command - shaft.speed), 0.0, -gain, gain * factor)


@kernel
def trimmed_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Trimmed torque of a motor or brake; arguments as for `trimmed_speed`, with the torque as command, N m."""
    factor = 1.0 + _trim(constants, shaft)[0]
    return LoadTorque(factor * shaft.command, 0.0, 0.0, factor)


@kernel(inline=True)
def _rate(constants: np.record, shaft: ShaftState, arm: float) -> StateRate:
    """Rate of the state, where a trim of 1 changes the torque by `arm`."""
    trim, free = _trim(constants, shaft)
    held = constants.integral * (1.0 - free)
    return StateRate(trim - constants.integral * shaft.state, 0.0, -held, arm * constants.integral * free)


@kernel
def rate_of_speed_trim(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> StateRate:
    """Rate of the state; arguments as for `trimmed_speed`."""
    return _rate(constants, shaft, constants.speed_gain * shaft.command)


@kernel
def rate_of_torque_trim(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> StateRate:
    """Rate of the state; arguments as for `trimmed_torque`."""
    return _rate(constants, shaft, shaft.command)


@kernel
def slope_of_speed_trim(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> SensorSlope:
    """Derivatives with respect to the error; arguments as for `trimmed_speed`."""
    by_error = constants.gain * _trim(constants, shaft)[1]
    return SensorSlope(constants.speed_gain * shaft.command * by_error, by_error)


@kernel
def slope_of_torque_trim(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> SensorSlope:
    """Derivatives with respect to the error; arguments as for `trimmed_torque`."""
    by_error = constants.gain * _trim(constants, shaft)[1]
    return SensorSlope(shaft.command * by_error, by_error)


class Trim(Load):
    """PI control from a dancer or a load cell, a moving tensioner, which trims what a motor does."""

    constants = TRIM

    sensor: Name = Field(description="the name of the pulley whose tensioner is the dancer or the load cell")
    set_position: Coordinate | None = Field(
        None, description="the set place of a dancer, from its given center, positive where the path is longer, in m"
    )
    position_gain: Annotated[float, quantity("1/m")] | None = Field(
        None, description="the trim over how much farther than set_position the dancer stands, in 1/m"
    )
    set_force: Force | None = Field(
        None, gt=0, description="the set force of the web on a load cell, along its direction, in N"
    )
    force_gain: Annotated[float, quantity("1/N")] | None = Field(
        None, description="the trim over how much less than set_force the load cell measures, in 1/N"
    )
    integral_time: Time | None = Field(
        None, gt=0, description="the integral time, after which a constant trim of 1 adds as much again, in s"
    )
    largest_trim: Ratio = Field(0.1, gt=0, description="the largest trim in either sense")
    lag: Time = Field(1e-3, gt=0, description="the time constant of the integral part, in s")

    if TYPE_CHECKING:

        def __init__(self, **keys: Any) -> None: ...

    @model_validator(mode="after")
    def _has_one_sensor(self) -> Self:
        if (self.position_gain is None) == (self.force_gain is None):
            raise ValueError(
                "needs one of position_gain, of a dancer, and force_gain, of a load cell. Give one of the two"
            )
        if self.position_gain is None and self.set_position is not None:
            raise ValueError("set_position needs position_gain; force_gain goes with set_force. Give a matching pair")
        if (self.force_gain is None) != (self.set_force is None):
            raise ValueError("set_force and force_gain belong together. Give both, or set_position and position_gain")
        return self

    @property
    def _gains(self) -> tuple[float, float]:
        """Of the error and of the state."""
        gain = self.force_gain if self.position_gain is None else self.position_gain
        return gain or 0.0, 0.0 if self.integral_time is None else 1.0 / self.integral_time

    def values(self) -> Mapping[str, Any]:
        """Gains and the limit."""
        gain, integral = self._gains
        own = getattr(self, "speed_gain", 0.0)
        return {"gain": gain, "integral": integral, "largest_trim": self.largest_trim, "speed_gain": own}

    def trim_at(self, error: float, state: float) -> float:
        """The trim without its limit at an error (m or N) and a state (s)."""
        gain, integral = self._gains
        return gain * error + integral * state

    def error_of(self, tensioner: MovingTensioner, arm: float) -> tuple[float, float]:
        """As in the base: farther than the set place, m, or less than the set force, N."""
        if self.set_force is None:
            return arm, -(self.set_position or 0.0)
        assert isinstance(tensioner, SpringTensioner)  # checked with the drive
        return tensioner.rate / arm, self.set_force - tensioner.preload / arm

    @property
    def sensed(self) -> str:
        """The dancer or load cell."""
        return self.sensor

    @property
    def senses_force(self) -> bool:
        """Whether it is a load cell."""
        return self.set_force is not None

    @property
    def has_mean(self) -> bool:
        """It has: the trim that holds the set value."""
        return True

    @property
    def state_lag(self) -> float | None:
        """Time constant of its integral part, s."""
        return None if self.integral_time is None else self.lag


@register
class SpeedTrim(Trim):
    """A motor with a speed controller whose set speed a dancer or a load cell trims.

    Examples
    --------
    >>> load = bd.model.SpeedTrim(
    ...     kind="speed_trim", speed={"kind": "constant", "value": 50.0}, speed_gain=20.0,
    ...     sensor="dancer", position_gain="0.5 1/m", integral_time="4 s"
    ... )
    >>> load.largest_trim
    0.1
    """

    torque_at = trimmed_speed
    rate_at = rate_of_speed_trim
    slope_at = slope_of_speed_trim
    signed = ("speed",)

    kind: Literal["speed_trim"] = Field(description="the kind of load")
    speed: SpeedProfile = Field(description="the set speed without trim over time, in rad/s")
    speed_gain: TorsionalDamping = Field(gt=0, description="the torque over the speed error, in N m s/rad")

    @property
    def command(self) -> Profile:
        """The set speed without trim."""
        return self.speed

    @property
    def driven_speed(self) -> float:
        """The set speed of largest magnitude, rad/s."""
        return self.speed.extreme()


@register
class TorqueTrim(Trim):
    """A motor or brake whose torque a dancer or a load cell trims.

    Examples
    --------
    >>> load = bd.model.TorqueTrim(
    ...     kind="torque_trim", torque={"kind": "constant", "value": -30.0}, sensor="dancer",
    ...     position_gain="2 1/m", integral_time="0.5 s"
    ... )
    >>> load.largest_trim
    1.0
    """

    torque_at = trimmed_torque
    rate_at = rate_of_torque_trim
    slope_at = slope_of_torque_trim
    signed = ("torque",)

    kind: Literal["torque_trim"] = Field(description="the kind of load")
    torque: TorqueProfile = Field(description="the torque without trim over time, in N*m")
    largest_trim: Ratio = Field(1.0, gt=0, description="the largest trim in either sense")

    @property
    def command(self) -> Profile:
        """The torque without trim."""
        return self.torque

"""An induction motor by its catalogue.

Up to the breakdown slip the torque is that of Kloss's formula through the rated point, from there it goes by smooth
steps to the pull-up and the locked-rotor torque.  This curve C is odd in the slip.  A supply of another frequency f
than the rated f_n shifts it in speed, and above f_n it weakens the field:

    M = min(1, f_n / |f|)^2 C(f / f_n - omega / omega_s)

Torques by name as in IEC 60034-12.
"""

from collections.abc import Mapping
from math import copysign, sqrt, tau
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState, nearer_kink
from beltdyn.machines.loads.motor import kloss_over_slip
from beltdyn.machines.profiles import FrequencyProfile
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.profiles.ramps import Constant, Step
from beltdyn.parts.messages import apart
from beltdyn.parts.quantity import AngularSpeed, Frequency, Power, Ratio, Time

INDUCTION_MOTOR = record(
    breakdown_torque="f8",  # N m
    breakdown_slip="f8",  # slip at which it is reached
    pull_up_torque="f8",  # smallest torque between breakdown and standstill, N m
    pull_up_slip="f8",  # slip at which it is reached
    locked_rotor_torque="f8",  # at the slip 1, and beyond, N m
    synchronous_speed="f8",  # omega_s at the rated frequency, rad/s, negative for a clockwise motor
    frequency="f8",  # f_n, rated frequency of the supply, Hz
    torque_limit="f8",  # largest torque that the inverter lets the motor have, N m, infinite without
)

_STAR = 1.0 / 3.0
"""Torque in star over that in delta."""
_MOST_PAIRS = 1000
"""Pairs of poles, far above those of any motor: without a bound the slip is lost in rounding."""

_PULL_UP_SLIP = 6.0 / 7.0
"""The seventh harmonic of the field runs at a seventh of the synchronous speed, and brakes above it."""


@kernel
def induction_torque(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `INDUCTION_MOTOR`; the command is the frequency of the supply, Hz.

    The torque is in the sense of the synchronous speed: it drives below that of the supply, and brakes above.
    """
    supply, synchronous = shaft.command / constants.frequency, constants.synchronous_speed
    sense = 1.0 if synchronous > 0.0 else -1.0
    slip = supply - shaft.speed / synchronous
    torque, by_slip = _torque_over_slip(constants, abs(slip))
    torque = sense * (torque if slip >= 0.0 else -torque)
    by_slip *= sense
    field, by_supply = 1.0, 0.0
    if abs(supply) > 1.0:
        field = 1.0 / (supply * supply)
        by_supply = -2.0 * field / supply
    if abs(field * torque) > constants.torque_limit:
        return LoadTorque(constants.torque_limit if torque > 0.0 else -constants.torque_limit, 0.0, 0.0, 0.0)
    by_command = (field * by_slip + by_supply * torque) / constants.frequency
    return LoadTorque(field * torque, 0.0, -field * by_slip / synchronous, by_command)


@kernel
def _torque_over_slip(constants: np.record, slip: float) -> tuple[float, float]:
    """Torque at a slip from zero on, and its derivative with respect to the slip, N m."""
    if slip <= constants.breakdown_slip:
        return kloss_over_slip(constants.breakdown_torque, constants.breakdown_slip, slip)
    if slip < constants.pull_up_slip:
        first, last = constants.breakdown_slip, constants.pull_up_slip
        start, change = constants.breakdown_torque, constants.pull_up_torque - constants.breakdown_torque
    elif slip < 1.0:
        first, last = constants.pull_up_slip, 1.0
        start, change = constants.pull_up_torque, constants.locked_rotor_torque - constants.pull_up_torque
    else:
        return constants.locked_rotor_torque, 0.0
    part = (slip - first) / (last - first)
    return start + change * part * part * (3.0 - 2.0 * part), 6.0 * change * part * (1.0 - part) / (last - first)


@kernel
def limit_reached(constants: np.record, _numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """Next speed at which the torque reaches its limit between no load and breakdown, or leaves it."""
    supply, nearest = shaft.command / constants.frequency, np.inf
    share = constants.breakdown_torque / (constants.torque_limit * max(1.0, supply * supply))
    if share > 1.0:
        slip = constants.breakdown_slip * (share - sqrt(share * share - 1.0))
        for side in (-1.0, 1.0):
            kink = (supply + side * slip) * constants.synchronous_speed
            nearest = nearer_kink(kink, nearest, shaft.speed, rising)
    return nearest


@register
class InductionMotor(Load):
    """An induction motor by catalogue data, which drives below its synchronous speed and brakes above it.

    Its torque is quasi-static at each speed; electrical transients, which last some periods of the supply, are
    neglected.

    Examples
    --------
    >>> load = bd.model.InductionMotor(
    ...     kind="induction_motor", rated_power="1.5 kW", rated_speed="1430 rpm",
    ...     locked_rotor_ratio=2.2, breakdown_ratio=2.6
    ... )
    >>> load.rated_power
    1500.0
    """

    constants = INDUCTION_MOTOR
    signed = ("rated_speed",)
    torque_at = induction_torque
    next_kink = limit_reached

    kind: Literal["induction_motor"] = Field(description="the kind of load")
    rated_power: Power = Field(gt=0, description="the mechanical power at the rated speed, in W")
    rated_speed: AngularSpeed = Field(description="the speed at rated power, in rad/s, of either sign")
    frequency: Frequency = Field(
        50.0, gt=0, description="the rated frequency of the supply, in Hz; it gives the number of poles"
    )
    locked_rotor_ratio: Ratio = Field(gt=0, description="the torque at standstill over the rated torque")
    pull_up_ratio: Ratio | None = Field(
        None, gt=0, description="the smallest torque between standstill and breakdown over the rated torque"
    )
    breakdown_ratio: Ratio = Field(gt=1, description="the largest torque below synchronous speed over the rated torque")
    star_until: Time | None = Field(
        None, gt=0, description="the end of the star connection at start, with a third of the torque, in s"
    )
    supply: FrequencyProfile | None = Field(
        None, description="the frequency of an inverter over time, in Hz; by default the rated frequency"
    )
    limit_ratio: Ratio | None = Field(None, gt=0, description="the torque limit of the inverter over the rated torque")

    @model_validator(mode="after")
    def _is_a_motor(self) -> Self:
        field_speed = tau * self.frequency
        if not field_speed / _MOST_PAIRS < abs(self.rated_speed) < field_speed:
            rated, fastest = apart(self.rated_speed, field_speed)
            raise ValueError(
                f"rated_speed = {rated} rad/s must be below {fastest} rad/s, that of two poles at "
                f"{self.frequency:g} Hz, and above {field_speed / _MOST_PAIRS:.5g} rad/s, that of {2 * _MOST_PAIRS}. "
                "Give the speed at the rated power"
            )
        if not self._breakdown_slip < _PULL_UP_SLIP:
            raise ValueError(
                f"rated_speed = {self.rated_speed:g} rad/s means a slip of {self._rated_slip:.3g} from the synchronous "
                f"speed of {abs(self.synchronous_speed):.4g} rad/s: breakdown would be at a slip of "
                f"{self._breakdown_slip:.3g}. Correct rated_speed or frequency"
            )
        least = self.pull_up_ratio
        if least is not None and least > min(self.locked_rotor_ratio, self.breakdown_ratio):
            raise ValueError(
                f"pull_up_ratio = {least:g} must not be above locked_rotor_ratio = {self.locked_rotor_ratio:g} and "
                f"breakdown_ratio = {self.breakdown_ratio:g}: it is the smallest torque of the run-up. Reduce it"
            )
        return self

    @model_validator(mode="after")
    def _has_one_way_to_start(self) -> Self:
        if self.star_until is not None and (self.supply is not None or self.schedule is not None):
            other = "supply" if self.supply is not None else "schedule"
            raise ValueError(f"star_until and {other} exclude each other. Keep one starting method")
        if self.limit_ratio is not None and self.supply is None:
            raise ValueError("has limit_ratio but no supply, although only an inverter limits torque. Give supply")
        return self

    @property
    def rated_torque(self) -> float:
        """Torque at the rated speed, N m, in its sense."""
        return self.rated_power / self.rated_speed

    @property
    def synchronous_speed(self) -> float:
        """Synchronous speed at the rated frequency, rad/s, for the number of poles nearest above the rated speed."""
        field_speed = tau * self.frequency
        return copysign(field_speed / np.ceil(field_speed / abs(self.rated_speed) - 1.0), self.rated_speed)

    @property
    def _rated_slip(self) -> float:
        return 1.0 - self.rated_speed / self.synchronous_speed

    @property
    def _breakdown_slip(self) -> float:
        """The slip at which Kloss's formula has its maximum, so that it gives the rated torque at the rated speed."""
        return self._rated_slip * (self.breakdown_ratio + sqrt(self.breakdown_ratio**2 - 1.0))

    def held_at(self, at: float) -> Mapping[str, Any]:
        """Its switch from star to delta, as a schedule."""
        if self.star_until is None:
            return {}
        star = {"schedule": Constant(value=_STAR)} if at < self.star_until else {}
        return {"star_until": None, **star}

    def values(self) -> Mapping[str, Any]:
        """Torques and slips of the curve."""
        rated, pulls_up = abs(self.rated_torque), self.pull_up_ratio is not None
        return {
            "breakdown_torque": rated * self.breakdown_ratio,
            "breakdown_slip": self._breakdown_slip,
            "pull_up_torque": rated * (self.pull_up_ratio or self.locked_rotor_ratio),
            "pull_up_slip": _PULL_UP_SLIP if pulls_up else 1.0,
            "locked_rotor_torque": rated * self.locked_rotor_ratio,
            "synchronous_speed": self.synchronous_speed,
            "frequency": self.frequency,
            "torque_limit": np.inf if self.limit_ratio is None else rated * self.limit_ratio,
        }

    @property
    def factor(self) -> Profile | None:
        """Its schedule, or the third of the torque in star."""
        if self.star_until is None:
            return self.schedule
        return Step(time=self.star_until, before=_STAR, value=1.0)

    @property
    def command(self) -> Profile:
        """The frequency of the supply."""
        return self.supply or Constant(value=self.frequency)

    @property
    def driven_speed(self) -> float:
        """The synchronous speed at the highest frequency of the supply, rad/s."""
        return self.synchronous_speed * self.command.largest() / self.frequency

"""Prescribed speeds, torques and schedules over time, and harmonics over the shaft angle."""

from typing import TYPE_CHECKING, Annotated

from pydantic import BeforeValidator, Field

from beltdyn.machines.profiles.moves import PositionTable as PositionTable
from beltdyn.machines.profiles.moves import SCurve as SCurve
from beltdyn.machines.profiles.moves import Trapezoid as Trapezoid
from beltdyn.machines.profiles.profile import PROFILES, Profile
from beltdyn.machines.profiles.ramps import (
    Constant as Constant,
)
from beltdyn.machines.profiles.ramps import (
    CosineRamp as CosineRamp,
)
from beltdyn.machines.profiles.ramps import (
    CosineRampPublished as CosineRampPublished,
)
from beltdyn.machines.profiles.ramps import (
    Ramp as Ramp,
)
from beltdyn.machines.profiles.ramps import (
    Step as Step,
)
from beltdyn.machines.profiles.ramps import Table as Table
from beltdyn.parts.kind_fields import OneOf
from beltdyn.parts.quantity import AngularSpeed, Force, Frequency, Power, Pressure, Torque, quantity

Factor = Annotated[float, quantity(""), Field(ge=0, le=1)]


def _is_value(given: object) -> bool:
    return isinstance(given, int | float | str) and not isinstance(given, bool)


if TYPE_CHECKING:
    Schedule = Profile[float]
    SpeedProfile = Profile[float]
    PushProfile = Profile[float]
    TorqueProfile = Profile[float]
    FrequencyProfile = Profile[float]
    BrakingProfile = Profile[float]
    ForceProfile = Profile[float]
    PowerProfile = Profile[float]
    PressureProfile = Profile[float]
else:

    def _constant(given):
        """A number, or text with a unit, is a constant."""
        return {"kind": "constant", "value": given} if _is_value(given) else given

    def _is_no_turn(kind):
        """Whether a kind may give any quantity."""
        return not kind.turns

    def _of(value, where=lambda _: True):
        """Type of a field that takes a profile of a quantity."""
        return Annotated[Profile, OneOf(PROFILES, lambda kind: kind[value], where), BeforeValidator(_constant)]

    Schedule = _of(Factor, lambda kind: kind.multiplies and _is_no_turn(kind))
    SpeedProfile = _of(AngularSpeed)
    TorqueProfile = _of(Torque, _is_no_turn)
    PushProfile = _of(Force, _is_no_turn)
    FrequencyProfile = _of(Frequency, _is_no_turn)
    BrakingProfile = _of(Annotated[Torque, Field(ge=0)], _is_no_turn)
    ForceProfile = _of(Annotated[Force, Field(ge=0)], _is_no_turn)
    PowerProfile = _of(Annotated[Power, Field(ge=0)], _is_no_turn)
    PressureProfile = _of(Annotated[Pressure, Field(ge=0)], _is_no_turn)

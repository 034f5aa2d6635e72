"""Field types for a profile of any kind."""

from typing import TYPE_CHECKING, Annotated

from pydantic import BeforeValidator, Field

from beltdyn.machines import profiles as kinds
from beltdyn.machines.family import any_of, kinds_in
from beltdyn.machines.profiles.profile import Profile
from beltdyn.parts.quantity import AngularSpeed, Force, Frequency, Power, Pressure, Torque, quantity

Factor = Annotated[float, quantity(""), Field(ge=0, le=1)]


def _is_value(given: object) -> bool:
    return isinstance(given, int | float | str) and not isinstance(given, bool)


if TYPE_CHECKING:
    Schedule = Profile[float]
    SpeedProfile = Profile[float]
    TorqueProfile = Profile[float]
    FrequencyProfile = Profile[float]
    BrakingProfile = Profile[float]
    ForceProfile = Profile[float]
    PowerProfile = Profile[float]
    PressureProfile = Profile[float]
else:
    KINDS = kinds_in(kinds)

    def _constant(given):
        """A number, or text with a unit, is a constant."""
        return {"kind": "constant", "value": given} if _is_value(given) else given

    def _of(value, kinds=KINDS):
        """Type of a field that takes a profile of a quantity."""
        return Annotated[any_of({name: kind[value] for name, kind in kinds.items()}), BeforeValidator(_constant)]

    Schedule = _of(Factor, {name: kind for name, kind in KINDS.items() if kind.multiplies})
    SpeedProfile = _of(AngularSpeed)
    TorqueProfile = _of(Torque)
    FrequencyProfile = _of(Frequency)
    BrakingProfile = _of(Annotated[Torque, Field(ge=0)])
    ForceProfile = _of(Annotated[Force, Field(ge=0)])
    PowerProfile = _of(Annotated[Power, Field(ge=0)])
    PressureProfile = _of(Annotated[Pressure, Field(ge=0)])

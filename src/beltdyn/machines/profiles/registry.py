"""Types of fields that take a profile of any kind."""

from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from beltdyn.machines.family import any_of, kinds_in
from beltdyn.machines.profiles import kinds
from beltdyn.machines.profiles.profile import Profile
from beltdyn.parts.quantity import AngularSpeed, Torque, quantity

Factor = Annotated[float, quantity(""), Field(ge=0, le=1)]

if TYPE_CHECKING:
    Schedule = Profile[float]
    SpeedProfile = Profile[float]
    TorqueProfile = Profile[float]
else:
    KINDS = kinds_in(kinds)
    Schedule = any_of({name: kind[Factor] for name, kind in KINDS.items() if kind.multiplies})
    SpeedProfile = any_of({name: kind[AngularSpeed] for name, kind in KINDS.items()})
    TorqueProfile = any_of({name: kind[Torque] for name, kind in KINDS.items()})

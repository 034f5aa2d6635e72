"""The common base of rises from zero to a value."""

from typing import Generic, Self

from pydantic import Field, model_validator

from beltdyn.machines.profiles.profile import Profile, Value
from beltdyn.parts.quantity import Time


class Rise(Profile[Value], Generic[Value]):
    """Zero before `start`, `value` after `end`."""

    start: Time = Field(description="the start of the rise, in s")
    end: Time = Field(description="the end of the rise, in s")
    value: Value = Field(description="the value after the rise")

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Self:
        if self.end <= self.start:
            raise ValueError(f"end = {self.end:g} s must be later than start = {self.start:g} s. Increase end")
        return self

    def breakpoints(self) -> tuple[float, ...]:
        """Start and end of the rise, s."""
        return (self.start, self.end)

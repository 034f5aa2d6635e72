"""A step from one value to another."""

from typing import Generic, Literal, cast

import numpy as np
from pydantic import Field

from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
from beltdyn.parts.quantity import Time
from beltdyn.records import Records, records


class Step(Profile[Value], Generic[Value]):
    """The value `before` until `time`, and `value` after it.

    Examples
    --------
    >>> bd.Step(time="500 ms", value=2.0).at([0.0, 1.0])
    array([0., 2.])
    """

    kind: Literal["step"] = Field("step", description="the kind of profile")
    time: Time = Field(description="the instant of the step, in s")
    before: Value = Field(cast(Value, 0.0), description="the value before the step")
    value: Value = Field(description="the value after the step")

    def segments(self) -> Records:
        """Two pieces: before, then value."""
        return records(SEGMENT, start=[-np.inf, self.time], offset=[self.before, self.value])

    def breakpoints(self) -> tuple[float, ...]:
        """The instant of the step, s."""
        return (self.time,)

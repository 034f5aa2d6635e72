"""The cosine rise as the paper prints it (Eq. 29)."""

from typing import Any, ClassVar, Generic, Literal, Self, cast

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import Records, records
from beltdyn.kinds import register
from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
from beltdyn.parts.quantity import Time
from beltdyn.parts.table_file import check_points, describe_file, take_file

# A constant value


@register
class Constant(Profile[Value], Generic[Value]):
    """The same value at all times.

    Examples
    --------
    >>> bd.model.Constant(value=3.0).at([0.0, 1.0])
    array([3., 3.])
    """

    kind: Literal["constant"] = Field("constant", description="the kind of profile")
    value: Value = Field(description="the value at all times")

    def segments(self) -> Records:
        """One piece: value(t) = value."""
        return records(SEGMENT, start=[-np.inf], offset=[self.value])


# The common base of rises from zero to a value


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


# A linear rise (Eq. 28)


@register
class Ramp(Rise[Value], Generic[Value]):
    """A linear rise from zero at `start` to `value` at `end`, Eq. (28).

    Examples
    --------
    >>> bd.model.Ramp(start=0.0, end=2.0, value=10.0).at([0.5, 1.0, 3.0])
    array([ 2.5,  5. , 10. ])
    """

    kind: Literal["ramp"] = Field("ramp", description="the kind of profile")

    def segments(self) -> Records:
        """Zero, then value (t - start) / (end - start), then value: Eq. (28)."""
        slope = self.value / (self.end - self.start)
        starts = [-np.inf, self.start, self.end]
        return records(SEGMENT, start=starts, offset=[0.0, 0.0, float(self.value)], slope=[0.0, slope, 0.0])


# A step from one value to another


@register
class Step(Profile[Value], Generic[Value]):
    """The value `before` until `time`, and `value` after it.

    Examples
    --------
    >>> bd.model.Step(time="500 ms", value=2.0).at([0.0, 1.0])
    array([0., 2.])
    """

    proportional = ("before", "value")

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


# A smooth rise along half a cosine


@register
class CosineRamp(Rise[Value], Generic[Value]):
    """A smooth rise from zero at `start` to `value` at `end`, along half a cosine from start to end.

    Examples
    --------
    >>> bd.model.CosineRamp(start=0.0, end=2.0, value=10.0).at([0.0, 1.0, 2.0]).round(6)
    array([ 0.,  5., 10.])
    """

    kind: Literal["cosine_ramp"] = Field("cosine_ramp", description="the kind of profile")

    def segments(self) -> Records:
        """Zero, then value/2 (1 - cos(pi (t - start) / (end - start))), then value."""
        omega = np.pi / (self.end - self.start)
        half = self.value / 2
        return records(
            SEGMENT,
            start=[-np.inf, self.start, self.end],
            offset=[0.0, half, float(self.value)],
            amplitude=[0.0, -half, 0.0],
            frequency=[0.0, omega, 0.0],
            phase=[0.0, -omega * self.start, 0.0],
        )


@register
class CosineRampPublished(Rise[Value], Generic[Value]):
    """The rise of Eq. (29) as printed: its cosine runs from time zero to `end`, so it jumps at `start`.

    Examples
    --------
    >>> bd.model.CosineRampPublished(start=0.0, end=2.0, value=10.0).at([0.0, 1.0, 2.0]).round(6)
    array([ 0.,  5., 10.])
    """

    multiplies: ClassVar[bool] = False

    kind: Literal["cosine_ramp_published"] = Field("cosine_ramp_published", description="the kind of profile")

    @model_validator(mode="after")
    def _ends_after_time_zero(self) -> Self:
        if self.end <= 0:
            raise ValueError(f"end = {self.end:g} s must be later than time zero. Increase end, or use cosine_ramp")
        return self

    def segments(self) -> Records:
        """Zero, then value/2 (1 - cos(pi t / end)), then value: Eq. (29)."""
        half = self.value / 2
        return records(
            SEGMENT,
            start=[-np.inf, self.start, self.end],
            offset=[0.0, half, float(self.value)],
            amplitude=[0.0, -half, 0.0],
            frequency=[0.0, np.pi / self.end, 0.0],
        )


@register
class Table(Profile[Value], Generic[Value]):
    """Linear between points, constant before the first and after the last.

    The points are `times` and `values`, or the two columns of the CSV file `file`, which is read when the
    table is made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> bd.model.Table(times=[0.0, 1.0], values=[0.0, 5.0]).at([0.5])
    array([2.5])
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("times", "values"), "two columns, times and values")
    )

    proportional = ("values",)

    kind: Literal["table"] = Field("table", description="the kind of profile")
    times: tuple[Time, ...] = Field(min_length=2, description="the instants of the points, in s")
    values: tuple[Value, ...] = Field(min_length=2, description="the values at these instants")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "times", "values")

    @model_validator(mode="after")
    def _is_a_function_of_time(self) -> Self:
        check_points("times", self.times, "values", self.values)
        return self

    def segments(self) -> Records:
        """Constant, then a line between each two points, then constant."""
        times, values = np.array(self.times), np.array(self.values, dtype=float)
        return records(
            SEGMENT,
            start=np.concatenate([[-np.inf], times]),
            offset=np.concatenate([values[:1], values]),
            slope=np.concatenate([[0.0], np.diff(values) / np.diff(times), [0.0]]),
        )

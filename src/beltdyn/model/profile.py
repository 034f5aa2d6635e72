"""Prescribed speeds, applied torques and schedules over time, and their harmonics over the angle."""

from abc import abstractmethod
from typing import Annotated, Any, Generic, Literal, Self, cast

import numpy as np
from numpy.typing import ArrayLike
from pydantic import ConfigDict, Field, ValidationInfo, model_validator
from typing_extensions import TypeVar

from beltdyn.arrays import FloatArray
from beltdyn.model.part import Part
from beltdyn.model.quantity import Angle, AngularSpeed, Ratio, Time, Torque, quantity
from beltdyn.model.table_file import check_points, describe_file, take_file

Value = TypeVar("Value", bound=float, default=float)


class Profile(Part, Generic[Value]):
    """A value over time: rad/s for a speed, N m for a torque, 1 for a factor; times are in s."""

    @classmethod
    def model_parametrized_name(cls, params: tuple[Any, ...]) -> str:
        """Name a profile of any quantity by its kind alone."""
        return cls.__name__

    @abstractmethod
    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Give the closed form of the profile, piece by piece.

        Returns
        -------
        starts : ndarray, shape (m,), s
            Where each piece starts; the first is minus infinity, and its c1 is zero.
        coefficients : ndarray, shape (m, 5)
            Rows (c0, c1, amplitude, omega, phase) such that for starts[k] < t <= starts[k + 1]
            value(t) = c0 + c1 (t - starts[k]) + amplitude cos(omega t + phase).
        """

    def breakpoints(self) -> tuple[float, ...]:
        """Instants of kinks and jumps that a time integrator must step onto, s: none unless a kind says so."""
        return ()

    def at(self, times: ArrayLike) -> FloatArray:
        """Evaluate the profile.

        Parameters
        ----------
        times : array_like
            Instants, s.

        Returns
        -------
        ndarray, shape of `times`
            The values, rad/s or N m.
        """
        t = np.asarray(times, dtype=float)
        starts, coefficients = self.segments()
        k = np.maximum(np.searchsorted(starts, t, side="left") - 1, 0)
        c0, c1, amplitude, omega, phase = np.moveaxis(coefficients[k], -1, 0)
        elapsed = np.where(k == 0, 0.0, t - starts[k])
        return np.asarray(c0 + c1 * elapsed + amplitude * np.cos(omega * t + phase))

    def largest(self, duration: float) -> float:
        """Largest absolute value from time zero to a time, s.

        It is at an end, or at the start of a piece, before or after a jump: within a piece all kinds are monotonic.
        """
        starts = self.segments()[0]
        ends = np.concatenate([[0.0, duration], starts[(starts > 0.0) & (starts < duration)]])
        after = np.nextafter(ends, np.inf)
        return float(np.max(np.abs(self.at(np.concatenate([ends, after[after <= duration]])))))


class Constant(Profile[Value], Generic[Value]):
    """The same value at all times."""

    kind: Literal["constant"] = Field("constant", description="the kind of profile")
    value: Value = Field(description="the value at all times")

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """One piece: value(t) = value."""
        return _pieces((-np.inf, self.value, 0, 0, 0, 0))


class Step(Profile[Value], Generic[Value]):
    """The value `before` until `time`, and `value` after it."""

    kind: Literal["step"] = Field("step", description="the kind of profile")
    time: Time = Field(description="the instant of the step, in s")
    before: Value = Field(cast(Value, 0.0), description="the value before the step")
    value: Value = Field(description="the value after the step")

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Two pieces: before, then value."""
        return _pieces((-np.inf, self.before), (self.time, self.value))

    def breakpoints(self) -> tuple[float, ...]:
        """The instant of the step, s."""
        return (self.time,)


class _Rise(Profile[Value], Generic[Value]):
    """Zero before `start`, `value` after `end`."""

    start: Time = Field(description="the instant when the rise starts, in s")
    end: Time = Field(description="the instant when the rise ends, in s")
    value: Value = Field(description="the value after the rise")

    @model_validator(mode="after")
    def _ends_after_its_start(self) -> Self:
        if self.end <= self.start:
            raise ValueError(f"end = {self.end:g} s must be later than start = {self.start:g} s. Raise end")
        return self

    def breakpoints(self) -> tuple[float, ...]:
        """Start and end of the rise, s."""
        return (self.start, self.end)


class Ramp(_Rise[Value], Generic[Value]):
    """A linear rise from zero at `start` to `value` at `end`, Eq. (28)."""

    kind: Literal["ramp"] = Field("ramp", description="the kind of profile")

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Zero, then value (t - start) / (end - start), then value: Eq. (28)."""
        slope = self.value / (self.end - self.start)
        return _pieces((-np.inf,), (self.start, 0, slope), (self.end, self.value))


class CosineRamp(_Rise[Value], Generic[Value]):
    """A smooth rise from zero at `start` to `value` at `end`, along half a cosine from start to end."""

    kind: Literal["cosine_ramp"] = Field("cosine_ramp", description="the kind of profile")

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Zero, then value/2 (1 - cos(pi (t - start) / (end - start))), then value."""
        omega = np.pi / (self.end - self.start)
        half = self.value / 2
        return _pieces((-np.inf,), (self.start, half, 0, -half, omega, -omega * self.start), (self.end, self.value))


class CosineRampPublished(_Rise[Value], Generic[Value]):
    """The rise of Eq. (29) as printed: its cosine runs from time zero to `end`, so it jumps at `start`."""

    kind: Literal["cosine_ramp_published"] = Field("cosine_ramp_published", description="the kind of profile")

    @model_validator(mode="after")
    def _ends_after_time_zero(self) -> Self:
        if self.end <= 0:
            raise ValueError(f"end = {self.end:g} s must be later than time zero. Raise end, or use cosine_ramp")
        return self

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Zero, then value/2 (1 - cos(pi t / end)), then value: Eq. (29)."""
        half = self.value / 2
        return _pieces((-np.inf,), (self.start, half, 0, -half, np.pi / self.end), (self.end, self.value))


class Table(Profile[Value], Generic[Value]):
    """Linear between points, constant before the first and after the last.

    The points are `times` and `values`, or the two columns of the CSV file `file`, which is read when the
    table is made: a relative path starts at the folder of the drive file.
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, "times", "values", "time in s and value in SI units")
    )

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

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """Constant, then a line between each two points, then constant."""
        times, values = np.array(self.times), np.array(self.values, dtype=float)
        coefficients = np.zeros((times.size + 1, 5))
        coefficients[:, 0] = np.concatenate([values[:1], values])
        coefficients[1:-1, 1] = np.diff(values) / np.diff(times)
        return np.concatenate([[-np.inf], times]), coefficients


def _pieces(*rows: tuple[Any, ...]) -> tuple[FloatArray, FloatArray]:
    """Arrays of segments from rows (start, c0, c1, amplitude, omega, phase); what a row leaves out is zero."""
    table = np.array([row + (0.0,) * (6 - len(row)) for row in rows], dtype=float)
    return table[:, 0], table[:, 1:]


class Harmonic(Part):
    """A wave over the angle theta of a shaft: amplitude cos(order theta + phase)."""

    order: Ratio = Field(gt=0, description="the number of waves in a turn of the shaft, such as 2 or 0.5")
    amplitude: Ratio = Field(description="the amplitude, over the value without harmonics")
    phase: Angle = Field(0.0, description="the phase at the angle zero, in rad")


Factor = Annotated[float, quantity(""), Field(ge=0, le=1)]
Schedule = Annotated[
    Constant[Factor] | Step[Factor] | Ramp[Factor] | CosineRamp[Factor] | Table[Factor], Field(discriminator="kind")
]
SpeedProfile = Annotated[
    Constant[AngularSpeed]
    | Step[AngularSpeed]
    | Ramp[AngularSpeed]
    | CosineRamp[AngularSpeed]
    | CosineRampPublished[AngularSpeed]
    | Table[AngularSpeed],
    Field(discriminator="kind"),
]
TorqueProfile = Annotated[
    Constant[Torque] | Step[Torque] | Ramp[Torque] | CosineRamp[Torque] | CosineRampPublished[Torque] | Table[Torque],
    Field(discriminator="kind"),
]

"""Prescribed speeds and applied torques over time."""

from abc import abstractmethod
from collections.abc import Mapping
from typing import Annotated, Any, Generic, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import ConfigDict, Field, ValidationInfo, model_validator
from typing_extensions import TypeVar

from beltdyn.model.part import Part
from beltdyn.model.quantity import AngularSpeed, Time, Torque
from beltdyn.model.table_file import read_table

FloatArray = NDArray[np.float64]
Value = TypeVar("Value", bound=float, default=float)


class Profile(Part, Generic[Value]):
    """A value over time: rad/s for a speed, N m for a torque, and s for times."""

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


class Constant(Profile[Value], Generic[Value]):
    """The same value at all times."""

    kind: Literal["constant"] = Field("constant", description="the kind of profile")
    value: Value = Field(description="the value at all times")

    def segments(self) -> tuple[FloatArray, FloatArray]:
        """One piece: value(t) = value."""
        return _pieces((-np.inf, self.value, 0, 0, 0, 0))


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

    model_config = ConfigDict(json_schema_extra=lambda schema: _describe_file(schema))

    kind: Literal["table"] = Field("table", description="the kind of profile")
    times: tuple[Time, ...] = Field(min_length=2, description="the instants of the points, in s")
    values: tuple[Value, ...] = Field(min_length=2, description="the values at these instants")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, Mapping) or "file" not in data:
            return data
        if "times" in data or "values" in data:
            raise ValueError("file excludes times and values: keep one of the two forms")
        times, values = read_table(data["file"], (info.context or {}).get("base"))
        others = {key: value for key, value in data.items() if key != "file"}
        return others | {"times": times, "values": values}

    @model_validator(mode="after")
    def _is_a_function_of_time(self) -> Self:
        if len(self.times) != len(self.values):
            raise ValueError(
                f"times has {len(self.times)} numbers and values has {len(self.values)}: each time needs one value"
            )
        for earlier, later in zip(self.times, self.times[1:], strict=False):
            if later <= earlier:
                raise ValueError(f"times must increase, but {later:g} follows {earlier:g}. Sort the points by time")
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


def _describe_file(schema: dict[str, Any]) -> None:
    """Add the key `file`, which is replaced by `times` and `values` on reading, to the JSON schema."""
    schema["properties"]["file"] = {
        "type": "string",
        "description": "a CSV file of two columns, time in s and value in SI units",
    }
    schema.pop("required", None)
    schema["oneOf"] = [{"required": ["file"]}, {"required": ["times", "values"]}]


SpeedProfile = Annotated[
    Constant[AngularSpeed]
    | Ramp[AngularSpeed]
    | CosineRamp[AngularSpeed]
    | CosineRampPublished[AngularSpeed]
    | Table[AngularSpeed],
    Field(discriminator="kind"),
]
TorqueProfile = Annotated[
    Constant[Torque] | Ramp[Torque] | CosineRamp[Torque] | CosineRampPublished[Torque] | Table[Torque],
    Field(discriminator="kind"),
]

"""A table of values over time."""

from typing import Any, Generic, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.kinds import register
from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
from beltdyn.parts.quantity import Time
from beltdyn.parts.table_file import check_points, describe_file, take_file
from beltdyn.records import Records, records


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

"""A torque over speed by points."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.machines.loads.search import first_above
from beltdyn.parts.quantity import AngularSpeed, Torque
from beltdyn.parts.table_file import check_points, describe_file, take_file
from beltdyn.records import record

LOAD_TABLE = record(
    count="i8",  # number of its points
)


@kernel
def interpolated(constants: np.record, numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Linear between points, constant outside.

    Parameters
    ----------
    constants
        A row of `LOAD_TABLE`.
    numbers : ndarray, shape (2 n,)
        Speeds, rad/s, ascending, then torques, N m.
    shaft
        Its speed counts.
    """
    count, speed = constants.count, shaft.speed
    above = first_above(numbers, 0, count, speed)
    if above == 0 or above == count:
        return LoadTorque(numbers[count if above == 0 else 2 * count - 1], 0.0, 0.0, 0.0)
    below = above - 1
    slope = (numbers[count + above] - numbers[count + below]) / (numbers[above] - numbers[below])
    return LoadTorque(numbers[count + below] + slope * (speed - numbers[below]), 0.0, slope, 0.0)


@kernel
def next_point(constants: np.record, numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """Speed of the nearest point above a speed, or below it if the speed falls, rad/s; infinite without any.

    Parameters
    ----------
    constants, numbers, shaft
        As for `interpolated`.
    rising
        Whether the speed rises.
    """
    above = first_above(numbers, 0, constants.count, shaft.speed)
    if rising:
        return numbers[above] if above < constants.count else np.inf
    below = above - 1
    if below >= 0 and numbers[below] >= shaft.speed:
        below -= 1
    return numbers[below] if below >= 0 else np.inf


class LoadTable(Load):
    """A torque over speed, linear between points, constant before the first and after the last.

    Both are counter-clockwise positive. The points are `speeds` and `torques`, or the two columns of the CSV file
    `file`, which is read when the table is made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> bd.LoadTable(kind="table", speeds=[0.0, 100.0], torques=[0.0, -5.0]).torques
    (0.0, -5.0)
    """

    constants = LOAD_TABLE
    torque_at = interpolated
    next_kink = next_point

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("speeds", "torques"), "two columns, speeds and torques")
    )

    kind: Literal["table"] = Field(description="the kind of load")
    speeds: tuple[AngularSpeed, ...] = Field(min_length=2, description="the speeds of the points, in rad/s")
    torques: tuple[Torque, ...] = Field(min_length=2, description="the torques at these speeds, in N*m")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "speeds", "torques")

    @model_validator(mode="after")
    def _is_a_function_of_speed(self) -> Self:
        check_points("speeds", self.speeds, "torques", self.torques)
        return self

    def values(self) -> Mapping[str, Any]:
        """The number of its points."""
        return {"count": len(self.speeds)}

    @property
    def numbers(self) -> Sequence[float]:
        """Speeds, rad/s, then torques, N m."""
        return (*self.speeds, *self.torques)

"""A torque over the speed by its points."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.loads.load import Load, LoadTorque
from beltdyn.parts.quantity import AngularSpeed, Torque
from beltdyn.parts.table_file import check_points, describe_file, take_file
from beltdyn.records import record

LOAD_TABLE = record(
    count="i8",  # number of its points
)


@kernel
def interpolated(constants: np.record, points: FloatArray, _angle: float, speed: float) -> LoadTorque:
    """Linear between points, constant outside.

    Parameters
    ----------
    constants
        A row of `LOAD_TABLE`.
    points : ndarray, shape (n, 2)
        Speeds, rad/s, ascending, and torques, N m.
    speed
        rad/s.
    """
    first, last = 0, constants.count - 1
    if speed <= points[first, 0]:
        return LoadTorque(points[first, 1], 0.0, 0.0)
    if speed >= points[last, 0]:
        return LoadTorque(points[last, 1], 0.0, 0.0)
    while last - first > 1:
        middle = (first + last) // 2
        if points[middle, 0] <= speed:
            first = middle
        else:
            last = middle
    slope = (points[last, 1] - points[first, 1]) / (points[last, 0] - points[first, 0])
    return LoadTorque(points[first, 1] + slope * (speed - points[first, 0]), 0.0, slope)


@kernel
def next_point(constants: np.record, points: FloatArray, speed: float, rising: bool) -> float:
    """Speed of the nearest point above a speed, or below it if the speed falls, rad/s; infinite without any.

    Parameters
    ----------
    constants, points
        As for `interpolated`.
    speed
        rad/s.
    rising
        Whether the speed rises.
    """
    above, end = 0, constants.count
    while above < end:  # the first point above the speed
        middle = (above + end) // 2
        if points[middle, 0] > speed:
            end = middle
        else:
            above = middle + 1
    if rising:
        return points[above, 0] if above < constants.count else np.inf
    below = above - 1
    if below >= 0 and points[below, 0] >= speed:
        below -= 1
    return points[below, 0] if below >= 0 else np.inf


class LoadTable(Load):
    """A torque over the speed: linear between points, constant before the first and after the last.

    Both are counter-clockwise positive. The points are `speeds` and `torques`, or the two columns of the CSV file
    `file`, which is read when the table is made: a relative path starts at the folder of the drive file.
    """

    constants = LOAD_TABLE
    torque_at = interpolated
    next_kink = next_point

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, "speeds", "torques", "speed in rad/s and torque in N*m")
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
    def points(self) -> Sequence[tuple[float, float]]:
        """Speeds, rad/s, and torques, N m."""
        return tuple(zip(self.speeds, self.torques, strict=True))

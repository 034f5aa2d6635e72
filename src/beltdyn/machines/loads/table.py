"""A torque over speed by points."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from math import ceil, tau
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState, nearer_kink
from beltdyn.machines.profiles.functions import first_above
from beltdyn.parts.quantity import Angle, AngularSpeed, Power, Torque
from beltdyn.parts.table_file import check_points, describe_file, take_file, take_grid

LOAD_TABLE = record(
    count="i8",  # number of its points
)


@kernel
def interpolated(constants: np.record, numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `LOAD_TABLE`: linear between points, constant outside.

    `numbers`, shape (2 n,), are ascending speeds, rad/s, then torques, N m.
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
    """Kernel of `Load.next_kink`: the nearest point in the sense of the change of speed."""
    above = first_above(numbers, 0, constants.count, shaft.speed)
    if rising:
        return numbers[above] if above < constants.count else np.inf
    below = above - 1
    if below >= 0 and numbers[below] >= shaft.speed:
        below -= 1
    return numbers[below] if below >= 0 else np.inf


@register
class LoadTable(Load):
    """A torque over speed, linear between points, constant before the first and after the last.

    Both are counter-clockwise positive. The points are `speeds` and `torques`, or the two columns of the CSV file
    `file`, which is read when the table is made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> bd.model.LoadTable(kind="table", speeds=[0.0, 100.0], torques=[0.0, -5.0]).torques
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

    def reversed(self) -> Self:
        """As in the base: the table turned about the origin."""
        return super().reversed().replace(speeds=_negative(self.speeds), torques=_negative(self.torques))

    def values(self) -> Mapping[str, Any]:
        """The number of its points."""
        return {"count": len(self.speeds)}

    @property
    def numbers(self) -> Sequence[float]:
        """Speeds, rad/s, then torques, N m."""
        return (*self.speeds, *self.torques)

    @property
    def driven_speed(self) -> float:
        """Speed up to which torques are in the sense of the speed, as of a motor, rad/s; zero for a load."""
        return _driven_speed(self.speeds, self.torques) or -_driven_speed(
            _negative(self.speeds), _negative(self.torques)
        )


def _driven_speed(speeds: Sequence[float], torques: Sequence[float]) -> float:
    """Largest positive speed up to which the torque is positive, the last point at most; zero without any."""
    points = [(0.0, float(np.interp(0.0, speeds, torques)))]
    points += [(speed, torque) for speed, torque in zip(speeds, torques, strict=True) if speed > 0.0]
    for place in reversed(range(len(points))):
        speed, torque = points[place]
        if torque > 0.0:
            last = points[place + 1 :]
            return speed + torque * (last[0][0] - speed) / (torque - last[0][1]) if last else speed
    return 0.0


def _negative(ascending: Sequence[float]) -> tuple[float, ...]:
    """Numbers with the opposite sign in the opposite order."""
    return tuple(-one for one in ascending[::-1])


# A power over speed, as sheets of accessories give it


@register
class PowerTable(Load):
    """The power that an accessory takes over its speed, by one point or more; it opposes the motion in either sense.

    The torques of the points, power over speed, are joined by straight lines; the torque is constant beyond the last
    point, and proportional to the speed before the first. The points are `speeds` and `powers`, or the two columns of
    the CSV file `file`, which is read when the table is made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> load = bd.model.PowerTable(kind="power", speeds=["3000 rpm"], powers=["2 kW"])
    >>> load.torque_over([0.0], 314.16).round(3).item()
    -6.366
    """

    constants = LOAD_TABLE
    torque_at = interpolated
    next_kink = next_point

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("speeds", "powers"), "two columns, speeds and powers")
    )

    kind: Literal["power"] = Field(description="the kind of load")
    speeds: tuple[Annotated[AngularSpeed, Field(gt=0)], ...] = Field(
        min_length=1, description="the speeds of the points, of either sense, in rad/s"
    )
    powers: tuple[Annotated[Power, Field(ge=0)], ...] = Field(
        min_length=1, description="the powers taken at these speeds, in W"
    )

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "speeds", "powers")

    @model_validator(mode="after")
    def _is_a_function_of_speed(self) -> Self:
        check_points("speeds", self.speeds, "powers", self.powers)
        return self

    def values(self) -> Mapping[str, Any]:
        """The number of its points, of both senses and at rest."""
        return {"count": 2 * len(self.speeds) + 1}

    @property
    def numbers(self) -> Sequence[float]:
        """Speeds, rad/s, then torques, N m."""
        torques = [power / speed for speed, power in zip(self.speeds, self.powers, strict=True)]
        speeds = [*(-one for one in reversed(self.speeds)), 0.0, *self.speeds]
        return (*speeds, *reversed(torques), 0.0, *(-one for one in torques))


# A torque over the shaft angle through points, periodic and smooth, and optionally over speed

ANGLE_TABLE = record(
    angles="i8",  # number of its angles; the last is the first a cycle later
    speeds="i8",  # number of its speeds
    cycle="f8",  # rad
)


@kernel
def torque_over_angle(constants: np.record, numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `ANGLE_TABLE`: bicubic, constant beyond the speeds.

    With a angles and b speeds, `numbers`, shape (a + b + 4 a b,), are ascending angles, rad, and speeds,
    rad/s; then for each angle and speed the torque M, dM/dtheta, dM/domega and d2M/(dtheta domega).
    """
    angles, speeds, start = constants.angles, constants.speeds, numbers[0]
    angle = start + (shaft.angle - start) % constants.cycle
    i = min(first_above(numbers, 0, angles, angle), angles - 1) - 1
    j = min(max(first_above(numbers, angles, angles + speeds, shaft.speed) - angles, 1), max(speeds - 1, 1)) - 1
    step = numbers[i + 1] - numbers[i]
    part = (angle - numbers[i]) / step
    width, share, inside = 1.0, 0.0, 0.0
    if speeds > 1:
        first, last = numbers[angles + j], numbers[angles + j + 1]
        width, inside = last - first, 1.0 if first < shaft.speed < last else 0.0
        share = min(max((shaft.speed - first) / width, 0.0), 1.0)
    torque, by_angle, by_speed = 0.0, 0.0, 0.0
    for a in range(2):
        value, slope, by_value, by_slope = _hermite(part, a)
        for b in range(min(speeds, 2)):
            over, rise, by_over, by_rise = _hermite(share, b)
            at = angles + speeds + 4 * ((i + a) * speeds + j + b)
            level = numbers[at] * over + width * numbers[at + 2] * rise
            tilt = step * (numbers[at + 1] * over + width * numbers[at + 3] * rise)
            torque += value * level + slope * tilt
            by_angle += (by_value * level + by_slope * tilt) / step
            level = numbers[at] * by_over + width * numbers[at + 2] * by_rise
            tilt = step * (numbers[at + 1] * by_over + width * numbers[at + 3] * by_rise)
            by_speed += inside * (value * level + slope * tilt) / width
    return LoadTorque(torque, by_angle, by_speed, 0.0)


@kernel(inline=True)
def _hermite(part: float, end: int) -> tuple[float, float, float, float]:
    """Cubics on [0, 1] of the value and of the slope at the end 0 or 1, and their derivatives."""
    x = 1.0 - part if end == 0 else part
    sign = -1.0 if end == 0 else 1.0
    return x * x * (3.0 - 2.0 * x), sign * x * x * (x - 1.0), sign * 6.0 * x * (1.0 - x), x * (3.0 * x - 2.0)


@kernel
def next_end(constants: np.record, numbers: FloatArray, shaft: ShaftState, rising: bool) -> float:
    """The next of the first and the last speed, rad/s; infinite without any."""
    first, nearest = constants.angles, np.inf
    if constants.speeds > 1:
        nearest = nearer_kink(numbers[first], nearest, shaft.speed, rising)
        nearest = nearer_kink(numbers[first + constants.speeds - 1], nearest, shaft.speed, rising)
    return nearest


class _OverAngle(Load):
    """A torque over the angle of the shaft."""

    constants = ANGLE_TABLE
    torque_at = torque_over_angle
    next_kink = next_end

    angles: tuple[Angle, ...] = Field(min_length=3, description="the angles of the points within one cycle, in rad")
    cycle: Angle = Field(
        tau,
        gt=0,
        description="the period of the torque, in rad; 4 pi for a four-stroke engine",
    )

    @property
    @abstractmethod
    def grid(self) -> tuple[Sequence[float], FloatArray]:
        """Speeds, rad/s, and torques of each angle at each speed, N m."""

    def _check_cycle(self) -> None:
        """Check that the points are those of a cycle."""
        torques = self.grid[1]
        whole, largest = self.angles[-1] - self.angles[0], float(np.abs(torques).max())
        if whole > self.cycle * (1.0 + _SAME):
            raise ValueError(
                f"angles span {whole:g} rad, more than cycle = {self.cycle:g} rad. Increase cycle, or give one cycle"
            )
        if self._closed and np.abs(torques[-1] - torques[0]).max() > _SAME * largest:
            raise ValueError(
                f"angles {self.angles[0]:g} and {self.angles[-1]:g} rad are one cycle apart with different torques. "
                "Remove one of them"
            )

    @property
    def _closed(self) -> bool:
        """Whether the last angle is the first one, a cycle later."""
        return self.angles[-1] - self.angles[0] > self.cycle * (1.0 - _SAME)

    def _cycle_of_points(self) -> tuple[FloatArray, FloatArray]:
        """Angles from the first to that a cycle later, and torques there."""
        angles, torques = np.array(self.angles), self.grid[1]
        if self._closed:
            angles, torques = angles[:-1], torques[:-1]
        return np.append(angles, angles[0] + self.cycle), np.concatenate([torques, torques[:1]])

    def values(self) -> Mapping[str, Any]:
        """Numbers of its points, and the cycle."""
        return {"angles": len(self._cycle_of_points()[0]), "speeds": len(self.grid[0]), "cycle": self.cycle}

    @property
    def numbers(self) -> FloatArray:
        """Angles, speeds, and torques with their slopes."""
        angles, torques = self._cycle_of_points()
        speeds = np.array(self.grid[0])
        by_angle = np.stack([_slopes_over_angle(angles, column) for column in torques.T], axis=1)
        by_speed, by_both = (
            np.stack([_slopes_over_speed(speeds, line) for line in one]) for one in (torques, by_angle)
        )
        nodes = np.stack([torques, by_angle, by_speed, by_both], axis=-1)
        return np.concatenate([angles, speeds, nodes.ravel()])

    @staticmethod
    def mean_numbers(constants: np.record, numbers: FloatArray) -> FloatArray:
        """Its torque and slope over the speed by their means over a cycle, and none over the angle."""
        angles, before = int(constants.angles), int(constants.angles + constants.speeds)
        nodes, found = numbers[before:].reshape(angles, -1, 2, 2), numbers.copy()
        step = np.diff(numbers[:angles])[:, None, None]
        values, slopes = nodes[..., 0], nodes[..., 1]  # of the torque and of its slope over the speed
        areas = 0.5 * step * (values[1:] + values[:-1]) - step**2 / 12.0 * np.diff(slopes, axis=0)
        means = np.zeros_like(nodes)
        means[..., 0] = areas.sum(axis=0) / constants.cycle
        found[before:] = means.ravel()
        return found

    @property
    def orders(self) -> Sequence[float]:
        """Those of its harmonics, of the cycle, and of the shortest distance between points as half a wave."""
        lowest = tau / self.cycle
        finest = float(np.diff(self._cycle_of_points()[0]).min())
        return [*super().orders, lowest, lowest * ceil(np.pi / finest / lowest * (1.0 - _SAME))]


_SAME = 1e-6
"""What differs by this part or less is the same."""


def _slopes_over_angle(angles: FloatArray, torques: FloatArray) -> FloatArray:
    """Slopes of a periodic function at its points, of which the last is the first a cycle later."""
    from scipy.interpolate import PchipInterpolator  # takes 0.3 s, and most drives have no such table

    cycle = angles[-1] - angles[0]
    around = np.concatenate([angles[-2:-1] - cycle, angles, angles[1:2] + cycle])
    wrapped = np.concatenate([torques[-2:-1], torques, torques[1:2]])
    return np.asarray(PchipInterpolator(around, wrapped).derivative()(angles))


def _slopes_over_speed(speeds: FloatArray, torques: FloatArray) -> FloatArray:
    """Slopes of a function at its points; zero with a single one."""
    from scipy.interpolate import PchipInterpolator

    if len(speeds) < 2:
        return np.zeros_like(torques)
    return np.asarray(PchipInterpolator(speeds, torques).derivative()(speeds))


@register
class AngleTable(_OverAngle):
    """A torque over the shaft angle, smooth through points and periodic.

    Both are counter-clockwise positive. The points are `angles` and `torques`, or the two columns of the CSV file
    `file`, which is read when the table is made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> bd.model.AngleTable(kind="angle_table", angles=["0 deg", "90 deg", "180 deg"], torques=[0.0, 5.0, 1.0]).torques
    (0.0, 5.0, 1.0)
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("angles", "torques"), "two columns, angles and torques")
    )

    kind: Literal["angle_table"] = Field(description="the kind of load")
    torques: tuple[Torque, ...] = Field(min_length=3, description="the torques at these angles, in N*m")

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "angles", "torques")

    @model_validator(mode="after")
    def _is_a_cycle(self) -> Self:
        check_points("angles", self.angles, "torques", self.torques)
        self._check_cycle()
        return self

    def reversed(self) -> Self:
        """As in the base: the table turned about the origin."""
        return super().reversed().replace(angles=_negative(self.angles), torques=_negative(self.torques))

    @property
    def grid(self) -> tuple[Sequence[float], FloatArray]:
        """One speed, and a column of torques."""
        return (0.0,), np.array(self.torques)[:, None]


@register
class AngleSpeedTable(_OverAngle):
    """A torque over shaft angle and speed, smooth through points, periodic, constant outside the speeds.

    All are counter-clockwise positive. The points are `angles`, `speeds` and `torques`, or a CSV file `file`: its first
    line has the speeds behind a first cell, and each other line an angle and the torques there.

    Examples
    --------
    >>> bd.model.AngleSpeedTable(
    ...     kind="angle_speed_table", angles=["0 deg", "90 deg", "180 deg"], speeds=["0 rpm", "1500 rpm"],
    ...     torques=[[0.0, -1.0], [-5.0, -6.0], [-1.0, -2.0]]
    ... ).speeds
    (0.0, 157.07963267948966)
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(
            schema,
            ("angles", "speeds", "torques"),
            "a first line of speeds after any cell, and lines of an angle and its torques",
        )
    )

    kind: Literal["angle_speed_table"] = Field(description="the kind of load")
    speeds: tuple[AngularSpeed, ...] = Field(min_length=2, description="the speeds of the points, in rad/s")
    torques: tuple[tuple[Torque, ...], ...] = Field(
        min_length=3, description="the torques, a list over the speeds for each angle, in N*m"
    )

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_grid(data, info, "angles", "speeds", "torques")

    @model_validator(mode="after")
    def _is_a_cycle_at_all_speeds(self) -> Self:
        check_points("angles", self.angles, "torques", self.torques)
        for line in self.torques:
            check_points("speeds", self.speeds, "torques", line)
        self._check_cycle()
        return self

    def reversed(self) -> Self:
        """As in the base: the table turned about the origin."""
        torques = tuple(_negative(line) for line in self.torques[::-1])
        return super().reversed().replace(angles=_negative(self.angles), speeds=_negative(self.speeds), torques=torques)

    @property
    def grid(self) -> tuple[Sequence[float], FloatArray]:
        """Speeds and torques as they are given."""
        return self.speeds, np.array(self.torques)

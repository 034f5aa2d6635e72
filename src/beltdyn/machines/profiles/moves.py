"""Moves to angles, as motion controllers make them: of trapezoidal speed, with limited jerk, and through points.

A move over the way D with the largest speed V, acceleration A and jerk J accelerates to v in the time

    T(v) = v / A + A / J    where v >= A^2 / J, and else 2 sqrt(v / J),

and both phases take the way v T(v).  A way shorter than V T(V) leaves no time at the largest speed: v T(v) = D.
"""

from collections.abc import Iterator
from math import cbrt, inf, sqrt
from typing import Any, ClassVar, Generic, Literal, NamedTuple, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationInfo, model_validator

from beltdyn.arrays import FloatArray, Records, records
from beltdyn.kinds import register
from beltdyn.machines.profiles.profile import SEGMENT, Profile, Value
from beltdyn.parts.quantity import Angle, AngularAcceleration, AngularJerk, AngularSpeed, Time
from beltdyn.parts.table_file import check_points, describe_file, take_file


class _Piece(NamedTuple):
    """A part of a move with constant jerk."""

    duration: float
    """s."""
    jerk: float


def _pieces(way: float, speed: float, acceleration: float, jerk: float) -> list[_Piece]:
    """Parts of a move over a positive way within its limits."""
    bend = acceleration**2 / jerk

    def phase(reached: float) -> tuple[float, float]:
        """Times with jerk, and without, in which a speed is reached."""
        with_jerk = acceleration / jerk if reached >= bend else sqrt(reached / jerk)
        whole = reached / acceleration + acceleration / jerk if reached >= bend else 2.0 * with_jerk
        return with_jerk, whole - 2.0 * with_jerk

    def length(reached: float) -> float:
        with_jerk, without = phase(reached)
        return reached * (2.0 * with_jerk + without)

    reached = speed
    if length(speed) > way:
        reached = 0.5 * (sqrt(bend**2 + 4.0 * acceleration * way) - bend)
        reached = reached if reached >= bend else cbrt(0.25 * way**2 * jerk)
    bent, straight = phase(reached)
    own = 0.0 if jerk == inf else jerk
    rise = [_Piece(bent, own), _Piece(straight, 0.0), _Piece(bent, -own)]
    fall = [_Piece(bent, -own), _Piece(straight, 0.0), _Piece(bent, own)]
    return [*rise, _Piece((way - length(reached)) / reached, 0.0), *fall]


class Moves(Profile[Value], Generic[Value]):
    """Moves to angles: one begins at each instant of `times` and ends at the angle of that place, the first at zero."""

    turns: ClassVar[bool] = True
    proportional = ("angles",)

    times: tuple[Time, ...] = Field(min_length=1, description="the instants at which moves begin, in s")
    angles: tuple[Angle, ...] = Field(
        min_length=1, examples=[[0.0, 1.0]], description="the angles at which they end, in rad"
    )
    speed: AngularSpeed = Field(gt=0, examples=[50.0], description="the largest speed of a move, in rad/s")
    acceleration: AngularAcceleration = Field(
        gt=0, examples=[1e3], description="the acceleration of a move, in rad/s^2"
    )

    @model_validator(mode="after")
    def _ends_a_move_before_the_next(self) -> Self:
        check_points("times", self.times, "angles", self.angles)
        for number, (begin, end) in enumerate(self._spans, 1):
            after = self.times[number] if number < len(self.times) else inf
            if end > after * (1.0 + 1e-9):
                raise ValueError(
                    f"move {number} takes from {begin:.6g} to {end:.6g} s, but the next one begins at {after:.6g} s. "
                    "Begin it later, or raise speed or acceleration"
                )
        return self

    @property
    def _largest_jerk(self) -> float:
        return inf

    @property
    def _spans(self) -> Iterator[tuple[float, float]]:
        """Begin and end of each move, s."""
        for begin, way in self._moves:
            whole = sum(one.duration for one in self._parts(way)) if way else 0.0
            yield begin, begin + whole

    @property
    def _moves(self) -> Iterator[tuple[float, float]]:
        """Instant and way of each move, s and rad."""
        yield from zip(self.times, np.diff([0.0, *self.angles]).tolist(), strict=True)

    def _parts(self, way: float) -> list[_Piece]:
        return _pieces(abs(way), self.speed, self.acceleration, self._largest_jerk)

    def segments(self) -> Records:
        """Rest, then for each move up to seven pieces of constant jerk, and rest."""
        rows = [(-np.inf, 0.0, 0.0, 0.0)]
        for begin, way in self._moves:
            rows += self._rows(begin, way) if way else []
        starts, offsets, slopes, curvatures = np.array(rows).T
        return records(SEGMENT, start=starts, offset=offsets, slope=slopes, curvature=curvatures)

    def _rows(self, begin: float, way: float) -> Iterator[tuple[float, float, float, float]]:
        """Start, speed, acceleration and jerk of the pieces of a move, and of the rest behind it."""
        sense = 1.0 if way > 0.0 else -1.0
        time, speed, rate = begin, 0.0, 0.0
        for number, piece in enumerate(self._parts(way)):
            if self._largest_jerk == inf:  # the acceleration jumps
                rate = {1: self.acceleration, 5: -self.acceleration}.get(number, 0.0)
            if piece.duration > 0.0:
                yield time, sense * speed, sense * rate, sense * piece.jerk
            time += piece.duration
            speed += (rate + 0.5 * piece.jerk * piece.duration) * piece.duration
            rate += piece.jerk * piece.duration
        yield time, 0.0, 0.0, 0.0

    def breakpoints(self) -> tuple[float, ...]:
        """Where acceleration or jerk jumps, s."""
        return tuple(self.segments().start[1:].tolist())


@register
class Trapezoid(Moves[Value], Generic[Value]):
    """Moves to angles, each with constant acceleration, constant speed and constant deceleration.

    A move begins at each instant of `times` and ends at the angle of that place; the first begins at zero.

    Examples
    --------
    >>> there = bd.model.Trapezoid(times=[0.1], angles=["1 turn"], speed="600 rpm", acceleration="1000 rad/s^2")
    >>> there.at([0.0, 0.12, 0.3]).round(1)
    array([ 0., 20.,  0.])
    """

    kind: Literal["trapezoid"] = Field("trapezoid", description="the kind of profile")


@register
class SCurve(Moves[Value], Generic[Value]):
    """Moves to angles with limited jerk: acceleration rises and falls along lines, the speed along an S.

    Examples
    --------
    >>> there = bd.model.SCurve(
    ...     times=[0.0], angles=["1 turn"], speed="600 rpm", acceleration="1000 rad/s^2", jerk="1e5 rad/s^3"
    ... )
    >>> there.at([0.0, 0.01, 0.02]).round(1)
    array([ 0.,  5., 15.])
    """

    kind: Literal["s_curve"] = Field("s_curve", description="the kind of profile")
    jerk: AngularJerk = Field(gt=0, examples=[1e5], description="the jerk of a move, in rad/s^3")

    @property
    def _largest_jerk(self) -> float:
        return self.jerk


@register
class PositionTable(Profile[Value], Generic[Value]):
    """Angles over time: the speed is that of the cubic spline through them, at rest before and after.

    The points are `times` and `angles`, or the two columns of the CSV file `file`, which is read when the table is
    made: a relative path starts at the folder of the drive file.

    Examples
    --------
    >>> table = bd.model.PositionTable(times=[0.0, 0.1, 0.2], angles=["0 turn", "0.5 turn", "1 turn"])
    >>> table.at([0.0, 0.1, 0.2]).round(1)
    array([ 0. , 47.1,  0. ])
    """

    model_config = ConfigDict(
        json_schema_extra=lambda schema: describe_file(schema, ("times", "angles"), "two columns, times and angles")
    )

    turns: ClassVar[bool] = True
    proportional = ("angles",)

    kind: Literal["position_table"] = Field("position_table", description="the kind of profile")
    times: tuple[Time, ...] = Field(min_length=2, description="the instants of the points, in s")
    angles: tuple[Angle, ...] = Field(
        min_length=2, examples=[[0.0, 1.0]], description="the angles at these instants, in rad"
    )

    @model_validator(mode="before")
    @classmethod
    def _read_file(cls, data: Any, info: ValidationInfo) -> Any:
        return take_file(data, info, "times", "angles")

    @model_validator(mode="after")
    def _is_a_function_of_time(self) -> Self:
        check_points("times", self.times, "angles", self.angles)
        return self

    def segments(self) -> Records:
        """Rest, then the derivative of a cubic between each two points, and rest."""
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.times, self.angles, bc_type="clamped")
        cubic, square, line, _ = spline.c
        return records(
            SEGMENT,
            start=np.concatenate([[-np.inf], self.times]),
            offset=np.concatenate([[0.0], line, [0.0]]),
            slope=np.concatenate([[0.0], 2.0 * square, [0.0]]),
            curvature=np.concatenate([[0.0], 6.0 * cubic, [0.0]]),
        )

    def breakpoints(self) -> tuple[float, ...]:
        """Begin and end of the motion, s; in between the acceleration has no jumps."""
        return self.times[0], self.times[-1]

    def _bends(self, end: float) -> FloatArray:
        """Those of the parabolas between points."""
        segments = self.segments()
        bends = np.divide(
            -segments.slope, segments.curvature, out=np.zeros(len(segments)), where=segments.curvature != 0
        )
        with np.errstate(invalid="ignore"):
            inside = segments.start + bends
        ends = np.append(segments.start[1:], np.inf)
        return np.asarray(inside[(bends > 0.0) & (inside < ends) & (inside <= end) & (inside > 0.0)])

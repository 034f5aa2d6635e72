"""A prescribed value over time, its rate and its integral, in closed form piece by piece (Eqs. 28 and 29)."""

from abc import abstractmethod
from functools import cached_property
from math import sin
from typing import Any, ClassVar, Generic, Self

import numpy as np
from numpy.typing import ArrayLike
from typing_extensions import TypeVar

from beltdyn.arrays import FloatArray, Records, record
from beltdyn.kernel import interpreted, kernel
from beltdyn.kinds import Registry
from beltdyn.parts.part import Part

_ROUNDING = 1e-9
"""Relative difference up to which two values of a profile count as equal."""

Value = TypeVar("Value", bound=float, default=float)

SEGMENT = record(
    start="f8",  # instant after which the segment holds, s; minus infinity of the first, whose slope is zero
    offset="f8",  # value at the start, without the wave
    slope="f8",  # change of it in a second, at the start
    curvature="f8",  # change of that in a second
    amplitude="f8",  # of the wave
    frequency="f8",  # angular frequency of the wave, rad/s
    phase="f8",  # of the wave at time zero, rad
    integral="f8",  # of the profile from time zero to the start (of the first: to time zero as if it held there)
)
"""A piece of a profile: offset + slope s + curvature s^2 / 2 + amplitude cos(frequency t + phase) with s = t - start,
for start < t <= next start."""


class Profile(Part, Generic[Value]):
    """A value over time: rad/s for a speed, N m for a torque, 1 for a factor; times are in s."""

    multiplies: ClassVar[bool] = True
    """Whether it may be a schedule."""

    turns: ClassVar[bool] = False
    """Whether it is given by angles, and can be a speed alone."""

    proportional: ClassVar[tuple[str, ...]] = ("value",)
    """Fields to which its values are proportional."""

    @classmethod
    def model_parametrized_name(cls, params: tuple[Any, ...]) -> str:
        """Name a profile of any quantity by its kind."""
        return cls.__name__

    @abstractmethod
    def segments(self) -> Records:
        """The closed form of the profile, piece by piece.

        Returns
        -------
        recarray, shape (m,)
            Rows of `SEGMENT` without their integrals, in the order of their starts.
        """

    @cached_property
    def integrated(self) -> Records:
        """Rows of `SEGMENT` with their integrals; not to be changed."""
        segments, integral = self.segments(), interpreted(segment_integral)
        begins = np.concatenate([[0.0], segments.start[1:]]).tolist()
        areas = [
            integral(segment, begin, end)
            for segment, begin, end in zip(segments[:-1], begins[:-1], begins[1:], strict=True)
        ]
        segments.integral[1:] = np.cumsum(areas)
        zero = max(int(np.searchsorted(segments.start, 0.0, side="left")) - 1, 0)
        segments.integral -= segments.integral[zero] + integral(segments[zero], begins[zero], 0.0)
        return segments

    def reversed(self) -> Self:
        """The profile with the opposite sign."""
        given = {name: getattr(self, name) for name in self.proportional}
        return self.replace(
            **{
                name: tuple(-one for one in value) if isinstance(value, tuple) else -value
                for name, value in given.items()
            }
        )

    def breakpoints(self) -> tuple[float, ...]:
        """Instants of kinks and jumps that a time integrator must step onto, s; by default none."""
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
        t, segments = np.asarray(times, dtype=float), self.segments()
        k = np.maximum(np.searchsorted(segments.start, t, side="left") - 1, 0)
        since = np.where(k == 0, 0.0, t - segments.start[k])
        return np.asarray(interpreted(segment_value)(segments[k], since, t))

    def largest(self, duration: float = np.inf) -> float:
        """Largest absolute value from time zero to a time, s."""
        return abs(self.extreme(duration))

    def extreme(self, duration: float = np.inf, begin: float = 0.0) -> float:
        """Value of largest magnitude from a time, s, by default zero, to another one; of equal ones the first.

        It is at an end, or at the start of a piece, before or after a jump: within a piece all kinds are monotonic,
        and the last piece is constant.
        """
        starts = self.segments().start
        end = min(duration, max(2.0 * starts[-1], 1.0))
        inside = np.concatenate([starts, self._bends(end)])
        begin = min(begin, end)
        ends = [begin, *np.sort(inside[(inside > begin) & (inside < end)]), end]
        values = self.around(np.array(ends), end)
        sizes = np.abs(values)
        return float(values[np.argmax(sizes >= (1.0 - _ROUNDING) * sizes.max())])

    def _bends(self, _end: float) -> FloatArray:
        """Instants after time zero up to an end at which a piece has an extreme, s; by default none."""
        return np.empty(0)

    def around(self, times: FloatArray, end: float = np.inf) -> FloatArray:
        """Values at times (s) and just after them, up to an end (s): before and after a jump."""
        with np.errstate(under="ignore"):  # just after zero
            after = np.nextafter(times, np.inf)
        values = self.at(np.stack([times, np.minimum(after, end)], axis=1))
        return np.asarray(values.ravel())


PROFILES = Registry[type[Profile]]("profile", Profile)
"""All kinds of profiles by name."""


@kernel(inline=True)
def segment_value(segment: Any, since: Any, time: Any) -> Any:
    """Value of a profile at an instant.

    `segment`: the row of `SEGMENT` that holds there; `since`: time since its start, s; zero in the first; `time`: s.
    """
    wave = segment.amplitude * np.cos(segment.frequency * time + segment.phase)
    return segment.offset + (segment.slope + 0.5 * segment.curvature * since) * since + wave


@kernel(inline=True)
def segment_integral(segment: np.record, begin: float, end: float) -> float:
    """Integral of a profile over a part of a segment that starts where the segment does, or at time zero in the first.

    (t - s) (offset + slope (t - s) / 2 + curvature (t - s)^2 / 6 + amplitude cos(omega (s + t) / 2 + phase) sin(x) / x)
    from s to t, x = omega (t - s) / 2.

    `segment`: a row of `SEGMENT`; `begin`, `end`: s and t, s.
    """
    since = end - begin
    half = 0.5 * segment.frequency * since
    wave = sin(half) / half if half != 0.0 else 1.0
    middle = np.cos(0.5 * segment.frequency * (begin + end) + segment.phase)
    straight = segment.offset + (0.5 * segment.slope + segment.curvature * since / 6.0) * since
    return float((straight + segment.amplitude * wave * middle) * since)

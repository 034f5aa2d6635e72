"""Means over whole cycles of what repeats: the one window over which a run is summed up.

With phases p_1, p_2, ... that grow by 1 in every cycle (a turn of the belt, a wave of a harmonic), the mean of y is

    y_0 = y,        y_j(t) = 1 / (t - s) integral of y_(j-1) from s to t,        p_j(t) - p_j(s) = n_j,

so what repeats in any of these cycles drops out, also where one is no multiple of the other.  Between outputs y is
taken as straight.
"""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.results.recorded import Recorded


@dataclass(frozen=True, eq=False)
class Cycle:
    """A repeating process.

    Attributes
    ----------
    phase : ndarray, shape (outputs,)
        Number of cycles gone by at every output, ascending.
    count : float
        Number of cycles n to take means over.
    """

    phase: FloatArray
    count: float

    def begin(self, time: FloatArray, end: FloatArray) -> FloatArray:
        """Instants `count` cycles before the given ones, or the first output's, s."""
        phase = np.maximum.accumulate(self.phase)
        return np.interp(np.interp(end, time, phase) - self.count, phase, time)


@dataclass(frozen=True, eq=False)
class Window:
    """An averaging window, which ends with the last output.

    Attributes
    ----------
    time : ndarray, shape (outputs,)
        Times of all outputs, s.
    cycles : tuple of Cycle
        What means are taken over, one after the other.
    turns : int
        Number of turns of the belt among them; zero where not even one was taken.
    """

    time: FloatArray
    cycles: tuple[Cycle, ...]
    turns: int = 0

    @property
    def end(self) -> float:
        """Last instant, s."""
        return float(self.time[-1])

    @property
    def start(self) -> float:
        """First instant, s."""
        instant = self.time[-1:]
        for cycle in reversed(self.cycles):
            instant = cycle.begin(self.time, instant)
        return float(instant[0])

    @property
    def first(self) -> int:
        """Number of the first output in the window."""
        return int(np.searchsorted(self.time, self.start * (1.0 - 1e-12)))

    def mean(self, recorded: Recorded, name: str) -> FloatArray:
        """Mean of a recorded variable over the window."""
        return self.mean_of(np.asarray(recorded[name][self._rows]))

    def product(self, recorded: Recorded, one: str, other: str) -> FloatArray:
        """Mean of the product of two recorded variables over the window."""
        return self.mean_of(*(np.asarray(recorded[name][self._rows]) for name in (one, other)))

    def rate(self, recorded: Recorded, name: str) -> FloatArray:
        """Mean rate of what was recorded as an integral over time, such as an angle or a work; zero of one output."""
        values, (time, cycles) = np.asarray(recorded[name][self._rows]), self._cut(self._rows)
        if len(time) == 1:
            return np.zeros(values.shape[1:])
        begin = cycles[0].begin(time, time)
        grown = _divide(values - _interpolate(begin, time, values), time - begin)
        grown[0] = grown[1]
        return np.asarray(_mean(grown, time, cycles[1:])[-1])

    def mean_of(self, values: FloatArray, factor: FloatArray | float = 1.0) -> FloatArray:
        """Mean of values times a factor at the last outputs, as many as are given; they must cover the window."""
        rows = slice(len(self.time) - len(values), None)
        return np.asarray(_mean(values * factor, *self._cut(rows))[-1])

    def running_means(self, values: FloatArray) -> FloatArray:
        """Means around every output.

        Parameters
        ----------
        values : ndarray, shape (outputs, ...)
            At all outputs.

        Returns
        -------
        ndarray, shape (outputs, ...)
            Means over windows with their middles at the outputs. NaN before the middle of the first whole window, and
            where a value in the window is NaN; from the middle of the last whole window on the mean over that one.
        """
        if not self.cycles:
            return values.copy()
        unknown = ~np.isfinite(values)
        middle, means = self._centred(np.where(unknown, 0.0, values))
        missing = self._centred(unknown.astype(float))[1] > 0.0
        known = _interpolate(self.time, middle, np.where(missing, np.nan, means))
        known[self.time < middle[0]] = np.nan
        return known

    def _centred(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Middles of all whole windows, and the means over them."""
        begin = self.time
        for cycle in reversed(self.cycles):
            begin = cycle.begin(self.time, begin)
        whole = begin > self.time[0]
        whole[-1] = True
        return 0.5 * (begin + self.time)[whole], _mean(values, self.time, self.cycles)[whole]

    @property
    def _rows(self) -> slice:
        """The outputs that cover the window, and one more for each cycle."""
        return slice(max(self.first - 1 - len(self.cycles), 0), None)

    def _cut(self, rows: slice) -> tuple[FloatArray, tuple[Cycle, ...]]:
        """Times and cycles at some outputs."""
        return self.time[rows], tuple(Cycle(cycle.phase[rows], cycle.count) for cycle in self.cycles)


def plain_window(time: FloatArray, start: float | None = None) -> Window:
    """Give the window from an instant to the last output, whatever repeats.

    Parameters
    ----------
    time : ndarray, shape (outputs,)
        Times of the outputs, s.
    start : float, optional
        The instant, s; that of the first output by default.
    """
    start = float(time[0]) if start is None else start
    return Window(time, (Cycle(time, float(time[-1]) - start),))


def _mean(values: FloatArray, time: FloatArray, cycles: tuple[Cycle, ...]) -> FloatArray:
    """Means over the cycles before every output, as far as there are outputs before it."""
    if len(time) == 1:
        return values
    for cycle in cycles:
        begin = cycle.begin(time, time)
        integral = _integral(values, time)
        at = np.clip(np.searchsorted(time, begin, side="right") - 1, 0, len(time) - 2)
        past = _along(begin - time[at], values)
        slope = (values[at + 1] - values[at]) / _along(time[at + 1] - time[at], values)
        before = integral[at] + past * (values[at] + 0.5 * past * slope)
        first, values = values[:1], _divide(integral - before, time - begin)
        values[:1] = first
    return values


def _integral(values: FloatArray, time: FloatArray) -> FloatArray:
    """Integral over time up to each output, by trapezoids."""
    areas = 0.5 * (values[1:] + values[:-1]) * _along(np.diff(time), values)
    return np.concatenate([np.zeros((1, *values.shape[1:])), np.cumsum(areas, axis=0)])


def _divide(values: FloatArray, elapsed: FloatArray) -> FloatArray:
    """Values over times; zero where no time has gone by."""
    return values / _along(np.where(elapsed > 0.0, elapsed, np.inf), values)


def _interpolate(instants: FloatArray, time: FloatArray, values: FloatArray) -> FloatArray:
    """Values between outputs, constant outside."""
    if len(time) == 1:
        return np.broadcast_to(values, (len(instants), *values.shape[1:])).copy()
    at = np.clip(np.searchsorted(time, instants, side="right") - 1, 0, len(time) - 2)
    part = np.clip((instants - time[at]) / (time[at + 1] - time[at]), 0.0, 1.0)
    return values[at] + _along(part, values) * (values[at + 1] - values[at])


def _along(column: FloatArray, values: FloatArray) -> FloatArray:
    """Lay a column over time along the other dimensions of values."""
    return column.reshape(-1, *(1,) * (values.ndim - 1))

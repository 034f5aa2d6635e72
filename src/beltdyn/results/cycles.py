"""The averaging window: whole cycles at the end of a run."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import floor, gcd, lcm

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.machines import Profile, Table
from beltdyn.model import Prepared
from beltdyn.quadrature import running_integral
from beltdyn.results.schema import Recorded

# Means over whole cycles of what repeats: the one window over which a run is summed up


@dataclass(frozen=True, eq=False)
class Cycle:
    """A repeating process."""

    phase: FloatArray
    """Number of cycles gone by at every output, ascending, shape (outputs,)."""
    count: float
    """Number of cycles n to take means over."""

    def begin(self, time: FloatArray, end: FloatArray) -> FloatArray:
        """Instants `count` cycles before the given ones, or the first output's, s."""
        phase = np.maximum.accumulate(self.phase)
        return np.interp(np.interp(end, time, phase) - self.count, phase, time)


@dataclass(frozen=True, eq=False)
class Window:
    """An averaging window, which ends with the last output."""

    time: FloatArray
    """Times of all outputs, s, shape (outputs,)."""
    cycles: tuple[Cycle, ...]
    """What means are taken over, one after the other."""
    turns: int = 0
    """Number of turns of the belt among them; zero where not even one was taken."""

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
        """Means over windows with their middles at the outputs.

        NaN before the middle of the first whole window, and where a value in the window is NaN; the last whole window's
        mean from its middle on.
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
    """The window from an instant, by default the first output, to the last output."""
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


SHORTEST, LONGEST = 0.1, 0.5
"""Parts of the recorded time that the window of means is at least and at most."""

_STANDSTILL_PART = 0.1
"""Part of its waves in a turn of the belt below which a shaft counts as standing still."""
_TABLE_SAMPLES = 4096
"""Samples of a table over a run, for its autocorrelation: shorter periods than a thousandth of the run are not
resolved."""
_PERIOD_TOLERANCE = 0.02
"""Mean square difference of what repeats from itself a period earlier, over its variance."""
_FINEST = 64
"""Largest denominator of the order of a harmonic."""


def mean_window(recorded: Recorded, prepared: Prepared) -> Window:
    """Choose the averaging window of a run.

    Whole turns of the belt and whole periods of prescribed harmonics and repeating tables: at least a tenth of the
    recorded time, and at most half of it or the time since the last prescribed change. If no turn of the belt fits, the
    window covers whole element passings within a tenth of the time. If nothing turns, it is the last tenth.
    """
    shortest = turn_window(recorded, prepared)
    time, least = shortest.time, SHORTEST * float(np.ptp(shortest.time))
    if not shortest.cycles:
        return plain_window(time, float(time[-1]) - least)
    times = max(floor(least / (shortest.end - shortest.start) * (1.0 + 1e-9)), 1)
    cycles = tuple(Cycle(cycle.phase, cycle.count * times) for cycle in shortest.cycles)
    return Window(time, cycles, shortest.turns * times)


_STANDSTILL = 0.02
"""Largest speed in the averaging window, over that of the run, at which a drive stands: what rings after a move."""


def ends_at_standstill(recorded: Recorded, prepared: Prepared) -> bool:
    """Whether all pulleys stand in the later half of the averaging window of a run in which they moved."""
    speeds = np.abs(np.asarray(recorded["pulley_speed"], dtype=float)).max(axis=1)
    later = (mean_window(recorded, prepared).first + len(speeds)) // 2
    return len(speeds) > 1 and bool(speeds[later:].max() < _STANDSTILL * speeds.max())


def turn_window(recorded: Recorded, prepared: Prepared) -> Window:
    """Give the shortest window of whole cycles, a turn of the belt if it fits, for running means."""
    time = np.asarray(recorded["time"], dtype=float)
    elapsed = float(np.ptp(time))
    if elapsed > 0.0:
        since_change = max(SHORTEST * elapsed, float(time[-1]) - last_change(prepared, time))
        longest = min(LONGEST * elapsed, since_change)
        turn = _belt_turns(recorded, prepared, time)
        element = Cycle(turn.phase * (prepared.element_kind.curves * prepared.elements), 1)
        waves = tuple(_waves(recorded, prepared, turn))
        repeats = [((turn, *waves), 1), ((element, *waves), 0), ((turn,), 1), ((element,), 0)]
        if prepared.frame.stays:
            repeats = [*repeats[::2], (waves, 0)] if waves else repeats[::2]
        for cycles, turns in repeats:
            window = Window(time, cycles, turns)
            begun = all(cycle.phase[-1] - cycle.phase[0] >= cycle.count for cycle in cycles)
            if begun and 0.0 < window.end - window.start <= longest:
                return window
    return Window(time, ())


def _belt_turns(recorded: Recorded, prepared: Prepared, time: FloatArray) -> Cycle:
    """Turns of the belt: the way that it goes, by the mean speed in its spans, over its length."""
    speed = np.asarray(recorded["belt_speed"]).mean(axis=1)
    way = running_integral(speed, time)
    return Cycle(np.sign(way[-1] - way[0]) * way / prepared.belt_length, 1)


def _waves(recorded: Recorded, prepared: Prepared, turn: Cycle) -> Iterator[Cycle]:
    """Whole waves of harmonics over the angles of shafts, and periods of tables."""
    time = np.asarray(recorded["time"], dtype=float)
    for number, pulley in enumerate(prepared.pulleys):
        orders = [wave.order for wave in pulley.harmonics] + [one for load in pulley.load for one in load.orders]
        if orders:
            angle = np.asarray(recorded["shaft_angle"][:, number])
            forward = np.sign(angle[-1] - angle[0])
            phase = forward * angle * _common_order(orders) / (2.0 * np.pi)
            yield Cycle(_without_rest(phase, turn.phase), 1)
    periods = {_repeats(profile, time) for profile in _profiles(prepared)}
    for period in sorted(periods - {0.0}):
        yield Cycle(time / period, 1)


def _without_rest(phase: FloatArray, turns: FloatArray) -> FloatArray:
    """Let waves of a shaft that stands still go by as many in a turn of the belt as at the end: it makes none."""
    waves, passed = np.diff(phase), np.diff(turns)
    end = slice(-max(len(waves) // 10, 1), None)
    ratio = waves[end].sum() / passed[end].sum() if passed[end].sum() > 0.0 else 0.0
    going = np.where(waves > _STANDSTILL_PART * ratio * passed, waves, ratio * passed)
    return np.concatenate([phase[:1], phase[0] + np.cumsum(going)])


def _common_order(orders: Sequence[float]) -> float:
    """The largest order of which all orders are multiples."""
    fractions = [Fraction(order).limit_denominator(_FINEST) for order in orders]
    top = reduce(gcd, (one.numerator for one in fractions))
    return top / reduce(lcm, (one.denominator for one in fractions))


def _profiles(prepared: Prepared) -> list[Profile]:
    return [profile for pulley in prepared.pulleys for profile in pulley.profiles]


def last_change(prepared: Prepared, time: FloatArray) -> float:
    """Instant at which something prescribed over time last changed, other than in what repeats, s."""
    changes = [float(time[0])]
    for profile in _profiles(prepared):
        if not isinstance(profile, Table):
            changes += [instant for instant in profile.breakpoints() if instant < time[-1]]
        elif _repeats(profile, time) == 0.0:
            instants = np.array(profile.times)
            known = np.unique(np.append(instants[instants < time[-1]], time))
            other = np.flatnonzero(profile.at(known) != profile.at(time[-1]))
            changes.append(float(known[min(other[-1] + 1, len(known) - 1)]) if other.size else float(time[0]))
    return max(changes)


def _repeats(profile: Profile, time: FloatArray) -> float:
    """Period in which a table repeats in the last half of a run, s; zero where it does not."""
    if not isinstance(profile, Table):
        return 0.0
    instants, half = np.linspace(time[0], time[-1], _TABLE_SAMPLES), _TABLE_SAMPLES // 2
    values = profile.at(instants)
    values = values - values[half:].mean()
    squares = np.cumsum(np.append(0.0, values**2))
    squares = (squares[half:] - squares[:-half])[::-1]
    if squares[0] == 0.0:
        return 0.0
    difference = (squares[0] + squares - 2.0 * np.correlate(values, values[half:], "valid")[::-1]) / squares[0]
    away = int(np.argmax(difference > 1.0))
    again = away + int(np.argmax(difference[away:] < _PERIOD_TOLERANCE))
    if not away < again <= half // 2:
        return 0.0
    until = again + int(np.argmax(np.append(difference[again:], _PERIOD_TOLERANCE) >= _PERIOD_TOLERANCE))
    lag, periods = again + int(np.argmin(difference[again:until])), 1
    while 2 * lag + 2 <= half:
        lag, periods = 2 * lag - 2 + int(np.argmin(difference[2 * lag - 2 : 2 * lag + 3])), 2 * periods
    return float(lag / periods * (instants[1] - instants[0]))

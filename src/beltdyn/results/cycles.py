"""The averaging window: whole cycles at the end of a run."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce
from math import floor, gcd, lcm

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.machines import Profile, Table
from beltdyn.model import Drive
from beltdyn.results.recorded import Recorded
from beltdyn.results.window import Cycle, Window, plain_window

SHORTEST, LONGEST = 0.1, 0.5
"""Parts of the recorded time that the window of means is at least and at most."""

_STANDS = 0.1
"""Part of its waves in a turn of the belt below which a shaft counts as standing still."""
_SAMPLES = 4096
_ALIKE = 0.02
"""Mean square difference of what repeats from itself a period earlier, over its variance."""
_FINEST = 64
"""Largest denominator of the order of a harmonic."""


def mean_window(recorded: Recorded, drive: Drive) -> Window:
    """Choose the averaging window of a run.

    Whole turns of the belt and whole periods of prescribed harmonics and repeating tables: at least a tenth of the
    recorded time, and at most half of it or the time since the last prescribed change. If no turn of the belt fits, the
    window covers whole element passings within a tenth of the time. If nothing turns, it is the last tenth.

    Parameters
    ----------
    recorded : Recorded
        The results, with at least one output.
    drive : Drive
        The drive.

    Returns
    -------
    Window
        The averaging window of figures, tables and summaries.
    """
    shortest = turn_window(recorded, drive)
    time, least = shortest.time, SHORTEST * float(np.ptp(shortest.time))
    if not shortest.cycles:
        return plain_window(time, float(time[-1]) - least)
    times = max(floor(least / (shortest.end - shortest.start) * (1.0 + 1e-9)), 1)
    cycles = tuple(Cycle(cycle.phase, cycle.count * times) for cycle in shortest.cycles)
    return Window(time, cycles, shortest.turns * times)


def turn_window(recorded: Recorded, drive: Drive) -> Window:
    """Give the shortest window of whole cycles, a turn of the belt if it fits, for running means.

    Parameters
    ----------
    recorded : Recorded
        The results, with at least one output.
    drive : Drive
        The drive.

    Returns
    -------
    Window
        The window; if nothing turns, a window without cycles, which leaves values unchanged.
    """
    time = np.asarray(recorded["time"], dtype=float)
    elapsed = float(np.ptp(time))
    if elapsed > 0.0:
        since_change = max(SHORTEST * elapsed, float(time[-1]) - _last_change(drive, time))
        longest = min(LONGEST * elapsed, since_change)
        turn = _belt_turns(recorded, drive, time)
        element = Cycle(turn.phase * (drive.element_kind.curves * drive.elements), 1)
        waves = tuple(_waves(recorded, drive, turn))
        repeats = [((turn, *waves), 1), ((element, *waves), 0), ((turn,), 1), ((element,), 0)]
        if drive.frame.stays:
            repeats = [*repeats[::2], (waves, 0)] if waves else repeats[::2]
        for cycles, turns in repeats:
            window = Window(time, cycles, turns)
            begun = all(cycle.phase[-1] - cycle.phase[0] >= cycle.count for cycle in cycles)
            if begun and 0.0 < window.end - window.start <= longest:
                return window
    return Window(time, ())


def _belt_turns(recorded: Recorded, drive: Drive, time: FloatArray) -> Cycle:
    """Turns of the belt: the way that it goes, by the mean speed in its spans, over its length."""
    speed = np.asarray(recorded["belt_speed"]).mean(axis=1)
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(time))])
    return Cycle(np.sign(way[-1] - way[0]) * way / drive.belt_length, 1)


def _waves(recorded: Recorded, drive: Drive, turn: Cycle) -> Iterator[Cycle]:
    """Whole waves of harmonics over the angles of shafts, and periods of tables."""
    time = np.asarray(recorded["time"], dtype=float)
    for number, pulley in enumerate(drive.pulleys):
        orders = [wave.order for wave in pulley.harmonics] + [one for load in pulley.load for one in load.orders]
        if orders:
            angle = np.asarray(recorded["shaft_angle"][:, number])
            forward = np.sign(angle[-1] - angle[0])
            phase = forward * angle * _common_order(orders) / (2.0 * np.pi)
            yield Cycle(_without_rest(phase, turn.phase), 1)
    periods = {_repeats(profile, time) for profile in _profiles(drive)}
    for period in sorted(periods - {0.0}):
        yield Cycle(time / period, 1)


def _without_rest(phase: FloatArray, turns: FloatArray) -> FloatArray:
    """Let waves of a shaft that stands still go by as many in a turn of the belt as at the end: it makes none."""
    waves, passed = np.diff(phase), np.diff(turns)
    end = slice(-max(len(waves) // 10, 1), None)
    ratio = waves[end].sum() / passed[end].sum() if passed[end].sum() > 0.0 else 0.0
    going = np.where(waves > _STANDS * ratio * passed, waves, ratio * passed)
    return np.concatenate([phase[:1], phase[0] + np.cumsum(going)])


def _common_order(orders: Sequence[float]) -> float:
    """The largest order of which all orders are multiples."""
    fractions = [Fraction(order).limit_denominator(_FINEST) for order in orders]
    top = reduce(gcd, (one.numerator for one in fractions))
    return top / reduce(lcm, (one.denominator for one in fractions))


def _profiles(drive: Drive) -> list[Profile]:
    return [profile for pulley in drive.pulleys for profile in pulley.profiles]


def _last_change(drive: Drive, time: FloatArray) -> float:
    """When something prescribed over time last changed, other than in what repeats, s."""
    changes = [float(time[0])]
    for profile in _profiles(drive):
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
    instants, half = np.linspace(time[0], time[-1], _SAMPLES), _SAMPLES // 2
    values = profile.at(instants)
    values = values - values[half:].mean()
    squares = np.cumsum(np.append(0.0, values**2))
    squares = (squares[half:] - squares[:-half])[::-1]
    if squares[0] == 0.0:
        return 0.0
    difference = (squares[0] + squares - 2.0 * np.correlate(values, values[half:], "valid")[::-1]) / squares[0]
    away = int(np.argmax(difference > 1.0))
    again = away + int(np.argmax(difference[away:] < _ALIKE))
    if not away < again <= half // 2:
        return 0.0
    until = again + int(np.argmax(np.append(difference[again:], _ALIKE) >= _ALIKE))
    lag, periods = again + int(np.argmin(difference[again:until])), 1
    while 2 * lag + 2 <= half:
        lag, periods = 2 * lag - 2 + int(np.argmin(difference[2 * lag - 2 : 2 * lag + 3])), 2 * periods
    return float(lag / periods * (instants[1] - instants[0]))

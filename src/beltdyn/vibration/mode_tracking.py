"""Modes tracked from state to state by the agreement of their shapes.

Speeds of all parts in a mode, times the roots of their masses, make a vector.  Of two such vectors a and b the modal
assurance |a* b|^2 / (|a|^2 |b|^2) is 1 where the shapes agree, and 0 where they share no motion.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.vibration.mode_shapes import Shares, even_points, shares_of, speeds_of
from beltdyn.vibration.modes import eigenmodes
from beltdyn.vibration.small_motions import SmallMotions

# Critical speeds: where the frequency of an excitation meets that of a mode


class Crossing(NamedTuple):
    """Where lines meet."""

    speed: float
    frequency: float
    mode: int
    """Number of the mode."""
    line: int
    """Number of the excitation."""
    damping_ratio: float


def crossings(speed: FloatArray, frequency: FloatArray, damping_ratio: FloatArray, lines: FloatArray) -> list[Crossing]:
    """Intersections of modes and excitations by ascending speed, linear between neighboring speeds."""
    found = list[Crossing]()
    for line in range(lines.shape[1]):
        apart = frequency - lines[:, [line]]
        with np.errstate(invalid="ignore"):
            meets = (apart[:-1] * apart[1:] < 0.0) | (apart[:-1] == 0.0)
        meets &= np.isfinite(apart[1:])
        for row, mode in zip(*np.nonzero(meets), strict=True):
            part = apart[row, mode] / (apart[row, mode] - apart[row + 1, mode]) if apart[row, mode] else 0.0
            at, hertz, damping = (
                float((1.0 - part) * values[row] + part * values[row + 1])
                for values in (speed, frequency[:, mode], damping_ratio[:, mode])
            )
            found.append(Crossing(at, hertz, int(mode), line, damping))
        (last,) = np.nonzero(apart[-1] == 0.0)
        found += [
            Crossing(float(speed[-1]), float(frequency[-1, mode]), int(mode), line, float(damping_ratio[-1, mode]))
            for mode in last
        ]
    return sorted(found)


_LEAST, _LEAST_OF_PAUSED = 0.3, 0.6
"""Least modal assurance times frequency ratio (lower over higher) for the continuation of a mode, and the same for a
mode that was missing in the previous state."""


class SeenModes(NamedTuple):
    """Modes of a drive in a state, from the lowest frequency on."""

    values: ComplexArray
    """Growth rate and angular frequency, 1/s, shape (k,)."""
    speeds: ComplexArray
    """Vectors of length 1 that tell what moves, shape (k, m)."""
    shares: Shares


def seen_modes(motions: SmallMotions, count: int) -> SeenModes:
    """Modes of a drive about a state, as they are compared with those of other states."""
    values, coordinates = eigenmodes(motions, count)
    points = even_points(motions)
    found = [
        np.concatenate(speeds_of(motions, points, value, vector))
        for value, vector in zip(values, coordinates.T, strict=True)
    ]
    speeds = np.array([one / np.linalg.norm(one) for one in found])
    return SeenModes(values, speeds, shares_of(motions, points, values, coordinates))


def assurance(speeds: ComplexArray, others: ComplexArray) -> FloatArray:
    """Modal assurance of modes of shape (k, m) with others of shape (j, m), vectors of length 1; shape (k, j)."""
    return np.asarray(np.abs(speeds.conj() @ others.T) ** 2)


class Tracks:
    """Modes over states that follow each other: a row of a table for each state, a column for each mode.

    A mode with which none of a state agrees pauses there, and one that agrees with none begins a column, if it is among
    the `lowest` of its state.
    """

    def __init__(self, lowest: int) -> None:
        self._lowest = lowest
        self._last = list[ComplexArray]()
        self._frequency = list[float]()
        self._paused = np.zeros(0, dtype=bool)
        self._seen = list[SeenModes | None]()
        self._places = list[IntArray]()
        self._agreed = list[FloatArray]()

    def take(self, seen: SeenModes | None) -> None:
        """Take the modes of the next state; None where they are not known."""
        from scipy.optimize import linear_sum_assignment

        places, agreed = np.full(len(self._last), -1), np.full(len(self._last), np.nan)
        if seen is not None:
            if self._last:
                table = assurance(np.array(self._last), seen.speeds)
                ratio = np.array(self._frequency)[:, None] / seen.values.imag
                score = table * np.minimum(ratio, 1.0 / ratio)
                score[score < np.where(self._paused, _LEAST_OF_PAUSED, _LEAST)[:, None]] = 0.0
                columns, modes = linear_sum_assignment(-score)
                good = score[columns, modes] > 0.0
                places[columns[good]] = modes[good]
                agreed[columns[good]] = table[columns[good], modes[good]]
            begun = np.setdiff1d(np.arange(seen.values.size), places)
            places, agreed = np.append(places, begun), np.append(agreed, np.full(begun.size, np.nan))
            self._last.extend(seen.speeds[begun])
            self._frequency.extend(seen.values.imag[begun])
            self._paused = places < 0
            for column in np.flatnonzero(places >= 0):
                self._last[column] = seen.speeds[places[column]]
                self._frequency[column] = seen.values.imag[places[column]]
        self._places.append(places)
        self._agreed.append(agreed)
        self._seen.append(seen)

    @property
    def found(self) -> bool:
        """Whether there are modes of any state."""
        return bool(self._last)

    def table(self, states: int) -> "ModeTable":
        """The modes: columns in the order in which they begin, those of lower frequency first."""
        places = np.full((states, len(self._last)), -1)
        agreed = np.full(places.shape, np.nan)
        for row, (own, agreement) in enumerate(zip(self._places, self._agreed, strict=True)):
            places[row, : own.size], agreed[row, : own.size] = own, agreement
        columns = np.flatnonzero(np.any((places >= 0) & (places < self._lowest), axis=0))
        places, agreed = places[:, columns], agreed[:, columns]
        first = np.argmax(places >= 0, axis=0)
        order = np.lexsort((np.take_along_axis(places, first[None], axis=0)[0], first))
        places, agreed = places[:, order], agreed[:, order]
        seen = [one for one in self._seen if one is not None]
        values = np.full(places.shape, complex(np.nan, np.nan))
        shares = Shares(*(np.full((*places.shape, *part.shape[1:]), np.nan) for part in seen[0].shares))
        for row, one in enumerate(self._seen):
            there = np.flatnonzero(places[row] >= 0)
            if one is not None:
                values[row, there] = one.values[places[row, there]]
                for part, given in zip(shares, one.shares, strict=True):
                    part[row, there] = given[places[row, there]]
        return ModeTable(values, agreed, shares)


class ModeTable(NamedTuple):
    """Modes over states, n of them, in columns, k of them; NaN where a mode is not found."""

    values: ComplexArray
    """Growth rate and angular frequency, 1/s, shape (n, k)."""
    assurance: FloatArray
    """Agreement with the mode where it was seen before; NaN where it begins; shape (n, k)."""
    shares: Shares
    """Of arrays of shape (n, k, ...)."""

    @property
    def frequency(self) -> FloatArray:
        """Hz, shape (n, k)."""
        return np.asarray(self.values.imag / (2.0 * np.pi))

    @property
    def damping_ratio(self) -> FloatArray:
        """Shape (n, k)."""
        return np.asarray(-self.values.real / np.abs(self.values))

    def mean_shares(self, mode: int) -> Shares:
        """Shares of a mode, on an average over states."""
        return Shares(*(np.nanmean(part[:, mode], axis=0) for part in self.shares))

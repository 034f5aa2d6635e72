"""Rainflow counting of load cycles, ASTM E1049-85, section 5.4.4."""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray


class Cycles(NamedTuple):
    """Cycles of a history."""

    low: FloatArray
    """Least value, shape (cycles,)."""
    high: FloatArray
    """Largest value, shape (cycles,)."""
    number: FloatArray
    """1, or 0.5 for a half cycle, shape (cycles,)."""
    at: IntArray
    """Place of the largest value in the history, shape (cycles,)."""

    @property
    def range(self) -> FloatArray:
        """Largest less least value."""
        return self.high - self.low

    def above(self, share: float) -> "Cycles":
        """The cycles whose range is at least a share of the largest range."""
        kept = self.range >= share * self.range.max(initial=0.0)
        return Cycles(self.low[kept], self.high[kept], self.number[kept], self.at[kept])


def turning_points(history: FloatArray) -> IntArray:
    """Indices of peaks, valleys and both ends of a history; of equal values the first."""
    moved = np.flatnonzero(np.diff(history, prepend=np.nan) != 0.0)
    slopes = np.sign(np.diff(history[moved]))
    turned = np.flatnonzero(slopes[1:] != slopes[:-1]) + 1
    return moved[np.unique(np.concatenate([[0], turned, [len(moved) - 1]]))] if moved.size else moved


def rainflow(history: FloatArray) -> Cycles:
    """Count the cycles of a history; what remains at its ends counts as half cycles."""
    points, found, kept = turning_points(history), list[tuple[int, int, float]](), list[int]()
    for point in points.tolist():
        kept.append(point)
        while len(kept) > 2:
            (first, second, last), whole = kept[-3:], len(kept) > 3
            if abs(history[last] - history[second]) < abs(history[second] - history[first]):
                break
            found.append((first, second, 1.0 if whole else 0.5))
            del kept[-3 : -1 if whole else -2]
    found += [(first, second, 0.5) for first, second in pairwise(kept)]
    return _cycles(history, found)


def rainflow_of_turn(history: FloatArray) -> Cycles:
    """Count the cycles of a history that repeats: from its largest value on there are whole cycles only."""
    if not len(history):
        return rainflow(history)
    begin = int(np.argmax(history))
    cycles = rainflow(np.concatenate([history[begin:], history[: begin + 1]]))
    return cycles._replace(at=(cycles.at + begin) % len(history))


def _cycles(history: FloatArray, found: list[tuple[int, int, float]]) -> Cycles:
    """Cycles from the places of their two ends and their counts."""
    if not found:
        return Cycles(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros(0, dtype=int))
    ends, number = np.array([one[:2] for one in found]), np.array([one[2] for one in found])
    values = history[ends]
    return Cycles(values.min(axis=1), values.max(axis=1), number, ends[np.arange(len(ends)), values.argmax(axis=1)])

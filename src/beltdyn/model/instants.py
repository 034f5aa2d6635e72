"""Output instants, counted but never listed as a whole."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray

SAME = 1e-11
"""Instants closer than this coincide, s."""


@dataclass(frozen=True)
class Instants:
    """Multiples of an interval from the start, and the end; fields along the belt are kept at some of them.

    Attributes
    ----------
    interval : float
        s.
    end : float
        s; a multiple that is nearer to it than a billionth of it is left out.
    stride : int
        Number of instants from one at which fields are recorded to the next; the end is one too.
    begin : float
        The first of them, s.
    """

    interval: float
    end: float
    stride: int = 1
    begin: float = 0.0

    @property
    def count(self) -> int:
        """The number of instants."""
        length = self.end - self.begin
        multiples = int(np.floor(length / self.interval * (1.0 + 1e-12)))
        return multiples + 1 + (length - multiples * self.interval > 1e-9 * self.end)

    @property
    def fields(self) -> int:
        """The number of field outputs."""
        return (self.count - 1) // self.stride + 1 + ((self.count - 1) % self.stride > 0)

    def has_fields(self, numbers: IntArray) -> BoolArray:
        """Whether fields are recorded at instants, by their numbers."""
        return np.asarray((numbers % self.stride == 0) | (numbers == self.count - 1))

    def __getitem__(self, numbers: IntArray) -> FloatArray:
        """Some of them, s, by their numbers."""
        return np.where(numbers < self.count - 1, self.begin + self.interval * numbers, self.end)

    def until(self, time: float) -> int:
        """The number of instants up to a time (s)."""
        return int(self.counts_until(np.array([time]))[0])

    def counts_until(self, times: FloatArray) -> IntArray:
        """The number of instants up to each of several times (s)."""
        multiples = np.floor((times - self.begin + SAME) / self.interval) + 1.0
        before_end = np.clip(multiples, 0.0, self.count - 1.0).astype(np.int64)
        return np.where(times >= self.end - SAME, self.count, before_end)

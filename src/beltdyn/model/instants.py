"""Output instants: counted, and never listed as a whole."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray

SAME = 1e-11
"""Instants nearer to each other than this are one, s."""


@dataclass(frozen=True)
class Instants:
    """Multiples of an interval from a beginning on, and the end; at every few of them fields along the belt are kept.

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
        """How many there are."""
        length = self.end - self.begin
        multiples = int(np.floor(length / self.interval * (1.0 + 1e-12)))
        return multiples + 1 + (length - multiples * self.interval > 1e-9 * self.end)

    @property
    def fields(self) -> int:
        """At how many of them fields are recorded."""
        return (self.count - 1) // self.stride + 1 + ((self.count - 1) % self.stride > 0)

    def has_fields(self, numbers: IntArray) -> BoolArray:
        """Whether fields are recorded at some of them, by their numbers."""
        return np.asarray((numbers % self.stride == 0) | (numbers == self.count - 1))

    def __getitem__(self, numbers: IntArray) -> FloatArray:
        """Some of them, s, by their numbers."""
        return np.where(numbers < self.count - 1, self.begin + self.interval * numbers, self.end)

    def until(self, time: float) -> int:
        """How many lie before a time (s) or on it."""
        return int(self.counts_until(np.array([time]))[0])

    def counts_until(self, times: FloatArray) -> IntArray:
        """How many lie before each of several times (s) or on it."""
        multiples = np.floor((times - self.begin + SAME) / self.interval) + 1.0
        before_end = np.clip(multiples, 0.0, self.count - 1.0).astype(np.int64)
        return np.where(times >= self.end - SAME, self.count, before_end)

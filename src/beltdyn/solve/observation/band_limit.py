"""Outputs for spectra: averaged over steps by a low-pass filter, so that nothing that is too fast for them folds back.

With the interval T between outputs, the output at t is the integral of x(s) K(t - s), where

    K(t) = sin(pi t / T) / (pi t) w(t / (M T)),    w(u) = 0.42 + 0.5 cos(pi u) + 0.08 cos(2 pi u),   |u| < 1

is an ideal low-pass filter at half the rate of outputs in a Blackman window (Harris 1978).  x is interpolated between
ends of steps by cubics.  `transfer` is the closed form of what a sinusoid is multiplied by.
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.results.schema import FILTER_REACH

_WINDOW = (0.42, 0.5, 0.08)
_FINEST = 0.25
"""Length of the pieces of the integral at most, in intervals."""
_BLOCK = 8
"""Instants that are filtered at a time: many more would mostly meet points beyond the reach of the filter."""
_NEAR = 1e-8
"""Distance from an instant, in intervals, below which sin(pi x) / (pi x) is one."""
_GAUSS, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def transfer(frequency: FloatArray) -> FloatArray:
    """Factor on the amplitude of a sinusoid, by its frequency over the rate of outputs.

    The integral of the window's spectrum from f - 1/2 to f + 1/2: a sum of sine integrals.
    """
    from scipy.special import sici

    def integral(f: FloatArray) -> FloatArray:
        terms = (
            0.5
            * weight
            * (sici(np.pi * (2.0 * FILTER_REACH * f - k))[0] + sici(np.pi * (2.0 * FILTER_REACH * f + k))[0])
            for k, weight in enumerate(_WINDOW)
        )
        return np.asarray(sum(terms, np.zeros_like(f)) / np.pi)

    frequency = np.asarray(frequency, dtype=float)
    return integral(frequency + 0.5) - integral(frequency - 0.5)


class BandLimit:
    """Filters what is seen at ends of steps, as they come.

    Parameters
    ----------
    interval : float
        Between outputs, s.
    """

    def __init__(self, interval: float) -> None:
        self._interval = interval
        self._reach = FILTER_REACH * interval
        self._time, self._values = np.empty(0), np.empty((0, 0))
        self._gain = float(transfer(np.zeros(1))[0])

    def take(self, time: FloatArray, values: FloatArray) -> None:
        """Go on to further states.

        Parameters
        ----------
        time : ndarray, shape (k,)
            s, after those before.
        values : ndarray, shape (k, channels)
            What is to be filtered.
        """
        before = self._values if len(self._time) else values[:0]
        self._time, self._values = np.append(self._time, time), np.concatenate([before, values])

    def known_until(self, *, last: bool = True) -> float:
        """Instant up to which the states that outputs need have all come, s.

        Parameters
        ----------
        last : bool
            Whether no more states come: the one after those in reach changes the slope at the last of them.
        """
        return float(self._time[-1 if last else -2]) - self._reach if len(self._time) > 2 else -np.inf

    def at(self, instants: FloatArray) -> FloatArray:
        """Filtered values, and forget states that outputs after them do not need.

        Parameters
        ----------
        instants : ndarray, shape (m,)
            s, ascending, up to `known_until`, none nearer to the first state than the reach of the filter.

        Returns
        -------
        ndarray, shape (m, channels)
        """
        if not len(instants):
            return np.empty((0, self._values.shape[1]))
        points, weighted = self._integrand(instants[0] - self._reach, instants[-1] + self._reach)
        filtered = np.empty((len(instants), weighted.shape[1]))
        for first in range(0, len(instants), _BLOCK):
            some = instants[first : first + _BLOCK]
            part = slice(*np.searchsorted(points, (some[0] - self._reach, some[-1] + self._reach)))
            filtered[first : first + _BLOCK] = self._kernel(some, points[part]) @ weighted[part]
        needed = max(0, int(np.searchsorted(self._time, instants[-1] - self._reach)) - 2)
        self._time, self._values = self._time[needed:], self._values[needed:]
        return filtered / (self._interval * self._gain)

    def _integrand(self, start: float, end: float) -> tuple[FloatArray, FloatArray]:
        """Gauss points of pieces between ends of steps, none of them long, and values there times their weights."""
        steps = self._time[np.searchsorted(self._time, start) : np.searchsorted(self._time, end)]
        grid = np.linspace(start, end, int(np.ceil((end - start) / (_FINEST * self._interval))) + 1)
        edges = np.union1d(steps, grid)
        half = 0.5 * np.diff(edges)[:, None]
        points = (edges[:-1, None] + half * (1.0 + _GAUSS)).ravel()
        return points, (half * _WEIGHTS).ravel()[:, None] * self._interpolate(points)

    def _kernel(self, instants: FloatArray, points: FloatArray) -> FloatArray:
        """K(t - s) by the sums of angles: sines and cosines of instants and of points alone."""
        there, here = (instants[:, None] - instants[0]) / self._interval, (points - instants[0]) / self._interval
        away = there - here
        wave = _sine_of_difference(np.pi * there, np.pi * here)
        turn = np.pi / FILTER_REACH
        cosine = _sine_of_difference(turn * there + 0.5 * np.pi, turn * here)
        constant, first, second = _WINDOW
        window = constant - second + cosine * (first + 2.0 * second * cosine)
        near = np.abs(away) < _NEAR
        ideal = wave / np.where(near, 1.0, np.pi * away)
        return np.where(np.abs(away) < FILTER_REACH, np.where(near, 1.0, ideal) * window, 0.0)

    def _interpolate(self, points: FloatArray) -> FloatArray:
        """Cubics through the values at both ends of a step, with the slopes of parabolas through three ends."""
        slopes = np.asarray(np.gradient(self._values, self._time, axis=0))
        end = np.clip(np.searchsorted(self._time, points), 1, len(self._time) - 1)
        step = (self._time[end] - self._time[end - 1])[:, None]
        x = (points - self._time[end - 1])[:, None] / step
        before, after = self._values[end - 1], self._values[end]
        bends = (1.0 - x) * (slopes[end - 1] * step - (after - before)) + x * ((after - before) - slopes[end] * step)
        return np.asarray(before + x * (after - before) + x * (1.0 - x) * bends)


def _sine_of_difference(left: FloatArray, right: FloatArray) -> FloatArray:
    """Give sin(left - right) for a column and a row."""
    return np.asarray(np.sin(left) * np.cos(right) - np.cos(left) * np.sin(right))

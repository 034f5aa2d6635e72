"""Outputs for spectra: averaged over steps by a low-pass filter, so that nothing that is too fast for them folds back.

With the interval T between outputs, the output at t is the integral of x(s) K(t - s), where

    K(t) = sin(pi t / T) / (pi t) w(t / (M T)),    w(u) = 0.42 + 0.5 cos(pi u) + 0.08 cos(2 pi u),   |u| < 1

is an ideal low-pass filter at half the rate of outputs in a Blackman window (Harris 1978).  x is interpolated between
ends of steps by cubics.  `transfer` is the closed form of what a sinusoid is multiplied by.
"""

from math import cos, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.results.schema import FILTER_REACH

_BLACKMAN = (0.42, 0.5, 0.08)
"""Coefficients of the Blackman window (dimensionless): of 1, cos(pi u) and cos(2 pi u); see Harris 1978."""
_FINEST = 0.5
"""Length of the pieces of the integral at most, in intervals."""
_NEAR = 1e-4
"""Distance from an output, in intervals, below which sin(pi x) / (pi x) is 1 - (pi x)^2 / 6 up to rounding."""
_TURN = pi / FILTER_REACH
"""Of the window, rad per interval."""
_GAUSS = ((-sqrt(0.6), 5.0 / 18.0), (0.0, 8.0 / 18.0), (sqrt(0.6), 5.0 / 18.0))
"""Places from -1 to 1, and weights, of the Gauss points of a piece."""


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
            for k, weight in enumerate(_BLACKMAN)
        )
        return np.asarray(sum(terms, np.zeros_like(f)) / np.pi)

    frequency = np.asarray(frequency, dtype=float)
    return integral(frequency + 0.5) - integral(frequency - 0.5)


class Curves(NamedTuple):
    """What was seen, as curves of time."""

    time: FloatArray
    """Ends of steps, in intervals between outputs, shape (k,)."""
    values: FloatArray
    """Shape (k, channels)."""
    slopes: FloatArray
    """The same, per interval."""
    there: FloatArray
    """Room for the values at an instant, shape (channels,)."""


class Outputs(NamedTuple):
    """When outputs are."""

    time: FloatArray
    """Ascending, in intervals, shape (m,)."""
    waves: FloatArray
    """Sines and cosines of pi and of `_TURN` times it, shape (m, 4)."""


class BandLimit:
    """A low-pass filter of values at ends of steps, for outputs at an interval (s)."""

    def __init__(self, interval: float) -> None:
        self._interval = interval
        self._reach = FILTER_REACH * interval
        self._time, self._values = np.empty(0), np.empty((0, 0))
        self._gain = float(transfer(np.zeros(1))[0])

    def take(self, time: FloatArray, values: FloatArray) -> None:
        """Take values, shape (k, channels), at later times."""
        before = self._values if len(self._time) else values[:0]
        self._time, self._values = np.append(self._time, time), np.concatenate([before, values])

    def known_until(self, *, last: bool = True) -> float:
        """Instant up to which the states that outputs need have all come, s."""
        return float(self._time[-1 if last else -2]) - self._reach if len(self._time) > 2 else -np.inf

    def at(self, instants: FloatArray) -> FloatArray:
        """Filtered values, shape (m, channels), at ascending instants; drops states that later outputs do not need.

        Instants are at most `known_until`, and beyond the filter's reach from the first state.
        """
        if not len(instants):
            return np.empty((0, self._values.shape[1]))
        when, time = ((given - instants[0]) / self._interval for given in (instants, self._time))
        waves = np.stack([of(rate * when) for rate in (pi, _TURN) for of in (np.sin, np.cos)], axis=1)
        slopes = np.asarray(np.gradient(self._values, time, axis=0))  # of parabolas through three ends
        curves = Curves(time, self._values, slopes, np.empty(self._values.shape[1]))
        filtered = np.zeros((len(when), self._values.shape[1]))
        add_filtered(curves, _pieces(time, when), Outputs(when, waves), filtered)
        needed = max(0, int(np.searchsorted(self._time, instants[-1] - self._reach)) - 2)
        self._time, self._values = self._time[needed:], self._values[needed:]
        return filtered / self._gain


def compile_filter() -> None:
    """Compile the kernel of the filter."""
    empty, table = np.empty(0), np.empty((0, 0))
    add_filtered(Curves(empty, table, table, empty), empty, Outputs(empty, table), table)


def _pieces(time: FloatArray, when: FloatArray) -> FloatArray:
    """Give the ends of the pieces of the integral: ends of steps, and others where these lie far apart."""
    start, end = when[0] - FILTER_REACH, when[-1] + FILTER_REACH
    steps = time[np.searchsorted(time, start) : np.searchsorted(time, end)]
    return np.union1d(steps, np.linspace(start, end, int(np.ceil((end - start) / _FINEST)) + 1))


@kernel
def add_filtered(curves: Curves, pieces: FloatArray, outputs: Outputs, filtered: FloatArray) -> None:
    """Add the integrals of curves times K at some outputs.

    `curves`: what is filtered; `pieces`: ends of the pieces of the integrals, each in one step, in intervals, shape (p
    + 1,); `outputs`: when outputs are; `filtered`: the sums, shape (m, channels).
    """
    constant, first, second = _BLACKMAN
    step, reached = 1, 0
    for piece in range(pieces.size - 1):
        middle, half = 0.5 * (pieces[piece] + pieces[piece + 1]), 0.5 * (pieces[piece + 1] - pieces[piece])
        while step < curves.time.size - 1 and curves.time[step] < middle:
            step += 1
        for place, weight in _GAUSS:
            point = middle + half * place
            _interpolate(curves, step, point)
            sine, cosine = sin(pi * point), cos(pi * point)
            slow_sine, slow_cosine = sin(_TURN * point), cos(_TURN * point)
            while reached < outputs.time.size and outputs.time[reached] <= point - FILTER_REACH:
                reached += 1
            for output in range(reached, outputs.time.size):
                away = outputs.time[output] - point
                if away >= FILTER_REACH:
                    break
                waves = outputs.waves[output]
                ideal = 1.0 - (pi * away) ** 2 / 6.0
                if abs(away) > _NEAR:
                    ideal = (waves[0] * cosine - waves[1] * sine) / (pi * away)
                wave = waves[3] * slow_cosine + waves[2] * slow_sine
                factor = 2.0 * half * weight * ideal * (constant - second + wave * (first + 2.0 * second * wave))
                for channel in range(filtered.shape[1]):
                    filtered[output, channel] += factor * curves.there[channel]


@kernel(inline=True)
def _interpolate(curves: Curves, step: int, point: float) -> None:
    """Cubic between the ends of a step, by values and slopes."""
    length = curves.time[step] - curves.time[step - 1]
    x = (point - curves.time[step - 1]) / length
    for channel in range(curves.there.size):
        before = curves.values[step - 1, channel]
        rise = curves.values[step, channel] - before
        bend = (1.0 - x) * (curves.slopes[step - 1, channel] * length - rise)
        bend += x * (rise - curves.slopes[step, channel] * length)
        curves.there[channel] = before + x * (rise + (1.0 - x) * bend)

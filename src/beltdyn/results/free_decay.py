"""Free vibrations of a run that die away, and how much of their decay is that of the time integrator."""

from math import pi
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray

_LEAST_OUTPUTS = 64
"""Outputs with which a spectrum is worth while."""
_PERIODS = 3.0
"""Periods in a piece over which an amplitude is taken; pieces begin a period after each other."""
_LEAST_PIECES = 4
"""Pieces whose amplitudes show a rate of decay."""
_LEAST_PART = 0.03
"""Amplitude over the first one down to which pieces count."""
_SCATTER = 0.1
"""Largest scatter of the logarithms of amplitudes about a straight line: more is beating, or driven."""
_LEAST_FALL = 0.3
"""Least fall of the logarithm of the amplitude over all pieces."""
_ABOVE = 5.0
"""A peak over the median of the spectrum."""
_SLOWEST = 4
"""First number of waves in the whole time that counts; slower ones are drift."""


class Decay(NamedTuple):
    """A free vibration."""

    frequency: float
    """Hz."""
    rate: float
    """Of the amplitude, 1/s."""
    amplitude: float
    """In the beginning, in the unit of the values."""
    until: float
    """Time up to which the rate is taken, s."""


def free_decay(time: FloatArray, values: FloatArray) -> Decay | None:
    """The strongest vibration in evenly spaced values, if it dies away like a free one; None otherwise.

    Amplitudes are taken over pieces of a few periods, by a Hann window; their logarithms must fall on a line.

    Parameters
    ----------
    time : ndarray, shape (k,)
        s, evenly spaced.
    values : ndarray, shape (k,)
        In any unit.
    """
    count = len(time)
    if count < _LEAST_OUTPUTS or not np.all(np.isfinite(values)):
        return None
    duration, parts = float(time[-1] - time[0]), np.arange(count) / (count - 1)
    fading = np.cos(0.5 * pi * parts) ** 2
    spectrum = np.abs(np.fft.rfft((values - np.average(values, weights=fading)) * fading))
    spectrum[:_SLOWEST] = 0.0
    peak = int(np.argmax(spectrum))
    if not (0 < peak < spectrum.size - 1 and spectrum[peak] > _ABOVE * np.median(spectrum[_SLOWEST:])):
        return None
    frequency = peak / duration
    interval = duration / (count - 1)
    size, hop = (int(np.ceil(periods / frequency / interval)) for periods in (_PERIODS, 1.0))
    starts = np.arange(0, count - size + 1, hop)
    if starts.size < _LEAST_PIECES:
        return None
    waves = np.array([_wave(time[at : at + size], values[at : at + size], frequency) for at in starts])
    amplitudes = np.abs(waves)
    kept = int(np.argmin(np.append(amplitudes, 0.0) > _LEAST_PART * amplitudes[0]))
    if kept < _LEAST_PIECES:
        return None
    middles = interval * starts[:kept]
    logarithms, phases = np.log(amplitudes[:kept]), np.unwrap(np.angle(waves[:kept]))
    slope, level = np.polyfit(middles, logarithms, 1)
    scatter = float(np.std(logarithms - level - slope * middles))
    if -slope * middles[-1] < _LEAST_FALL or scatter > _SCATTER:
        return None
    frequency += float(np.polyfit(middles, phases, 1)[0]) / (2.0 * pi)
    return Decay(frequency, -float(slope), float(amplitudes[0]), float(time[starts[kept - 1] + size - 1]))


def _wave(time: FloatArray, values: FloatArray, frequency: float) -> complex:
    """Complex amplitude of a frequency (Hz) in a piece, without its mean and trend."""
    window = np.hanning(len(time))
    trend = np.polyval(np.polyfit(time, values, 1), time)
    return complex(2.0 * np.sum(window * (values - trend) * np.exp(-2j * pi * frequency * time)) / np.sum(window))


def real_decay(
    vibration: Decay, time: FloatArray, step_size: FloatArray, spectral_radius: float
) -> tuple[Decay, float]:
    """The vibration as `without_integrator`, and the step (s) that counts, by times and steps of outputs from it on."""
    during = time <= vibration.until
    step = float(np.mean(step_size[during] ** 3) ** (1.0 / 3.0))
    return without_integrator(spectral_radius, vibration, step), step


def without_integrator(spectral_radius: float, vibration: Decay, step: float) -> Decay:
    """The vibration that generalized-alpha, with steps of a length (s), shows as another one.

    A mode q'' + 2 s q' + w^2 q = 0 has the factor z from step to step where, with the auxiliary acceleration A of
    Arnold and Brüls (2007) and the coefficients of Chung and Hulbert (1993),

        ((1 - am) z + am) A = ((1 - af) z + af) q'',        h q' V(z), h^2 q Q(z) by A from the rules of the step,

    which is linear in s h and (w h)^2: they follow from the z of the vibration that is seen.

    Parameters
    ----------
    spectral_radius
        At infinite frequency.
    vibration
        As seen.
    step
        s.
    """
    rho = spectral_radius
    am, af = (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    factor = np.exp((2j * pi * vibration.frequency - vibration.rate) * step)
    speed = (1.0 - gamma + gamma * factor) / (factor - 1.0)
    place = (speed + 0.5 - beta + beta * factor) / (factor - 1.0)
    gain = ((1.0 - am) * factor + am) / ((1.0 - af) * factor + af)
    columns = np.array([[2.0 * speed.real, place.real], [2.0 * speed.imag, place.imag]])
    damping, square = np.linalg.solve(columns, -np.array([gain.real, gain.imag]))
    swing = np.sqrt(max(square - damping**2, 0.0))
    return vibration._replace(frequency=float(swing / (2.0 * pi * step)), rate=float(damping / step))

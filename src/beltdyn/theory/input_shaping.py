"""Input shapers: impulses with which a command is convolved, so that a vibration cancels itself.

ZV: Singer and Seering, "Preshaping command inputs to reduce system vibration", J. Dyn. Syst. Meas. Control 112 (1990);
EI: Singhose, Seering and Singer, "Residual vibration reduction using vector diagrams to generate shaped inputs",
J. Mech. Des. 116 (1994), in its form with three impulses for small damping; MZV: a ZV shaper of three impulses within
three quarters of a period, as firmwares of printers have it.
"""

from collections.abc import Callable
from math import exp, pi, sqrt
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray

EI_TOLERANCE = 0.05
"""Vibration that an EI shaper leaves at its own frequency, over that without it: the usual value."""


class Shaper(NamedTuple):
    """Impulses of a shaper."""

    times: FloatArray
    """s, from 0."""
    amplitudes: FloatArray
    """Shares of the command, of sum 1."""

    @property
    def duration(self) -> float:
        """Time by which a move becomes longer, s."""
        return float(self.times[-1])


def zv_shaper(frequency: float, damping: float) -> Shaper:
    """Two impulses, half a damped period apart.

    Parameters
    ----------
    frequency : float
        Natural frequency without damping, Hz.
    damping : float
        Damping ratio, below 1.
    """
    return _shaper(frequency, damping, (0.0, 0.5), (1.0, 1.0))


def mzv_shaper(frequency: float, damping: float) -> Shaper:
    """Three impulses, three eighths of a damped period apart; parameters as of `zv_shaper`."""
    return _shaper(frequency, damping, (0.0, 0.375, 0.75), (1.0 - sqrt(0.5), sqrt(2.0) - 1.0, 1.0 - sqrt(0.5)))


def ei_shaper(frequency: float, damping: float) -> Shaper:
    """Three impulses, half a damped period apart, which leave `EI_TOLERANCE`; parameters as of `zv_shaper`."""
    outer, inner = 0.25 * (1.0 + EI_TOLERANCE), 0.5 * (1.0 - EI_TOLERANCE)
    return _shaper(frequency, damping, (0.0, 0.5, 1.0), (outer, inner, outer))


SHAPERS: MappingProxyType[str, Callable[[float, float], Shaper]] = MappingProxyType(
    {"ZV": zv_shaper, "MZV": mzv_shaper, "EI": ei_shaper}
)
"""By name, from the shortest to the longest."""


def _shaper(frequency: float, damping: float, periods: tuple[float, ...], amplitudes: tuple[float, ...]) -> Shaper:
    """Impulses at parts of the damped period, each smaller by what the vibration has decayed until then."""
    root = sqrt(1.0 - damping * damping)
    decayed = np.array([exp(-2.0 * pi * damping / root * part) for part in periods])
    sizes = np.array(amplitudes) * decayed
    return Shaper(np.array(periods) / (frequency * root), sizes / sizes.sum())


def residual_vibration(shaper: Shaper, frequencies: FloatArray, damping: float) -> FloatArray:
    """Vibration behind a shaped impulse, over that behind an unshaped one at the same instant.

    Parameters
    ----------
    shaper : Shaper
        The impulses.
    frequencies : FloatArray
        Natural frequencies of what vibrates, without damping, Hz, shape (n,).
    damping : float
        Damping ratio of it, below 1.

    Returns
    -------
    FloatArray
        Shape (n,).
    """
    omega = 2.0 * pi * np.asarray(frequencies)[:, None]
    since = omega * (shaper.times[-1] - shaper.times)
    phases = omega * sqrt(1.0 - damping * damping) * shaper.times
    sizes = shaper.amplitudes * np.exp(-damping * since)
    residual: FloatArray = np.hypot((sizes * np.cos(phases)).sum(axis=1), (sizes * np.sin(phases)).sum(axis=1))
    return residual


def fitted_shaper(name: str, frequencies: FloatArray, damping: float, trials: int = 201) -> tuple[float, float, Shaper]:
    """The shaper of a kind that leaves least vibration over some natural frequencies.

    Parameters
    ----------
    name : str
        One of `SHAPERS`.
    frequencies : FloatArray
        Natural frequencies, Hz, shape (n,).
    damping : float
        Damping ratio, below 1.
    trials : int
        Number of frequencies that are tried, between the least and the largest.

    Returns
    -------
    frequency : float
        That of the shaper, Hz.
    residual : float
        Largest vibration over the frequencies, as of `residual_vibration`.
    shaper : Shaper
        Its impulses.
    """
    tried = np.linspace(frequencies.min(), frequencies.max(), trials if np.ptp(frequencies) > 0.0 else 1)
    shapers = [SHAPERS[name](float(frequency), damping) for frequency in tried]
    left = [float(residual_vibration(shaper, frequencies, damping).max()) for shaper in shapers]
    best = int(np.argmin(left))
    return float(tried[best]), left[best], shapers[best]


def best_shaper(residuals: FloatArray, limit: float = EI_TOLERANCE) -> int:
    """Number of the shortest shaper that leaves at most a limit, or of that which leaves least.

    Parameters
    ----------
    residuals : FloatArray
        Vibration that each leaves, from the shortest on, shape (n,).
    limit : float
        Vibration left with which a shaper fits.
    """
    fitting = np.flatnonzero(residuals <= limit)
    return int(fitting[0]) if fitting.size else int(np.argmin(residuals))

"""Critical speeds: where the frequency of an excitation meets that of a mode."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray


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
    """Find where modes and excitations meet, by straight lines between neighbouring speeds.

    Parameters
    ----------
    speed : ndarray, shape (n,)
        Ascending.
    frequency, damping_ratio : ndarray, shape (n, k)
        Of modes; NaN where they are not known.
    lines : ndarray, shape (n, j)
        Frequencies of excitations; NaN where they are not known.

    Returns
    -------
    list of Crossing
        By ascending speed.
    """
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

"""How far the energy account of a run was open at the most."""

from typing import NamedTuple

import numpy as np

from beltdyn.results.recorded import Recorded


class Closure(NamedTuple):
    """Largest closure error of a run.

    Attributes
    ----------
    time : float
        When, s.
    error : float
        Closure error at that time, over the energy put in by then.
    """

    time: float
    error: float


def largest_closure(recorded: Recorded) -> Closure:
    """Largest closure error of the energy account over time.

    Parameters
    ----------
    recorded : Recorded
        What was recorded, with at least one output.

    Returns
    -------
    Closure
        The error of largest magnitude with its sign, and its instant; the first NaN if there is one.
    """
    errors = np.asarray(recorded["energy_closure"])
    worst = int(np.argmax(np.abs(errors)))
    return Closure(float(recorded["time"][worst]), float(errors[worst]))

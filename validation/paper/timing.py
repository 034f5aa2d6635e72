"""Computing times that were taken several times over, and what can be concluded from them."""

import numpy as np

from beltdyn.arrays import FloatArray
from validation.paper.numbers import shown
from validation.paper.statement import Value, Verdict, judged


def below(times: FloatArray, others: FloatArray) -> Verdict:
    """Judge whether one thing takes less time than another: undecided where the ranges of repetitions overlap.

    Parameters
    ----------
    times, others : ndarray, shape (repeats,)
        Repetitions of both.
    """
    return judged(holds=bool(np.max(times) < np.min(others)), fails=bool(np.min(times) > np.max(others)))


def with_spread(times: FloatArray) -> Value:
    """Print the median and the range of repetitions.

    Parameters
    ----------
    times : ndarray, shape (repeats,)
        The repetitions.
    """
    low, middle, high = (shown(float(value)) for value in np.quantile(times, (0.0, 0.5, 1.0)))
    return f"{middle} ({low}–{high})"

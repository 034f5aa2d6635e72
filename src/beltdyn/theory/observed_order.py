"""Order of convergence that three values show, and what is left of the error.

Celik, Ghia, Roache, Freitas, Coleman and Raad, "Procedure for estimation and reporting of uncertainty due to
discretization in CFD applications", J. Fluids Eng. 130 (2008).
"""

from collections.abc import Sequence
from math import log

import numpy as np
from scipy.optimize import brentq

_HIGHEST_ORDER = 30.0
"""Order above which differences of values are rounding."""
_LOWEST_ORDER = 1e-3
"""Order below which values do not converge."""
_ROUNDING = 1e-12
"""Difference of two values, relative, below which it is rounding."""


def observed_order(sizes: Sequence[float], values: Sequence[float]) -> float:
    """Order p with which values approach a limit as ``v + c h^p``.

    Parameters
    ----------
    sizes : sequence of float
        Three sizes h of elements or steps, or tolerances, positive, the smallest last.
    values : sequence of float
        The value at each.

    Returns
    -------
    float
        NaN where the values do not approach a limit in one sense, or differ by rounding alone.
    """
    (coarse, middle, fine), (first, second, third) = sizes, values
    if not np.all(np.isfinite(values)) or abs(third - second) <= _ROUNDING * abs(third):
        return np.nan
    ratio = (first - second) / (second - third)

    def excess(order: float) -> float:
        return float(np.expm1(order * log(coarse / middle)) / -np.expm1(order * log(fine / middle)) - ratio)

    if excess(_LOWEST_ORDER) >= 0.0 or excess(_HIGHEST_ORDER) <= 0.0:
        return np.nan
    return float(brentq(excess, _LOWEST_ORDER, _HIGHEST_ORDER, xtol=1e-10))


def extrapolated(sizes: Sequence[float], values: Sequence[float], order: float) -> float:
    """The limit of two values, the finer one last, that converge with an order (Richardson)."""
    (coarse, fine), (first, second) = sizes, values
    return second + (second - first) / float(np.expm1(order * log(coarse / fine)))

"""Quadrature on the unit interval."""

from functools import cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@cache
def gauss_points(count: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights of Gauss-Legendre quadrature on [0, 1].

    Parameters
    ----------
    count
        Number of points, at least 1; polynomials up to degree 2 count - 1 are integrated exactly.

    Returns
    -------
    points, weights : ndarray, shape (count,)
        Dimensionless and read-only; the weights add up to 1.
    """
    points, weights = leggauss(count)
    return _read_only(0.5 * (points + 1.0)), _read_only(0.5 * weights)


@cache
def trapezoid_points() -> tuple[FloatArray, FloatArray]:
    """Points and weights of the trapezoidal rule on [0, 1]: its two ends, half each; shapes (2,), read-only."""
    return _read_only(np.array([0.0, 1.0])), _read_only(np.array([0.5, 0.5]))


def _read_only(values: FloatArray) -> FloatArray:
    values.flags.writeable = False
    return values

"""Gauss-Legendre quadrature on the unit interval."""

from functools import cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray


@cache
def gauss_points(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
    points, weights = 0.5 * (points + 1.0), 0.5 * weights
    points.flags.writeable = weights.flags.writeable = False
    return points, weights

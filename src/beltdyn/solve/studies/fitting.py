"""Least squares between bounds (trust-region reflective, SciPy), and what the fit knows of its numbers.

Near the fit residuals are straight in the numbers, r(x) = r + J (x - x^), with independent errors of deviation 1 or of
one deviation s that is unknown.  Then x^ has the covariance (J'J)^-1, times s^2 = r'r / (rows - numbers) where it is
unknown, and intervals are those of Student's t, or of the normal distribution where deviations are given (Bard 1974).
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray

_TOLERANCE = 1e-8
"""Of numbers, goal and gradient, at which the search ends."""
_LEAST_SINGULAR = 1e-5
"""Singular value over the largest one, below which numbers cannot be told apart: derivatives are no more exact."""
_INVOLVED = 0.1
"""Part of a number in a change of all that measurements do not notice, from which it is one of those not told."""


class Fit(NamedTuple):
    """Numbers that fit best."""

    numbers: FloatArray
    errors: FloatArray
    """Their standard errors, shape (n,); infinite where measurements do not tell."""
    correlation: FloatArray
    """Shape (n, n)."""
    reach: float
    """Half of an interval over the standard error."""
    residuals: FloatArray
    spread: float
    """Root mean square of residuals with the degrees of freedom that are left; NaN where none is left."""
    untold: tuple[int, ...]
    """Which numbers measurements do not tell, alone or from each other."""
    interrupted: bool = False
    """Whether the search was ended before the numbers fitted best."""

    @property
    def told(self) -> bool:
        """Whether measurements tell all numbers."""
        return not self.untold


def fit(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    confidence: float,
    *,
    known: bool,
    most: int = 100,
) -> Fit:
    """Fit numbers between 0 and 1.

    Parameters
    ----------
    residuals
        Of numbers, shape (m,), over standard deviations.
    jacobian
        Their derivatives, shape (m, n).
    start
        Where to begin.
    confidence
        Of the intervals, between 0 and 1.
    known
        Whether the standard deviations are those of the measurements; otherwise one factor is unknown.
    most
        Evaluations, at most.

    Raises
    ------
    KeyboardInterrupt
        If the search is interrupted before derivatives at its start are known. Later it ends where it has come to.
    """
    from scipy import stats

    numbers, away, slopes, interrupted = _search(residuals, jacobian, start, most)
    left = away.size - start.size
    spread = float(np.sqrt(away @ away / left)) if left > 0 else np.nan
    sizes = np.linalg.norm(slopes, axis=0)
    scaled = slopes / np.where(sizes > 0.0, sizes, 1.0)
    _, singular, rows = np.linalg.svd(scaled, full_matrices=False)
    unnoticed = rows[singular <= _LEAST_SINGULAR * singular.max()]
    untold = tuple(np.flatnonzero((sizes == 0.0) | (left < 0) | (np.abs(unnoticed) > _INVOLVED).any(axis=0)).tolist())
    told = not untold
    inverse = (
        rows.T / np.maximum(singular, np.finfo(float).tiny) if told else np.full((start.size, singular.size), np.inf)
    )
    covariance = inverse @ inverse.T if told else np.diag(np.full(start.size, np.inf))
    deviations = np.sqrt(np.diag(covariance))
    correlation = covariance / np.outer(deviations, deviations) if told else np.full(covariance.shape, np.nan)
    factor = 1.0 if known else spread
    half = 0.5 * (1.0 + confidence)
    reach = float(stats.norm.ppf(half) if known else stats.t.ppf(half, left)) if known or left > 0 else np.inf
    errors = factor * deviations / np.where(sizes > 0.0, sizes, 1.0)
    return Fit(numbers, errors, correlation, reach, away, spread, untold, interrupted)


class _Reached(NamedTuple):
    """Where a search has come to."""

    numbers: FloatArray
    residuals: FloatArray
    slopes: FloatArray
    interrupted: bool


def _search(
    residuals: Callable[[FloatArray], FloatArray],
    jacobian: Callable[[FloatArray], FloatArray],
    start: FloatArray,
    most: int,
) -> _Reached:
    """Least squares, or the last numbers at which derivatives were taken where the search is interrupted."""
    from scipy.optimize import least_squares

    solve: Callable[..., Any] = least_squares
    settings = {"ftol": _TOLERANCE, "xtol": _TOLERANCE, "gtol": _TOLERANCE, "max_nfev": most}
    reached: _Reached | None = None

    def slopes_at(numbers: FloatArray) -> FloatArray:
        nonlocal reached
        slopes = jacobian(numbers)
        reached = _Reached(numbers.copy(), residuals(numbers), slopes, True)
        return slopes

    try:
        found = solve(residuals, start, jac=slopes_at, bounds=(0.0, 1.0), method="trf", x_scale="jac", **settings)
    except KeyboardInterrupt:
        if reached is None:
            raise
        return reached
    return _Reached(found.x, found.fun, found.jac, False)

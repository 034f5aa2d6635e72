"""Sobol indices: what part of the variance of a result is due to each number that varies (Saltelli et al. 2010)."""

import numpy as np

from beltdyn.arrays import FloatArray

_RESAMPLES = 200
"""Of the bootstrap."""
_LEVEL = 1e-12
"""Change of a result, over its largest value, that is rounding."""


def sobol_indices(values: FloatArray, dimensions: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """First-order and total Sobol indices of results at the points of Saltelli's design (Saltelli et al. 2010).

    Parameters
    ----------
    values
        Results, shape (n (d + 2), results); where one is not known, as of a failed point, the n-th points of all parts
        of the design are left out.
    dimensions
        Number of coordinates d.

    Returns
    -------
    first, total : ndarray
        Indices, shape (results, d); NaN where a result is known in fewer than two places, or does not vary.
    first_error, total_error : ndarray
        Half of the 95 % confidence intervals, by bootstrap over the points.
    """
    parts = values.reshape(dimensions + 2, -1, values.shape[1])
    found = np.full((4, values.shape[1], dimensions), np.nan)
    for result in range(values.shape[1]):
        known = parts[:, np.isfinite(parts[:, :, result]).all(axis=0), result]
        if known.shape[1] < 2 or np.ptp(known) <= _LEVEL * np.max(np.abs(known)):
            continue
        drawn = np.random.default_rng(0).integers(known.shape[1], size=(_RESAMPLES, known.shape[1]))
        spread = np.stack([_indices(known[:, places]) for places in drawn])
        low, high = np.nanquantile(spread, (0.025, 0.975), axis=0)
        found[:, result] = [*_indices(known), *(0.5 * (high - low))]
    return found[0], found[1], found[2], found[3]


def _indices(known: FloatArray) -> FloatArray:
    """First-order indices and total ones, shape (2, d), from results of shape (d + 2, n).

    Those of first order by Saltelli et al. (2010), Table 2 (b), total ones by Jansen, (f).
    """
    first, second, mixed = known[0], known[1], known[2:]
    mean, variance = known[:2].mean(), known[:2].var()
    with np.errstate(divide="ignore", invalid="ignore"):
        alone = ((second - mean) * (mixed - first)).mean(axis=1) / variance
        in_all = 0.5 * ((first - mixed) ** 2).mean(axis=1) / variance
    return np.stack([alone, in_all])

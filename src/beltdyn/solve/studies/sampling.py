"""Points of a study in the unit cube: Latin hypercube, Sobol's sequence, and Saltelli's design for Sobol indices."""

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray


def unit_points(sampling: str, dimensions: int, count: int, seed: int) -> FloatArray:
    """Take points in the unit cube.

    Parameters
    ----------
    sampling
        "latin_hypercube", "sobol" (scrambled, of which the first points stay the same where there are more), or
        "saltelli": the design A, B, A with each column from B (Saltelli et al. 2010), from which `sobol_indices` are
        found.
    dimensions
        Number of coordinates d.
    count
        Number of points n; of Saltelli's design n of A, and n (d + 2) of all.
    seed
        The same seed gives the same points.

    Returns
    -------
    ndarray
        Shape (points, d), each from 0 to 1.
    """
    from scipy.stats import qmc

    if sampling == "latin_hypercube":
        return np.asarray(qmc.LatinHypercube(dimensions, rng=np.random.default_rng(seed)).random(count))
    wide = 2 * dimensions if sampling == "saltelli" else dimensions
    engine = qmc.Sobol(wide, scramble=True, rng=np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The balance properties of Sobol' points")  # the user chose their number
        found = np.asarray(engine.random(count))
    return found if sampling == "sobol" else _saltelli(found[:, :dimensions], found[:, dimensions:])


def _saltelli(first: FloatArray, second: FloatArray) -> FloatArray:
    """The design of two samples of shape (n, d), shape (n (d + 2), d)."""
    mixed = [first.copy() for _ in range(first.shape[1])]
    for column, one in enumerate(mixed):
        one[:, column] = second[:, column]
    return np.concatenate([first, second, *mixed])


def combinations(values: Sequence[NDArray[np.object_]]) -> NDArray[np.object_]:
    """All combinations of values, the last number changing first, shape (points, numbers)."""
    grid = np.meshgrid(*(np.arange(len(one)) for one in values), indexing="ij")
    return np.stack([one[place.ravel()] for one, place in zip(values, grid, strict=True)], axis=1)


def one_at_a_time(values: Sequence[NDArray[np.object_]], base: Sequence[object]) -> NDArray[np.object_]:
    """The base, and points at which one number takes another of its values, shape (points, numbers)."""
    found = [np.array(base, dtype=object)]
    for column, some in enumerate(values):
        for value in some:
            if value != base[column]:
                found.append(found[0].copy())
                found[-1][column] = value
    return np.stack(found)

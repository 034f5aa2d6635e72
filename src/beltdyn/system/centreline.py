"""Points of the centreline of a belt at any place along it."""

from math import comb

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.system.arrays import System
from beltdyn.system.discretization import curve_lengths


def centreline_points(
    system: System, position: FloatArray, along: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Places of material points and their derivatives along the belt.

    Parameters
    ----------
    system
        The system.
    position : ndarray, shape (n N + D,)
        The state.
    along : ndarray, shape (k,)
        Belt coordinates of the points, m.

    Returns
    -------
    place, slope, bend : ndarray, shape (k, 2)
        r (m), dr/dx and d2r/dx2 (1/m).
    """
    lengths = curve_lengths(system)
    ends = np.cumsum(lengths)
    curve = np.minimum(np.searchsorted(ends, along, side="right"), lengths.size - 1)
    length = lengths[curve]
    xi = (along - (ends - lengths)[curve]) / length
    curves = system.control.shape[1]
    element = curve // curves
    nodes = position[: system.first_body].reshape(system.nodes, -1)
    both = np.concatenate([nodes[element], nodes[(element + 1) % system.nodes]], axis=1)
    vectors = both[:, np.add.outer(np.array(system.vectors), np.arange(2))]
    points = system.control[element, curve % curves] @ vectors
    degree = points.shape[1] - 1
    first = degree * np.diff(points, axis=1) / length[:, None, None]
    second = (degree - 1) * np.diff(first, axis=1) / length[:, None, None]
    place, slope, bend = (np.einsum("ka,kax->kx", _bernstein(xi, p.shape[1] - 1), p) for p in (points, first, second))
    return place, slope, bend


def _bernstein(xi: FloatArray, degree: int) -> FloatArray:
    """Bernstein polynomials, shape (k, degree + 1)."""
    return np.stack([comb(degree, k) * xi**k * (1.0 - xi) ** (degree - k) for k in range(degree + 1)], axis=1)

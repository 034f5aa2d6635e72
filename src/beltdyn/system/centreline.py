"""Points of the centreline of a belt at any place along it."""

from functools import cache
from math import comb

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
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
    lengths, (points, powers, curve) = curve_lengths(system), _on_its_curves(system, position, along)
    degree = points.shape[1] - 1
    first = degree * np.diff(points, axis=1) / lengths[:, None, None]
    second = (degree - 1) * np.diff(first, axis=1) / lengths[:, None, None]
    place, slope, bend = (_on_curves(powers, p, curve) for p in (points, first, second))
    return place, slope, bend


def centreline_places(system: System, position: FloatArray, along: FloatArray) -> FloatArray:
    """Places of material points alone, shape (k, 2), m; see `centreline_points`."""
    points, powers, curve = _on_its_curves(system, position, along)
    return _on_curves(powers, points, curve)


def _on_its_curves(system: System, position: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
    """Control points of all curves, and of each point along the belt powers of xi and the number of its curve."""
    lengths, points = curve_lengths(system), _control_points(system, position)
    ends = np.cumsum(lengths)
    curve = np.minimum(np.searchsorted(ends, along, side="right"), lengths.size - 1)
    xi = (along - (ends - lengths)[curve]) / lengths[curve]
    return points, np.vander(xi, points.shape[1], increasing=True), curve


def _control_points(system: System, position: FloatArray) -> FloatArray:
    """Control points of the Bezier curves of a belt, shape (curves, degree + 1, 2), m."""
    nodes = position[: system.first_body].reshape(system.nodes, -1)
    after = np.arange(1, system.length.size + 1) % system.nodes
    both = np.concatenate([nodes[: system.length.size], nodes[after]], axis=1)
    vectors = both[:, np.add.outer(np.array(system.vectors), np.arange(2))]
    points = system.control @ vectors[:, None]
    return np.asarray(points.reshape(-1, *points.shape[2:]))


def _on_curves(powers: FloatArray, points: FloatArray, curve: IntArray) -> FloatArray:
    """Points (k, 2) of Bezier curves, from powers of xi (k, at least degree + 1) and the curves that they are on."""
    count = points.shape[1]
    coefficients = _polynomials(count - 1) @ points
    return np.asarray(np.einsum("ka,kax->kx", powers[:, :count], coefficients[curve]))


@cache
def _polynomials(degree: int) -> FloatArray:
    """Coefficients by powers of xi of the Bernstein polynomials, shape (degree + 1, degree + 1), a column of each."""
    return np.array(
        [
            [(-1.0) ** (power - k) * comb(degree, k) * comb(degree - k, power - k) if k <= power else 0.0]
            for power in range(degree + 1)
            for k in range(degree + 1)
        ]
    ).reshape(degree + 1, degree + 1)

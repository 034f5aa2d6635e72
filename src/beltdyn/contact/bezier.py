"""The centerline of an element as a Bezier curve, common to all belt discretizations (Eq. 24).

The degree is one less than the number of control points.  Kernels read it from the length of the arrays in which they
keep weights.  Where these are fields of a record the compiler knows their lengths, and each degree gets code of its
own.
"""

from math import comb
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel

MAX_DEGREE = 9
"""Highest degree of a curve."""

BINOMIALS = np.array(
    [[comb(n, k) for k in range(2 * MAX_DEGREE + 1)] for n in range(2 * MAX_DEGREE + 1)], dtype=np.float64
)
"""Binomial coefficients, up to twice the highest degree."""


class Curve(NamedTuple):
    """A Bezier curve of the centerline: n control points from v vectors of nodal coordinates."""

    control: FloatArray
    """Control points, m, shape (n, 2)."""
    velocity: FloatArray
    """Their velocities, m/s, shape (n, 2)."""
    basis: FloatArray
    """Control points (rows) from the vectors (columns), shape (n, v)."""
    length: float
    """Reference length of the piece of belt, m."""
    start: float = 0.0
    """Material coordinate at which it begins, m, which teeth ask for."""


@kernel(inline=True)
def fill_bernstein(xi: float, weights: FloatArray) -> None:
    """Weights of the control points at xi: the Bernstein polynomials C(p, k) xi^k (1 - xi)^(p - k).

    Parameters
    ----------
    xi
        Place on the curve, 0 to 1.
    weights : ndarray, shape (p + 1,)
        Overwritten; its length says the degree p.
    """
    _fill_polynomials(xi, weights.size - 1, weights)


@kernel(inline=True)
def fill_bernstein_rates(xi: float, rates: FloatArray) -> None:
    """Derivatives of the weights with respect to xi: p times the differences of the polynomials of degree p - 1.

    Parameters
    ----------
    xi
        Place on the curve, 0 to 1.
    rates : ndarray, shape (p + 1,)
        Overwritten; its length says the degree p.
    """
    degree = rates.size - 1
    _fill_polynomials(xi, degree - 1, rates)
    rates[degree] = degree * rates[degree - 1]
    for k in range(degree - 1, 0, -1):
        rates[k] = degree * (rates[k - 1] - rates[k])
    rates[0] *= -degree


@kernel(inline=True)
def _fill_polynomials(xi: float, degree: int, values: FloatArray) -> None:
    """Overwrite the first values by the Bernstein polynomials of a degree."""
    complement, power = 1.0 - xi, 1.0
    for k in range(degree + 1):
        values[k] = BINOMIALS[degree, k] * power
        power *= xi
    power = 1.0
    for k in range(degree + 1):
        values[degree - k] *= power
        power *= complement


@kernel(inline=True)
def combine(control: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Weighted sum of control points or of their velocities."""
    x = y = 0.0
    for k in range(weights.size):
        x += weights[k] * control[k, 0]
        y += weights[k] * control[k, 1]
    return x, y


@kernel(inline=True)
def fill_shape_functions(basis: FloatArray, weights: FloatArray, shape: FloatArray) -> None:
    """Overwrite `shape` by the shape functions S_b of the v vectors from the weights of the control points."""
    for b in range(shape.size):
        shape[b] = 0.0
        for k in range(weights.size):
            shape[b] += weights[k] * basis[k, b]

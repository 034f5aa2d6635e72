"""The centreline of an element as a cubic Bezier curve, a form that every belt discretisation can give (Eq. 24)."""

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel

Four = tuple[float, float, float, float]


@kernel
def bernstein(xi: float) -> Four:
    """Bernstein polynomials of degree three, the weights of the control points at xi."""
    rest = 1.0 - xi
    return rest * rest * rest, 3.0 * xi * rest * rest, 3.0 * xi * xi * rest, xi * xi * xi


@kernel
def bernstein_rates(xi: float) -> Four:
    """Derivatives of the Bernstein polynomials with respect to xi."""
    rest = 1.0 - xi
    return -3.0 * rest * rest, 3.0 * rest * (rest - 2.0 * xi), 3.0 * xi * (2.0 * rest - xi), 3.0 * xi * xi


@kernel
def combine(control: FloatArray, weights: Four) -> tuple[float, float]:
    """Weighted sum of control points or of their velocities."""
    return (
        weights[0] * control[0, 0]
        + weights[1] * control[1, 0]
        + weights[2] * control[2, 0]
        + weights[3] * control[3, 0],
        weights[0] * control[0, 1]
        + weights[1] * control[1, 1]
        + weights[2] * control[2, 1]
        + weights[3] * control[3, 1],
    )


@kernel
def shape_functions(basis: FloatArray, weights: Four) -> Four:
    """Shape functions S_b of the four vectors from the weights of the control points."""
    return (
        weights[0] * basis[0, 0] + weights[1] * basis[1, 0] + weights[2] * basis[2, 0] + weights[3] * basis[3, 0],
        weights[0] * basis[0, 1] + weights[1] * basis[1, 1] + weights[2] * basis[2, 1] + weights[3] * basis[3, 1],
        weights[0] * basis[0, 2] + weights[1] * basis[1, 2] + weights[2] * basis[2, 2] + weights[3] * basis[3, 2],
        weights[0] * basis[0, 3] + weights[1] * basis[1, 3] + weights[2] * basis[2, 3] + weights[3] * basis[3, 3],
    )

"""Truss element: a straight link between two points that stretches, with the strain measure of Eq. 14."""

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel


@kernel
def truss_energy(e: FloatArray, i: int, axial: float, length: float) -> float:
    """Strain energy EA L (G - 1)^2 / 8 of the link between two points, with G = |r_j - r_i|^2 / L^2.

    Parameters
    ----------
    e : ndarray, shape (12,)
        Places of points in turn, m.
    i
        Index of the first coordinate of point i; those of point j follow.
    axial
        Axial stiffness E A alpha1, N.
    length
        Reference length L of the link, m.

    Returns
    -------
    float
        J.
    """
    x, y = e[i + 2] - e[i], e[i + 3] - e[i + 1]
    excess = (x * x + y * y) / (length * length) - 1.0
    return 0.125 * axial * length * excess * excess


@kernel
def add_truss(e: FloatArray, i: int, axial: float, length: float, gradient: FloatArray, tangent: FloatArray) -> None:
    """Add gradient and exact tangent of `truss_energy`.

    Parameters
    ----------
    e, i, axial, length
        As for `truss_energy`.
    gradient : ndarray, shape (12,)
        dU/de, N.
    tangent : ndarray, shape (12, 12)
        d2U/de2, N/m.
    """
    x, y = e[i + 2] - e[i], e[i + 3] - e[i + 1]
    square = length * length
    factor = 0.5 * axial * ((x * x + y * y) / square - 1.0) / length
    steep = axial / (length * square)
    xx, xy, yy = factor + steep * x * x, steep * x * y, factor + steep * y * y
    for a in range(2):
        sign, p = 2.0 * a - 1.0, i + 2 * a
        gradient[p] += sign * factor * x
        gradient[p + 1] += sign * factor * y
        for b in range(2):
            both, q = sign * (2.0 * b - 1.0), i + 2 * b
            tangent[p, q] += both * xx
            tangent[p, q + 1] += both * xy
            tangent[p + 1, q] += both * xy
            tangent[p + 1, q + 1] += both * yy

"""Centerline of the belt element: cubic Hermite shape functions (Eqs. 2 and 6).

The centerline is carried by the four vectors r_i, r_x,i, r_j, r_x,j of an element, in this order everywhere.
"""

from beltdyn.kernel import kernel

Four = tuple[float, float, float, float]


@kernel
def slopes(xi: float, length: float) -> Four:
    """First derivatives of the shape functions with respect to x, whose combination is q = r_c,x.

    Parameters
    ----------
    xi
        Dimensionless element coordinate x / L, 0 to 1.
    length
        Reference length L of the element, m.

    Returns
    -------
    tuple of 4 floats
        Factors of r_i (1/m), r_x,i (1), r_j (1/m), r_x,j (1).
    """
    chord = 6.0 * xi * (1.0 - xi) / length
    return -chord, 1.0 - xi * (4.0 - 3.0 * xi), chord, xi * (3.0 * xi - 2.0)


@kernel
def bends(xi: float, length: float) -> Four:
    """Second derivatives of the shape functions with respect to x, whose combination is w = r_c,xx.

    Parameters
    ----------
    xi, length
        As for `slopes`.

    Returns
    -------
    tuple of 4 floats
        Factors of r_i (1/m^2), r_x,i (1/m), r_j (1/m^2), r_x,j (1/m).
    """
    chord = (6.0 - 12.0 * xi) / (length * length)
    return -chord, (6.0 * xi - 4.0) / length, chord, (6.0 * xi - 2.0) / length

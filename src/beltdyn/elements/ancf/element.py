"""First argument of the kernels of the paper's element.

Centerline of the belt element: cubic Hermite shape functions (Eqs. 2 and 6).

The centerline is carried by the four vectors r_i, r_x,i, r_j, r_x,j of an element, in this order everywhere.
"""

from typing import NamedTuple

from beltdyn.elements.kind import Section
from beltdyn.kernel import kernel
from beltdyn.quadrature import Quadrature

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


class Ancf(NamedTuple):
    """The element of the paper's section 2: nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6)."""

    section: Section
    elastic: Quadrature
    """Points and weights on [0, 1] along the element."""

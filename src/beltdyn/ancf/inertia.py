"""Constant mass matrix of the belt element (kinetic energy of Eq. 2; section 4)."""

import numpy as np
from numpy.typing import NDArray

from beltdyn.ancf.section import Section
from beltdyn.kernel import kernel


@kernel
def element_mass(section: Section, length: float) -> NDArray[np.float64]:
    """Mass matrix, the integral of rho S^T S over the volume.

    The centreline carries rho A with cubic Hermite functions, the section vectors r_y carry rho I with linear ones; on a
    symmetric section the two do not couple.

    Parameters
    ----------
    section
        Inertia of the section.
    length
        Reference length L of the element, m.

    Returns
    -------
    ndarray, shape (12, 12)
        In the order r, r_x, r_y of node i, then of node j; kg, kg m and kg m^2.
    """
    hermite = np.array(
        (
            (156.0, 22.0 * length, 54.0, -13.0 * length),
            (22.0 * length, 4.0 * length**2, 13.0 * length, -3.0 * length**2),
            (54.0, 13.0 * length, 156.0, -22.0 * length),
            (-13.0 * length, -3.0 * length**2, -22.0 * length, 4.0 * length**2),
        )
    )
    matrix = np.zeros((12, 12))
    for a in range(4):
        for b in range(4):
            value = section.mass * length / 420.0 * hermite[a, b]
            row, column = 6 * (a // 2) + 2 * (a % 2), 6 * (b // 2) + 2 * (b % 2)
            matrix[row, column] = value
            matrix[row + 1, column + 1] = value
    for a in range(2):
        for b in range(2):
            value = section.rotary_inertia * length / (3.0 if a == b else 6.0)
            matrix[6 * a + 4, 6 * b + 4] = value
            matrix[6 * a + 5, 6 * b + 5] = value
    return matrix

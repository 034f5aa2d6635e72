"""Constant mass matrix of the belt element (kinetic energy of Eq. 2; section 4)."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.section import Section


def element_mass(section: Section, length: float) -> FloatArray:
    """Mass matrix, the integral of rho S^T S over the volume.

    The centreline carries rho A with cubic Hermite functions, the section vectors r_y carry rho I with linear ones;
    on a symmetric section the two do not couple.

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
        [
            [156.0, 22.0 * length, 54.0, -13.0 * length],
            [22.0 * length, 4.0 * length**2, 13.0 * length, -3.0 * length**2],
            [54.0, 13.0 * length, 156.0, -22.0 * length],
            [-13.0 * length, -3.0 * length**2, -22.0 * length, 4.0 * length**2],
        ]
    )
    linear = np.array([[2.0, 1.0], [1.0, 2.0]])
    matrix = np.zeros((12, 12))
    for axis in range(2):
        centreline, section_vectors = np.array([0, 2, 6, 8]) + axis, np.array([4, 10]) + axis
        matrix[np.ix_(centreline, centreline)] = section.mass * length / 420.0 * hermite
        matrix[np.ix_(section_vectors, section_vectors)] = section.rotary_inertia * length / 6.0 * linear
    return matrix

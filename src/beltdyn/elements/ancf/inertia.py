"""Constant mass matrix of the belt element (kinetic energy of Eq. 2; section 4)."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.section import Section

_HERMITE = np.array(
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]]
)
"""420 times the mass matrix of r_i, r_x,i, r_j, r_x,j of an element of length 1 and mass 1."""
_LINEAR = np.array([[2.0, 1.0], [1.0, 2.0]])
"""6 times that of r_y,i, r_y,j."""


def element_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrix, the integral of rho S^T S over the volume.

    The centreline carries rho A with cubic Hermite functions, the section vectors r_y carry rho I with linear ones;
    on a symmetric section the two do not couple.

    Parameters
    ----------
    section
        Inertia of the section.
    length
        Reference lengths L of the elements, shape (...), m.

    Returns
    -------
    ndarray, shape (..., 12, 12)
        In the order r, r_x, r_y of node i, then of node j; kg, kg m and kg m^2.
    """
    each = np.asarray(length)[..., None, None]
    scale = each[..., 0] ** np.array([0.0, 1.0, 0.0, 1.0])
    hermite = section.mass * each / 420.0 * scale[..., :, None] * scale[..., None, :] * _HERMITE
    linear = section.rotary_inertia * each / 6.0 * _LINEAR
    matrix = np.zeros((*np.shape(length), 12, 12))
    for axis in range(2):
        centreline, section_vectors = np.array([0, 2, 6, 8]) + axis, np.array([4, 10]) + axis
        matrix[..., centreline[:, None], centreline] = hermite
        matrix[..., section_vectors[:, None], section_vectors] = linear
    return matrix

"""The element kind of the paper: a cubic centerline, and sections with shear (Eqs. 2 and 6)."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf.elastic_force import ELASTIC_WORKSPACE, element_energy, element_force
from beltdyn.elements.ancf.element import Ancf
from beltdyn.elements.ancf.material_damping import DAMPING_WORKSPACE, damping_force
from beltdyn.elements.kind import ElementKind, Section
from beltdyn.kinds import register

# Constant mass matrix of the belt element (kinetic energy of Eq. 2; section 4)

_HERMITE = np.array(
    [[156.0, 22.0, 54.0, -13.0], [22.0, 4.0, 13.0, -3.0], [54.0, 13.0, 156.0, -22.0], [-13.0, -3.0, -22.0, 4.0]]
)
"""420 times the mass matrix of r_i, r_x,i, r_j, r_x,j of an element of length 1 and mass 1."""
_LINEAR = np.array([[2.0, 1.0], [1.0, 2.0]])
"""6 times that of r_y,i, r_y,j."""


def element_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrices of elements of lengths L, shape (..., 12, 12): the integral of rho S^T S; kg, kg m and kg m^2.

    The centerline carries rho A with cubic Hermite functions, the section vectors r_y carry rho I with linear ones; on
    a symmetric section the two do not couple. Order: r, r_x, r_y of node i, then of node j.
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


_UNIT_CONTROL = np.array([[1, 0, 0, 0], [1, 1 / 3, 0, 0], [0, 0, 1, -1 / 3], [0, 0, 1, 0]], dtype=float)
"""Control points from the vectors r_i, r_x,i, r_j, r_x,j of a cubic Hermite curve of length 1."""
_ORDERS = np.array([0.0, 1.0, 0.0, 1.0])
"""Of the derivatives that these are."""


def _hermite_control(length: FloatArray | float) -> FloatArray:
    """Control points of a cubic Hermite curve from r_i, r_x,i, r_j, r_x,j, shape (..., 1, 4, 4)."""
    return np.asarray(_UNIT_CONTROL * np.asarray(length)[..., None, None, None] ** _ORDERS)


def _upright(place: FloatArray, slope: FloatArray, _bend: FloatArray) -> FloatArray:
    """Nodal coordinates of a centerline whose sections stand upright on it, shape (N, 6)."""
    normal = np.stack([-slope[:, 1], slope[:, 0]], axis=1)
    return np.hstack([place, slope, normal / np.linalg.norm(slope, axis=1, keepdims=True)])


ANCF = register(
    ElementKind(
        name="ancf",
        meaning="the paper's element",
        element=Ancf,
        coordinates=("r_x", "r_y", "dr_x/dx", "dr_y/dx", "dr_x/dy", "dr_y/dy"),
        vectors=(0, 2, 6, 8),
        shift=(1.0, 0.0, 1.0, 0.0),
        control=_hermite_control,
        scale=lambda length: (1.0, 1.0, length, length, length, length),
        mass=element_mass,
        nodal=_upright,
        energy=element_energy,
        force=element_force,
        damping=damping_force,
        scratch={"elastic": ELASTIC_WORKSPACE, "damping": DAMPING_WORKSPACE},
        turned=4,
        bent_strain=-1.5,  # least energy of Eq. 14, EA e^2 / 2 + EI (1 + 3 e) / (2 R^2) at a small strain e
    )
)

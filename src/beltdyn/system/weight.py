"""Weight of the belt as nodal forces (gravity is not in the paper)."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.system.discretization import Discretization


def weight_forces(mesh: Discretization, nodes: int, gravity: tuple[float, float]) -> FloatArray:
    """Generalised forces of a uniform gravity, the integral of rho A S^T g over the belt.

    A uniform acceleration moves the material points alone, not the derivatives, so that the integral is the mass
    matrix of an element times g at its points.

    Parameters
    ----------
    mesh
        The elements of the belt.
    nodes
        Number of nodes; the last element of a closed belt ends at the first.
    gravity
        Acceleration of gravity g, m/s^2.

    Returns
    -------
    ndarray, shape (n * nodes,)
        N for the rows of places, N m for those of r_x.
    """
    dof = len(mesh.scale)
    node = np.zeros(dof)
    node[: 2 * mesh.points] = np.tile(gravity, mesh.points)
    by_element = mesh.mass @ np.tile(node, 2)
    force, element = np.zeros((nodes, dof)), np.arange(len(by_element))
    force[element] += by_element[:, :dof]
    force[(element + 1) % nodes] += by_element[:, dof:]
    return force.ravel()

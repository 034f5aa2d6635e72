"""Weight of the belt as nodal forces (gravity is not in the paper)."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.system.discretization import Discretization


def weight_forces(mesh: Discretization, nodes: int, gravity: tuple[float, float]) -> FloatArray:
    """Generalised forces of a uniform gravity, the integral of rho A S^T g over the belt.

    A uniform acceleration moves the material points alone, not the gradients, so that the integral is the mass matrix
    of an element times g at its points; for a chain it is half of the weight of every link at each of its ends.

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
    ndarray, shape (6 * nodes,)
        N for the rows of r (of every point of a chain), N m for those of r_x, nothing for r_y.
    """
    dof = len(mesh.scale)
    node = np.zeros(dof)
    node[: 2 * mesh.points] = np.tile(gravity, mesh.points)
    by_element = mesh.mass @ np.tile(node, 2)
    force = np.zeros((nodes, dof))
    for element, ends in enumerate(by_element):
        force[element] += ends[:dof]
        force[(element + 1) % nodes] += ends[dof:]
    return force.ravel()

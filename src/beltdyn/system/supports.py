"""Supports and loads of single nodes: what makes a cantilever of a belt."""

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import RingMatrix, System


@kernel
def add_nodal_loads(system: System, position: FloatArray, by_position: float, matrix: RingMatrix) -> None:
    """Take constant forces and moments off the residual.

    A moment m turns a vector d of its node, r_y of the paper's element: its work is m dphi with phi the direction of
    d, so that it acts on d with m n / |d|, n normal to d.  (On r_x it would be a couple of opposite shears within one
    element, which grows with every refinement of the mesh, since the energy holds s but not its jumps.)

    Parameters
    ----------
    system
        With its supports.
    position : ndarray, shape (n N + D,)
        Nodal coordinates first.
    by_position
        Factor of the derivative with respect to position in the tangent.
    matrix
        Right-hand side and tangent, changed in place.
    """
    supports, dof = system.supports, len(system.scale)
    for node in range(system.nodes):
        for c in range(dof):
            matrix.node_side[node, c] -= supports.force[dof * node + c]
        moment = supports.moment[node]
        if moment != 0.0:
            c, first = system.turned, dof * node + system.turned
            x, y = position[first], position[first + 1]
            square = x * x + y * y
            matrix.node_side[node, c] += moment * y / square
            matrix.node_side[node, c + 1] -= moment * x / square
            factor = by_position * moment / (square * square)
            matrix.diagonal[node, c, c] -= 2.0 * factor * x * y
            matrix.diagonal[node, c, c + 1] += factor * (x * x - y * y)
            matrix.diagonal[node, c + 1, c] += factor * (x * x - y * y)
            matrix.diagonal[node, c + 1, c + 1] += 2.0 * factor * x * y


@kernel
def hold_fixed(system: System, matrix: RingMatrix) -> None:
    """Replace the equations of fixed coordinates by "no change".

    Parameters
    ----------
    system
        With its supports.
    matrix
        Rows and columns of fixed coordinates become those of the identity, their right-hand side zero.
    """
    dof = len(system.scale)
    for node in range(system.nodes):
        before = (node - 1) % system.nodes
        for c in range(dof):
            if system.supports.fixed[dof * node + c]:
                matrix.diagonal[node, c, :] = 0.0
                matrix.diagonal[node, :, c] = 0.0
                matrix.diagonal[node, c, c] = 1.0
                matrix.upper[node, c, :] = 0.0
                matrix.lower[node, :, c] = 0.0
                matrix.upper[before, :, c] = 0.0
                matrix.lower[before, c, :] = 0.0
                matrix.column[node, c, :] = 0.0
                matrix.row[node, :, c] = 0.0
                matrix.node_side[node, c] = 0.0

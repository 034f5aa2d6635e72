"""Supports and loads of single nodes: what makes a cantilever of a belt."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import RingMatrix, System

# What an element adds to the equations of its nodes, and of the pulleys that it touches


@kernel(inline=True)
def take_contact(system: System, wanted: bool, work: np.record) -> None:
    """Take contact force and tangent off the residual and tangent of the element."""
    contact, gradient, tangent = work.contact, work.element.gradient, work.element.tangent
    for a in range(len(system.vectors)):
        row = system.vectors[a]
        gradient[row] -= contact.force[a, 0]
        gradient[row + 1] -= contact.force[a, 1]
        if not wanted:
            continue
        for b in range(len(system.vectors)):
            column = system.vectors[b]
            tangent[row, column] -= contact.xx[a, b]
            tangent[row, column + 1] -= contact.xy[a, b]
            tangent[row + 1, column] -= contact.yx[a, b]
            tangent[row + 1, column + 1] -= contact.yy[a, b]


@kernel(inline=True)
def couple_rim(system: System, element: int, unknown: int, contact: np.record, matrix: RingMatrix) -> None:
    """Coupling of the element with angle and speed of a free pulley."""
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for a in range(len(system.vectors)):
        first = system.vectors[a]
        node, c = (element, first) if first < dof else (node_j, first - dof)
        for axis in range(2):
            matrix.column[node, c + axis, unknown] -= contact.by_turn[a, axis]
            matrix.row[node, unknown, c + axis] -= contact.moment[a, axis]


@kernel(inline=True)
def scatter(system: System, element: int, wanted: bool, work: np.record, matrix: RingMatrix) -> None:
    """Add residual and tangent of the element to those of its nodes i and j."""
    i, j = element, (element + 1) % system.nodes
    dof, gradient, tangent = len(matrix.unknowns), work.element.gradient, work.element.tangent
    for row in range(dof):
        matrix.node_side[i, row] += gradient[row]
        matrix.node_side[j, row] += gradient[dof + row]
        if not wanted:
            continue
        for column in range(dof):
            matrix.diagonal[i, row, column] += tangent[row, column]
            matrix.upper[i, row, column] += tangent[row, dof + column]
            matrix.lower[i, row, column] += tangent[dof + row, column]
            matrix.diagonal[j, row, column] += tangent[dof + row, dof + column]


@kernel
def add_nodal_loads(system: System, position: FloatArray, by_position: float, matrix: RingMatrix) -> None:
    """Take constant forces and moments off the residual.

    A moment m turns a vector d of its node, r_y of the paper's element: its work is m dphi with phi the direction of
    d, so that it acts on d with m n / |d|, n normal to d.  (On r_x it would be a couple of opposite shears within one
    element, which grows with every refinement of the mesh, since the energy holds s but not its jumps.)

    `system`: with its supports; `position`: nodal coordinates first, shape (n N + D,); `by_position`: factor of the
    derivative with respect to position in the tangent; `matrix`: right-hand side and tangent, changed in place.
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

    `system`: with its supports; `matrix`: rows and columns of fixed coordinates become those of the identity, their
    right-hand side zero.
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

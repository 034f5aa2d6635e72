"""What an element adds to the equations of its nodes, and of the pulleys that it touches."""

import numpy as np

from beltdyn.kernel import kernel
from beltdyn.system.arrays import RingMatrix, System


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

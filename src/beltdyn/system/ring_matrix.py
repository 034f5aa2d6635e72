"""Linear algebra of the belt: a block-tridiagonal matrix, cyclic or open, with a border, solved in O(n).

A closed ring is cut open by moving its last node to the border.  The chain that remains is eliminated block by
block; what it leaves in the border is a small dense system.  Rows are kept as [own block | border | right-hand
side], so that eliminating a node is one small matrix product for the next node and one for the border.
"""

import numpy as np
from numpy.typing import NDArray

from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, RingMatrix, RingScratch

FloatArray = NDArray[np.float64]

_LANES = 16
"""Rows are padded to a multiple of this many numbers, so that the inner loops run in whole vector registers."""


def ring_matrix(nodes: int, border: int) -> RingMatrix:
    """Make a zero matrix.

    Parameters
    ----------
    nodes
        Number of nodes.
    border
        Number of unknowns in the border.

    Returns
    -------
    RingMatrix
        With room to solve it.
    """
    size = NODE + border
    width = (NODE + size + _LANES) // _LANES * _LANES
    return RingMatrix(
        diagonal=np.zeros((nodes, NODE, NODE)),
        upper=np.zeros((nodes, NODE, NODE)),
        lower=np.zeros((nodes, NODE, NODE)),
        column=np.zeros((nodes, NODE, border)),
        row=np.zeros((nodes, border, NODE)),
        corner=np.zeros((border, border)),
        node_side=np.zeros((nodes, NODE)),
        border_side=np.zeros(border),
        scratch=RingScratch(
            rows=np.zeros((NODE, width)),
            panels=np.zeros((nodes, NODE, width)),
            rim=np.zeros((size, width)),
            left=np.zeros((size, NODE)),
            dense=np.zeros((size, size)),
            answer=np.zeros((size, 1)),
        ),
    )


@kernel
def clear(matrix: RingMatrix) -> None:
    """Set matrix and right-hand side to zero."""
    matrix.diagonal[:] = 0.0
    matrix.upper[:] = 0.0
    matrix.lower[:] = 0.0
    matrix.column[:] = 0.0
    matrix.row[:] = 0.0
    matrix.corner[:] = 0.0
    matrix.node_side[:] = 0.0
    matrix.border_side[:] = 0.0


@kernel
def solve_ring(matrix: RingMatrix, closed: bool, node_part: FloatArray, border_part: FloatArray) -> bool:
    """Solve for the unknowns of the nodes and of the border.

    Parameters
    ----------
    matrix
        Kept as it is.
    closed
        Whether `upper` and `lower` of the last node couple it to the first.
    node_part : ndarray, shape (N, 6)
        Overwritten by the solution.
    border_part : ndarray, shape (m,)
        Overwritten by the solution.

    Returns
    -------
    bool
        False if a pivot vanished (singular to working precision); the solution is then meaningless.
    """
    nodes, extra = matrix.diagonal.shape[0], matrix.corner.shape[0]
    cut, chain = (NODE, nodes - 1) if closed else (0, nodes)
    border = cut + extra
    rows, rim, left, answer = matrix.scratch.rows, matrix.scratch.rim, matrix.scratch.left, matrix.scratch.answer
    _load_node(matrix, 0, closed, chain, rows)
    _load_border(matrix, closed, rim)
    _load_coupling(matrix, 0, closed, chain, rim)
    for k in range(chain):
        panel = matrix.scratch.panels[k]
        _split(rows, matrix.upper[k], k < chain - 1, panel)
        if not _eliminate(rows, panel, NODE):
            return False
        _copy_columns(rim, left, border)
        if k < chain - 1:
            _load_node(matrix, k + 1, closed, chain, rows)
            _load_coupling(matrix, k + 1, closed, chain, rim)
            _subtract_product(matrix.lower[k], panel, rows, NODE)
        _subtract_product(left, panel, rim, border)
    if not _solve_border(rim, matrix.scratch.dense, answer, border):
        return False
    for i in range(extra):
        border_part[i] = answer[cut + i, 0]
    for i in range(cut):
        node_part[chain, i] = answer[i, 0]
    for k in range(chain - 1, -1, -1):
        _back_substitute(matrix.scratch.panels[k], answer, border, node_part, k, k < chain - 1)
    return True


@kernel
def _load_node(matrix: RingMatrix, k: int, closed: bool, chain: int, rows: FloatArray) -> None:
    """Rows of node k: [diagonal block | columns of the border | right-hand side]."""
    extra = matrix.corner.shape[0]
    start = 2 * NODE if closed else NODE
    for i in range(NODE):
        for j in range(NODE):
            rows[i, j] = matrix.diagonal[k, i, j]
        for j in range(extra):
            rows[i, start + j] = matrix.column[k, i, j]
        rows[i, start + extra] = matrix.node_side[k, i]
        if closed:
            for j in range(NODE):
                rows[i, NODE + j] = 0.0
                if k == 0:
                    rows[i, NODE + j] += matrix.lower[chain, i, j]
                if k == chain - 1:
                    rows[i, NODE + j] += matrix.upper[k, i, j]


@kernel
def _load_coupling(matrix: RingMatrix, k: int, closed: bool, chain: int, rim: FloatArray) -> None:
    """Columns of node k in the rows of the border."""
    cut = NODE if closed else 0
    for j in range(NODE):
        for i in range(cut):
            rim[i, j] = 0.0
            if k == 0:
                rim[i, j] += matrix.upper[chain, i, j]
            if k == chain - 1:
                rim[i, j] += matrix.lower[k, i, j]
        for i in range(matrix.corner.shape[0]):
            rim[cut + i, j] = matrix.row[k, i, j]


@kernel
def _load_border(matrix: RingMatrix, closed: bool, rim: FloatArray) -> None:
    """Rows of the border: [columns of a node, loaded later | border with itself | right-hand side]."""
    extra = matrix.corner.shape[0]
    cut = NODE if closed else 0
    start = NODE + cut
    for i in range(extra):
        for j in range(extra):
            rim[cut + i, start + j] = matrix.corner[i, j]
        rim[cut + i, start + extra] = matrix.border_side[i]
    if closed:
        last = matrix.diagonal.shape[0] - 1
        for i in range(NODE):
            for j in range(NODE):
                rim[i, NODE + j] = matrix.diagonal[last, i, j]
            for j in range(extra):
                rim[i, start + j] = matrix.column[last, i, j]
                rim[cut + j, NODE + i] = matrix.row[last, j, i]
            rim[i, start + extra] = matrix.node_side[last, i]


@kernel
def _split(rows: FloatArray, upper: FloatArray, coupled: bool, panel: FloatArray) -> None:
    """Panel of a node: [block towards the next node | columns of the border | right-hand side]."""
    for i in range(NODE):
        for j in range(panel.shape[1]):
            panel[i, j] = rows[i, j]
        for j in range(NODE):
            panel[i, j] = upper[i, j] if coupled else 0.0


@kernel
def _copy_columns(rim: FloatArray, left: FloatArray, border: int) -> None:
    """Take the columns of the current node out of the rows of the border."""
    for i in range(border):
        for j in range(NODE):
            left[i, j] = rim[i, j]


@kernel
def _eliminate(square: FloatArray, panel: FloatArray, size: int) -> bool:
    """Overwrite panel by square^-1 panel, with partial pivoting; square is destroyed.  False if a pivot vanishes."""
    width = panel.shape[1]
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(square[i, k]) > abs(square[pivot, k]):
                pivot = i
        if not abs(square[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for j in range(size):
                square[k, j], square[pivot, j] = square[pivot, j], square[k, j]
            for j in range(width):
                panel[k, j], panel[pivot, j] = panel[pivot, j], panel[k, j]
        inverse = 1.0 / square[k, k]
        for j in range(width):
            panel[k, j] *= inverse
        for j in range(k + 1, size):
            square[k, j] *= inverse
        for i in range(k + 1, size):
            factor = square[i, k]
            for j in range(k + 1, size):
                square[i, j] -= factor * square[k, j]
            for j in range(width):
                panel[i, j] -= factor * panel[k, j]
    for k in range(size - 1, 0, -1):
        for i in range(k):
            factor = square[i, k]
            for j in range(width):
                panel[i, j] -= factor * panel[k, j]
    return True


@kernel
def _subtract_product(left: FloatArray, right: FloatArray, target: FloatArray, count: int) -> None:
    """Target -= left right in the first rows, for a left factor of six columns."""
    for i in range(count):
        for k in range(NODE):
            factor = left[i, k]
            for j in range(target.shape[1]):
                target[i, j] -= factor * right[k, j]


@kernel
def _solve_border(rim: FloatArray, dense: FloatArray, answer: FloatArray, border: int) -> bool:
    """Solve the dense system that is left in the border; False if it is singular."""
    for i in range(border):
        answer[i, 0] = rim[i, NODE + border]
        for j in range(border):
            dense[i, j] = rim[i, NODE + j]
    return _eliminate(dense, answer, border)


@kernel
def _back_substitute(
    panel: FloatArray, answer: FloatArray, border: int, node_part: FloatArray, k: int, coupled: bool
) -> None:
    """Unknowns of node k from those of the border and of the next node."""
    for i in range(NODE):
        total = panel[i, NODE + border]
        for j in range(border):
            total -= panel[i, NODE + j] * answer[j, 0]
        if coupled:
            for j in range(NODE):
                total -= panel[i, j] * node_part[k + 1, j]
        node_part[k, i] = total

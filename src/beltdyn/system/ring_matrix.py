"""Linear algebra of the belt: a block-tridiagonal matrix, cyclic or open, with a border, solved in O(n).

A closed ring is cut open by moving its last node to the border.  The chain that remains is solved for the right-hand
side and for all columns of the border at once; what the border's own equations leave of these solutions is a small
dense system.  An equation of the border touches few nodes, so that the cost is linear in nodes times border.
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
    rows, panels, dense, answer = matrix.scratch
    for k in range(chain):
        _load_node(matrix, k, closed, chain, rows)
        if k > 0:
            _subtract_product(matrix.lower[k - 1], panels[k - 1], rows)
        _split(rows, matrix.upper[k], k < chain - 1, panels[k])
        if not _eliminate(rows, panels[k], rows.shape[0]):
            return False
    for k in range(chain - 2, -1, -1):
        _subtract_product(panels[k, :, :NODE], panels[k + 1], panels[k])
        panels[k, :, :NODE] = 0.0  # so that the next product, over whole rows, leaves its left factor alone
    _load_border(matrix, closed, dense, answer)
    if closed:
        for i in range(NODE):
            _reduce(matrix.upper[chain, i], panels[0], border, i, dense, answer)
            _reduce(matrix.lower[chain - 1, i], panels[chain - 1], border, i, dense, answer)
    for k in range(chain):
        for i in range(extra):
            _reduce(matrix.row[k, i], panels[k], border, cut + i, dense, answer)
    if not _eliminate(dense, answer, border):
        return False
    for i in range(extra):
        border_part[i] = answer[cut + i, 0]
    for i in range(cut):
        node_part[chain, i] = answer[i, 0]
    for k in range(chain):
        for i in range(NODE):
            total = panels[k, i, NODE + border]
            for j in range(border):
                total -= panels[k, i, NODE + j] * answer[j, 0]
            node_part[k, i] = total
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
def _load_border(matrix: RingMatrix, closed: bool, dense: FloatArray, answer: FloatArray) -> None:
    """The border with itself: the last node of a closed ring, then the given border."""
    extra = matrix.corner.shape[0]
    cut = NODE if closed else 0
    for i in range(extra):
        for j in range(extra):
            dense[cut + i, cut + j] = matrix.corner[i, j]
        answer[cut + i, 0] = matrix.border_side[i]
    if closed:
        last = matrix.diagonal.shape[0] - 1
        for i in range(NODE):
            for j in range(NODE):
                dense[i, j] = matrix.diagonal[last, i, j]
            for j in range(extra):
                dense[i, NODE + j] = matrix.column[last, i, j]
                dense[NODE + j, i] = matrix.row[last, j, i]
            answer[i, 0] = matrix.node_side[last, i]


@kernel
def _split(rows: FloatArray, upper: FloatArray, coupled: bool, panel: FloatArray) -> None:
    """Panel of a node: [block towards the next node | columns of the border | right-hand side]."""
    for i in range(NODE):
        for j in range(panel.shape[1]):
            panel[i, j] = rows[i, j]
        for j in range(NODE):
            panel[i, j] = upper[i, j] if coupled else 0.0


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
def _subtract_product(left: FloatArray, right: FloatArray, target: FloatArray) -> None:
    """Target -= left right, for factors of six columns and of six rows."""
    for i in range(NODE):
        a, b, c = left[i, 0], left[i, 1], left[i, 2]
        d, e, f = left[i, 3], left[i, 4], left[i, 5]
        for j in range(target.shape[1]):
            first = a * right[0, j] + b * right[1, j] + c * right[2, j]
            target[i, j] -= first + (d * right[3, j] + e * right[4, j] + f * right[5, j])


@kernel
def _reduce(
    coupling: FloatArray, panel: FloatArray, border: int, row: int, dense: FloatArray, answer: FloatArray
) -> None:
    """Put the solutions of a node into an equation of the border that couples to it."""
    for k in range(NODE):
        factor = coupling[k]
        if factor != 0.0:
            for j in range(border):
                dense[row, j] -= factor * panel[k, NODE + j]
            answer[row, 0] -= factor * panel[k, NODE + border]

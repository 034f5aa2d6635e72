"""Linear algebra of the belt: a block-tridiagonal matrix, cyclic or open, with a border, solved in O(n).

A closed ring is cut open by moving its last node to the border.  The chain that remains is factorised, and solved for
all columns of the border at once; what the border's own equations leave of these solutions is a small dense matrix.
An equation of the border touches few nodes, so that the cost is linear in nodes times border.  Another right-hand side
costs a sixth of a factorisation.
"""

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, RingFactors, RingMatrix

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
    width = (NODE + size + _LANES - 1) // _LANES * _LANES
    return RingMatrix(
        diagonal=np.zeros((nodes, NODE, NODE)),
        upper=np.zeros((nodes, NODE, NODE)),
        lower=np.zeros((nodes, NODE, NODE)),
        column=np.zeros((nodes, NODE, border)),
        row=np.zeros((nodes, border, NODE)),
        corner=np.zeros((border, border)),
        node_side=np.zeros((nodes, NODE)),
        border_side=np.zeros(border),
        factors=RingFactors(
            rows=np.zeros((NODE, width)),
            panels=np.zeros((nodes, NODE, width)),
            squares=np.zeros((nodes, NODE, NODE)),
            pivots=np.zeros((nodes, NODE), dtype=np.int64),
            links=np.zeros((nodes, NODE, NODE)),
            dense=np.zeros((size, size)),
            dense_pivots=np.zeros(size, dtype=np.int64),
            no_columns=np.zeros((size, 0)),
            answer=np.zeros(size),
        ),
    )


@kernel
def clear(matrix: RingMatrix, whole: bool) -> None:
    """Set the right-hand side to zero, and the whole matrix if asked for."""
    matrix.node_side[:] = 0.0
    matrix.border_side[:] = 0.0
    if whole:
        matrix.diagonal[:] = 0.0
        matrix.upper[:] = 0.0
        matrix.lower[:] = 0.0
        matrix.column[:] = 0.0
        matrix.row[:] = 0.0
        matrix.corner[:] = 0.0


def entries(matrix: RingMatrix) -> FloatArray:
    """Entries of all blocks, one block after another, in the order of `places`."""
    blocks = (matrix.diagonal, matrix.upper, matrix.lower, matrix.column, matrix.row, matrix.corner)
    return np.concatenate([block.ravel() for block in blocks])


def places(matrix: RingMatrix) -> tuple[IntArray, IntArray]:
    """Rows and columns of the entries among the 6 N + m unknowns; entries of equal place add up."""
    nodes, border = len(matrix.diagonal), len(matrix.corner)
    own = np.arange(NODE * nodes).reshape(nodes, NODE)
    after, extra = np.roll(own, -1, axis=0), NODE * nodes + np.arange(border)
    blocks = ((own, own), (own, after), (after, own), (own, extra), (extra, own), (extra, extra))
    pairs = [np.broadcast_arrays(rows[..., :, None], columns[..., None, :]) for rows, columns in blocks]
    rows, columns = (np.concatenate([pair[axis].ravel() for pair in pairs]) for axis in (0, 1))
    return rows, columns


@kernel
def solve_ring(matrix: RingMatrix, closed: bool, node_part: FloatArray, border_part: FloatArray) -> bool:
    """Factorise a matrix and solve for its right-hand side; see `factorise_ring` and `substitute`.

    Returns
    -------
    bool
        False if the matrix is singular to working precision; there is no solution then.
    """
    if not factorise_ring(matrix, closed):
        return False
    substitute(matrix, closed, node_part, border_part)
    return True


@kernel
def factorise_ring(matrix: RingMatrix, closed: bool) -> bool:
    """Factorise a matrix, whose entries are kept as they are.

    Parameters
    ----------
    matrix
        Its factors are overwritten.
    closed
        Whether `upper` and `lower` of the last node couple it to the first.

    Returns
    -------
    bool
        False if a pivot vanished (singular to working precision); the factors are then meaningless.
    """
    nodes, extra = matrix.diagonal.shape[0], matrix.corner.shape[0]
    cut, chain = (NODE, nodes - 1) if closed else (0, nodes)
    rows, panels, squares, pivots, links, dense, dense_pivots, no_columns, _ = matrix.factors
    for k in range(chain):
        _load_node(matrix, k, closed, chain, rows)
        if k > 0:
            _subtract_product(matrix.lower[k - 1], panels[k - 1], rows)
        _split(rows, matrix.upper[k], k < chain - 1, squares[k], panels[k])
        if not _eliminate(squares[k], pivots[k], panels[k], NODE):
            return False
    for k in range(chain - 2, -1, -1):
        for i in range(NODE):
            for j in range(NODE):
                links[k, i, j] = panels[k, i, j]
        _subtract_product(links[k], panels[k + 1], panels[k])
        panels[k, :, :NODE] = 0.0  # so that the next product, over whole rows, leaves these columns alone
    _load_border(matrix, closed, dense)
    if closed:
        for i in range(NODE):
            _reduce(matrix.upper[chain, i], panels[0], cut + extra, dense[i])
            _reduce(matrix.lower[chain - 1, i], panels[chain - 1], cut + extra, dense[i])
    for k in range(chain):
        for i in range(extra):
            _reduce(matrix.row[k, i], panels[k], cut + extra, dense[cut + i])
    return _eliminate(dense, dense_pivots, no_columns, cut + extra)


@kernel
def substitute(matrix: RingMatrix, closed: bool, node_part: FloatArray, border_part: FloatArray) -> None:
    """Solve for the right-hand side with the factors that are there.

    Parameters
    ----------
    matrix
        Factorised by `factorise_ring`, since when its blocks between nodes and in the border's rows are the same.
    closed
        As there.
    node_part : ndarray, shape (N, 6)
        Overwritten by the solution.
    border_part : ndarray, shape (m,)
        Overwritten by the solution.
    """
    nodes, extra = matrix.diagonal.shape[0], matrix.corner.shape[0]
    cut, chain = (NODE, nodes - 1) if closed else (0, nodes)
    _, panels, squares, pivots, links, dense, dense_pivots, _, answer = matrix.factors
    for k in range(chain):
        for i in range(NODE):
            node_part[k, i] = matrix.node_side[k, i]
        if k > 0:
            _subtract_image(matrix.lower[k - 1], node_part[k - 1], node_part[k])
        _solve_factorised(squares[k], pivots[k], NODE, node_part[k])
    for k in range(chain - 2, -1, -1):
        _subtract_image(links[k], node_part[k + 1], node_part[k])
    if closed:
        for i in range(NODE):
            answer[i] = matrix.node_side[chain, i]
        _subtract_image(matrix.upper[chain], node_part[0], answer)
        _subtract_image(matrix.lower[chain - 1], node_part[chain - 1], answer)
    for i in range(extra):
        answer[cut + i] = matrix.border_side[i]
        for k in range(chain):
            for j in range(NODE):
                answer[cut + i] -= matrix.row[k, i, j] * node_part[k, j]
    _solve_factorised(dense, dense_pivots, cut + extra, answer)
    for i in range(extra):
        border_part[i] = answer[cut + i]
    for i in range(cut):
        node_part[chain, i] = answer[i]
    for k in range(chain):
        for i in range(NODE):
            total = node_part[k, i]
            for j in range(cut + extra):
                total -= panels[k, i, NODE + j] * answer[j]
            node_part[k, i] = total


@kernel(inline=True)
def _load_node(matrix: RingMatrix, k: int, closed: bool, chain: int, rows: FloatArray) -> None:
    """Rows of node k: [diagonal block | columns of the border]."""
    extra = matrix.corner.shape[0]
    start = 2 * NODE if closed else NODE
    for i in range(NODE):
        for j in range(NODE):
            rows[i, j] = matrix.diagonal[k, i, j]
        for j in range(extra):
            rows[i, start + j] = matrix.column[k, i, j]
        if closed:
            for j in range(NODE):
                rows[i, NODE + j] = 0.0
                if k == 0:
                    rows[i, NODE + j] += matrix.lower[chain, i, j]
                if k == chain - 1:
                    rows[i, NODE + j] += matrix.upper[k, i, j]


@kernel(inline=True)
def _load_border(matrix: RingMatrix, closed: bool, dense: FloatArray) -> None:
    """The border with itself: the last node of a closed ring, then the given border."""
    extra = matrix.corner.shape[0]
    cut = NODE if closed else 0
    for i in range(extra):
        for j in range(extra):
            dense[cut + i, cut + j] = matrix.corner[i, j]
    if closed:
        last = matrix.diagonal.shape[0] - 1
        for i in range(NODE):
            for j in range(NODE):
                dense[i, j] = matrix.diagonal[last, i, j]
            for j in range(extra):
                dense[i, NODE + j] = matrix.column[last, i, j]
                dense[NODE + j, i] = matrix.row[last, j, i]


@kernel(inline=True)
def _split(rows: FloatArray, upper: FloatArray, coupled: bool, square: FloatArray, panel: FloatArray) -> None:
    """Block of a node, and its panel: [block towards the next node | columns of the border]."""
    for i in range(NODE):
        for j in range(panel.shape[1]):
            panel[i, j] = rows[i, j]
        for j in range(NODE):
            square[i, j] = rows[i, j]
            panel[i, j] = upper[i, j] if coupled else 0.0


@kernel(inline=True)
def _eliminate(square: FloatArray, pivots: IntArray, panel: FloatArray, size: int) -> bool:
    """Overwrite panel by square^-1 panel, with partial pivoting, and square by its factors; False if a pivot vanishes.

    The factors are P^-1 L U with ones on the diagonal of U, and the inverse of L's diagonal in its place.
    """
    width = panel.shape[1]
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(square[i, k]) > abs(square[pivot, k]):
                pivot = i
        pivots[k] = pivot
        if not abs(square[pivot, k]) > 0.0:
            return False
        if pivot != k:
            for j in range(size):
                square[k, j], square[pivot, j] = square[pivot, j], square[k, j]
            for j in range(width):
                panel[k, j], panel[pivot, j] = panel[pivot, j], panel[k, j]
        inverse = 1.0 / square[k, k]
        square[k, k] = inverse
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


@kernel(inline=True)
def _solve_factorised(square: FloatArray, pivots: IntArray, size: int, vector: FloatArray) -> None:
    """Overwrite a vector by square^-1 vector, from the factors that `_eliminate` leaves."""
    for k in range(size):
        pivot = pivots[k]
        vector[k], vector[pivot] = vector[pivot], vector[k]
    for k in range(size):
        value = vector[k] * square[k, k]
        vector[k] = value
        for i in range(k + 1, size):
            vector[i] -= square[i, k] * value
    for k in range(size - 1, 0, -1):
        value = vector[k]
        for i in range(k):
            vector[i] -= square[i, k] * value


@kernel(inline=True)
def _subtract_product(left: FloatArray, right: FloatArray, target: FloatArray) -> None:
    """Target -= left right, for factors of six columns and of six rows."""
    for i in range(NODE):
        a, b, c = left[i, 0], left[i, 1], left[i, 2]
        d, e, f = left[i, 3], left[i, 4], left[i, 5]
        for j in range(target.shape[1]):
            first = a * right[0, j] + b * right[1, j] + c * right[2, j]
            target[i, j] -= first + (d * right[3, j] + e * right[4, j] + f * right[5, j])


@kernel(inline=True)
def _subtract_image(block: FloatArray, vector: FloatArray, target: FloatArray) -> None:
    """Take block times vector, six numbers, off the first six of target."""
    for i in range(NODE):
        first = block[i, 0] * vector[0] + block[i, 1] * vector[1] + block[i, 2] * vector[2]
        target[i] -= first + (block[i, 3] * vector[3] + block[i, 4] * vector[4] + block[i, 5] * vector[5])


@kernel(inline=True)
def _reduce(coupling: FloatArray, panel: FloatArray, border: int, row: FloatArray) -> None:
    """Put the chain's answers into an equation of the border that couples to a node."""
    for k in range(NODE):
        factor = coupling[k]
        if factor != 0.0:
            for j in range(border):
                row[j] -= factor * panel[k, NODE + j]

"""Linear algebra of the belt: a block-tridiagonal matrix, cyclic or open, with a border, solved in O(n).

A closed ring is cut open by moving its last node to the border.  The inner nodes that remain are factorized, and
solved for all columns of the border at once; what the border's own equations leave of these solutions is a small dense
matrix.  An equation of the border touches few nodes, so that the cost is linear in nodes times border.  Another
right-hand side costs a sixth of a factorization.
"""

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import RingFactors, RingMatrix

# Linear algebra of the small dense blocks that the belt's equations are made of


@kernel(inline=True)
def eliminate(square: FloatArray, pivots: IntArray, panel: FloatArray, size: int) -> bool:
    """Overwrite panel by square^-1 panel, with partial pivoting, and square by its factors; False if a pivot vanishes.

    The factors are P^-1 L U with ones on the diagonal of U, and the inverse of L's diagonal in its place.

    `square`: shape (size, size); `pivots`: shape (size,); `panel`: shape (size, any); `size`: number of rows.
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
def solve_factorised(square: FloatArray, pivots: IntArray, size: int, vector: FloatArray) -> None:
    """Overwrite a vector of shape (size,) by square^-1 vector, from the factors that `eliminate` leaves."""
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
def subtract_product(dof: int, left: FloatArray, right: FloatArray, target: FloatArray) -> None:
    """Target -= left right, for left of shape (dof, dof), and right and target of shape (dof, any).

    Six columns of left are taken at a time, the rest by pairs.
    """
    sixes = dof - dof % 6
    for i in range(dof):
        for k in range(0, sixes, 6):
            a, b, c = left[i, k], left[i, k + 1], left[i, k + 2]
            d, e, f = left[i, k + 3], left[i, k + 4], left[i, k + 5]
            for j in range(target.shape[1]):
                first = a * right[k, j] + b * right[k + 1, j] + c * right[k + 2, j]
                target[i, j] -= first + (d * right[k + 3, j] + e * right[k + 4, j] + f * right[k + 5, j])
        for k in range(sixes, dof, 2):
            a, b = left[i, k], left[i, k + 1]
            for j in range(target.shape[1]):
                target[i, j] -= a * right[k, j] + b * right[k + 1, j]


@kernel(inline=True)
def subtract_image(dof: int, block: FloatArray, vector: FloatArray, target: FloatArray) -> None:
    """Take block, of shape (dof, dof), times the first dof numbers of vector off those of target."""
    for i in range(dof):
        total = 0.0
        for k in range(dof):
            total += block[i, k] * vector[k]
        target[i] -= total


_LANES = 16
"""Rows are padded to a multiple of this many numbers, so that the inner loops run in whole vector registers."""


def ring_matrix(dof: int, nodes: int, border: int) -> RingMatrix:
    """Make a zero matrix."""
    size = dof + border
    width = (dof + size + _LANES - 1) // _LANES * _LANES
    return RingMatrix(
        unknowns=tuple(range(dof)),
        diagonal=np.zeros((nodes, dof, dof)),
        upper=np.zeros((nodes, dof, dof)),
        lower=np.zeros((nodes, dof, dof)),
        column=np.zeros((nodes, dof, border)),
        row=np.zeros((nodes, border, dof)),
        corner=np.zeros((border, border)),
        node_side=np.zeros((nodes, dof)),
        border_side=np.zeros(border),
        factors=RingFactors(
            rows=np.zeros((dof, width)),
            panels=np.zeros((nodes, dof, width)),
            squares=np.zeros((nodes, dof, dof)),
            pivots=np.zeros((nodes, dof), dtype=np.int64),
            links=np.zeros((nodes, dof, dof)),
            dense=np.zeros((size, size)),
            dense_pivots=np.zeros(size, dtype=np.int64),
            no_columns=np.zeros((size, 0)),
            answer=np.zeros(size),
        ),
    )


@kernel
def clear(matrix: RingMatrix, whole: bool) -> None:
    """Set the right-hand side to zero, and on request the whole matrix."""
    matrix.node_side[:] = 0.0
    matrix.border_side[:] = 0.0
    if whole:
        matrix.diagonal[:] = 0.0
        matrix.upper[:] = 0.0
        matrix.lower[:] = 0.0
        matrix.column[:] = 0.0
        matrix.row[:] = 0.0
        matrix.corner[:] = 0.0


@kernel(inline=True)
def hold_at_end(matrix: RingMatrix, node: int, c: int) -> None:
    """Let coordinate c of the first or the last node of an open belt stay, and no other equation depend on it."""
    matrix.diagonal[node, c, :] = 0.0
    matrix.diagonal[node, :, c] = 0.0
    matrix.diagonal[node, c, c] = 1.0
    if node == 0:
        matrix.upper[node, c, :] = 0.0
        matrix.lower[node, :, c] = 0.0
    else:
        matrix.lower[node - 1, c, :] = 0.0
        matrix.upper[node - 1, :, c] = 0.0
    matrix.column[node, c, :] = 0.0
    matrix.row[node, :, c] = 0.0


def entries(matrix: RingMatrix) -> FloatArray:
    """Entries of all blocks, one block after another, in the order of `places`."""
    blocks = (matrix.diagonal, matrix.upper, matrix.lower, matrix.column, matrix.row, matrix.corner)
    return np.concatenate([block.ravel() for block in blocks])


def places(matrix: RingMatrix) -> tuple[IntArray, IntArray]:
    """Rows and columns of the entries among the n N + m unknowns; entries of equal place add up."""
    nodes, border = len(matrix.diagonal), len(matrix.corner)
    dof = len(matrix.unknowns)
    own = np.arange(dof * nodes).reshape(nodes, dof)
    after, extra = np.roll(own, -1, axis=0), dof * nodes + np.arange(border)
    blocks = ((own, own), (own, after), (after, own), (own, extra), (extra, own), (extra, extra))
    pairs = [np.broadcast_arrays(rows[..., :, None], columns[..., None, :]) for rows, columns in blocks]
    rows, columns = (np.concatenate([pair[axis].ravel() for pair in pairs]) for axis in (0, 1))
    return rows, columns


@kernel
def solve_ring(matrix: RingMatrix, closed: bool, node_part: FloatArray, border_part: FloatArray) -> bool:
    """Factorize a matrix and solve for its right-hand side; see `factorise_ring` and `substitute`.

    Returns false if the matrix is singular to working precision; there is no solution then.
    """
    if not factorise_ring(matrix, closed):
        return False
    substitute(matrix, closed, node_part, border_part)
    return True


@kernel
def factorise_ring(matrix: RingMatrix, closed: bool) -> bool:
    """Factorize a matrix, whose entries are kept as they are.

    `matrix`: its factors are overwritten; `closed`: whether `upper` and `lower` of the last node couple it to the
    first. Returns false if a pivot vanished (singular to working precision); the factors are then meaningless.
    """
    dof, nodes, extra = len(matrix.unknowns), matrix.diagonal.shape[0], matrix.corner.shape[0]
    cut, inner = (dof, nodes - 1) if closed else (0, nodes)
    rows, panels, squares, pivots, links, dense, dense_pivots, no_columns, _ = matrix.factors
    for k in range(inner):
        _load_node(matrix, k, closed, inner, rows)
        if k > 0:
            subtract_product(dof, matrix.lower[k - 1], panels[k - 1], rows)
        _split(dof, rows, matrix.upper[k], k < inner - 1, squares[k], panels[k])
        if not eliminate(squares[k], pivots[k], panels[k], dof):
            return False
    for k in range(inner - 2, -1, -1):
        for i in range(dof):
            for j in range(dof):
                links[k, i, j] = panels[k, i, j]
        subtract_product(dof, links[k], panels[k + 1], panels[k])
        panels[k, :, :dof] = 0.0  # so that the next product, over whole rows, leaves these columns alone
    _load_border(matrix, closed, dense)
    if closed:
        for i in range(dof):
            _reduce(dof, matrix.upper[inner, i], panels[0], cut + extra, dense[i])
            _reduce(dof, matrix.lower[inner - 1, i], panels[inner - 1], cut + extra, dense[i])
    for k in range(inner):
        for i in range(extra):
            _reduce(dof, matrix.row[k, i], panels[k], cut + extra, dense[cut + i])
    return eliminate(dense, dense_pivots, no_columns, cut + extra)


def determinant_sign(matrix: RingMatrix, closed: bool) -> int:
    """Sign of the determinant of a matrix that `factorise_ring` has factorized."""
    dof, inner, factors = len(matrix.unknowns), len(matrix.diagonal) - closed, matrix.factors
    size = dof * closed + len(matrix.corner)
    blocks = (
        (factors.squares[:inner], factors.pivots[:inner]),
        (factors.dense[:size, :size], factors.dense_pivots[:size]),
    )
    sign = 1
    for square, pivots in blocks:
        negative = np.count_nonzero(np.diagonal(square, axis1=-2, axis2=-1) < 0.0)
        exchanged = np.count_nonzero(pivots != np.arange(pivots.shape[-1]))
        sign *= -1 if (negative + exchanged) % 2 else 1
    return sign


@kernel
def substitute(matrix: RingMatrix, closed: bool, node_part: FloatArray, border_part: FloatArray) -> None:
    """Solve for the right-hand side with the factors that are there.

    `matrix`: factorized by `factorise_ring`, since when its blocks between nodes and in the border's rows are the same;
    `closed`: as there; `node_part`: overwritten by the solution, shape (N, n); `border_part`: overwritten by the
    solution, shape (m,).
    """
    dof, nodes, extra = len(matrix.unknowns), matrix.diagonal.shape[0], matrix.corner.shape[0]
    cut, inner = (dof, nodes - 1) if closed else (0, nodes)
    _, panels, squares, pivots, links, dense, dense_pivots, _, answer = matrix.factors
    for k in range(inner):
        for i in range(dof):
            node_part[k, i] = matrix.node_side[k, i]
        if k > 0:
            subtract_image(dof, matrix.lower[k - 1], node_part[k - 1], node_part[k])
        solve_factorised(squares[k], pivots[k], dof, node_part[k])
    for k in range(inner - 2, -1, -1):
        subtract_image(dof, links[k], node_part[k + 1], node_part[k])
    if closed:
        for i in range(dof):
            answer[i] = matrix.node_side[inner, i]
        subtract_image(dof, matrix.upper[inner], node_part[0], answer)
        subtract_image(dof, matrix.lower[inner - 1], node_part[inner - 1], answer)
    for i in range(extra):
        answer[cut + i] = matrix.border_side[i]
        for k in range(inner):
            for j in range(dof):
                answer[cut + i] -= matrix.row[k, i, j] * node_part[k, j]
    solve_factorised(dense, dense_pivots, cut + extra, answer)
    for i in range(extra):
        border_part[i] = answer[cut + i]
    for i in range(cut):
        node_part[inner, i] = answer[i]
    for k in range(inner):
        for i in range(dof):
            total = node_part[k, i]
            for j in range(cut + extra):
                total -= panels[k, i, dof + j] * answer[j]
            node_part[k, i] = total


@kernel(inline=True)
def _load_node(matrix: RingMatrix, k: int, closed: bool, inner: int, rows: FloatArray) -> None:
    """Rows of node k: [diagonal block | columns of the border]."""
    dof, extra = len(matrix.unknowns), matrix.corner.shape[0]
    start = 2 * dof if closed else dof
    for i in range(dof):
        for j in range(dof):
            rows[i, j] = matrix.diagonal[k, i, j]
        for j in range(extra):
            rows[i, start + j] = matrix.column[k, i, j]
        if closed:
            for j in range(dof):
                rows[i, dof + j] = 0.0
                if k == 0:
                    rows[i, dof + j] += matrix.lower[inner, i, j]
                if k == inner - 1:
                    rows[i, dof + j] += matrix.upper[k, i, j]


@kernel(inline=True)
def _load_border(matrix: RingMatrix, closed: bool, dense: FloatArray) -> None:
    """The border with itself: the last node of a closed ring, then the given border."""
    dof, extra = len(matrix.unknowns), matrix.corner.shape[0]
    cut = dof if closed else 0
    for i in range(extra):
        for j in range(extra):
            dense[cut + i, cut + j] = matrix.corner[i, j]
    if closed:
        last = matrix.diagonal.shape[0] - 1
        for i in range(dof):
            for j in range(dof):
                dense[i, j] = matrix.diagonal[last, i, j]
            for j in range(extra):
                dense[i, dof + j] = matrix.column[last, i, j]
                dense[dof + j, i] = matrix.row[last, j, i]


@kernel(inline=True)
def _split(dof: int, rows: FloatArray, upper: FloatArray, coupled: bool, square: FloatArray, panel: FloatArray) -> None:
    """Block of a node, and its panel: [block towards the next node | columns of the border]."""
    for i in range(dof):
        for j in range(panel.shape[1]):
            panel[i, j] = rows[i, j]
        for j in range(dof):
            square[i, j] = rows[i, j]
            panel[i, j] = upper[i, j] if coupled else 0.0


@kernel(inline=True)
def _reduce(dof: int, coupling: FloatArray, panel: FloatArray, border: int, row: FloatArray) -> None:
    """Put the answers of the inner nodes into an equation of the border that couples to a node."""
    for k in range(dof):
        factor = coupling[k]
        if factor != 0.0:
            for j in range(border):
                row[j] -= factor * panel[k, dof + j]

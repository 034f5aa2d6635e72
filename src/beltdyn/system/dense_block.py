"""Linear algebra of the small dense blocks that the belt's equations are made of."""

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel


@kernel(inline=True)
def eliminate(square: FloatArray, pivots: IntArray, panel: FloatArray, size: int) -> bool:
    """Overwrite panel by square^-1 panel, with partial pivoting, and square by its factors; False if a pivot vanishes.

    The factors are P^-1 L U with ones on the diagonal of U, and the inverse of L's diagonal in its place.

    Parameters
    ----------
    square : ndarray, shape (size, size)
        Overwritten.
    pivots : ndarray of int, shape (size,)
        Overwritten.
    panel : ndarray, shape (size, any)
        Overwritten.
    size
        Number of rows.
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

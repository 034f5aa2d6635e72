"""Search in a table."""

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel


@kernel
def first_above(numbers: FloatArray, first: int, end: int, value: float) -> int:
    """Index of the first of ascending numbers above a value.

    Parameters
    ----------
    numbers : ndarray, shape (n,)
        Numbers.
    first, end
        Places of the first number to be looked at, and behind the last.
    value
        The value.

    Returns
    -------
    int
        The place, `end` where none is above.
    """
    while first < end:
        middle = (first + end) // 2
        if numbers[middle] > value:
            end = middle
        else:
            first = middle + 1
    return first

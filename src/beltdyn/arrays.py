"""Types of arrays, and tables of rows with named fields: one argument of compiled code in place of one for every array.

In kernels `table[k].name` is a number or an array of fixed shape, and a row alone is passed as one pointer.
"""

from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]
"""Numbers in double precision."""

IntArray = NDArray[np.integer[Any]]
"""Whole numbers: counts, indices, kinds."""

BoolArray = NDArray[np.bool_]
"""Yes or no, one by one."""

ComplexArray = NDArray[np.complex128]
"""Complex numbers in double precision."""

# Tables of rows with named fields

Records = np.recarray[Any, Any]
"""Rows of one kind: `table.name` is a column, `table[k].name` a value."""


@cache
def record(**fields: str | np.dtype[np.void]) -> np.dtype[np.void]:
    """Kind of the rows of a table."""
    return np.dtype(list(fields.items()), align=True)


def records(kind: np.dtype[np.void], /, **columns: ArrayLike) -> Records:
    """Make a table of rows of a kind; fields that are not given are zero."""
    table: Records = np.zeros(len(np.asarray(next(iter(columns.values())))), kind).view(np.recarray)
    for name, values in columns.items():
        table[name] = values
    return table


def row(kind: np.dtype[np.void], /, **values: Any) -> np.record:
    """Make one row of a kind; fields that are not given are zero."""
    made = blank(kind)
    fill(made, values)
    return made


def fill(given: np.record, values: Mapping[str, Any]) -> None:
    """Set fields of a row."""
    for name, value in values.items():
        if isinstance(value, Mapping):
            fill(given[name], value)
        else:
            given[name] = value


def blank(kind: np.dtype[np.void]) -> np.record:
    """Make one row of a kind, of zeros."""
    row: np.record = np.zeros(1, kind).view(np.recarray)[0]
    return row


def offsets(counts: Iterable[int]) -> IntArray:
    """Where groups of rows begin that are laid end to end, and where the last one ends."""
    return np.cumsum([0, *counts]).astype(np.int64)


def as_values(row: np.record) -> dict[str, Any]:
    """The fields of a row, with inner rows as mappings, for `fill`."""
    names = row.dtype.names or ()
    return {name: as_values(row[name]) if isinstance(row[name], np.record) else row[name] for name in names}

"""Rows with named fields, rows within them, and groups laid end to end."""

import numpy as np

from beltdyn.arrays import fill, offsets, record, records, row

INNER = record(stiffness="f8", ends="2f8")
OUTER = record(number="i8", inner=INNER)


def test_a_row_within_a_row_is_filled_by_a_mapping() -> None:
    made = row(OUTER, number=3, inner={"stiffness": 2.5})
    assert (made.number, made.inner.stiffness, made.inner.ends.tolist()) == (3, 2.5, [0.0, 0.0])


def test_filling_a_row_of_a_table_changes_the_table() -> None:
    table = records(OUTER, number=[1, 2])
    fill(table[1], {"inner": {"ends": (0.5, 0.7)}})
    assert table.number.tolist() == [1, 2]
    np.testing.assert_array_equal(table.inner.ends, [[0.0, 0.0], [0.5, 0.7]])


def test_groups_begin_where_the_ones_before_end() -> None:
    assert offsets([2, 0, 3]).tolist() == [0, 2, 2, 5]
    assert offsets([]).tolist() == [0]


def test_a_kind_is_made_once() -> None:
    """Reading the types of its fields takes NumPy longer than making a row."""
    assert record(stiffness="f8", ends="2f8") is INNER

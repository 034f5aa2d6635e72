"""Tables of a sheet, and those of several results in columns beside each other."""

import pytest

from beltdyn.show.tables import Table, facts_beside, side_by_side


@pytest.mark.parametrize(
    ("column", "words"), [(0, True), (1, False), (2, True), (3, False)], ids=["names", "numbers", "words", "signs"]
)
def test_columns_of_words_are_told_from_those_of_numbers(column: int, words: bool) -> None:
    rows = (("crank", "12.0", "arm of tensioner", "-3.5"), ("fan", "–", "–", "> 100"))
    assert Table("", ("", "a", "b", "c"), rows).has_words(column) is words


def test_a_table_wider_than_a_page_is_divided() -> None:
    """Into blocks of columns with the names in front, each as wide as allowed; none is lost."""
    headings = ("", *(f"quantity {number}\nmm" for number in range(12)))
    rows = tuple((f"pulley {row}", *(f"{row}.{number}" for number in range(12))) for row in range(3))
    table = Table("Pulleys", headings, rows)
    blocks = list(table.blocks(60))
    assert len(blocks) > 1
    assert all(sum(one.column_widths) <= 60 for one in blocks)
    assert [heading for one in blocks for heading in one.headings[1:]] == list(headings[1:])
    for number, row in enumerate(rows):
        assert [one.rows[number][0] for one in blocks] == [row[0]] * len(blocks)
        assert [cell for one in blocks for cell in one.rows[number][1:]] == list(row[1:])
    assert list(table.blocks(1000)) == [table]
    assert [len(one.headings) for one in table.blocks(1)] == [2] * 12  # a column at least


def test_columns_that_differ_stand_beside_each_other() -> None:
    """With the letter of their result; those that are the same stand once, and what has no match stays apart."""
    first = Table("Pulleys (means from 1 s)", ("", "rpm", "hub\nN"), (("crank", "800", "10"), ("fan", "900", "20")))
    second = Table("Pulleys (means from 2 s)", ("", "rpm", "hub\nN"), (("crank", "800", "11"), ("fan", "900", "21")))
    alone = Table("Teeth", ("", "load"), (("crank", "1"),))
    (together,), rest = side_by_side([[first], [alone, second]], ["A", "B"])
    assert together == Table(
        "Pulleys", ("", "rpm", "hub\nN\nA", "hub\nN\nB"), (("crank", "800", "10", "11"), ("fan", "900", "20", "21"))
    )
    assert rest == [[], [alone]]


def test_tables_of_other_rows_stay_apart() -> None:
    first, second = (Table("Pulleys", ("", "rpm"), ((name, "800"),)) for name in ("crank", "motor"))
    assert side_by_side([[first], [second]], ["A", "B"]) == ([], [[first], [second]])


def test_facts_have_a_column_for_each_result() -> None:
    table = facts_beside([[("power", "1 W")], [("power", "2 W"), ("jumps", "none")]], ["A", "B"])
    assert table == Table("", ("", "A", "B"), (("power", "1 W", "2 W"), ("jumps", "–", "none")))


def test_columns_can_be_left_out() -> None:
    table = Table("Pulleys", ("", "slip", "rpm"), (("crank", "0.1%", "800"),))
    assert table.without(["slip", "other"]) == Table("Pulleys", ("", "rpm"), (("crank", "800"),))

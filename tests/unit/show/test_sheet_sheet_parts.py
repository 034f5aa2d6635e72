"""Tables of a sheet."""

import pytest

from beltdyn.show.sheet import Table


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

"""Tables of a sheet."""

import pytest

from beltdyn.show.sheet import Table


@pytest.mark.parametrize(
    ("column", "words"), [(0, True), (1, False), (2, True), (3, False)], ids=["names", "numbers", "words", "signs"]
)
def test_columns_of_words_are_told_from_those_of_numbers(column: int, words: bool) -> None:
    rows = (("crank", "12.0", "arm of tensioner", "-3.5"), ("fan", "–", "–", "> 100"))
    assert Table("", ("", "a", "b", "c"), rows).has_words(column) is words

"""Edits of a text in TOML."""

import tomllib
from typing import Any

import pytest

from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

TEXT = """\
# a drive
[belt]
width = "10 mm"  # as delivered

[[pulley]]
name = "driver"
center = [0.0, 0.0]  # the origin
"""


def changed(*edits: Edit) -> tuple[str | None, dict[str, Any]]:
    data = changed_data(tomllib.loads(TEXT), edits)
    return changed_text(TEXT, edits, data), data


@pytest.mark.parametrize(
    ("edit", "before", "after"),
    [
        (Edit("set", ("belt", "width"), "12 mm"), '"10 mm"', '"12 mm"'),
        (Edit("set", ("pulley", 0, "center", 1), -0.2), "[0.0, 0.0]", "[0.0, -0.2]"),
        (Edit("remove", ("pulley", 0, "name")), 'name = "driver"\n', ""),
    ],
)
def test_all_but_one_value_stays(edit: Edit, before: str, after: str) -> None:
    assert changed(edit)[0] == TEXT.replace(before, after)


def test_the_data_given_stay_as_they_are() -> None:
    given = tomllib.loads(TEXT)
    assert changed_data(given, [Edit("insert", ("pulley", 1), {"name": "driven"})])["pulley"][1] == {"name": "driven"}
    assert given == tomllib.loads(TEXT)


def test_groups_are_made_on_the_way_and_written_in_brackets() -> None:
    load = {"kind": "resistance", "constant": 2.0}
    text, data = changed(Edit("insert", ("pulley", 0, "load", 0), load), Edit("set", ("limits", "largest_slip"), 0.01))
    assert text is not None
    assert tomllib.loads(text) == data
    assert "[[pulley.load]]" in text
    assert "\n\n[limits]\n" in text
    assert "# the origin" in text


def test_a_new_key_stands_in_its_group_before_remarks_on_the_next_one() -> None:
    text = TEXT.replace("\n[[pulley]]", "\n# in the order of the belt\n[[pulley]]")
    edit = Edit("set", ("belt", "length"), 2.0)
    written = changed_text(text, [edit], changed_data(tomllib.loads(text), [edit]))
    assert written == text.replace("as delivered\n", "as delivered\nlength = 2.0\n")


def test_a_text_that_would_not_say_the_data_is_not_given() -> None:
    edit = Edit("set", ("belt", "width"), 1.0)
    assert changed_text(TEXT, [edit], {"belt": {"width": 2.0}}) is None
    assert changed_text("no TOML", [edit], {}) is None


def test_a_place_that_is_not_there_is_an_error() -> None:
    with pytest.raises(LookupError):
        changed_data(tomllib.loads(TEXT), [Edit("set", ("pulley", 3, "name"), "a")])

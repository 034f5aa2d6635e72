"""A drive file that is edited: data, comments, undo and redo."""

import random
import tomllib
from importlib.resources import files

import pytest

from beltdyn.app.session import Document
from beltdyn.parts.toml_edits import Edit

EXAMPLES = sorted(one.name for one in files("beltdyn").joinpath("examples").iterdir() if one.name.endswith(".toml"))
NEW = {"name": "new", "center": [0.1, 0.2], "radius": "20 mm", "load": [{"kind": "resistance", "constant": 2.0}]}


def test_comments_stay_where_values_change(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply([Edit("set", ("belt", "installed_tension"), "350 N"), Edit("set", ("pulley", 1, "radius"), "33 mm")])
    assert document.text == alternator_text.replace('"300 N"', '"350 N"').replace('"32 mm"', '"33 mm"')
    assert not document.lost_comments


@pytest.mark.parametrize("name", EXAMPLES)
def test_edits_of_every_example_keep_its_comments_and_say_what_the_data_say(name: str) -> None:
    text = files("beltdyn").joinpath("examples", name).read_text(encoding="utf-8")
    document = Document(text)
    for edit in (
        Edit("insert", ("pulley", 1), NEW),
        Edit("set", ("pulley", 0, "speed"), {"kind": "constant", "value": "3 rpm"}),
        Edit(
            "insert", ("pulley", 1, "load", 1), {"kind": "resistance", "schedule": {"kind": "constant", "value": 1.0}}
        ),
        Edit("set", ("limits", "largest_slip"), 0.01),
        Edit("insert", ("tensioner", 0), {"kind": "fixed", "pulley": "new", "direction": [1.0, 0.0]}),
        Edit("set", ("gravity",), [0.0, -9.81]),
        Edit("remove", ("pulley", 1, "load", 0)),
        Edit("remove", ("pulley", 1)),
    ):
        document.apply([edit])
        assert tomllib.loads(document.text) == document.data
    assert not document.lost_comments
    kept = [line for line in text.splitlines() if line.startswith("#")]
    assert [line for line in kept if line in document.text.splitlines()] == kept


def test_groups_that_are_missing_are_made() -> None:
    document = Document("")
    document.apply([Edit("insert", ("pulley", 0), NEW), Edit("set", ("belt", "profile"), "PK")])
    assert document.data == {"pulley": [NEW], "belt": {"profile": "PK"}}
    assert "[[pulley.load]]" in document.text


def test_what_tomlkit_cannot_change_is_written_anew_and_said() -> None:
    document = Document('# a comment\npulley = [{ name = "a" }]\n')
    document.apply([Edit("insert", ("pulley", 1), {"name": "b", "load": [{"kind": "fan"}]})])
    assert tomllib.loads(document.text) == document.data
    assert document.data["pulley"][1] == {"name": "b", "load": [{"kind": "fan"}]}


def test_undo_and_redo_step_through_the_states(alternator_text: str) -> None:
    document, states = Document(alternator_text), [alternator_text]
    generator = random.Random(7)
    for _ in range(20):
        document.apply([Edit("set", ("pulley", generator.randrange(3), "radius"), generator.random())])
        states.append(document.text)
    for state in reversed(states[:-1]):
        document.undo()
        assert document.text == state
    assert not document.can_undo
    for state in states[1:]:
        document.redo()
        assert document.text == state
    assert not document.can_redo
    document.undo()
    document.apply([Edit("remove", ("pulley", 0, "radius"))])
    assert not document.can_redo


def test_a_preview_and_an_edit_that_changes_nothing_leave_no_state(alternator_text: str) -> None:
    document = Document(alternator_text)
    assert document.preview([Edit("remove", ("pulley", 2))])["pulley"] == document.data["pulley"][:2]
    document.apply([Edit("set", ("belt", "ribs"), 6)])
    assert not document.can_undo
    assert not document.changed


def test_a_place_that_is_not_there_is_an_error_and_changes_nothing(alternator_text: str) -> None:
    document = Document(alternator_text)
    with pytest.raises(LookupError):
        document.apply([Edit("set", ("pulley", 9, "radius"), 1.0)])
    assert document.text == alternator_text

"""A form as rows, and what they change."""

import tomllib

from beltdyn.app.beginnings import edits_of_entry, edits_of_kind
from beltdyn.app.form_view import edits_of_value, rows
from beltdyn.app.session import Document


def test_rows_follow_groups_and_lists(alternator_text: str) -> None:
    data = tomllib.loads(alternator_text)
    found = [(row.what, row.depth, row.location) for row in rows(data, ("pulley", 2), set())]
    assert ("entry", 0, ("pulley", 2, "load", 0)) in found
    assert ("group", 1, ("pulley", 2, "load", 0, "schedule")) in found
    assert ("field", 2, ("pulley", 2, "load", 0, "schedule", "start")) in found
    assert ("add", 0, ("pulley", 2, "load")) in found
    assert found[-1] == ("more", 0, ("pulley", 2))
    more = [row.location for row in rows(data, ("pulley", 2), {("pulley", 2)})]
    assert ("pulley", 2, "friction") in more
    assert ("pulley", 2, "friction") not in [location for _, _, location in found]


def test_another_kind_keeps_what_both_have(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(edits_of_kind(document.data, ("pulley", 0, "speed"), "ramp"))
    assert document.data["pulley"][0]["speed"] == {"kind": "ramp", "start": 0.02, "end": 0.15, "value": "1500 rpm"}
    document.apply(edits_of_kind(document.data, ("pulley", 0, "speed"), "constant"))
    assert document.data["pulley"][0]["speed"] == {"kind": "constant", "value": "1500 rpm"}
    document.apply(edits_of_kind(document.data, ("pulley", 0, "speed"), None))
    assert "speed" not in document.data["pulley"][0]
    assert edits_of_kind(document.data, ("pulley", 0, "speed"), None) == []
    document.apply(edits_of_kind(document.data, ("pulley", 0, "torque"), "step"))
    assert document.data["pulley"][0]["torque"] == {"kind": "step", "time": 0.1, "value": "5 N m"}


def test_entries_are_added_with_and_without_a_kind(alternator_text: str) -> None:
    document = Document(alternator_text)
    document.apply(edits_of_entry(document.data, ("pulley", 2, "load"), "fan"))
    document.apply(edits_of_entry(document.data, ("pulley", 0, "harmonics"), None))
    assert document.data["pulley"][2]["load"][1] == {"kind": "fan", "rated_power": "2 kW", "rated_speed": "1500 rpm"}
    assert document.data["pulley"][0]["harmonics"] == [{"order": 2, "amplitude": 0.01}]


def test_a_value_is_set_left_open_or_the_same(alternator_text: str) -> None:
    document = Document(alternator_text)
    assert edits_of_value(document.data, ("belt", "ribs"), 6) == []
    assert edits_of_value(document.data, ("belt", "width"), None) == []
    document.apply(edits_of_value(document.data, ("pulley", 1, "name"), "arm"))
    assert document.data["tensioner"][0]["pulley"] == "arm"
    document.apply(edits_of_value(document.data, ("belt", "installed_tension"), None))
    assert "installed_tension" not in document.data["belt"]

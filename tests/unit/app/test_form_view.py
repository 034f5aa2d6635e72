"""A form as rows, and what they change."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from beltdyn.app.draft import draft
from beltdyn.app.form_view import edits_of_entry, edits_of_kind, edits_of_profile, edits_of_value, in_use, rows
from beltdyn.app.session import Document
from beltdyn.model import read_catalogue
from beltdyn.parts.toml_edits import changed_data

HERE = Path(__file__).parent
SMOOTH: dict[str, Any] = {
    "belt": {"profile": "PK", "ribs": 6, "installed_tension": 300.0},
    "pulley": [
        {"name": "driver", "center": [0, 0], "radius": 0.075, "speed": 150.0},
        {"name": "driven", "center": [0.4, 0.0], "radius": 0.05, "inertia": 0.003},
    ],
}


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


@pytest.mark.parametrize("profile", [name for name, one in read_catalogue().items() if one.toothing is None])
def test_another_profile_clears_what_does_not_fit(profile: str) -> None:
    """From ribs to any other smooth belt, and back; V-belts and flat belts are about as wide."""
    before = draft(SMOOTH, HERE).drive
    assert before is not None
    data = changed_data(SMOOTH, edits_of_profile(SMOOTH, profile, before))
    found = draft(data, HERE)
    assert found.told == []
    assert found.drive is not None
    again = changed_data(data, edits_of_profile(data, "PK", found.drive))
    assert draft(again, HERE).told == []
    assert again["belt"].keys() == SMOOTH["belt"].keys()
    entry = read_catalogue()[profile]
    if entry.is_v_belt or entry.sold_by == "width":  # ribs remain ribs, and a round belt has its diameter
        assert found.drive.belt.width == pytest.approx(before.belt.width, rel=0.5)


def test_teeth_come_and_go_with_the_profile() -> None:
    smooth = draft(SMOOTH, HERE).drive
    data = changed_data(SMOOTH, edits_of_profile(SMOOTH, "HTD 8M", smooth))
    assert data["belt"] == {"profile": "HTD 8M", "teeth": 150, "width": "20 mm"}
    assert [one["teeth"] for one in data["pulley"]] == [59, 39]
    data["belt"]["teeth"] = 149  # the only message is that 150 would hang slack
    toothed = draft(data, HERE)
    assert toothed.told == []
    back = changed_data(data, edits_of_profile(data, "PK", toothed.drive))
    assert draft(back, HERE).told == []
    assert "teeth" not in back["belt"]
    assert all("teeth" not in one for one in back["pulley"])
    length = changed_data(SMOOTH, edits_of_value(SMOOTH, ("belt", "nominal_length"), "1.234 m"))
    assert "nominal_length" not in changed_data(length, edits_of_profile(length, "SPZ", smooth))["belt"]


def test_empty_fields_show_the_value_in_use() -> None:
    drive = draft(SMOOTH, HERE).drive
    assert drive is not None
    assert in_use(drive, ("belt", "axial_stiffness")) == pytest.approx(120e3)  # of the profile
    assert in_use(drive, ("belt", "length")) == pytest.approx(drive.belt_length)
    assert in_use(drive, ("contact", "stiffness")) == pytest.approx(drive.contact_stiffness)  # chosen
    assert in_use(drive, ("contact", "friction")) == in_use(drive, ("pulley", 1, "friction")) == drive.belt.friction
    assert in_use(drive, ("pulley", 7, "mass")) is None
    assert in_use(None, ("belt", "length")) is None

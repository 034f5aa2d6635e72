"""New items of forms begin with valid numbers."""

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

from beltdyn.app.draft import draft
from beltdyn.app.form_view import edits_of_entry, edits_of_group, edits_of_kind
from beltdyn.app.forms import fields
from beltdyn.model.toml import example_texts
from beltdyn.parts.toml_edits import Edit, Location, changed_data

HERE = Path(__file__).parent
EXAMPLES = {name: tomllib.loads(example_texts()[name]) for name in ("accessory_drive", "unequal_radii", "conveyor")}


def offered(data: Mapping[str, Any], location: Location) -> Iterator[list[Edit]]:
    """Everything that a form offers to add to a group."""
    drive = draft(data, HERE).drive
    for one in fields(data, location):
        if one.form == "groups":
            yield from (edits_of_entry(data, one.location, kind, drive) for kind in one.choices or (None,))
        elif one.form == "group" and one.choices:
            yield from (edits_of_kind(data, one.location, kind, drive) for kind in one.choices)
        elif one.form == "group":
            yield edits_of_group(data, one.location)


@pytest.mark.slow
@pytest.mark.parametrize("name", EXAMPLES)
def test_whatever_is_added_to_a_drive_leaves_it_valid(name: str) -> None:
    data = EXAMPLES[name]
    places: list[Location] = [("pulley", number) for number, _ in enumerate(data["pulley"])]
    count = 0
    for place in [*places, ("belt",), ("contact",), ("limits",), *[("tensioner", 0)] * ("tensioner" in data)]:
        for edits in offered(data, place):
            assert draft(changed_data(data, edits), HERE).told == [], edits
            count += 1
    assert count > 15 * len(places)


def test_a_new_torque_opposes_the_rotation_of_its_pulley() -> None:
    data = EXAMPLES["accessory_drive"]
    drive = draft(data, HERE).drive
    begun = {
        number: edits_of_kind(data, ("pulley", number, "torque"), "constant", drive)[0].value["value"]
        for number in (2, 3)  # the second one on the back of the belt
    }
    assert begun == {2: "-5 N m", 3: "5 N m"}


def test_a_hub_begins_with_the_rim_that_it_needs() -> None:
    """A chain behind a rim needs an inertia of the rim, which a driven pulley without one gets."""
    data = EXAMPLES["accessory_drive"]
    assert "inertia" not in data["pulley"][0]
    edits = edits_of_entry(data, ("pulley", 0, "hub"), "isolator")
    assert [one.location for one in edits] == [("pulley", 0, "hub", 0), ("pulley", 0, "inertia")]
    assert 0.0 < edits[1].value < 1.0


@pytest.mark.parametrize("number", [2, 3], ids=("inside", "back"))
def test_new_loads_act_at_once_and_oppose_their_pulley(number: int) -> None:
    """Whatever its kind, a load that begins with torques takes power; brakes brake at all times."""
    data = EXAMPLES["accessory_drive"]
    drive = draft(data, HERE).drive
    assert drive is not None
    for kind in ("brake", "table", "angle_table", "angle_speed_table", "resistance", "fan", "generator"):
        edits = edits_of_entry(data, ("pulley", number, "load"), kind, drive)
        alone = changed_data(data, [Edit("set", ("pulley", number, "load"), [edits[-1].value])])
        changed = draft(alone, HERE).drive
        assert changed is not None, kind
        powers = changed.belt_loads(changed.driver or 0).powers_drawn(changed.path)[0]
        assert powers[number] > 0.0, kind

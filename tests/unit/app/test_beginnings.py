"""New items of forms begin with valid numbers."""

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.app.beginnings import edits_of_entry, edits_of_group, edits_of_kind
from beltdyn.app.draft import draft
from beltdyn.app.forms import fields
from beltdyn.model import Drive
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


FULL_LOADS = {"fan": 2000.0, "power": 2000.0, "generator": 1000.0 / 0.7}
"""Power at the largest speed of the pulley, W, by the numbers with which these loads begin."""
DRIVING = ("motor", "servo_motor", "induction_motor", "speed_trim")


def begun_loads(data: dict[str, Any]) -> Iterator[tuple[str, int, Drive]]:
    """Each new load alone on each pulley without prescribed speed: kind, number in the file, and the drive."""
    drive = draft(data, HERE).drive
    for number, pulley in enumerate(data["pulley"]):
        if pulley.get("speed") is not None:
            continue
        place: Location = ("pulley", number, "load")
        bare = changed_data(data, [Edit("remove", (*place[:2], key)) for key in ("load", "torque") if key in pulley])
        for kind in next(one for one in fields(bare, place[:2]) if one.key == "load").choices:
            changed = draft(changed_data(bare, edits_of_entry(bare, place, kind, drive)), HERE)
            assert changed.told == [], (kind, pulley["name"])
            assert changed.drive is not None
            yield kind, number, changed.drive


def check_loads(data: dict[str, Any]) -> None:
    """At the largest speed loads draw power, motors drive in the sense of their pulley, and holdbacks let it turn."""
    for kind, number, drive in begun_loads(data):
        if drive.driver is None or data["pulley"][number]["name"] == drive.pulleys[drive.driver].name:
            continue
        place = drive.number_of(data["pulley"][number]["name"])
        pulleys = drive.counter_clockwise_pulleys
        loads = drive.belt_loads(drive.driver)._replace(pulleys=pulleys)
        power = loads.powers_drawn(drive.path)[0][place]
        sense = drive.running_sense * pulleys[place].turning
        if kind in DRIVING:
            assert pulleys[place].load[0].torque_over(np.zeros(1), 0.0)[0] * sense > 0.0, (kind, number)
        elif kind == "holdback":
            assert abs(power) < 1.0, (kind, number)
        else:
            assert power > 0.0, (kind, number)
            assert power == pytest.approx(FULL_LOADS.get(kind, power), rel=1e-2), (kind, number)


def mirrored(data: dict[str, Any]) -> dict[str, Any]:
    """The same drive with clockwise positive, whose driver turns the other way, and its pulleys listed clockwise."""
    return data | {"rotation": "clockwise", "pulley": [data["pulley"][0], *data["pulley"][:0:-1]]}


def test_new_loads_act_as_their_kind_says() -> None:
    data = EXAMPLES["accessory_drive"]
    check_loads(data)
    check_loads(mirrored(data))


@pytest.mark.slow
@pytest.mark.parametrize("name", list(example_texts()))
def test_new_loads_of_all_examples_act_as_their_kind_says(name: str) -> None:
    check_loads(tomllib.loads(example_texts()[name]))


@pytest.mark.parametrize("duration", [0.1, 2.0])
def test_new_profiles_act_within_the_run(duration: float) -> None:
    """A step at 0.1 s would do nothing in a run of 0.1 s."""
    data = EXAMPLES["accessory_drive"] | {"simulation": {"duration": duration}}
    drive, place = draft(data, HERE).drive, ("pulley", 2, "torque")
    for kind in next(one for one in fields(data, place[:2]) if one.key == "torque").choices:
        changed = draft(changed_data(data, edits_of_kind(data, place, kind, drive)), HERE)
        assert changed.drive is not None, (kind, changed.told)
        profile = changed.drive.pulleys[changed.drive.number_of("steering")].torque
        assert profile is not None
        assert profile.at([0.6 * duration]) < 0.0, kind

"""Empty fields show what holds: of the profile, chosen, or solved for."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from beltdyn.app.draft import draft
from beltdyn.app.values_in_use import in_use
from beltdyn.model.toml import example_texts

HERE = Path(__file__).parent
TWO: dict[str, Any] = {
    "belt": {"profile": "PK", "ribs": 6, "installed_tension": 300.0},
    "pulley": [
        {"name": "driver", "center": [0, 0], "radius": 0.075, "speed": 150.0},
        {"name": "driven", "center": [0.4, 0.0], "radius": 0.05, "inertia": 0.003},
    ],
}


def test_values_of_the_profile_and_chosen_ones() -> None:
    drive = draft(TWO, HERE).drive
    assert drive is not None
    assert in_use(drive, TWO, ("belt", "axial_stiffness")) == pytest.approx(120e3)  # of the profile
    assert in_use(drive, TWO, ("belt", "length")) == pytest.approx(drive.belt_length)
    assert in_use(drive, TWO, ("belt", "discretization")) == drive.element_kind.name
    assert in_use(drive, TWO, ("contact", "stiffness")) == pytest.approx(drive.contact_stiffness)  # chosen
    assert in_use(drive, TWO, ("contact", "friction")) == drive.belt.friction
    assert in_use(drive, TWO, ("pulley", 1, "friction")) == drive.belt.friction
    assert in_use(drive, TWO, ("simulation", "frame")) == drive.frame.name
    assert in_use(drive, TWO, ("pulley", 7, "mass")) is None
    assert in_use(None, TWO, ("belt", "length")) is None


def test_what_a_length_or_a_tensioner_leaves_is_solved_for() -> None:
    given = TWO | {"belt": {"profile": "PK", "ribs": 6, "length": 1.19}}
    drive = draft(given, HERE).drive
    assert drive is not None
    tension = in_use(drive, given, ("belt", "installed_tension"))
    assert tension == pytest.approx((drive.path.length / 1.19 - 1.0) * 120e3, rel=0.1)
    axis = tomllib.loads(example_texts()["servo_axis"])
    drive = draft(axis, HERE).drive
    assert drive is not None
    moved = in_use(drive, axis, ("tensioner", 0, "take_up"))
    assert moved != 0.0
    assert drive.centers[0][0] == pytest.approx(-moved)  # away from the table, along the direction


def test_pulleys_are_those_of_the_file_in_either_order() -> None:
    """A drive has its pulleys counter-clockwise."""
    data = tomllib.loads(example_texts()["accessory_drive"])
    clockwise = data | {"pulley": [data["pulley"][0], *data["pulley"][:0:-1]]}
    drive = draft(clockwise, HERE).drive
    assert drive is not None
    assert drive.pulleys[1].name != clockwise["pulley"][1]["name"]
    for number, pulley in enumerate(clockwise["pulley"]):
        assert in_use(drive, clockwise, ("pulley", number, "diameter")) == pytest.approx(
            2.0 * drive.pulleys[drive.number_of(pulley["name"])].radius
        )

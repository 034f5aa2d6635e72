"""Numbers deep inside a drive are changed by their paths, and their tolerances are those an engineer writes."""

import math
import pickle
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, alignment, loads, read_catalogue
from beltdyn.model.toml import dumps, edited
from beltdyn.parts.change import converted, tolerances_of, unit_at, value_at
from validation.published.cases import demo_text

MOTOR = """
[[pulley.load]]
kind = "resistance"
constant = 1.0
[[pulley.load]]
kind = "resistance"
constant = 2.0

[[tensioner]]
kind = "sliding"
pulley = "driven"
direction = [1.0, 0.0]
mass = 0.1
preload = 60.0
"""


@pytest.fixture
def loaded(drive_text: str) -> Drive:
    """The two-pulley drive with two loads on a driven pulley that a tensioner carries."""
    before, contact, after = drive_text.partition("[contact]")
    return loads(f"{before}{MOTOR}{contact}{after}")


@pytest.mark.parametrize(
    ("path", "value", "found"),
    [
        ("belt.width", "12 mm", lambda drive: drive.belt.width == 0.012),
        ("pulley[driven].inertia", 0.2, lambda drive: drive.pulleys[1].inertia == 0.2),
        ("pulley[2].inertia", 0.2, lambda drive: drive.pulleys[1].inertia == 0.2),
        ("pulley.driven.inertia", 0.2, lambda drive: drive.pulleys[1].inertia == 0.2),
        ("pulley[driven].load[2].constant", "5 N*m", lambda drive: drive.pulleys[1].load[1].constant == 5.0),
        (
            "pulley[driver].speed.value",
            "120 rpm",
            lambda drive: drive.pulleys[0].speed.value == pytest.approx(12.566, 1e-4),
        ),
        ("pulley[driver].center[2]", "1 mm", lambda drive: drive.pulleys[0].center[1] == 0.001),
        ("tensioner[driven].preload", "0.07 kN", lambda drive: drive.tensioners[0].preload == 70.0),
        ("contact.friction", 0.9, lambda drive: drive.contact.friction == 0.9),
        ("simulation", {"duration": 2.0, "output_interval": 0.1}, lambda drive: drive.simulation.duration == 2.0),
        ("pulley[driven].torque", None, lambda drive: drive.pulleys[1].torque is None),
    ],
)
def test_one_number_changes_and_all_else_stays(loaded: Drive, path: str, value: Any, found: Any) -> None:
    changed = loaded.with_({path: value})
    assert found(changed)
    assert not found(loaded) or value is None
    assert loaded.with_({}) == loaded
    assert changed.with_({"gravity": (0.0, -9.81)}) != changed


def test_changes_are_made_all_at_once(drive: Drive) -> None:
    """Pulleys of twice the radius overlap until they are moved apart, and need another belt."""
    wider = {"pulley[driver].radius": 0.2, "pulley[driver].center": (-0.4, 0.0)}
    changed = drive.with_(wider | {"belt.installed_tension": "40 N", "pulley[driven].center[1]": 0.3})
    assert (changed.pulleys[0].radius, changed.pulleys[1].center) == (0.2, (0.3, 0.0))
    assert (changed.belt.length, changed.belt.installed_tension) == (None, 40.0)


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        ("belt.lenght", 1.0, 'belt.lenght is not a known key. Did you mean "length"?'),
        ("bolt.length", 1.0, 'bolt is not a known key. Did you mean "belt"?'),
        ("pulley[drvien].inertia", 1.0, 'pulley[drvien] does not exist. Did you mean "driven"?'),
        ("pulley[0].inertia", 1.0, "pulley[0] does not exist; entries count from 1. Choose one of driver, driven."),
        ("pulley[driven].load[3].constant", 1.0, "pulley[driven].load[3] does not exist; entries count from 1."),
        ("pulley[driven].inertia", -1.0, "pulley[driven].inertia = -1.0 must be at least 0."),
        ("pulley[driven].load[2].constant", "5 N", 'pulley[driven].load[2].constant = "5 N" must be in units of N*m'),
        ("tensioner[driven].preload", "5 m", 'tensioner[driven].preload = "5 m" must be in units of N'),
        ("pulley[driven].speed.value", 1.0, "pulley[driven].speed is not given, so nothing inside it can be changed"),
        ("belt.length.unit", 1.0, "belt.length = 1.2727 has no part .unit."),
        ("belt.", 1.0, '"belt." is not a path. Write for example "belt.length"'),
        ("", 1.0, '"" is not a path.'),
        (5, 1.0, '"5" is not a path.'),
    ],
)
def test_a_path_that_leads_nowhere_is_said(loaded: Drive, path: Any, value: Any, said: str) -> None:
    with pytest.raises(ModelError) as caught:
        loaded.with_({path: value})
    assert str(caught.value).startswith(said)


def test_changes_are_a_mapping(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"changes = \[1\] must be a mapping"):
        drive.with_([1])  # type: ignore[arg-type]


def test_a_part_is_not_changed_twice(drive: Drive) -> None:
    with pytest.raises(ModelError, match="belt is changed both as a whole and in parts"):
        drive.with_({"belt": drive.belt, "belt.length": 1.27})


def test_a_belt_takes_the_form_of_the_change(drive: Drive) -> None:
    """Its stiffnesses stay but for the one that changes; a profile brings a section of its own."""
    belt = drive.belt
    stiffer = drive.with_({"belt.axial_stiffness": "20 kN"}).belt
    assert stiffer.axial_stiffness == pytest.approx(2e4)
    assert stiffer.bending_stiffness == pytest.approx(belt.bending_stiffness)
    assert stiffer.mass_per_length == pytest.approx(belt.mass_per_length)
    assert (stiffer.width, stiffer.thickness, stiffer.length) == (belt.width, belt.thickness, belt.length)
    sold = drive.with_({"belt.profile": "PK", "belt.ribs": 6, "belt.installed_tension": "300 N"}).belt
    entry = read_catalogue()["PK"]
    assert (sold.thickness, sold.mass_per_length) == pytest.approx((entry.thickness, 6 * entry.mass_per_length))
    assert sold.axial_stiffness == pytest.approx(6 * entry.axial_stiffness)
    with pytest.raises(ModelError, match=r"belt\.profile is missing"):
        drive.with_({"belt.ribs": 6})


@pytest.mark.parametrize(
    ("path", "value", "unit"),
    [
        ("belt.width", 0.01, "m"),
        ("pulley[driven].center[1]", 0.191441, "m"),
        ("pulley[driven].load[2].constant", 2.0, "N*m"),
        ("tensioner[driven].preload", 60.0, "N"),
        ("contact.friction", None, ""),
    ],
)
def test_what_stands_at_a_path(loaded: Drive, path: str, value: float | None, unit: str) -> None:
    assert unit_at(loaded, path) == unit
    assert value is None or value_at(loaded, path) == value


def test_a_value_with_a_unit_is_converted(loaded: Drive) -> None:
    assert converted(loaded, "pulley[driven].center[1]", "25 mm") == 0.025
    with pytest.raises(ModelError, match="must be in units of m"):
        converted(loaded, "belt.width", "2 kg")
    with pytest.raises(ModelError, match="must be greater than 0"):
        converted(loaded, "belt.width", -1.0)


@pytest.mark.parametrize("path", ["belt.widht", "pulley[idler].radius", "belt.width.more"])
def test_nothing_stands_at_a_wrong_path(loaded: Drive, path: str) -> None:
    with pytest.raises(ModelError):
        value_at(loaded, path)


def test_a_name_has_no_unit(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="is not a number"):
        unit_at(loaded, "pulley[driven].name")


def with_radius(text: str) -> str:
    given, at = demo_text(), "radius = 0.08125"
    assert at in given
    return given.replace(at, f"radius = {text}", 1)


@pytest.mark.parametrize(
    ("text", "tolerance"),
    [
        ('"81.25 ± 0.1 mm"', 1e-4),
        ('"81.25 +- 0.1 mm"', 1e-4),
        ('"81.25+/-0.1mm"', 1e-4),
        ('"81.25 mm ± 2 %"', 0.02 * 0.08125),
        ('"81.25 mm +- .5%"', 0.005 * 0.08125),
    ],
)
def test_tolerances_have_the_unit_of_the_number(text: str, tolerance: float) -> None:
    drive = loads(with_radius(text))
    assert drive.pulleys[0].radius == pytest.approx(0.08125)
    assert tolerances_of(drive) == {"pulley[driver].radius": pytest.approx(tolerance)}


def test_they_go_with_the_text_of_the_drive() -> None:
    """Results keep that text, and files that are written with other numbers keep the tolerance."""
    drive = loads(with_radius('"81.25 ± 0.1 mm"'))
    again = pickle.loads(pickle.dumps(drive))
    assert tolerances_of(again) == tolerances_of(drive)
    changed = edited(drive, {"pulley[driver].radius": 0.082})
    assert '"82 ± 0.1 mm"' in changed
    assert tolerances_of(loads(changed)) == tolerances_of(drive)


@pytest.mark.parametrize(
    "text", ['"81.25 ± mm"', '"81.25 ± 0 mm"', '"81.25 ± 0.1 ± 0.2 mm"', '"81.25 ± -0.1 mm"', '"± 1 mm"']
)
def test_what_is_no_tolerance_is_refused(text: str) -> None:
    with pytest.raises(ModelError, match=r"driver.*(an unreadable tolerance|must be a number)"):
        loads(with_radius(text))


def test_drives_made_in_python_keep_them() -> None:
    """Through parts, copies with other values changed, and files; not where the number itself is given anew."""
    drive, width, tilt = loads(demo_text()), "belt.width", "pulley[driven].tilt[1]"
    made = drive.with_({width: "10 ± 0.2 mm", "pulley[driven].tilt": ["0 ± 0.1 deg", "0.2 deg"]})
    expected = pytest.approx({width: 2e-4, tilt: math.radians(0.1)}, rel=1e-9)
    assert tolerances_of(made) == expected
    copies = [made.with_({"belt.elements": 40}), made.replace(name="copy"), pickle.loads(pickle.dumps(made))]
    assert all(tolerances_of(one) == expected for one in [*copies, loads(dumps(made)), loads(made.text)])
    assert tolerances_of(made.with_({width: 0.011})).keys() == {tilt}
    belt = drive.belt.replace(width="10 ± 0.2 mm").replace(elements=40)
    assert tolerances_of(drive.replace(belt=belt)) == {width: pytest.approx(2e-4)}
    assert tolerances_of(made.replace(belt=drive.belt)).keys() == {tilt}
    assert belt.replace(width="10 mm").toleranced == {}


def test_alignment_in_python_is_that_of_the_file() -> None:
    text = demo_text().replace('name = "driven"', 'name = "driven"\naxial_offset = "1 ± 0.5 mm"', 1)
    plain = loads(demo_text()).with_({"pulley[driven].axial_offset": "1 ± 0.5 mm"})
    np.testing.assert_array_equal(alignment(plain).worst, alignment(loads(text)).worst)
    assert np.all(alignment(plain).worst > np.abs(alignment(plain).angles))

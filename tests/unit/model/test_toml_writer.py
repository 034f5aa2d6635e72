"""A drive that is written is the same when it is read again."""

import tomllib
from importlib.resources import files

import pytest

from beltdyn.designs.sensitivity import numbers_of
from beltdyn.model import Drive, dumps, loads
from beltdyn.model.toml import edited, spelled_out
from beltdyn.parts.change import tolerances_of, unit_at

EXAMPLES = sorted(path.name for path in files("beltdyn").joinpath("examples").iterdir() if path.name.endswith(".toml"))


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_comes_back(name: str) -> None:
    text = files("beltdyn").joinpath("examples", name).read_text(encoding="utf-8")
    drive = loads(text)
    written = dumps(drive)
    assert loads(written) == drive
    assert dumps(loads(written)) == written


def test_numbers_are_in_si_units_and_defaults_are_spelled_out(drive: Drive) -> None:
    data = tomllib.loads(dumps(drive))
    assert data["belt"]["width"] == drive.belt.width
    assert data["simulation"]["integrator"] == "generalized_alpha"
    assert [pulley["radius"] for pulley in data["pulley"]] == [pulley.radius for pulley in drive.pulleys]


@pytest.mark.parametrize("name", EXAMPLES)
def test_tolerances_come_back(name: str) -> None:
    """Of all numbers of all examples at once."""
    given = loads(files("beltdyn").joinpath("examples", name).read_text(encoding="utf-8"))
    numbers = [one for one in numbers_of(given) if unit_at(given, one.path) is not None]
    expected = {one.path: float(f"{abs(one.value) / 64.0 + 1e-6:.6g}") for one in numbers}
    written = spelled_out(given, expected)
    drive = loads(written)
    assert drive == given
    assert tolerances_of(drive) == pytest.approx(expected, rel=1e-9)
    assert dumps(drive) == written


def test_a_tolerance_of_a_diameter_is_that_of_the_radius(drive: Drive) -> None:
    """The drive has the radius, and is written with it."""
    changed = drive.text.replace("radius = 0.08125", 'diameter = "162.5 ± 0.2 mm"', 1)
    assert changed != drive.text
    given = loads(changed)
    assert tolerances_of(given) == {"pulley[driver].radius": pytest.approx(1e-4)}
    again = loads(dumps(given))
    assert again == given
    assert tolerances_of(again) == pytest.approx(tolerances_of(given))


def test_changed_drives_that_are_spelled_out_keep_tolerances(drive: Drive) -> None:
    """The text has no radius to be changed."""
    given = loads(drive.text.replace("radius = 0.08125", 'diameter = "162.5 ± 0.2 mm"', 1))
    changed = loads(edited(given, {"pulley[driver].radius": 0.082}))
    assert changed.pulleys[0].radius == 0.082
    assert tolerances_of(changed) == pytest.approx(tolerances_of(given))

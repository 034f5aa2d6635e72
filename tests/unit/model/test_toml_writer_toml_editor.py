"""Numbers changed in the text of a drive file."""

from importlib.resources import files

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, loads
from beltdyn.model.toml import edited


def test_the_rest_stays_as_its_author_wrote_it(drive: Drive, drive_text: str) -> None:
    text = edited(drive, {"pulley[driven].inertia": 0.5})
    lines, before = text.splitlines(), drive_text.splitlines()
    assert len(lines) == len(before)
    assert sum(one != other for one, other in zip(lines, before, strict=True)) == 1
    assert loads(text) == drive.with_({"pulley[driven].inertia": 0.5})


@pytest.mark.parametrize(
    ("given", "path", "value", "written"),
    [
        ('width = "10 mm"', "belt.width", 0.0123, 'width = "12.3 mm"'),
        ("radius = 0.08125", "pulley[driver].radius", 0.082, "radius = 0.082"),
        ('radius = "81.25 mm"', "pulley[2].radius", 0.082, 'radius = "82 mm"'),
    ],
)
def test_units_and_lists(drive_text: str, given: str, path: str, value: float, written: str) -> None:
    lines = [given if line.startswith(given.split(" = ")[0]) else line for line in drive_text.splitlines()]
    text = edited(loads("\n".join(lines)), {path: value})
    assert written in text
    assert loads(text) == loads("\n".join(lines)).with_({path: value})


def test_entries_of_lists(drive: Drive) -> None:
    text = edited(drive, {"pulley[driver].center[1]": -0.2, "pulley[2].center[2]": 1e-3})
    assert "center = [-0.2, 0.0]" in text
    assert "center = [0.191441, 0.001]" in text


def test_what_the_text_does_not_say_is_spelled_out(drive: Drive) -> None:
    """A width that a default gives stands nowhere in the text."""
    text = edited(drive, {"gravity[2]": -9.81})
    assert loads(text) == drive.with_({"gravity[2]": -9.81})


@pytest.mark.parametrize("path", ["belt.axial_stiffness", "belt.bending_stiffness", "belt.stretch_damping_time"])
def test_what_a_profile_gave_is_said_beside_it(path: str) -> None:
    """One line more, at the end of its group: the belt stays that of its profile."""
    given = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    drive, key = loads(given), path.split(".")[1]
    value = 1.07 * getattr(drive.belt, key)
    text, before = edited(drive, {path: value}).splitlines(), given.splitlines()
    place = next(number for number, line in enumerate(before) if line.startswith("installed_tension")) + 1
    assert text == [*before[:place], f"{key} = {float(f'{value:.10g}')}", *before[place:]]
    assert getattr(loads("\n".join(text)).belt, key) == pytest.approx(value)


def test_a_wrong_path(drive: Drive) -> None:
    with pytest.raises(ModelError, match="width"):
        edited(drive, {"belt.widht": 1.0})

"""Belts of a profile stay such when something of them is changed."""

from math import pi
from pathlib import Path
from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, read_catalogue
from beltdyn.parts.change import converted, value_at

PK = {"profile": "PK", "ribs": 6, "installed_tension": 300.0}
FLAT = {"profile": "flat-polyamide", "width": 0.05, "installed_tension": 300.0}


def drive_with(drive: Drive, **belt: Any) -> Drive:
    return drive.replace(belt=Belt.model_validate(belt), contact={"friction": 0.3})


@pytest.mark.parametrize(
    ("given", "changes", "same"),
    [
        (PK, {"ribs": 3}, PK | {"ribs": 3}),
        (PK, {"profile": "PJ"}, PK | {"profile": "PJ"}),
        (PK, {"profile": "flat-polyamide", "width": "50 mm"}, FLAT),
        (PK, {"axial_stiffness": "90 kN"}, PK | {"axial_stiffness": 9e4}),
        (PK, {"bending_damping_time": 1e-4}, PK | {"bending_damping_time": 1e-4}),
        (PK, {"elements": 40}, PK | {"elements": 40}),
        (PK | {"friction": 0.31, "width": 0.02}, {"ribs": 5}, PK | {"ribs": 5, "friction": 0.31, "width": 0.02}),
        (PK | {"friction": 0.31}, {"profile": "PJ"}, PK | {"profile": "PJ"}),
        (PK | {"bending_loss_factor": 0.2}, {"bending_damping_time": 1e-4}, PK | {"bending_damping_time": 1e-4}),
        (PK | {"axial_stiffness": 1e5}, {"stretch_curve": {"strains": [0.1], "tensions": [9e3]}},
         PK | {"stretch_curve": {"strains": [0.1], "tensions": [9e3]}}),
        (FLAT, {"width": "80 mm"}, FLAT | {"width": 0.08}),
        (FLAT, {"profile": "flat-polyester-fabric"}, FLAT | {"profile": "flat-polyester-fabric"}),
        (PK, {"nominal_length": 1.2}, {"profile": "PK", "ribs": 6, "nominal_length": 1.2}),
    ],
)  # fmt: skip
def test_a_change_gives_the_belt_of_the_changed_keys(
    drive: Drive, given: dict[str, Any], changes: dict[str, Any], same: dict[str, Any]
) -> None:
    """That of a file with these keys, also where something else was changed before."""
    belt = drive_with(drive, **given).replace(gravity=(0.0, -9.81)).belt.replace(crossed=True).replace(crossed=False)
    changed = Drive(**drive.arguments | {"belt": belt, "contact": {"friction": 0.3}}).with_(
        {f"belt.{key}": value for key, value in changes.items()}
    )
    assert changed.belt == Belt.model_validate(same)


def test_a_size_that_does_not_fit_is_said(drive: Drive) -> None:
    with pytest.raises(
        ModelError, match='ribs = 6 is incompatible with profile "flat-polyamide", which is sold by width'
    ):
        drive_with(drive, **PK).with_({"belt.profile": "flat-polyamide"})
    with pytest.raises(ModelError, match=r"belt\.ribs = 4\.5 must be a whole number"):
        drive_with(drive, **PK).with_({"belt.ribs": 4.5})


def test_a_change_of_the_material_leaves_the_profile(drive: Drive) -> None:
    belt = drive_with(drive, **PK).with_({"belt.axial_factor": 2.0}).belt
    assert belt.axial_stiffness == pytest.approx(2.0 * 6 * read_catalogue()["PK"].axial_stiffness)
    with pytest.raises(ModelError, match=r"belt\.profile is missing"):
        belt.replace(ribs=3)


def test_what_stands_where_it_was_not_given(drive: Drive) -> None:
    sold = drive_with(drive, **PK)
    assert value_at(sold, "belt.ribs") == 6
    assert value_at(sold, "belt.profile") == "PK"
    assert value_at(sold, "belt.axial_stiffness") == pytest.approx(6 * read_catalogue()["PK"].axial_stiffness)
    assert value_at(sold, "belt.nominal_length") is None
    assert converted(sold, "belt.ribs", 4) == 4
    length = sold.with_({"belt.length": 1.2})
    around = 1.2 * (1 + 300.0 / 120e3)
    assert value_at(length, "belt.nominal_length") == pytest.approx(around - 2 * pi * length.belt.pitch_offset)
    assert value_at(sold, "pulley[driver].diameter") == 2 * sold.pulleys[0].radius
    assert converted(sold, "pulley[driver].diameter", "30 mm") == pytest.approx(0.03)


def test_ones_own_catalogue_is_found_from_anywhere(
    drive: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a belt whose catalogue has gone keeps its values, but for its size."""
    keys = "width = 4e-3\nthickness = 5e-3\naxial_stiffness = 2e4\nbending_stiffness = 1e-3\nmass_per_length = 0.02"
    (tmp_path / "own.toml").write_text(f'[our]\ntitle = "ours"\nsource = "rig"\n{keys}\n')
    monkeypatch.chdir(tmp_path)
    sold = drive_with(drive, profile="our", ribs=6, installed_tension=300.0, catalogue="own.toml")
    monkeypatch.undo()
    assert sold.with_({"belt.ribs": 3}).belt.axial_stiffness == pytest.approx(6e4)
    (tmp_path / "own.toml").unlink()
    assert sold.with_({"belt.elements": 40}).belt.axial_stiffness == pytest.approx(12e4)

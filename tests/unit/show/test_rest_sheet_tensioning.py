"""The instruction to tension a belt, in facts and a table of spans."""

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, install
from beltdyn.model.installation import tension_checks
from beltdyn.show.rest_sheet import rest_sheet, tensioning


def test_it_shows_tensions_and_each_span(drive: Drive) -> None:
    found = tensioning(drive)
    assert found is not None
    facts, checks = dict(found.facts), tension_checks(drive, install(drive))
    assert facts["tension of a new belt"] == f"{checks[0].tension:.4g} N"
    assert facts["tension run in"] == f"{install(drive).tension:.4g} N"
    assert [row[0] for row in found.table.rows] == ["driver to driven", "driven to driver"]
    assert found.table.headings[3:] == ("new\nHz", "new\nN", "run in\nHz", "run in\nN", "least\nHz", "least\nN")
    shown = [float(value) for value in found.table.rows[0][1:]]
    length = float(install(drive).path.span_lengths[0])
    assert shown[:2] == pytest.approx([length, 16.0 * length], rel=5e-3)
    assert shown[2::2] == pytest.approx([float(one.frequencies[0]) for one in checks], rel=5e-3)
    assert shown[3::2] == pytest.approx([float(one.forces[0]) for one in checks], rel=5e-3)


def test_the_tension_of_the_file_counts(drive: Drive) -> None:
    found = tensioning(drive, 400.0)
    assert found is not None
    assert dict(found.facts)["tension run in"] == "400 N"


def test_a_tensioner_holds_it(drive: Drive) -> None:
    slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    found = tensioning(drive.replace(tensioner=[slide]))
    assert found is not None
    assert dict(found.facts)["tension at rest"].endswith("held by its tensioner")
    assert found.table.headings[3:] == ("at rest\nHz", "at rest\nN")


def test_a_drive_without_an_estimate_at_rest_has_no_instruction(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    def none(_: Drive) -> None:
        raise ModelError("no equilibrium")

    monkeypatch.setattr("beltdyn.show.rest_sheet.install", none)
    assert tensioning(drive) is None


def test_the_sheet_at_rest_has_it_for_belts_of_a_profile(drive: Drive) -> None:
    assert not any(part.title == "Tensioning" for part in rest_sheet(drive, drive, install(drive)).parts)
    sold = drive.with_({"belt.profile": "SPZ", "belt.ribs": 2, "belt.installed_tension": "400 N"})
    found = [part for part in rest_sheet(sold, sold, install(sold)).parts if part.title == "Tensioning"]
    instruction = tensioning(sold)
    assert instruction is not None
    assert found == [instruction.table]
    assert "each of 2 V-belts" in dict(instruction.facts)["force"]

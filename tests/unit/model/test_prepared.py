"""What a drive leaves open is found once."""

import pickle
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive, Prepared, install, layer_lengths, prepare
from beltdyn.model.resolution import graded_mesh, layer_length
from tests.unit.model.conftest import MakeDrive

SLIDE = {"kind": "sliding", "pulley": "idler", "direction": [0, 1], "mass": 1.0, "preload": 60.0}

SOURCE = Path(__file__).parents[3] / "src" / "beltdyn"


def test_nothing_is_open(make_drive: MakeDrive) -> None:
    drive = make_drive("flat", installed_tension=200.0)
    prepared = prepare(drive)
    assert drive.belt.length is None
    assert prepared.belt_length == drive.belt_length
    assert prepared.installed_tension == 200.0
    assert not prepared.contact.open_keys
    assert prepared.installation.tension == pytest.approx(200.0, rel=1e-11)
    assert {choice.key for choice in prepared.choices} >= {"contact.damping"}


@pytest.mark.parametrize(("frame", "kind"), [("staying", "quintic"), ("travelling", "ancf")])
def test_the_elements_are_those_of_the_mesh_of_runs(drive: Drive, frame: str, kind: str) -> None:
    prepared = prepare(drive.with_({"simulation.frame": frame, "simulation.start": "equilibrium"}))
    assert (prepared.frame.name, prepared.element_kind.name) == (frame, kind)


def test_it_is_described_at_rest_as_by_its_estimate(make_drive: MakeDrive) -> None:
    prepared = prepare(make_drive("flat", tensioner=[SLIDE], length=2.57))
    found = install(prepared.drive)
    again = prepared.installed(found.span_tensions, found.penetrations, found.hub_loads, found.tensioner_positions)
    assert again.path.length == prepared.installation.path.length
    assert prepared.tension_at_rest == pytest.approx(found.tension, rel=1e-14)
    (carrier,) = prepared.carriers
    assert carrier.tensioner is prepared.tensioners[0]
    assert prepared.installation.path.centers[carrier.pulley, 1] != prepared.path.centers[carrier.pulley, 1]


def test_lengths_of_elements_make_the_belt(drive: Drive) -> None:
    """Graded ones are the shortest where the belt takes on the curvature of a pulley."""
    prepared = prepare(drive)
    np.testing.assert_allclose(prepared.equal_lengths(40), drive.belt_length / 40)
    assert prepared.layer == layer_length(*layer_lengths(drive, prepared.installation.tension))
    graded = prepared.graded_lengths(1.0)
    np.testing.assert_array_equal(graded, graded_mesh(drive.belt_length, prepared.laid.arcs(), prepared.layer, 1.0))
    assert graded.sum() == pytest.approx(drive.belt_length, rel=1e-12)


def test_a_drive_with_another_argument_is_prepared_anew(drive: Drive) -> None:
    heavy = prepare(drive).replace(gravity=(0.0, -9.81))
    assert heavy.gravity == heavy.drive.gravity == (0.0, -9.81)


def test_other_instants_of_output_leave_all_else(drive: Drive) -> None:
    prepared = prepare(drive)
    short = prepared.over(prepared.simulation.replace(duration=1e-3))
    assert short.simulation.duration == short.drive.simulation.duration == 1e-3
    assert short.belt is prepared.belt


def test_it_travels_as_its_drive(drive: Drive) -> None:
    sent: Any = pickle.loads(pickle.dumps(prepare(drive)))
    assert sent.drive == drive
    np.testing.assert_array_equal(sent.path.centers, drive.path.centers)


AS_GIVEN = {"belt", "tensioners", "simulation"}
"""What a prepared drive and the drive both have, and some ask for as it was given."""


def test_what_a_prepared_drive_knows_is_not_asked_of_its_drive_again() -> None:
    known = {name for name in dir(Prepared) if not name.startswith("_")} | {one.name for one in fields(Prepared)}
    asked = {
        f"{path.relative_to(SOURCE)}: {name}"
        for path in SOURCE.rglob("*.py")
        for name in re.findall(r"prepared\.drive\.(\w+)", path.read_text(encoding="utf-8"))
        if name in known - AS_GIVEN - {"replace"}
    }
    assert asked == set()
    below = [path for name in ("system", "solvers", "contact", "elements") for path in (SOURCE / name).rglob("*.py")]
    assert [path for path in below if re.search(r"import .*\bDrive\b", path.read_text(encoding="utf-8"))] == []

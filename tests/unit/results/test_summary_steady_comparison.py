"""The end of a run beside steady running."""

from collections.abc import Callable

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli.output import show_result
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, steady_comparison, summarize
from beltdyn.results.summary import FAILURE, VALUES, steady_values
from validation.published.cases import loaded_two_pulley


@pytest.fixture(scope="module")
def settled() -> Run:
    """A tenth of a second that begins in steady running, on the mesh that stays."""
    drive = loaded_two_pulley()
    driver, driven = drive.pulleys
    return bd.simulate(
        drive.replace(
            pulley=[driver.replace(speed=steady(120.0)), driven.replace(torque=steady(-45.0))],
            contact=drive.contact.replace(integration="zone", normal_law="no_pull"),
            simulation={"duration": 0.1, "output_interval": 0.01, "frame": "staying", "start": "steady"},
        ),
        compare_steady=True,
    )


def steady(value: float) -> dict[str, object]:
    return {"kind": "constant", "value": value}


def test_a_run_that_begins_in_steady_running_stays_there(settled: Run, capsys: pytest.CaptureFixture[str]) -> None:
    """Speeds and slip to 0.02 %, tensions to 0.3 %, contact forces to a few percent between the two meshes."""
    found = {(one.quantity, one.name): one for one in steady_comparison(settled)}
    limits = {"speed": 2e-4, "hub load": 3e-3, "tension": 3e-3, "contact force": 0.05}
    for (quantity, _), one in found.items():
        if quantity in limits:
            assert one.run == pytest.approx(one.steady, rel=limits[quantity])
    assert found["slip", "driven"].run == pytest.approx(found["slip", "driven"].steady, abs=2e-4)
    assert found["speed", "driver"].unit == "rad/s"
    assert {quantity for quantity, _ in found} == {*limits, "slip"}
    show_result(settled)
    said = capsys.readouterr().out
    assert "Against steady running" in said
    assert "contact force of driven" in said


def test_numbers_stand_in_their_order(make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]) -> None:
    """Twice those of the run itself."""
    run = make_run(outputs=101)
    values = steady_values(run)
    run.dataset.attrs[VALUES] = 2.0 * np.array(values)
    compared = steady_comparison(run)
    assert [one.run for one in compared] == values
    assert [one.steady for one in compared] == pytest.approx([2.0 * one for one in values], nan_ok=True)
    speeds = [one.speed for one in summarize(run).pulleys]
    assert [one.run for one in compared if one.quantity == "speed"] == speeds
    forces = [one for one in compared if one.quantity == "contact force"]
    assert [one.name for one in forces] == [one.name for one in summarize(run).pulleys]
    show_result(run)
    said = " ".join(capsys.readouterr().out.split())
    assert "Against steady running" in said
    assert "speed of driver 114.59 229.18 rpm -115 -50.00%" in said


def test_nothing_is_said_where_nothing_was_asked_for(
    make_run: Callable[..., Run], capsys: pytest.CaptureFixture[str]
) -> None:
    run = make_run(outputs=101)
    assert steady_comparison(run) == ()
    show_result(run)
    assert "steady" not in capsys.readouterr().out
    run.dataset.attrs[FAILURE] = "the belt slips through on driven"
    show_result(run)
    assert "steady running  the belt slips through on driven" in capsys.readouterr().out


def test_a_drive_without_steady_running_is_refused_at_once(drive: Drive) -> None:
    driver, driven = drive.pulleys
    shaped = drive.replace(pulley=[driver, driven.replace(surface={"kind": "eccentric", "eccentricity": 1e-4})])
    with pytest.raises(ModelError, match="driven is not a smooth circle"):
        bd.simulate(shaped, compare_steady=True)

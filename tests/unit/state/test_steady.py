"""Steady running as a result like that of a run over time, what it needs, and how it fails."""

from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.cli import main
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.points.changed_drive import at_speed_under, held_at
from beltdyn.results import Run, open_result, summarize
from beltdyn.state.steady import steady_on_mesh, steady_state
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def loaded() -> Drive:
    return better(loaded_two_pulley())


@pytest.fixture(scope="module")
def run(loaded: Drive) -> Run:
    return steady_state(loaded)


def test_torques_balance(run: Run) -> None:
    """The driven pulley takes its load, and power goes nowhere but into friction and contact dampers."""
    summary = summarize(run)
    driver, driven = summary.pulleys
    assert driven.shaft_torque == pytest.approx(-45.0, rel=1e-6)
    assert driver.power + driven.power == pytest.approx(summary.balance.lost, rel=1e-4)
    spans = np.array([span.tension for span in summary.spans])
    assert np.ptp(spans) * 0.08125 == pytest.approx(45.0, rel=0.03)  # less penetration


def test_nothing_changes_but_angles(run: Run) -> None:
    found = run.dataset
    for name in ("span_tension", "pulley_speed", "hub_force"):
        assert np.ptp(found[name].values, axis=0).max() == 0.0
    turned = np.diff(found.pulley_angle.values, axis=0) / np.diff(found.time.values)[:, None]
    np.testing.assert_allclose(turned[0], found.pulley_speed[0])
    assert summarize(run).turns == 1


def test_its_errors_are_known(run: Run) -> None:
    assert run.resolution.errors["peak pressure"] < 0.01
    assert run.dataset.sizes["node"] < 60
    assert not [warning for warning in run.warnings if "mesh" in warning]


def test_equal_elements(loaded: Drive, run: Run) -> None:
    found = steady_state(loaded, elements=60)
    np.testing.assert_allclose(found.dataset.pulley_speed, run.dataset.pulley_speed, rtol=1e-3)
    assert found.dataset.sizes["node"] == 84


def test_the_mesh_that_the_drive_file_names(loaded: Drive) -> None:
    """As many equal elements as the belt has, of which the finer ones stand; an option comes before the file."""
    uniform = loaded.with_({"steady.mesh": "uniform", "belt.elements": 40})
    assert steady_state(uniform).dataset.sizes["node"] == 56
    refined = steady_state(uniform, force_tolerance=0.01)
    assert np.ptp(np.diff(refined.dataset.node_coordinate)) > 1e-3
    rough = steady_state(loaded.with_({"steady.force_tolerance": 0.2}))
    fine = steady_state(loaded.with_({"steady.force_tolerance": 1e-4}))
    assert rough.dataset.sizes["node"] < fine.dataset.sizes["node"]


def test_the_instant(loaded: Drive) -> None:
    """At a quarter of the ramp of speed."""
    found = steady_state(loaded, at=0.05 + 0.25 * 0.55)
    assert float(found.dataset.pulley_speed[0, 0]) == pytest.approx(30.0)


def test_it_says_what_slips_through(loaded: Drive) -> None:
    """All of the arc slides at 117.9 N m, which traction by slip gives for these tensions, and Euler's formula."""
    driver, driven = loaded.pulleys
    heavy = loaded.replace(
        pulley=[driver, driven.replace(torque={"kind": "constant", "value": -600.0})],
        contact=loaded.contact.replace(friction=0.3, creep_rate_factor=1e5),
    )
    with pytest.raises(
        ConvergenceError, match=r"slips on `(driver|driven)`, .* at most 11[78].* of the 600 N m required"
    ):
        steady_state(heavy)


def test_hysteresis_in_small_elements() -> None:
    """The shortest element is a small part of the length over which the stretch of this belt changes."""
    washing = bd.load(str(files("beltdyn") / "examples" / "washing_machine.toml"))
    found = steady_state(washing)
    balance, (motor, drum) = summarize(found).balance, summarize(found).pulleys
    assert found.dataset.sizes["node"] > 80
    assert motor.power + drum.power == pytest.approx(balance.lost, rel=1e-4)
    assert 0.001 * motor.power < balance.lost < 0.2 * motor.power


@pytest.fixture(scope="module")
def machines() -> Drive:
    return bd.load(str(files("beltdyn") / "examples" / "accessory_drive.toml"))


def test_dry_friction_holds_a_tensioner_within_a_band(machines: Drive) -> None:
    """Both ends of the band are where an arm without friction stands, with a preload less and more by as much."""
    arm, run = machines.moving_tensioners[0], steady_state(machines)
    found, installed = run.dataset, run.drive.replace(contact=run.drive.completed.contact)
    smooth = arm.replace(tensioning_friction=0.0, yielding_friction=0.0)
    for name, sense in (("tensioning", -1.0), ("yielding", 1.0)):
        preload = arm.spring["preload"] + sense * arm.spring[f"{name}_friction"]
        other = steady_state(installed.replace(tensioner=[smooth.replace(preload=preload)])).dataset
        end = float(np.atleast_1d(found.attrs[f"tensioner_position_after_{name}"])[0])
        assert end == pytest.approx(float(other.tensioner_position[0, 0]), abs=2e-4)
        assert abs(end - float(found.tensioner_position[0, 0])) > 1e-3
        assert f"tensioner_position_after_{name}" not in other.attrs


def test_a_neighbour_of_a_drive_with_a_given_tension(machines: Drive) -> None:
    """Of the same drive at another instant the length is known; hubs, clutches and arm are taken along."""
    run = steady_state(machines)
    found = steady_state(machines, at=1.4, start=run).dataset
    assert found.attrs["newton_iterations_of_search"] < 40
    other = steady_state(machines, at=1.4).dataset
    for name in ("pulley_speed", "shaft_speed", "tensioner_position", "span_tension", "hub_force"):
        np.testing.assert_allclose(found[name], other[name], rtol=1e-3, atol=1e-6)
    for name in ("tensioning", "yielding"):
        ends = [one.attrs[f"tensioner_position_after_{name}"] for one in (found, other)]
        assert float(np.ptp(ends)) < 0.01 * abs(float(ends[1][0] - other.tensioner_position[0, 0]))


def test_an_open_clutch_lets_its_load_stop(machines: Drive) -> None:
    """At 0.2 s the compressor's clutch is open, and dry friction has its shaft."""
    found = steady_state(machines, at=0.2).dataset
    assert abs(float(found.shaft_speed[0, -1])) < 0.1
    assert float(found.pulley_speed[0, -1]) > 50.0


def test_a_torque_over_the_angle_counts_with_its_mean(loaded: Drive) -> None:
    """The smooth curve through 0 and -20 N m a half turn apart, against the constant torque of -10 N m."""
    driver, driven = loaded.pulleys
    table = {"kind": "angle_table", "angles": [0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi], "torques": [0, -10, -20, -10]}
    uneven, even = (
        steady_state(loaded.replace(pulley=[driver, driven.replace(torque=torque, load=load)]))
        for torque, load in ((None, [table]), ({"kind": "constant", "value": -10.0}, ()))
    )
    for name in ("shaft_speed", "span_tension", "hub_force"):
        np.testing.assert_allclose(uneven.dataset[name], even.dataset[name], rtol=1e-9)
    said = 'the load of driven of kind "angle_table" varies with the shaft angle; steady running uses its mean'
    assert [said in warning for warning in uneven.warnings].count(True) == 1
    assert not any("uses its mean" in warning for warning in even.warnings)


def test_a_function_of_the_angle_is_refused(loaded: Drive) -> None:
    driver, driven = loaded.pulleys
    table = {"kind": "function", "function": lambda t, angle, speed: -10.0 - np.sin(angle)}
    uneven = loaded.replace(pulley=[driver, driven.replace(torque=None, load=[table])])
    with pytest.raises(ModelError, match="whose mean over the shaft angle is unknown"):
        steady_state(uneven)


def test_the_belt_wears_evenly(run: Run) -> None:
    work = run.dataset.friction_work_on_belt.isel(field_time=-1).sum("pulley").values
    coordinates = run.dataset.element_coordinate.values
    nodes = run.dataset.node_coordinate.values
    lengths = 2.0 * (coordinates - nodes)
    np.testing.assert_allclose(work / lengths, np.full(work.size, work.sum() / lengths.sum()), rtol=1e-6)


def test_a_neighbour_begins_where_another_ended(loaded: Drive, run: Run) -> None:
    """On its mesh, in a few iterations, to the same state as from rest."""
    driver, driven = run.drive.pulleys
    lighter = run.drive.replace(pulley=[driver, driven.replace(torque={"kind": "constant", "value": -40.0})])
    found, other = steady_state(lighter, start=run).dataset, steady_state(lighter).dataset
    assert found.attrs["newton_iterations_of_search"] <= min(4, other.attrs["newton_iterations_of_search"])
    np.testing.assert_array_equal(found.node_coordinate, run.dataset.node_coordinate)
    np.testing.assert_allclose(found.pulley_speed, other.pulley_speed, rtol=1e-5)
    np.testing.assert_allclose(found.span_tension, other.span_tension, rtol=1e-4)
    slower = steady_state(loaded, at=0.05 + 0.25 * 0.55, start=run).dataset
    assert slower.attrs["newton_iterations_of_search"] <= 5
    assert float(slower.pulley_speed[0, 0]) == pytest.approx(30.0)


def test_the_mesh_of_a_neighbour_is_checked(loaded: Drive, run: Run) -> None:
    """Its errors are its own, and where they are too large the mesh is made anew."""
    driver, driven = run.drive.pulleys
    lighter = run.drive.replace(pulley=[driver, driven.replace(torque={"kind": "constant", "value": -20.0})])
    found = steady_state(lighter, start=run)
    assert 0.0 < found.resolution.errors["peak pressure"] <= 0.01
    assert found.resolution.errors["peak pressure"] != run.resolution.errors["peak pressure"]
    taken_over = steady_on_mesh(lighter, run)
    assert taken_over.resolution.errors["peak pressure"] == run.resolution.errors["peak pressure"]
    exact = 0.5 * found.resolution.errors["peak pressure"]
    finer = steady_state(lighter, start=run, force_tolerance=exact)
    assert finer.resolution.errors["peak pressure"] <= exact
    assert finer.dataset.sizes["node"] > run.dataset.sizes["node"]


def test_a_start_that_is_far_off_or_not_resolved_does_no_harm(loaded: Drive, run: Run) -> None:
    still = loaded.pulleys[0].replace(speed={"kind": "constant", "value": -120.0})
    other_way = loaded.replace(pulley=[still, loaded.pulleys[1]])
    found = steady_state(other_way, start=run)
    assert float(found.dataset.pulley_speed[0, 1]) < -100.0
    assert steady_state(loaded, start=run, force_tolerance=1e-4).resolution.errors["peak pressure"] < 1e-4


def test_starts_that_do_not_fit(loaded: Drive, run: Run) -> None:
    short = loaded.replace(simulation=loaded.simulation.replace(duration=1e-3))
    with pytest.raises(ModelError, match="start is a run over time"):
        steady_state(loaded, start=bd.simulate(short))
    renamed = loaded.replace(pulley=[loaded.pulleys[0], loaded.pulleys[1].replace(name="other")])
    with pytest.raises(ModelError, match="start has the pulleys driver, driven and 0 moving tensioners; the drive has"):
        steady_state(renamed, start=run)
    with pytest.raises(ModelError, match="elements = 30 cannot be given with start"):
        steady_state(loaded, start=run, elements=30)


def test_drives_that_cannot_run_steadily(loaded: Drive) -> None:
    driver, driven = loaded.pulleys
    still = driver.replace(speed={"kind": "constant", "value": 0.0})
    with pytest.raises(ModelError, match="every prescribed speed is zero"):
        steady_state(loaded.replace(pulley=[still, driven]))
    shaped = driven.replace(surface={"kind": "eccentric", "eccentricity": 1e-3})
    with pytest.raises(ModelError, match="driven is not a smooth circle"):
        steady_state(loaded.replace(pulley=[driver, shaped]))
    servo = {"kind": "servo_motor", "speed": {"kind": "constant", "value": 9.0}, "proportional_gain": 1.0}
    servo |= {"integral_time": 0.1, "torque_limit": 5.0}
    for load in (servo, {"kind": "function", "function": abs}):
        turned = loaded.pulleys[1].replace(torque=None, load=[load])
        with pytest.raises(ModelError, match=f'driven has a load of kind "{load["kind"]}", whose mean over'):
            steady_state(loaded.replace(pulley=[loaded.pulleys[0], turned]))
    with pytest.raises(ModelError, match="force_tolerance = 2"):
        steady_state(loaded, force_tolerance=2.0)
    with pytest.raises(ModelError, match="elements = 2"):
        steady_state(loaded, elements=2)


def test_the_command_writes_a_result(
    loaded: Drive, run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "drive.toml").write_text(bd.dumps(loaded), encoding="utf-8")
    with pytest.raises(SystemExit) as end:
        main(["steady-state", str(tmp_path / "drive.toml")])
    assert end.value.code == 0
    assert "driven" in capsys.readouterr().out
    saved = open_result(tmp_path / "drive-steady-state.nc")
    np.testing.assert_allclose(saved.dataset.span_tension, run.dataset.span_tension)
    assert bd.steady_state is steady_state


TOOTHED = {"profile": "HTD 8M", "width": "20 mm", "teeth": 100}


@pytest.mark.parametrize(
    ("driver", "driven", "message"),
    [
        (
            {"teeth": 24, "speed": 1.0},
            {"teeth": 36, "speed": 24.0 / 36.0},
            "driver and driven have prescribed speeds and teeth",
        ),
        (
            {"radius": 0.027, "speed": 1.0},
            {"teeth": 36, "inertia": 1.0},
            "driver drives a belt with teeth, but has none",
        ),
        (
            {"teeth": 24, "speed": 1.0},
            {"teeth": 36, "inertia": 1.0, "torque": -900.0},
            "the search ends at .* of the loads, where .* takes .* N m and spans have .* The belt jumps",
        ),
    ],
)
def test_belts_with_teeth_that_do_not_run(driver: dict[str, Any], driven: dict[str, Any], message: str) -> None:
    pulleys = [{"name": "driver", "center": [0.0, 0.0], **driver}, {"name": "driven", "center": [0.28, 0.0], **driven}]
    drive = Drive(belt=TOOTHED, pulley=pulleys, contact={"friction": 0.3}, simulation={"duration": 1.0})
    with pytest.raises((ModelError, ConvergenceError), match=message):
        steady_state(drive)


def test_a_belt_that_no_pulley_touches_is_refused() -> None:
    """Its own tension m v^2 is beyond that which it is installed with."""
    drive = at_speed_under(held_at(bd.example("unequal_radii"), None), 0, 1e4, 0.0)
    with pytest.raises(ConvergenceError, match=r"lifted off all pulleys.*Reduce the speed"):
        steady_state(drive, force_tolerance=0.2)


def test_a_load_that_falls_with_the_speed_runs_under_a_driver_that_slides(loaded: Drive) -> None:
    """Beyond the grip the belt, and the load with it, keep their speed, whatever that of the driver."""
    driver, driven = loaded.pulleys
    fan = driven.replace(torque=None, load=[{"kind": "resistance", "quadratic": 45.0 / 100.0**2}])
    weak = loaded.replace(pulley=[driver, fan], contact=loaded.contact.replace(friction=0.3))
    runs = [steady_state(weak.with_({"pulley[driver].speed": speed})) for speed in (200.0, 300.0)]
    slow, fast = (run.dataset.pulley_speed.values[-1] for run in runs)
    assert (slow[0], fast[0]) == (200.0, 300.0)
    assert fast[1] == pytest.approx(slow[1], rel=1e-3)
    for run in runs:
        assert any(text.startswith("gross slip") for text in run.warnings)

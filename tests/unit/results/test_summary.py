import math
from collections.abc import Callable
from types import SimpleNamespace

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, summarize
from beltdyn.results.cycles import plain_window
from beltdyn.results.means import tensioner_means


def test_means_are_taken_over_whole_elements_where_no_turn_fits(make_run: Callable[..., Run], drive: Drive) -> None:
    """One of 20 passes in L / (20 * 12 rad/s * R) = 65 ms; of a jump for the second half of it the mean has a half."""
    element = drive.belt_length / (20 * 12.0 * drive.pulleys[0].radius)
    tension = np.full((1001, 2), [1.0, 3.0])
    tension[round(1000 * (1.0 - 0.5 * element)) :] += 2.0
    summary = summarize(make_run(outputs=1001, span_tension=tension))
    assert summary.start == pytest.approx(1.0 - element)
    assert (summary.end, summary.turns) == (1.0, 0)
    assert [span.tension for span in summary.spans] == pytest.approx([2.0, 4.0], abs=2.0 * 1e-3 / element)


def _grashof_safety(drive: Drive, tight: float, slack: float) -> float:
    """Load at gross slip over the present one: two equal pulleys at fixed centers, linear stretch, no inertia."""
    friction, radius, span = float(drive.frictions[0]), float(drive.radii[0]), float(drive.path.span_lengths[0])
    adhering = math.pi - math.log(tight / slack) / friction
    held = (span + radius * adhering) * (tight + slack) + 2.0 * radius * (tight - slack) / friction
    capacity = held / (span / math.tanh(0.5 * friction * math.pi) + 2.0 * radius / friction)
    return capacity / (tight - slack)


def test_pulleys(run: Run) -> None:
    driver, driven = summarize(run).pulleys
    assert (driver.name, driven.name) == ("driver", "driven")
    assert driver.speed == pytest.approx(12.0)
    assert driver.slip == 0.0
    assert driven.slip == pytest.approx(0.005)
    assert driven.belt_torque == pytest.approx(30.0 * 0.08125)
    assert driven.shaft_torque == pytest.approx(-30.0 * 0.08125)
    assert driven.hub_load == pytest.approx(90.0)
    assert driven.wrap_angle == pytest.approx(math.pi)
    assert driven.power == pytest.approx(-0.995 * 12.0 * 30.0 * 0.08125)
    assert driven.slip_safety == pytest.approx(_grashof_safety(run.drive, 60.0, 30.0), rel=0.05)  # without penetration
    assert (driven.sliding, driven.sliding_speed, driven.sliding_arc) == (0.0, 0.0, 0.0)


def test_pulley_that_slides_through(make_run: Callable[..., Run], run: Run) -> None:
    """The belt is faster than the whole driven rim by 0.4 m/s, creep included, and slower than none of the driver's."""
    touched, normal = (run.dataset[name].values for name in ("contact_pulley", "normal_force"))
    slipping = make_run(slip_velocity=np.where(touched == 1, 0.4, 0.0))
    driver, driven = summarize(slipping).pulleys
    creep = 1.2 * normal[90:].max() / 1e5  # where the tension is highest
    assert driven.sliding_speed == pytest.approx(0.4 - creep, rel=1e-3)
    assert driven.sliding == pytest.approx(driven.sliding_speed / (12.0 * run.drive.rolling_radii[0]))
    assert driven.sliding_arc == pytest.approx(math.pi)
    assert (driver.sliding, driver.sliding_speed, driver.sliding_arc) == (0.0, 0.0, 0.0)


def test_spans_swing(make_run: Callable[..., Run]) -> None:
    tension = np.tile([30.0, 60.0], (101, 1))
    tension[95] = [20.0, 75.0]
    spans = summarize(make_run(span_tension=tension)).spans
    assert [(span.lowest, span.highest) for span in spans] == [(20.0, 30.0), (60.0, 75.0)]


def test_efficiency_is_that_of_the_end(run: Run) -> None:
    balance = summarize(run).balance
    assert balance.efficiency == pytest.approx(1.0 - balance.lost / (balance.power_out + balance.lost))
    assert balance.lost == pytest.approx(0.1 * 12.0)
    assert balance.losses["friction"] == pytest.approx(0.09 * 12.0)


def test_spans_and_solver(run: Run) -> None:
    summary = summarize(run)
    assert [span.name for span in summary.spans] == ["driver-driven", "driven-driver"]
    assert [span.tension for span in summary.spans] == pytest.approx([30.0, 60.0])
    assert summary.spans[0].belt_speed == pytest.approx(12.0 * 0.08125)
    assert (summary.steps, summary.newton_iterations, summary.computing_time_per_second) == (1200, 4900, 0.5)
    assert summary.energy_closure == pytest.approx(1e-4)
    assert summary.warnings == tuple(run.warnings)


def test_closure_is_the_largest_over_time(make_run: Callable[..., Run]) -> None:
    errors = np.zeros(11)
    errors[3] = -0.04
    assert summarize(make_run(outputs=11, energy_closure=errors)).energy_closure == -0.04


def test_tensioners_that_move() -> None:
    """Over the given part of the time."""
    moving = [SimpleNamespace(turns=True, pulley="idler"), SimpleNamespace(turns=False, pulley="driven")]
    drive = SimpleNamespace(moving_tensioners=moving)
    position = np.zeros((11, 2))
    position[-2:] = [[0.1, 0.004], [0.3, 0.002]]
    dataset = {"time": np.linspace(0.0, 1.0, 11), "tensioner_position": position}
    window = plain_window(dataset["time"], 0.9)
    arm, slide = tensioner_means(dataset, drive, window)  # type: ignore[arg-type]
    assert (arm.name, arm.rotary, slide.name, slide.rotary) == ("idler", True, "driven", False)
    assert (arm.position, arm.lowest, arm.highest) == pytest.approx((0.2, 0.1, 0.3))
    assert (slide.position, slide.lowest, slide.highest) == pytest.approx((0.003, 0.002, 0.004))
    assert tensioner_means(dataset, SimpleNamespace(moving_tensioners=[])) == ()  # type: ignore[arg-type]


def test_single_output_at_rest(make_run: Callable[..., Run]) -> None:
    summary = summarize(make_run(outputs=1))
    assert (summary.start, summary.end, summary.outputs) == (0.0, 0.0, 1)
    assert all(math.isnan(pulley.slip) for pulley in summary.pulleys)
    assert summary.spans[0].tension == 30.0


def test_run_whose_end_was_not_recorded(run: Run) -> None:
    killed = Run(run.dataset.drop_attrs(deep=False).assign_attrs(status="running"), run.drive)
    summary = summarize(killed)
    assert (summary.integrator, summary.steps) == ("", 0)
    assert math.isnan(summary.wall_time)


def test_run_without_outputs_cannot_be_summed_up(run: Run) -> None:
    with pytest.raises(ModelError, match="before its first output"):
        summarize(Run(run.dataset.isel(time=slice(0)), run.drive))


def test_belt_speed_is_positive_in_the_sense_in_which_the_drive_runs(make_run: Callable[..., Run], run: Run) -> None:
    """A clockwise drive as well as a counter-clockwise one."""
    backward = {name: -run.dataset[name].values for name in ("pulley_speed", "belt_speed")}
    for one in (run, make_run(**backward)):
        assert summarize(one).spans[0].belt_speed == pytest.approx(12.0 * 0.08125)

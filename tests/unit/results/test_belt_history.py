"""Tension and curvature that material points of the belt meet."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.belt_history import belt_history, turn_history
from beltdyn.results.damage import rainflow
from beltdyn.state.steady import steady_state
from tests.conftest import SLACK, TIGHT


@pytest.fixture(scope="module")
def steady(fatigue_drive: Drive) -> Run:
    return steady_state(fatigue_drive)


def tension_of(drive: Drive, time: FloatArray, marks: FloatArray) -> FloatArray:
    """Tension of material points by the formula of the made run, in which it is linear over the arcs."""
    radius, path = drive.pulleys[0].radius, drive.path
    ramp = np.clip((time - 0.05) / 0.55, 0.0, 1.0)
    angle = np.where(time < 0.6, 3.3 * ramp**2, 3.3 + 12.0 * (time - 0.6))
    place = (path.length / drive.belt_length * marks + radius * angle[:, None]) % path.length
    span, arc = path.span_lengths[0], np.pi * radius
    corners = np.cumsum([0.0, span, arc, span, arc])
    return np.asarray(SLACK + (TIGHT - SLACK) * ramp[:, None] * np.interp(place, corners, [0, 0, 1, 1, 0]))


def test_a_material_point_is_followed(make_run: Callable[..., Run]) -> None:
    run = make_run(outputs=101)
    history = belt_history(run, points=5)
    marks = np.arange(5) * run.drive.belt_length / 5
    exact = tension_of(run.drive, history.time, marks)
    assert np.abs(history.tension - exact).max() < 0.1 * (TIGHT - SLACK)
    assert np.abs(history.tension - exact).mean() < 0.01 * (TIGHT - SLACK)


def test_between_outputs_it_moves_with_the_belt(make_run: Callable[..., Run]) -> None:
    """With a tenth of a turn of the belt between outputs, a point still meets the full tension between them."""
    run = make_run(outputs=11)
    history = belt_history(run, points=5)
    exact = tension_of(run.drive, history.time, np.arange(5) * run.drive.belt_length / 5)
    late = history.time > 0.65
    assert len(history.time) > 2 * run.dataset.sizes["field_time"]
    assert np.abs(history.tension - exact)[late].mean() < 0.03 * (TIGHT - SLACK)


def test_passed_length_is_that_of_the_shafts(run: Run) -> None:
    history = belt_history(run)
    drive = run.drive
    way = drive.pulleys[0].radius * float(run.dataset.pulley_angle[-1, 0]) * drive.belt_length / drive.path.length
    assert history.passed[-1] == pytest.approx(way, rel=1e-3)
    assert np.all(np.diff(history.time) > 0.0)


def test_bending_of_a_material_point(run: Run) -> None:
    history, radius = belt_history(run), run.drive.pulleys[0].radius
    assert history.curvature.max() == pytest.approx(1.0 / radius, rel=0.02)
    assert history.curvature.min() == pytest.approx(0.0, abs=0.02 / radius)
    assert set(np.unique(history.pulley)) == {0, 1}
    passages = sum(rainflow(line).above(0.5).number.sum() for line in history.curvature.T) / history.curvature.shape[1]
    turns = history.passed[-1] / run.drive.belt_length
    assert passages == pytest.approx(2.0 * turns, abs=1.0)


def test_over_a_turn_of_steady_running(steady: Run) -> None:
    history, drive = turn_history(steady), steady.drive
    tensions = steady.dataset.span_tension.values[-1]
    assert history.tension.max() == pytest.approx(tensions.max(), rel=1e-4)
    assert history.passed[0] >= 0.0
    assert history.passed[-1] < drive.belt_length
    for number, radius in enumerate(drive.radii):
        curvature = history.curvature[history.pulley == number]
        assert np.quantile(curvature, 0.8) == pytest.approx(1.0 / radius, rel=0.01)


def test_the_sense_of_rotation_reverses_the_history(steady: Run, fatigue_drive: Drive) -> None:
    """The tight side comes after the driven pulley either way, as the belt passes it."""
    small, large = fatigue_drive.pulleys
    turned = fatigue_drive.replace(
        pulley=[small.replace(speed=-157.08), large.replace(torque={"kind": "constant", "value": 12.0})]
    )
    for run in (steady, steady_state(turned)):
        history = turn_history(run)
        driven = np.flatnonzero((history.pulley[:, 0] == 1) & (history.curvature[:, 0] > 5.0))
        assert np.all(np.diff(history.passed) > 0.0)
        assert history.tension[driven[-1], 0] > history.tension[driven[0], 0] + 50.0


def test_one_output_is_no_history(make_run: Callable[..., Run]) -> None:
    with pytest.raises(ModelError, match="no history"):
        belt_history(make_run(outputs=1))

"""Runs on the mesh that travels which begin in steady running: nothing changes but for the ripple of that mesh."""

from typing import Literal

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.state.installation import bring_to_rest
from beltdyn.system.state import point_coordinates
from beltdyn.transient.beginning import steady_state_on
from validation.published.cases import better, loaded_two_pulley

BEGIN = 1.6
"""When case 2 of the paper has its full speed and load, s."""


@pytest.fixture(scope="module")
def drive() -> Drive:
    """Case 2 from there on, for half a turn of the belt."""
    given = better(loaded_two_pulley(), elements=60, duration=0.06)
    return given.replace(simulation=given.simulation.replace(start="steady", start_at=BEGIN))


def test_no_transient(drive: Drive) -> None:
    """Tensions ripple by 0.06 %, and their means over the passing of an element stay within a tenth of that."""
    found = bd.simulate(drive).dataset
    speed, tension = found.pulley_speed.values[:, 1], found.span_tension.values
    assert found.time.values[[0, -1]] == pytest.approx([BEGIN, BEGIN + 0.06])
    assert found.shaft_angle.values[-1, 0] - found.shaft_angle.values[0, 0] == pytest.approx(120.0 * 0.06, rel=1e-9)
    assert found.settling_left < 1e-3
    assert np.ptp(speed) < 1e-5 * speed[0]
    assert np.ptp(tension, axis=0).max() < 1e-3 * tension.max()
    halves = np.array([half.mean(axis=0) for half in np.array_split(tension, 2)])
    np.testing.assert_allclose(halves[0], halves[1], rtol=1e-4)


def test_both_meshes_begin_in_the_same_state(drive: Drive) -> None:
    run = bd.simulate(drive)
    steady = bd.steady_state(run.drive, at=BEGIN).dataset
    np.testing.assert_allclose(run.dataset.pulley_speed.values[0], steady.pulley_speed.values[-1], rtol=1e-4)
    np.testing.assert_allclose(run.dataset.span_tension.values[0], steady.span_tension.values[-1], rtol=2e-3)


def test_nodes_move_along_the_belt_with_it(drive: Drive) -> None:
    """On spans the rate of a node is the way to the next one over the time in which an element passes."""
    rest = bring_to_rest(drive)
    _, state = steady_state_on(rest)
    nodes = state.nodes(rest.system)[:, :2]
    rates = state.velocity[: rest.system.first_body].reshape(rest.system.nodes, -1)[:, :2]
    way = 0.5 * (np.roll(nodes, -1, axis=0) - np.roll(nodes, 1, axis=0))
    gap = float(np.diff(point_coordinates(rest.system))[0])
    bend = np.roll(nodes, -1, axis=0) - 2.0 * nodes + np.roll(nodes, 1, axis=0)
    on_spans = np.hypot(*bend.T) < 1e-3 * gap
    assert np.count_nonzero(on_spans) > 20
    np.testing.assert_allclose(way[on_spans], gap / 9.394 * rates[on_spans], rtol=1e-3, atol=1e-3 * gap)  # in m/s


@pytest.mark.parametrize("frame", ["travelling", "staying"])
def test_a_load_steps_at_its_own_time(drive: Drive, frame: Literal["travelling", "staying"]) -> None:
    """The driven pulley is let go 20 ms after the beginning, and not before."""
    driver, driven = drive.pulleys
    step = {"kind": "step", "time": BEGIN + 0.02, "before": -45.0, "value": 0.0}
    stepped = drive.replace(
        pulley=[driver, driven.replace(torque=step)],
        simulation=drive.simulation.replace(frame=frame, duration=0.03),
    )
    found = bd.simulate(stepped).dataset
    speed = found.pulley_speed.sel(pulley=driven.name)
    before, after = speed.sel(time=slice(None, BEGIN + 0.02)), speed.sel(time=slice(BEGIN + 0.02, None))
    assert float(np.ptp(before.values)) < 1e-4 * float(before[0])
    assert float(np.ptp(after.values)) > 1e-2 * float(before[0])


def test_what_stands_still_is_refused(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"every prescribed speed is zero"):
        bd.simulate(drive.replace(simulation=drive.simulation.replace(start_at=0.0)))

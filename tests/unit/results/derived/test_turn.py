"""Means over a turn of the first pulley, which turns at 12 rad/s from 0.6 s on: in 0.5236 s."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.results.derived import turn_means

TURN = 2.0 * np.pi / 12.0
MakeRun = Callable[..., Run]


@pytest.fixture
def steady(make_run: MakeRun) -> Run:
    return make_run(outputs=201, pulley_speed=np.full((201, 2), 12.0))


def test_what_repeats_in_a_turn_drops_out(steady: Run) -> None:
    """Trapezoids of 105 outputs a turn, with ends between outputs: to a thousandth of the amplitude."""
    time = steady.dataset["time"].values
    wave = 3.0 + np.sin(2.0 * np.pi * time / TURN)
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=np.column_stack([wave, 2.0 * wave])))
    inner = (time > TURN / 2) & (time < 1.0 - TURN / 2)
    np.testing.assert_allclose(means[inner], np.tile([3.0, 6.0], (inner.sum(), 1)), atol=1e-3)


def test_a_line_stays_and_ends_are_means_of_what_is_there(steady: Run) -> None:
    """The integral is taken as straight between outputs, which misses dt^2 / 8 of a turn, 6e-6 s."""
    time = steady.dataset["time"].values
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=np.column_stack([time, time])))
    assert float(means.sel(time=0.5)[0]) == pytest.approx(0.5)
    assert float(means[0, 0]) == pytest.approx(TURN / 4, abs=2e-5)
    assert float(means[-1, 0]) == pytest.approx(1.0 - TURN / 4, abs=2e-5)


def test_what_is_not_known_stays_unknown(steady: Run) -> None:
    values = np.ones((201, 2))
    values[0, 1] = np.nan
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=values))
    assert np.isfinite(means[:, 0]).all()
    np.testing.assert_array_equal(np.isnan(means[:, 1]), steady.dataset["time"].values < TURN / 2 + 0.005)


def test_a_drive_at_rest_has_no_turns(make_run: MakeRun) -> None:
    """All of the run is within a turn of it."""
    still = make_run(outputs=11, pulley_speed=np.zeros((11, 2)))
    values = np.linspace(0.0, 1.0, 22).reshape(11, 2)
    means = turn_means(still, still.dataset["pulley_speed"].copy(data=values))
    np.testing.assert_allclose(means, np.tile(values.mean(axis=0), (11, 1)))

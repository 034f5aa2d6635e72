"""Means over a turn of the belt, which takes 0.2 s here, so that five of them fit into the run."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.results.derived import turn_means

TURN = 0.2
MakeRun = Callable[..., Run]


@pytest.fixture
def steady(make_run: MakeRun, run: Run) -> Run:
    return make_run(outputs=201, belt_speed=np.full((201, 2), run.drive.belt_length / TURN))


def test_what_repeats_in_a_turn_drops_out_up_to_the_end(steady: Run) -> None:
    time = steady.dataset["time"].values
    wave = 3.0 + np.sin(2.0 * np.pi * time / TURN)
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=np.column_stack([wave, 2.0 * wave])))
    inner = time > TURN / 2 + 1e-9
    np.testing.assert_allclose(means[inner], np.tile([3.0, 6.0], (inner.sum(), 1)), atol=1e-9)
    assert np.isnan(means[~inner]).all()


def test_a_line_stays_and_ends_in_the_mean_of_the_last_turn(steady: Run) -> None:
    time = steady.dataset["time"].values
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=np.column_stack([time, time])))
    assert float(means.sel(time=0.5)[0]) == pytest.approx(0.5)
    assert float(means[-1, 0]) == pytest.approx(1.0 - TURN / 2)


def test_what_is_not_known_stays_unknown(steady: Run) -> None:
    values = np.ones((201, 2))
    values[20, 1] = np.nan
    means = turn_means(steady, steady.dataset["pulley_speed"].copy(data=values))
    time = steady.dataset["time"].values
    np.testing.assert_array_equal(np.isnan(means[:, 0]), time < TURN / 2 + 1e-9)
    np.testing.assert_array_equal(np.isnan(means[:, 1]), time < TURN / 2 + 0.1075)


def test_a_drive_at_rest_has_no_turns(make_run: MakeRun) -> None:
    still = make_run(outputs=11, belt_speed=np.zeros((11, 2)))
    values = np.linspace(0.0, 1.0, 22).reshape(11, 2)
    np.testing.assert_array_equal(turn_means(still, still.dataset["pulley_speed"].copy(data=values)), values)

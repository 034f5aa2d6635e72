"""What happened at any time of a run, put into datasets by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.incidents import Incident, incidents

MakeRun = Callable[..., Run]


def found(run: Run) -> list[str]:
    with run.recorded() as recorded:
        return [str(one) for one in incidents(recorded, run.prepared)]


def test_a_sound_run_has_none(run: Run) -> None:
    assert found(run) == []


def test_gross_slip_has_periods_and_is_not_that_of_a_single_output(make_run: MakeRun) -> None:
    sliding = np.zeros((101, 2))
    sliding[[*range(20, 31), *range(60, 71), 90], 1] = 0.5
    run = make_run(sliding_speed=sliding)
    time = run.dataset["time"].values
    assert found(run) == [f"the belt was in gross slip on driven from {time[20]:.4g} to {time[70]:.4g} s, 2 times"]
    sliding[:] = 0.0
    sliding[50, 0] = 0.5
    assert found(make_run(sliding_speed=sliding)) == []


def test_slack_spans(make_run: MakeRun) -> None:
    tension = np.full((101, 2), 40.0)
    tension[33, 0] = -1.0
    tension[40, 1] = np.nan
    run = make_run(span_tension=tension)
    assert found(run) == [f"driver-driven went slack at {float(run.dataset['time'][33]):.4g} s"]


@pytest.mark.parametrize(("place", "side"), [(-0.02, "lower"), (0.03, "upper"), (0.0, "")])
def test_stops(make_run: MakeRun, drive: Drive, place: float, side: str) -> None:
    slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    stopped = drive.replace(tensioner=[{**slide, "stops": [-0.01, 0.01], "stop_stiffness": 1e5}])
    dataset = make_run().dataset.assign(tensioner_position=(("time", "tensioner"), np.full((101, 1), place)))
    expected = [f"the tensioner of driven was on its {side} stop from 0 to {float(dataset['time'][-1]):.4g} s"]
    assert found(Run(dataset, stopped)) == (expected if side else [])


def test_a_result_without_time_says_so_without_periods() -> None:
    assert str(Incident("slack", "a-b", ())) == "a-b went slack"

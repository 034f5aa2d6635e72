"""What a caller is told of a simulation."""

from collections.abc import Callable
from dataclasses import FrozenInstanceError
from itertools import pairwise

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.solvers.run_progress import Pace, Progress


@pytest.fixture(scope="module")
def told(change: Callable[..., Drive]) -> list[Progress]:
    reports: list[Progress] = []
    simulate(change(), progress=reports.append)
    return reports


def test_phases_come_in_order(told: list[Progress]) -> None:
    phases = [report.phase for report in told]
    assert list(dict.fromkeys(phases)) == ["compiling", "equilibrium", "integrating"]
    assert phases == sorted(phases, key=["compiling", "equilibrium", "integrating"].index)


def test_time_and_outputs_only_grow(told: list[Progress]) -> None:
    for before, after in pairwise(told):
        assert after.time >= before.time
        assert after.outputs_written >= before.outputs_written


def test_the_last_report_is_the_end(told: list[Progress]) -> None:
    last = told[-1]
    assert (last.time, last.duration, last.outputs_written) == (5e-3, 5e-3, 6)
    assert last.step_size > 0.0


def test_a_report_cannot_be_changed(told: list[Progress]) -> None:
    with pytest.raises(FrozenInstanceError):
        told[0].time = 1.0  # type: ignore[misc]


def test_what_is_left_goes_by_the_pace_of_late() -> None:
    """A second a second for ten seconds, then a hundredth of it: of 12 s, 1.95 s are left after 5 s more."""
    pace = Pace()
    for elapsed in np.arange(0.0, 10.0, 0.1):
        assert np.isnan(pace.at(float(elapsed), float(elapsed))) == (elapsed == 0.0)
    slow = [pace.at(10.0 + 0.1 * k, 10.0 + 0.001 * k) for k in range(60)]
    assert slow[-1] == pytest.approx(0.01)
    progress = Progress(10.05, 12.0, 1e-6, 3, elapsed=16.0, pace=slow[-1])
    assert progress.remaining == pytest.approx(195.0)
    assert Progress(10.05, 12.0, 1e-6, 3, elapsed=16.0).remaining == pytest.approx(16.0 * 1.95 / 10.05)


def test_nothing_is_forecast_of_a_run_that_has_just_begun() -> None:
    """A start with short steps says nothing of the rest: of 109 s it once promised three hours."""
    for reached in (0.0, 1e-4, 0.049):
        assert np.isnan(Progress(reached, 1.0, 1e-6, 1, elapsed=5.1, pace=1e-4).remaining)
    assert Progress(0.05, 1.0, 1e-6, 1, elapsed=5.1, pace=0.01).remaining == pytest.approx(95.0)

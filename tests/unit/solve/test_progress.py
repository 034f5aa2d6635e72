"""What a caller is told of a simulation."""

from collections.abc import Callable
from dataclasses import FrozenInstanceError
from itertools import pairwise

import pytest

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.solve import Progress


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

"""What docs/examples/accessory_drive.md says of the study: pivot and spring of a tensioner for the least hub load."""

import numpy as np
import pytest
from tensioner_study import found

from beltdyn import Result, summarize
from beltdyn.parts.quantity import RPM
from beltdyn.points.operating_points import at_point
from beltdyn.state.steady import steady_state
from beltdyn.transient.sweep import without_schedules

pytestmark = pytest.mark.slow

SPEEDS = np.linspace(700.0, 2500.0, 10) / RPM


def best_at(result: Result, label: str, point: str) -> float:
    return float(result.dataset.best_result.sel(result=label, point=point))


def test_hub_loads_fall_as_the_page_says() -> None:
    dataset = found().dataset
    assert float(dataset.goal_at_start) == pytest.approx(897.2, rel=0.005)
    assert float(dataset.goal_found) == pytest.approx(743.3, rel=0.005)
    worst = dict(zip(dataset.requirement.values.tolist(), dataset.worst.values.tolist(), strict=True))
    assert worst["slip_safety at least 1.2"] == pytest.approx(1.2, rel=0.002)


def test_the_best_drive_found_anew_from_rest_is_the_same() -> None:
    """States that were followed along tangents are those that are found without them, as exact as the mesh."""
    result = found()
    held = without_schedules(result.drive, result.drive.simulation.duration)[0]
    pulleys = [one.name for one in held.pulleys]
    for number, load in ((0, 0.5), (9, 1.0)):
        run = steady_state(at_point(held, 0, {"speed": float(SPEEDS[number]), "load": load}))
        point = result.dataset.point.values[number + (10 if load == 1.0 else 0)]
        for name, one in zip(pulleys, summarize(run).pulleys, strict=True):
            assert best_at(result, f"hub_load[{name}]", point) == pytest.approx(one.hub_load, rel=0.01)
            if np.isfinite(one.slip_safety):
                assert best_at(result, f"slip_safety[{name}]", point) == pytest.approx(one.slip_safety, rel=0.01)

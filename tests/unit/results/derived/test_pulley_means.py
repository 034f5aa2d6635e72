from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.results import Run, summarize
from beltdyn.results.derived import hub_loads, slip_safety, tension_ratios

MakeRun = Callable[..., Run]


def test_hub_loads_as_vectors(make_run: MakeRun) -> None:
    force = np.tile([[3.0, 4.0], [0.0, -2.0]], (101, 1, 1))
    loads = hub_loads(make_run(hub_force=force))
    np.testing.assert_allclose(loads["hub_load"], np.tile([5.0, 2.0], (101, 1)))
    np.testing.assert_allclose(loads["hub_direction"][0], [np.arctan2(4.0, 3.0), -0.5 * np.pi])
    assert loads["hub_load"].dims == ("time", "pulley")


def test_safeties_over_time_end_where_the_summary_does(run: Run) -> None:
    """Tensions of 30 and 60 N: (90 - 2 m v^2) tanh(0.6 pi) / 30 at the same sum, which fixed centers let grow."""
    speed, mass = 12.0 * 0.08125, run.drive.belt.mass_per_length
    at_same_sum = (90.0 - 2.0 * mass * speed**2) * np.tanh(0.6 * np.pi) / 30.0
    safeties = slip_safety(run, start=0.7)
    assert [pulley.slip_safety for pulley in summarize(run).pulleys] == pytest.approx(safeties[-1].values)
    assert np.all((safeties > at_same_sum) & (safeties < 1.4 * at_same_sum))
    assert np.isnan(slip_safety(run, end=0.04)).all()


def test_tension_ratio_of_slack_spans_is_unknown(make_run: MakeRun) -> None:
    tension = np.tile([20.0, 60.0], (101, 1))
    tension[50:, 0] = 0.0
    ratios = tension_ratios(make_run(span_tension=tension))
    np.testing.assert_allclose(ratios[:50], 3.0)
    assert np.isnan(ratios[50:]).all()


def test_tension_ratio_does_not_depend_on_the_unit_of_tension(make_run: MakeRun) -> None:
    for unit in (1.0, 1e-3):
        ratios = tension_ratios(make_run(span_tension=np.tile([20.0 * unit, 60.0 * unit], (101, 1))))
        np.testing.assert_allclose(ratios, 3.0)

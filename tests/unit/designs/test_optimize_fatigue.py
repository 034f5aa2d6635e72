"""Fatigue among the results of studies: its names and units, and limits of an optimization."""

import numpy as np
import pytest

from beltdyn.designs.batch import OperatingPoint
from beltdyn.designs.named_results import names_of, scalar_results, unit_of, values_of
from beltdyn.designs.optimization_history import aims_of
from beltdyn.model import Drive, OptimizationStudy
from beltdyn.results.damage import hourly_damage
from beltdyn.state.steady import steady_state

TORQUE = {"path": "belt.installed_tension", "least": "250 N", "largest": "350 N"}


def test_damage_and_lives_are_results_of_steady_running(fatigue_drive: Drive) -> None:
    run = steady_state(fatigue_drive)
    found, damage = values_of(run, scalar_results(run)), hourly_damage(run)
    assert found["cord_life"] == pytest.approx(1.0 / damage.cord.sum())
    assert found["rib_damage[large]"] == damage.rib[1]
    names = names_of(fatigue_drive)
    assert {"cord_life", "rib_life", "cord_damage[small]", "rib_damage_rate"} <= set(names)
    assert [unit_of(name, fatigue_drive) for name in ("cord_life", "cord_damage[small]", "cord_force")] == [
        "h",
        "1/h",
        "N",
    ]


def test_a_life_is_a_limit(fatigue_drive: Drive) -> None:
    study = OptimizationStudy(
        number=[TORQUE],
        goal={"result": "hub_load"},
        requirement=[{"result": "cord_life", "at_least": "8000 h"}, {"result": "slip_safety", "at_least": 1.5}],
    )
    aims = aims_of(study, fatigue_drive, [OperatingPoint("", 1.0, lambda drive: drive)])
    life = next(limit for limit in aims.limits if "cord_life" in limit.name)
    assert (life.value, life.sign) == (8000.0, 1.0)
    values = np.full((1, len(aims.watched)), 1.6)
    values[0, life.result] = 4000.0
    assert aims.violation(values) == pytest.approx(0.5)

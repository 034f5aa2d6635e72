"""Powers of a run made by formulas: 2.4375 N m at 12 rad/s, losses of 0.1 J for each radian."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.results import Run, power_balance
from beltdyn.results.cycles import plain_window
from beltdyn.results.energy_balance import Balance

TORQUE = 30.0 * 0.08125
MakeRun = Callable[..., Run]


def test_powers_of_the_end_of_a_run(run: Run) -> None:
    balance = power_balance(run.dataset, plain_window(run.dataset["time"].values, 0.9))
    assert balance.pulleys == pytest.approx((12.0 * TORQUE, -0.995 * 12.0 * TORQUE))
    assert balance.power_in == pytest.approx(12.0 * TORQUE)
    out = 0.995 * 12.0 * TORQUE
    assert balance.efficiency == pytest.approx(out / (out + 1.2))
    lost = {"friction": 0.09 * 12, "contact damping": 0.01 * 12}
    assert balance.losses == pytest.approx(dict.fromkeys(balance.losses, 0.0) | lost)
    assert balance.lost == pytest.approx(1.2)
    assert balance.stored == pytest.approx(0.0, abs=1e-9)


def test_stored_energy_counts_all_that_is_held(make_run: MakeRun) -> None:
    time = np.linspace(0.0, 1.0, 101)
    names = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
    changed: dict[str, Any] = {name: 10.0**power * time for power, name in enumerate(names)}
    assert power_balance(make_run(**changed).dataset).stored == pytest.approx(11111.0)


def test_one_output_has_no_rates(make_run: MakeRun) -> None:
    balance = power_balance(make_run(outputs=1).dataset)
    assert (balance.lost, balance.stored, balance.power_in) == (0.0, 0.0, 0.0)
    assert np.isnan(balance.efficiency)


def test_a_drive_that_delivers_no_power_has_no_efficiency() -> None:
    """All power of a level conveyor is lost to its supports and goods; lifting is useful, and sinking goods drive."""
    lifts = Balance(pulleys=(1000.0, 0.0), losses={"supports and goods": 600.0}, stored=0.0, lifted=400.0)
    assert (lifts.power_in, lifts.power_out, lifts.efficiency) == (1000.0, 400.0, 0.4)
    sinks = Balance(pulleys=(-300.0, 0.0), losses={"supports and goods": 100.0}, stored=0.0, lifted=-400.0)
    assert (sinks.power_in, sinks.power_out, sinks.efficiency) == (400.0, 300.0, 0.75)
    assert math.isnan(Balance(pulleys=(1000.0, 0.0), losses={"supports and goods": 1000.0}, stored=0.0).efficiency)
    assert Balance(pulleys=(1000.0, -900.0), losses={"friction": 100.0}, stored=0.0).efficiency == pytest.approx(0.9)

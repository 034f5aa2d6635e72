"""Validated: what V-belt drives lose, as published, in steady running with the loss factors of the catalogue.

Published: 95 to 98 % (Gates, "Belt Drive Efficiencies"), 93 to 95 % of single V-belts with their bearings, which
are not modeled; torque losses in proportion to 1/R (Childs and Cowburn 1987).
"""

from collections.abc import Callable
from importlib.resources import files

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model.hysteresis import bending_resistance, compression_losses
from beltdyn.results.energy_balance import Balance
from beltdyn.results.summary import summarize
from beltdyn.state.steady import steady_state

pytestmark = pytest.mark.slow

EXAMPLES = files("beltdyn") / "examples"


def losses_by_hand(drive: bd.Drive) -> dict[str, float]:
    """Forces that hold the belt back, N."""
    return {
        "belt bending": bending_resistance(bd.model.prepare(drive)),
        "belt compression": float(compression_losses(bd.model.prepare(drive)).sum()),
    }


@pytest.mark.parametrize("name", ["fan_direct_start", "unequal_radii"])
def test_efficiency_of_the_examples(name: str, measured: Callable[..., None]) -> None:
    """As published; compression takes its closed form within 15 %: a driving arc lies mostly under the tight side."""
    drive = bd.load(str(EXAMPLES / f"{name}.toml"))
    summary = summarize(steady_state(drive))
    balance, speed = summary.balance, summary.spans[0].belt_speed
    over = {cause: balance.losses[cause] / (speed * force) for cause, force in losses_by_hand(drive).items()}
    measured(efficiency=balance.efficiency, **{cause.replace(" ", "_"): ratio for cause, ratio in over.items()})
    assert 0.95 < balance.efficiency < 0.98
    assert over["belt compression"] == pytest.approx(1.0, rel=0.15)


def balance_at(radius: float) -> tuple[Balance, float]:
    """One SPZ on two equal pulleys, 10 m/s, without load but what it loses; powers, and the speed of the belt."""
    drive = bd.loads(f"""
[belt]
profile = "SPZ"
ribs = 1
installed_tension = 250.0

[[pulley]]
name = "driver"
center = [0.0, 0.0]
radius = {radius}
speed = {{kind = "constant", value = {10.0 / radius}}}

[[pulley]]
name = "driven"
center = [0.5, 0.0]
radius = {radius}
inertia = 1e-3

[simulation]
duration = 0.1
output_interval = 1e-3
""")
    summary = summarize(steady_state(drive))
    return summary.balance, summary.spans[0].belt_speed


def test_torque_losses_go_by_the_inverse_radius(measured: Callable[..., None]) -> None:
    """Without load, from 32 to 80 mm: an exponent of -1 within 0.1."""
    radii, torques = np.array([0.032, 0.05, 0.08]), []
    for radius in radii.tolist():
        balance, speed = balance_at(radius)
        torques.append(radius * (balance.losses["belt bending"] + balance.losses["belt compression"]) / speed)
    exponent = float(np.polyfit(np.log(radii), np.log(torques), 1)[0])
    measured(exponent=exponent)
    assert exponent == pytest.approx(-1.0, abs=0.1)

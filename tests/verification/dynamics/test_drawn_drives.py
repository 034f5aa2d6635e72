"""Steady running of drives drawn at random, against an independent balance of lumped spans."""

import re
from collections.abc import Callable, Sequence
from math import radians
from typing import Any

import numpy as np
import pytest

from beltdyn import steady_state
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from tests.lumped.drawn_drives import SEED, drawn_drive, idler_between
from tests.lumped.seeds import blocks

LEAST, MOST = 0.05, 0.95
"""Loads, over those that a drive transmits by the lumped balance."""
SURE = 0.97
"""Load that is transmitted for sure, over the same: that of the balance is right within 3 %."""


def load_of(seed: int) -> float:
    return float(np.random.default_rng([SEED, 1, seed]).uniform(LEAST, MOST))


@blocks(range(6), 2000, 100)
def test_every_drive_runs_with_the_tensions_of_the_balance(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    """The balance leaves out hysteresis and the ends of short spans: 0.7 % of the largest tension."""
    errors = dict[int, float]()
    for seed in seeds:
        drawn, load = drawn_drive(seed), load_of(seed)
        tensions = steady_state(drawn.under(load)).dataset.span_tension.values[-1]
        expected = drawn.balance.at(load).tensions
        errors[seed] = float(np.max(np.abs(tensions - expected)) / np.max(expected))
    worst = max(errors, key=lambda seed: errors[seed])
    measured(drives=len(errors), median=float(np.median(list(errors.values()))), worst=errors[worst], seed=worst)
    assert errors[worst] < 0.02


@blocks(range(2000, 2001), 2050, 10)
def test_a_sweep_of_loads_has_no_hole(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    """Each of 40 loads is found from rest, up to where the balance loses its grip, which it knows within 3 %."""
    loads, missing, last = (np.arange(1, 41) / 40).tolist(), dict[int, list[float]](), dict[int, float]()
    for seed in seeds:
        drawn = drawn_drive(seed)
        found = [load for load in loads if _runs(drawn.under(load))]
        last[seed] = max(found, default=0.0)
        missing[seed] = sorted({load for load in loads if load <= max(last[seed], SURE)} - set(found))
    measured(sweeps=len(last), missing=sum(map(len, missing.values())), least_limit=min(last.values()))
    assert not any(missing.values()), missing


def _runs(drive: Drive) -> bool:
    try:
        steady_state(drive)
    except ConvergenceError:
        return False
    return True


@blocks(range(4), 60, 20)
def test_a_refusal_names_the_pulley_that_limits_and_its_torque(seeds: Sequence[int]) -> None:
    """Of pulleys that use their grip alike, within 5 %, either may be named."""
    for seed in seeds:
        drawn, load = drawn_drive(seed), float(np.random.default_rng([SEED, 2, seed]).uniform(1.1, 2.0))
        with pytest.raises(ConvergenceError) as caught:
            steady_state(drawn.under(load))
        named = re.search(r"slips on `pulley (\d)`, which transmits at most (\S+) N m of", str(caught.value))
        assert named, (seed, str(caught.value))
        pulley, state = int(named[1]), drawn.limit.state
        pull = abs(float(state.tensions[pulley] - state.tensions[pulley - 1]))
        assert state.use[pulley] > 0.95, (seed, str(caught.value))
        assert float(named[2]) == pytest.approx(pull * float(drawn.drive.radii[pulley]), rel=0.03), seed


@pytest.mark.parametrize("tension", [*(pytest.param(one, marks=pytest.mark.slow) for one in (100.0, 200.0)), 600.0])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_idlers_of_small_wrap_under_a_stiff_belt(tension: float, sign: float) -> None:
    """The belt bends over them with hysteresis, nowhere with the curvature of their rims."""
    for wrap in (1.0, 2.5, 5.0, 15.0):
        ring = idler_between(sign * 0.035, radians(wrap))
        names: list[dict[str, Any]] = [{"name": f"pulley {k}", "inertia": 1e-3} for k in range(3)]
        for one, center, radius in zip(names, ring.centers.tolist(), ring.radii.tolist(), strict=True):
            one |= {"center": center, "radius": abs(radius), "side": "inside" if radius > 0.0 else "outside"}
        names[0]["speed"] = {"kind": "constant", "value": 200.0}
        names[2]["torque"] = {"kind": "constant", "value": -0.3 * tension * 0.03}
        belt = {"profile": "PK", "ribs": 6, "installed_tension": tension}
        drive = Drive(belt=belt, pulley=names, simulation={"duration": 1.0, "output_interval": 0.01})
        tensions = steady_state(drive).dataset.span_tension.values[-1]
        assert float(np.ptp(tensions)) == pytest.approx(0.3 * tension * 0.03 / float(drive.radii[2]), rel=0.15)

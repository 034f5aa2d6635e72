"""Steady running of drives whose tensioners move far, against a lumped balance with the moving arm."""

import re
from collections.abc import Callable, Sequence
from contextlib import nullcontext
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest

from beltdyn import load, steady_state
from beltdyn.errors import ConvergenceError
from beltdyn.points.changed_drive import held_at, with_load
from beltdyn.results import Run
from tests.lumped.drawn_drives import SEED, drawn_arm_drive
from tests.lumped.lumped_balance import LumpedBalance
from tests.lumped.seeds import blocks
from tests.verification.dynamics.test_drawn_drives import SURE


def part_of(seed: int, low: float, high: float) -> float:
    return float(np.random.default_rng([SEED, 4, seed]).uniform(low, high))


@blocks(range(3), 1000, 50)
def test_every_drive_runs_with_the_tensions_of_the_balance(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    """From 5 to 99 % of the load at which a pulley slips or the arm gives way; one of 1000 may be refused."""
    errors, refused = dict[int, float](), list[int]()
    for seed in seeds:
        drawn, part = drawn_arm_drive(seed), part_of(seed, 0.05, 0.99)
        try:
            tensions = steady_state(drawn.under(part)).dataset.span_tension.values[-1]
        except ConvergenceError:
            refused.append(seed)
            continue
        expected = drawn.balance.at(part).tensions
        errors[seed] = float(np.max(np.abs(tensions - expected)) / np.max(expected))
    worst = max(errors, key=lambda seed: errors[seed])
    measured(
        drives=len(seeds), refused=len(refused), median=float(np.median(list(errors.values()))), worst=errors[worst]
    )
    assert len(refused) <= len(seeds) // 1000, refused
    assert errors[worst] < 0.02, worst


@blocks(range(3), 250, 25)
def test_a_refusal_states_the_limit_of_the_balance_and_its_cause(
    seeds: Sequence[int], measured: Callable[..., None]
) -> None:
    """A pulley that uses its grip within 5 % of the worst may be named for it; the torque is right within 3 %."""
    errors = dict[int, float]()
    for seed in seeds:
        drawn, part = drawn_arm_drive(seed), part_of(seed, 1.05, 2.0)
        with pytest.raises(ConvergenceError) as caught:
            steady_state(drawn.under(part))
        state, text = drawn.limit.state, str(caught.value)
        slips = re.search(r"slips on `pulley (\d)`, which transmits at most (\S+) N m", text)
        gives_way = re.search(r"tensioner of `pulley \d` balances the belt up to (\S+)% of the loads", text)
        if drawn.limit.cause == "arm":
            assert gives_way, (seed, text)
            errors[seed] = abs(0.01 * float(gives_way[1]) * part - 1.0)
        else:
            assert slips, (seed, text)
            pulley = int(slips[1])
            assert state.use[pulley] > 0.95, (seed, text)
            pull = abs(float(state.tensions[pulley] - state.tensions[pulley - 1]))
            errors[seed] = abs(float(slips[2]) / (pull * float(drawn.drive.radii[pulley])) - 1.0)
    measured(refusals=len(errors), median=float(np.median(list(errors.values()))), worst=max(errors.values()))
    assert max(errors.values()) < 0.03, errors


@blocks(range(2000, 2001), 2200, 5)
def test_a_sweep_of_loads_has_no_hole(seeds: Sequence[int], measured: Callable[..., None]) -> None:
    loads, missing = (np.arange(1, 41) / 40).tolist(), dict[int, list[float]]()
    for seed in seeds:
        drawn, found = drawn_arm_drive(seed), list[float]()
        for part in loads:
            try:
                steady_state(drawn.under(part))
            except ConvergenceError:
                continue
            found.append(part)
        missing[seed] = sorted({part for part in loads if part <= max([*found, SURE])} - set(found))
    measured(sweeps=len(missing), missing=sum(map(len, missing.values())))
    assert not any(missing.values()), missing


@blocks((0, 1, 3, 48), 200, 25)
def test_the_band_of_dry_friction_ends_where_the_balance_does(
    seeds: Sequence[int], measured: Callable[..., None]
) -> None:
    """Where the whole friction leads to slip, the part of it that is stated does so in the balance, within 3 %."""
    errors, slipping, missing = list[float](), 0, list[int]()
    for seed in seeds:
        drawn, part = drawn_arm_drive(seed), part_of(seed, 0.05, 0.99)
        arm, run = drawn.drive.moving_tensioners[0], steady_state(drawn.under(part))
        attributes = run.dataset.attrs
        for name, sense in (("tensioning", -1.0), ("yielding", 1.0)):
            push = sense * getattr(arm, f"{name}_friction")
            if push == 0.0:
                continue
            end = attributes.get(f"tensioner_position_after_{name}")
            if end is None:
                missing.append(seed)
                continue
            used, base = attributes.get(f"friction_used_after_{name}"), drawn.balance.at(part)
            there = pushed(drawn.balance, push if used is None else float(used) * push).at(part, base)
            if used is None:
                movements = end - run.dataset.tensioner_position.values[-1], there.positions - base.positions
                errors.append(float(np.max(np.abs(movements[0] - movements[1]))) / drawn.balance.springs[0].scale)
            else:
                slipping += 1
                errors.append(abs(float(there.use.max()) - 1.0))
    measured(ends=len(errors), slipping=slipping, median=float(np.median(errors)), worst=max(errors))
    assert not missing
    assert max(errors) < 0.03


def pushed(balance: LumpedBalance, push: float) -> LumpedBalance:
    """The balance with a force (N or N m) on its tensioner besides that of the spring."""
    spring = balance.springs[0]
    return replace(balance, springs=(spring._replace(force=lambda q: spring.force(q) + push),))


@pytest.mark.parametrize("name", ["alternator_drive", "accessory_drive", "tensioner_stop"])
def test_examples_run_up_to_the_limit_of_the_balance(name: str) -> None:
    """Their loads depend little on speed; the drag of clutches, and the weight of the arm, are left out.

    Beyond it loads that fall with speed let a drive run on with gross slip, which its warnings tell.
    """
    drive = load(str(files("beltdyn") / "examples" / f"{name}.toml"))
    held = held_at(steady_state(drive).drive, None)
    limit = LumpedBalance.of(held).limit()
    for part in (0.3, 0.6, 0.9, 0.95):
        assert not slips_grossly(steady_state(with_load(held, part * limit.factor)))
    with nullcontext() if name == "accessory_drive" else pytest.raises(ConvergenceError, match="slips on"):
        assert slips_grossly(steady_state(with_load(held, 1.05 * limit.factor)))


def slips_grossly(run: Run) -> bool:
    return any("gross slip: the belt slides on the whole arc" in warning for warning in run.warnings)

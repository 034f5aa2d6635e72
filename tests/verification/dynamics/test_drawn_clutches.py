"""Steady running of drives whose friction clutches slip: the belt takes their capacity, and what lies behind stops."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest

from beltdyn import load, steady_state
from beltdyn.errors import ConvergenceError
from beltdyn.machines import FrictionClutch, Resistance
from beltdyn.model import Drive
from beltdyn.points.changed_drive import held_at, with_load
from tests.lumped.drawn_drives import SEED, Drawn, drawn_drive
from tests.lumped.lumped_balance import LumpedBalance
from tests.lumped.seeds import blocks


def clutched(drawn: Drawn, rng: np.random.Generator) -> tuple[Drive, LumpedBalance]:
    """The drive with a clutch, and a load from half to three times its capacity, at each loaded pulley; its balance.

    The capacities are 30 to 90 % of the loads at which the belt slips.
    """
    pulleys, torques = list(drawn.drive.pulleys), drawn.balance.torques.copy()
    for p, pulley in enumerate(pulleys):
        if pulley.torque is None or pulley.prescribed:
            continue
        capacity = rng.uniform(0.3, 0.9) * abs(float(torques[p]))
        taken = capacity * float(np.exp(rng.uniform(np.log(0.5), np.log(3.0))))
        running = abs(drawn.balance.speed / float(drawn.balance.radii[p]))
        hub = FrictionClutch(
            kind="friction_clutch",
            capacity=capacity,
            locking_damping=1e4 * capacity / running,
            inertia=pulley.inertia,
        )
        resistance = Resistance(kind="resistance", constant=taken, creep_speed=1e-3 * running)
        pulleys[p] = pulley.replace(torque=None, load=(resistance,), hub=(hub,))
        torques[p] = np.sign(torques[p]) * min(capacity, taken)
    return drawn.drive.replace(pulley=pulleys), replace(drawn.balance, torques=torques)


@blocks(range(4), 300, 50)
def test_every_drive_runs_with_the_tensions_of_the_limited_torques(
    seeds: Sequence[int], measured: Callable[..., None]
) -> None:
    """Whether no clutch slips, some do, or all; one of 1000 may be refused."""
    errors, refused = dict[int, float](), dict[int, str]()
    for seed in seeds:
        drive, balance = clutched(drawn_drive(seed), np.random.default_rng([SEED, 11, seed]))
        expected = balance.at(1.0)
        if expected.use.max() > 0.95:  # a torque that the others balanced
            continue
        try:
            tensions = steady_state(drive).dataset.span_tension.values[-1]
        except ConvergenceError as error:
            refused[seed] = str(error)
            continue
        errors[seed] = float(np.max(np.abs(tensions - expected.tensions)) / np.max(expected.tensions))
    worst = max(errors, key=lambda seed: errors[seed])
    measured(
        drives=len(errors), refused=len(refused), median=float(np.median(list(errors.values()))), worst=errors[worst]
    )
    assert len(refused) <= len(seeds) // 1000, refused
    assert errors[worst] < 0.02, worst


def test_accessories_run_on_where_the_clutch_of_the_compressor_slips() -> None:
    """At four times its load of 9 N m it takes the 30 N m of its clutch."""
    example = load(str(files("beltdyn") / "examples" / "accessory_drive.toml"))
    held = held_at(steady_state(example.with_({"contact.friction": 0.6})).drive, None)
    compressor = held.number_of("compressor")
    for factor in (3.3, 3.4, 4.0, 8.0):
        torques = steady_state(with_load(held, factor)).dataset.pulley_torque.values[-1]
        assert abs(float(torques[compressor])) == pytest.approx(min(30.0, 9.0 * factor), rel=1e-3)

"""Steady running of drives drawn at random, against an independent balance of lumped spans."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn import steady_state
from tests.lumped.drawn_drives import SEED, drawn_drive

LEAST, MOST = 0.05, 0.95
"""Loads, over those that a drive transmits by the lumped balance."""


def load_of(seed: int) -> float:
    return float(np.random.default_rng([SEED, 1, seed]).uniform(LEAST, MOST))


@pytest.mark.parametrize("seeds", [range(20), pytest.param(range(21, 100), marks=pytest.mark.slow)], ids=len)
def test_every_drive_runs_with_the_tensions_of_the_balance(seeds: range, measured: Callable[..., None]) -> None:
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

from math import pi, sqrt

import pytest

from validation.paper.hand_formulas import (
    creep_lag,
    creeping_torsional_swing,
    gross_slip_torque,
    torsional_swing,
)
from validation.published import two_pulley


def test_torsional_swing_by_hand() -> None:
    """I = 0.1 kg m^2, k = 1e4 N / 0.382882 m, R = 0.08125 m."""
    swing = torsional_swing(two_pulley())
    assert swing.frequency == pytest.approx(sqrt(2.0 * 1e4 / 0.382882 * 0.08125**2 / 0.1) / (2.0 * pi), rel=1e-6)
    assert swing.decay == 0.0


def test_a_belt_that_neither_creeps_nor_sinks_in_swings_on_its_spans() -> None:
    """Creep reaches in by sqrt(E A / (omega nu_s)), 4e-7 m at each of four ends."""
    drive = two_pulley(creep_rate_factor=1e15)
    rigid = drive.replace(contact=drive.contact.replace(stiffness=1e15))
    swing = creeping_torsional_swing(rigid)
    assert swing.frequency == pytest.approx(torsional_swing(rigid).frequency, rel=3e-6)
    assert 0.0 < swing.decay < 1e-3


def test_creep_slows_and_damps_the_swing() -> None:
    factors = (1e7, 1e6, 1e5)
    swings = [creeping_torsional_swing(two_pulley(creep_rate_factor=factor)) for factor in factors]
    assert swings[0].frequency > swings[1].frequency > swings[2].frequency
    assert 0.0 < swings[0].decay < swings[1].decay < swings[2].decay


@pytest.mark.parametrize(
    ("factor", "by_hand"),
    [(1.0, 2.0 * 0.5 / (pi * 0.08125**3 * 1.0)), (1e8, 12.0 * 0.5 / (0.08125 * 1e4))],
    ids=["friction spread evenly", "elastic creep"],
)
def test_limits_of_the_creep_lag(factor: float, by_hand: float) -> None:
    """The first correction is (a / 2 l)^2 / 3 with a / 2 l = 1e-5, the other exp(-2 a / 2 l) with 1e3."""
    assert creep_lag(two_pulley(creep_rate_factor=factor), 0.5, 12.0) == pytest.approx(by_hand, rel=1e-6)


def test_gross_slip_by_euler() -> None:
    assert gross_slip_torque(two_pulley()) == pytest.approx(4.12, abs=0.01)

"""Damage of cords and ribs, by the closed form of two pulleys under constant load."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import CordFatigue, Drive
from beltdyn.results import Run
from beltdyn.results.damage import (
    HOUR,
    Damage,
    Lives,
    damage_of_run,
    fatigue_by_name,
    hourly_damage,
    known_variables,
    miner,
    rainflow_of_turn,
)
from beltdyn.results.mechanics import SpanTension
from beltdyn.state.steady import steady_state
from beltdyn.transient.simulate import simulate

BENDING, T1, T2 = 12.0, 370.0, 240.0


@pytest.fixture(scope="module")
def steady(fatigue_drive: Drive) -> Run:
    return steady_state(fatigue_drive)


def line_of(drive: Drive) -> CordFatigue:
    assert drive.belt.cord_fatigue is not None
    return drive.belt.cord_fatigue


@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0])
def test_two_pulleys_by_hand(fatigue_drive: Drive, exponent: float) -> None:
    """Per turn a cycle between T2 and T1 + B/r of the smaller pulley, and one from T1 to T1 + B/r of the larger."""
    line, radii = line_of(fatigue_drive).replace(range_exponent=exponent), fatigue_drive.radii
    small, large = T1 + BENDING / radii
    turn = np.array([T1, small, T2 + BENDING / radii[0], T2, T2 + BENDING / radii[1], large])
    pulley = np.array([0, 0, 0, 1, 1, 1])
    damage, force = miner(line, rainflow_of_turn(turn), pulley, 2)
    counted = line.equivalent_force([T2, T1], [small, large])
    np.testing.assert_allclose(damage, 1.0 / line.cycles_to_failure(counted), rtol=1e-12)
    assert force == pytest.approx(counted.max())


def test_slack_cords_do_no_damage(fatigue_drive: Drive) -> None:
    damage, force = miner(line_of(fatigue_drive), rainflow_of_turn(np.array([-5.0, -1.0])), np.array([0, 1]), 2)
    assert damage.tolist() == [0.0, 0.0]
    assert force == 0.0


def test_cords_in_steady_running(steady: Run) -> None:
    """The closed form, but that the belt unbends at the end of the driven arc before it has all of its tension.

    At the ends of arcs the curvature swings over that of the pulley, by 1 % on the softness of this contact.
    """
    drive, line = steady.drive, line_of(steady.drive)
    tight = float(steady.dataset.span_tension.values[-1].max())
    closed = tight + BENDING / drive.radii
    damage = hourly_damage(steady)
    swung = tight + 1.01 * BENDING / drive.radii[0]
    assert closed[0] < damage.force < swung
    slope = np.log(100.0) / np.log(900.0 / 600.0)
    by_hand = damage.turns / line.cycles_to_failure(closed)
    assert 1.0 < damage.cord[0] / by_hand[0] < (swung / closed[0]) ** slope
    assert 0.97**slope < damage.cord[1] / by_hand[1] < 1.0
    speed = 157.08 * drive.radii[0]
    assert damage.turns == pytest.approx(HOUR * speed / drive.belt_length, rel=0.01)


def test_ribs_in_steady_running(steady: Run) -> None:
    """Each pulley once a turn, at the larger of its tensions; half the diameter is 2^5.6 times the damage."""
    law, damage = steady.drive.belt.rib_fatigue, hourly_damage(steady)
    assert law is not None
    before, after = SpanTension.of(lambda name: steady.dataset[name].values[-1]).at_arcs(steady.prepared)
    tight = np.maximum(before, after)
    assert damage.rib[0] / damage.rib[1] == pytest.approx(2.0**5.6 * (tight[0] / tight[1]) ** 1.13, rel=1e-6)
    assert damage.rib[0] == pytest.approx(damage.turns * (tight[0] / 100.0) ** 1.13 * 0.9**-5.6, rel=1e-6)


def test_heat_halves_the_life_of_ribs(steady: Run, fatigue_drive: Drive) -> None:
    drive = steady.drive
    hot = Run(steady.dataset, drive.replace(belt=drive.belt.replace(temperature="103 °C")))
    np.testing.assert_allclose(hourly_damage(hot).rib, 2.0 * hourly_damage(steady).rib, rtol=1e-12)


def test_values_by_name(steady: Run) -> None:
    found, damage = fatigue_by_name(steady), hourly_damage(steady)
    assert found["cord_life"] == pytest.approx(1.0 / damage.cord.sum())
    assert found["rib_life"] == pytest.approx(1e9 / damage.rib.sum())
    np.testing.assert_array_equal(found["cord_damage"], damage.cord)
    assert found["rib_damage_rate"] == damage.rib.sum()
    assert list(found) == known_variables(steady.drive)


def test_without_data_there_is_no_number(steady: Run) -> None:
    drive = steady.drive
    law = drive.belt.rib_fatigue
    assert law is not None
    bare = drive.replace(belt=drive.belt.replace(cord_fatigue=None, rib_fatigue=None))
    assert fatigue_by_name(Run(steady.dataset, bare)) == {}
    relative = drive.replace(belt=drive.belt.replace(cord_fatigue=None, rib_fatigue=law.replace(passages=None)))
    assert sorted(fatigue_by_name(Run(steady.dataset, relative))) == ["rib_damage", "rib_damage_rate"]


def test_a_life_beyond_the_line_is_a_lower_bound(fatigue_drive: Drive) -> None:
    """Below the last point, at 1e9 cycles, the life is at least 1e9 turns."""
    zero = np.zeros(2)
    strong = Lives(fatigue_drive, Damage(np.array([1e-7, 0.0]), zero, 1000.0, 650.0))
    weak = Lives(fatigue_drive, Damage(np.array([1e-7, 0.0]), zero, 1000.0, 500.0))
    assert strong.cord == pytest.approx(1e7)
    assert weak.cord == pytest.approx(1e6)
    assert [strong.is_bound, weak.is_bound] == [False, True]


def test_a_run_at_constant_load(make_run: Callable[..., Run], fatigue_drive: Drive) -> None:
    """Turns are those of the shafts, and forces lie between the tension and the closed form of a full arc."""
    made = make_run(outputs=201)
    belt = fatigue_drive.belt
    line = line_of(fatigue_drive).replace(forces=(90.0, 60.0), bending_force=0.5)
    data = {"cord_fatigue": line, "rib_fatigue": belt.rib_fatigue}
    run = Run(made.dataset, made.drive.replace(belt=made.drive.belt.replace(**data)))
    damage, radius = damage_of_run(run), run.drive.radii[0]
    stiff = 0.5 * run.drive.belt.bending_stiffness / radius**2
    way = run.drive.pulleys[0].radius * float(run.dataset.pulley_angle[-1, 0])
    assert damage.turns == pytest.approx(way / run.drive.path.length, rel=0.01)
    assert 60.0 < damage.force < 60.0 + stiff + 0.5 / radius
    assert damage.rib[0] > 0.0
    assert damage.cord.sum() > 0.0


def test_steady_running_as_a_run(steady: Run) -> None:
    elapsed = float(np.ptp(steady.dataset.time.values)) / HOUR
    np.testing.assert_allclose(damage_of_run(steady).cord, elapsed * hourly_damage(steady).cord)


@pytest.mark.slow
def test_a_run_from_steady_running(steady: Run, fatigue_drive: Drive) -> None:
    """Over three turns of the belt in time: the damage of steady running, but for half cycles at both ends."""
    settings = fatigue_drive.simulation.replace(duration=0.6, start="steady")
    damage, hourly = damage_of_run(simulate(fatigue_drive.replace(simulation=settings))), hourly_damage(steady)
    assert damage.turns == pytest.approx(0.6 * hourly.turns / HOUR, rel=1e-3)
    assert damage.cord[0] / damage.turns == pytest.approx(hourly.cord[0] / hourly.turns, rel=0.05)
    np.testing.assert_allclose(damage.rib / damage.turns, hourly.rib / hourly.turns, rtol=1e-4)

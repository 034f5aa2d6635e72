"""Steady running by the balance about rest, against finite elements and closed forms."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, prepare
from beltdyn.points.changed_drive import at_instant
from beltdyn.points.quasi_steady import QuasiSteady, Torques, torque_of, torques_between, torques_of
from beltdyn.results.sag import weight_of_meter
from beltdyn.state.installation import looked_at
from beltdyn.state.staying import bring_to_stand


def steady_of(drive: Drive) -> QuasiSteady:
    rest = bring_to_stand(prepare(at_instant(drive, None)))
    return QuasiSteady(rest.prepared, looked_at(rest.prepared, rest.system, rest.state).installation)


@pytest.fixture(scope="module")
def alternator() -> QuasiSteady:
    return steady_of(example("alternator_drive"))


def test_tensions_hub_loads_and_positions_are_those_of_finite_elements(alternator: QuasiSteady) -> None:
    """Within 0.5 %: what bending changes with the tension."""
    torques = torques_of(alternator.drive, alternator.driver)
    speed = alternator.belt_speed(alternator.drive, torques)
    found = alternator.at(np.array([speed]), torques(speed)[None], np.zeros(1))
    run = bd.steady_state(alternator.drive).dataset.isel(time=-1)
    largest = float(run.span_tension.max())
    np.testing.assert_allclose(found.tension[0], run.span_tension, atol=5e-3 * largest)
    np.testing.assert_allclose(found.hub_force[0], run.hub_force, atol=1e-2 * largest)
    np.testing.assert_allclose(found.positions[0], run.tensioner_position, atol=2e-3)
    np.testing.assert_allclose(found.torque[0], run.shaft_torque, atol=0.05)
    safety = alternator.slip_safety(found, np.array([1.0, 0.5]))
    means = bd.summarize(bd.steady_state(alternator.drive)).pulleys
    for values, name in zip(safety, ("slip_safety", "own_load_safety"), strict=True):
        np.testing.assert_allclose(values[0, 0], [getattr(one, name) for one in means], rtol=0.02)
        lower = values[1, 0] / values[0, 0]
        assert np.isnan(lower[1])  # the tensioner has no load
        assert np.all(lower[[0, 2]] < 0.8)


def test_slip_safeties_of_other_loads_lead_to_the_same_loads(alternator: QuasiSteady) -> None:
    """At rest all states are on one path of the loads, with one slip of each pulley and one slack span."""
    torques = torques_of(alternator.drive, alternator.driver)(
        alternator.belt_speed(alternator.drive, torques_of(alternator.drive, alternator.driver))
    )
    loads = np.array([0.4, 0.5, 0.7, 1.0, 1.5, 2.0])
    still = np.zeros(loads.size)
    found = alternator.slip_safety(alternator.at(still, loads[:, None] * torques, still), np.ones(1)).all_loads[0]
    loaded = np.isfinite(found).all(axis=0)
    assert loaded.sum() == 2
    np.testing.assert_allclose((found * loads[:, None])[:, loaded] / found[3, loaded], 1.0, rtol=1e-4)


def test_acceleration_adds_the_torque_of_all_inertias(alternator: QuasiSteady) -> None:
    speed, acceleration = np.full(2, 10.0), np.array([0.0, 5.0])
    found = alternator.at(speed, np.zeros((2, 3)), acceleration)
    radii = alternator.prepared.path.radii
    change = np.diff(found.torque, axis=0)[0]
    others = alternator.inertia[1:] * acceleration[1] / radii[1:] ** 2
    assert change[0] == pytest.approx(radii[0] * others.sum() + alternator.inertia[0] * acceleration[1] / radii[0])
    tension = found.tension[1] - np.roll(found.tension[1], 1) - (found.tension[0] - np.roll(found.tension[0], 1))
    np.testing.assert_allclose(tension[1:], others, rtol=1e-6)


@pytest.mark.parametrize("speed", [0.0, 3.0])
def test_hub_loads_carry_the_weight_of_the_belt(speed: float) -> None:
    """The arcs, and the spans between, whatever their direction."""
    drive = example("two_pulley")
    belt = drive.belt.replace(mass_per_length=2.0)
    heavy = steady_of(drive.replace(gravity=[-3.0, -9.0], belt=belt, pulley=drive.pulleys))
    torque, meter = np.zeros((1, 2)), weight_of_meter(heavy.prepared, heavy.balance.tension)[0]
    found = heavy.at(np.array([speed]), torque, np.zeros(1))
    assert np.all(found.tension > 2.0 * heavy.prepared.belt.mass_per_length * speed**2)
    carried = meter * float(heavy.rest.path.length)
    np.testing.assert_allclose(
        found.hub_force[0].sum(axis=0), carried, rtol=1e-3, atol=1e-3 * float(np.linalg.norm(carried))
    )
    points = heavy.rest.path.span_points
    np.testing.assert_allclose(found.ends[0, :, 0] - found.ends[0, :, 1], (points[:, 1] - points[:, 0]) @ meter)


def test_inertias_are_those_of_rims_and_all_that_turns_with_them() -> None:
    drive = example("accessory_drive")
    prepared = prepare(at_instant(drive, None))
    inertia = steady_of(drive).inertia
    for one, found in zip(prepared.pulleys, inertia, strict=True):
        assert found == pytest.approx(one.inertia + float(np.sum([link.inertia for link in one.hub])))
    assert any(one.hub for one in prepared.pulleys)


def test_a_motor_finds_its_speed() -> None:
    steady = steady_of(example("fan_direct_start"))
    torques = torques_of(steady.drive, steady.driver)
    speed = steady.belt_speed(steady.drive, torques)
    motor = torque_of(steady.drive, steady.driver, speed / float(steady.prepared.path.radii[steady.driver]))
    found = steady.at(np.array([speed]), torques(speed)[None], np.zeros(1))
    assert found.torque[0, steady.driver] == pytest.approx(motor, rel=1e-3)


def test_a_motor_that_would_not_start_its_load_carries_it_at_speed() -> None:
    """A torque between those at standstill and at a fifth of the motor's speed; none beyond its breakdown."""
    drive, kloss = example("fan_direct_start"), {"breakdown_torque": 300.0, "breakdown_slip": 0.15}
    load = {"kind": "motor", "synchronous_speed": 150.0} | kloss
    steady = steady_of(drive.replace(pulley=[drive.pulleys[0].replace(load=[load]), *drive.pulleys[1:]]))
    (motor,) = steady.drive.pulleys[0].load
    radii = np.asarray(steady.prepared.path.radii)
    at = [torque_of(steady.drive, 0, share * motor.driven_speed) for share in (1e-3, 0.2)]
    assert 0.0 < at[0] < at[1]

    def taking(torque: float) -> Torques:
        return lambda belt: np.array([0.0, -torque * radii[1] / radii[0]])

    speed = steady.belt_speed(steady.drive, taking(0.5 * sum(at))) / radii[0]
    assert torque_of(steady.drive, 0, speed) == pytest.approx(0.5 * sum(at), rel=0.05)  # bending takes 2 %
    assert 0.5 * motor.driven_speed < speed < motor.driven_speed
    with pytest.raises(ModelError, match="does not carry the loads between a fifth of"):
        steady.belt_speed(steady.drive, taking(10.0 * at[1]))


def test_torques_between_rows_are_straight_and_the_largest_of_equal_speed() -> None:
    rows = [(5.0, np.array([0.0, -2.0])), (10.0, np.array([0.0, -4.0])), (10.0, np.array([0.0, -1.0]))]
    torques = torques_between(rows, [1], lambda belt: np.zeros(2))
    assert [float(torques(speed)[1]) for speed in (2.0, 5.0, 7.5, 12.0)] == [-2.0, -2.0, -3.0, -4.0]


def test_a_second_prescribed_speed_is_refused(drive: Drive) -> None:
    speed = drive.pulleys[0].speed
    twice = drive.replace(pulley=[drive.pulleys[0], drive.pulleys[1].replace(speed=speed, torque=None)])
    with pytest.raises(ModelError, match="the torque of driven is unknown"):
        torques_of(twice, 0)

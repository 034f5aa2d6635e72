"""Steady running by the balance about rest, against finite elements and closed forms."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, prepare
from beltdyn.points.changed_drive import at_instant
from beltdyn.points.quasi_steady import QuasiSteady, torque_of, torques_between, torques_of
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


def test_a_motor_finds_its_speed() -> None:
    steady = steady_of(example("fan_direct_start"))
    torques = torques_of(steady.drive, steady.driver)
    speed = steady.belt_speed(steady.drive, torques)
    motor = torque_of(steady.drive, steady.driver, speed / float(steady.prepared.path.radii[steady.driver]))
    found = steady.at(np.array([speed]), torques(speed)[None], np.zeros(1))
    assert found.torque[0, steady.driver] == pytest.approx(motor, rel=1e-3)


def test_torques_between_rows_are_straight_and_the_largest_of_equal_speed() -> None:
    rows = [(5.0, np.array([0.0, -2.0])), (10.0, np.array([0.0, -4.0])), (10.0, np.array([0.0, -1.0]))]
    torques = torques_between(rows, [1], lambda belt: np.zeros(2))
    assert [float(torques(speed)[1]) for speed in (2.0, 5.0, 7.5, 12.0)] == [-2.0, -2.0, -3.0, -4.0]


def test_a_second_prescribed_speed_is_refused(drive: Drive) -> None:
    speed = drive.pulleys[0].speed
    twice = drive.replace(pulley=[drive.pulleys[0], drive.pulleys[1].replace(speed=speed, torque=None)])
    with pytest.raises(ModelError, match="the torque of driven is unknown"):
        torques_of(twice, 0)

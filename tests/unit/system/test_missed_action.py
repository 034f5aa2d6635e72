"""What steps miss of an action, against quadrature with points at every kink."""

from typing import Any

import numpy as np
import pytest

from beltdyn.model import Belt, Constant, Drive, Harmonic, Pulley, Table
from beltdyn.system.arrays import POWERS, Motion, System
from beltdyn.system.build import belt_system
from beltdyn.system.missed_action import jump_work, missed_action, missed_impulses, missed_work
from beltdyn.system.state import straight

START, LENGTH = 0.11, 0.37
TIMES = np.linspace(0.0, 0.6, 41) ** 1.1
TABLE = Table(times=tuple(TIMES), values=tuple(np.random.default_rng(5).normal(0.0, 3.0, TIMES.size)))


def system_of(drive: Drive, pulley: Pulley) -> tuple[System, Motion]:
    system = belt_system(Belt(**drive.belt.model_dump() | {"elements": 3}), [pulley], drive.contact)
    rest = straight(system)
    return system, Motion(START, rest.position, rest.velocity, rest.acceleration)


def deviation_integral(speed: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Cumulative integral of values less the straight line between the ends."""
    line = np.interp(times, times[[0, -1]], speed[[0, -1]])
    middle = 0.5 * ((speed - line)[1:] + (speed - line)[:-1])
    return np.concatenate([[0.0], np.cumsum(middle * np.diff(times))])


@pytest.mark.parametrize("free", [True, False], ids=["torque", "speed"])
def test_table(drive: Drive, free: bool) -> None:
    given = {"inertia": 0.4, "torque": TABLE} if free else {"speed": TABLE}
    system, motion = system_of(drive, Pulley(**{"name": "far", "center": (0.0, 50.0), "radius": 0.1} | given))
    times = np.union1d(np.linspace(START, START + LENGTH, 100_001), TIMES[(TIMES > START) & (TIMES < START + LENGTH)])
    integral = deviation_integral(TABLE.at(times), times)
    largest, whole = missed_action(system, 0, motion, LENGTH, np.inf)
    assert whole == pytest.approx(integral[-1], abs=1e-12)
    assert largest == pytest.approx(np.max(np.abs(integral)), rel=1e-6)
    assert missed_action(system, 0, motion, 1e-4, np.inf) == (0.0, 0.0)  # within a straight piece
    assert missed_action(system, 0, motion, LENGTH, 0.1 * largest)[0] > 0.1 * largest


@pytest.mark.parametrize("length", [LENGTH, 1e-4 * LENGTH, 1e4 * LENGTH])
def test_whole_waves(drive: Drive, length: float) -> None:
    """A step of five waves, which sees the same phase at both ends, however long it takes."""
    wave = Harmonic(order=1.0, amplitude=0.3)
    mean = 2.0 * np.pi * 5.0 / length
    speed = Constant(value=mean)
    system, motion = system_of(
        drive, Pulley(name="far", center=(0.0, 50.0), radius=0.1, speed=speed, harmonics=(wave,))
    )
    times = np.linspace(START, START + length, 100_001)
    integral = deviation_integral(mean * (1.0 + 0.3 * np.cos(mean * times)), times)
    largest, whole = missed_action(system, 0, motion, length, np.inf)
    assert whole == pytest.approx(integral[-1], rel=0.02)  # the trapezoidal rule in parts of 0.4 rad
    assert largest == pytest.approx(np.max(np.abs(integral)), rel=0.02)


J = 0.4
SHARES = np.abs(np.cos(np.arange(TIMES.size)))
SCHEDULE = {"kind": "table", "times": list(TIMES), "values": list(SHARES)}
OVER_SPEED: dict[str, Any] = {
    "kind": "table",
    "speeds": [-6.0, 1.0, 2.5, 4.0, 9.0],
    "torques": [2.0, 0.0, -7.0, 1.0, 3.0],
}


def free(**given: Any) -> Pulley:
    return Pulley(**{"name": "far", "center": (0.0, 50.0), "radius": 0.1, "inertia": J} | given)


def turning(drive: Drive, pulley: Pulley, speed: float, acceleration: float) -> tuple[System, Motion]:
    """A shaft at a speed and an acceleration."""
    system, motion = system_of(drive, pulley)
    motion.velocity[system.first_body :] = speed
    motion.acceleration[system.first_body :] = acceleration
    return system, motion


def assert_missed(
    system: System, motion: Motion, source: int, times: np.ndarray, action: np.ndarray, rel: float
) -> None:
    integral = deviation_integral(action, times)
    largest, whole = missed_action(system, source, motion, LENGTH, np.inf)
    size = float(np.max(np.abs(integral)))
    assert size > 1e-3
    assert largest == pytest.approx(size, rel=rel)
    assert whole == pytest.approx(integral[-1], abs=rel * size)


@pytest.mark.parametrize(("speed", "acceleration"), [(0.3, 20.0), (8.0, -35.0), (-2.0, 12.0), (2.5, 9.0), (2.5, -9.0)])
def test_load_over_a_speed_that_changes(drive: Drive, speed: float, acceleration: float) -> None:
    """Its kinks are met where the speed, as far as it is known beforehand, passes the points of the table."""
    system, motion = turning(drive, free(load=[OVER_SPEED]), speed, acceleration)
    times = np.linspace(START, START + LENGTH, 200_001)
    torque = np.interp(speed + acceleration * (times - START), OVER_SPEED["speeds"], OVER_SPEED["torques"])
    assert_missed(system, motion, 0, times, torque, 1e-5)


@pytest.mark.parametrize("speed", [9.5, 0.5, -9.0])
def test_load_at_a_steady_speed_misses_nothing(drive: Drive, speed: float) -> None:
    system, motion = turning(drive, free(load=[OVER_SPEED]), speed, 0.0)
    assert missed_action(system, 0, motion, LENGTH, np.inf) == (0.0, 0.0)


def test_load_with_a_schedule(drive: Drive) -> None:
    """A torque of 3 N m at 9 rad/s, times the schedule."""
    system, motion = turning(drive, free(load=[OVER_SPEED | {"schedule": SCHEDULE}]), 9.0, 0.0)
    times = np.union1d(np.linspace(START, START + LENGTH, 100_001), TIMES[(TIMES > START) & (TIMES < START + LENGTH)])
    assert_missed(system, motion, 0, times, 3.0 * np.interp(times, TIMES, SHARES), 1e-6)


@pytest.mark.parametrize("speed", [120.0, -120.0])
def test_load_with_waves_over_the_angle(drive: Drive, speed: float) -> None:
    waves = [{"order": 1.0, "amplitude": 0.3}, {"order": 0.5, "amplitude": 0.2, "phase": 1.0}]
    system, motion = turning(drive, free(load=[OVER_SPEED | {"harmonics": waves}]), speed, 5.0)
    times = np.linspace(START, START + LENGTH, 100_001)
    since = times - START
    angle = (speed + 2.5 * since) * since
    torque = np.interp(speed, [-6.0, 9.0], [2.0, 3.0]) * (1.0 + 0.3 * np.cos(angle) + 0.2 * np.cos(0.5 * angle + 1.0))
    assert_missed(system, motion, 0, times, torque, 0.03)  # the trapezoidal rule in parts of 0.4 rad


@pytest.fixture
def clutched(drive: Drive) -> tuple[System, Motion]:
    """A rim at 3 rad/s behind a clutch that slips at 2 N m times the table; the hub stands."""
    clutch = {"kind": "friction_clutch", "locking_damping": 1e6, "capacity": 2.0, "inertia": 0.1, "schedule": SCHEDULE}
    system, motion = turning(drive, free(hub=[clutch]), 0.0, 0.0)
    motion.velocity[system.first_body + system.links[0].front] = 3.0
    return system, motion


def test_impulses_of_a_clutch_are_opposite_on_its_bodies(clutched: tuple[System, Motion]) -> None:
    system, motion = clutched
    times = np.union1d(np.linspace(START, START + LENGTH, 100_001), TIMES[(TIMES > START) & (TIMES < START + LENGTH)])
    torque = 2.0 * np.interp(times, TIMES, SHARES)
    assert_missed(system, motion, system.pulleys.size, times, torque, 1e-6)
    impulse = np.full((2, motion.position.size), 7.0)
    missed_impulses(system, motion, LENGTH, impulse)
    expected = deviation_integral(torque, times)[-1]
    front, back = (system.first_body + body for body in (system.links[0].front, system.links[0].back))
    assert (impulse[1, front], impulse[1, back]) == pytest.approx((-expected, expected))
    assert np.count_nonzero(impulse) == 2


def test_impulses_of_torques_turn_their_own_shafts(drive: Drive) -> None:
    """Of three pulleys: one with a given speed, one with a torque behind a hub, one with a torque on its rim."""
    far: list[dict[str, Any]] = [
        {"name": name, "center": (0.0, 50.0 + 10.0 * number), "radius": 0.1} for number, name in enumerate("abc")
    ]
    hub = [{"kind": "isolator", "stiffness": 30.0, "damping": 0.4, "inertia": 0.1}]
    half = Table(times=TABLE.times, values=tuple(0.5 * value for value in TABLE.values))
    pulleys = [
        Pulley(**far[0], speed=TABLE),
        Pulley(**far[1], torque=TABLE, inertia=J, hub=hub),
        Pulley(**far[2], torque=half, inertia=J),
    ]
    system = belt_system(drive.belt.replace(elements=3), pulleys, drive.contact)
    rest = straight(system)
    impulse = np.full((2, rest.position.size), 7.0)
    missed_impulses(system, Motion(START, rest.position, rest.velocity, rest.acceleration), LENGTH, impulse)
    times = np.union1d([START, START + LENGTH], TIMES[(TIMES > START) & (TIMES < START + LENGTH)])
    missed = deviation_integral(TABLE.at(times), times)[-1]
    np.testing.assert_allclose(impulse[0, system.first_body :], [0.0, 0.0, 0.5 * missed, missed], atol=1e-12)
    assert not impulse[0, : system.first_body].any()
    assert not impulse[1].any()


def after_step(system: System, motion: Motion, speed: float, acceleration: float) -> Motion:
    velocity, rate = motion.velocity.copy(), motion.acceleration.copy()
    velocity[system.first_body :], rate[system.first_body :] = speed, acceleration
    return Motion(START + LENGTH, motion.position, velocity, rate)


def test_works_on_a_free_shaft_make_its_kinetic_energy(drive: Drive) -> None:
    """Trapezoidal power and what it misses are the work of the impulse, by which the speed has changed."""
    system, motion = turning(drive, free(torque=TABLE), 5.0, 0.0)
    times = np.union1d([START, START + LENGTH], TIMES[(TIMES > START) & (TIMES < START + LENGTH)])
    speed = 5.0 + float(np.trapezoid(TABLE.at(times), times)) / J
    end = after_step(system, motion, speed, 0.0)
    impulse, work = np.zeros((2, motion.position.size)), np.full(len(POWERS), 7.0)
    missed_impulses(system, motion, LENGTH, impulse)
    missed_work(system, motion, end, impulse, work)
    first, last = (float(TABLE.at(np.array(time))) for time in (START, START + LENGTH))
    seen = 0.5 * LENGTH * (first * 5.0 + last * speed)
    assert seen + work[POWERS.index("torque_work")] == pytest.approx(0.5 * J * (speed**2 - 25.0))
    assert np.count_nonzero(work) == 1


def test_works_of_a_driver_make_the_kinetic_energy_of_its_pulley(drive: Drive) -> None:
    system, motion = turning(drive, free(speed=TABLE), 5.0, 3.0)
    end = after_step(system, motion, 7.0, -2.0)
    work = np.zeros(len(POWERS))
    missed_work(system, motion, end, np.zeros((2, motion.position.size)), work)
    seen = 0.5 * LENGTH * J * (5.0 * 3.0 + 7.0 * -2.0)
    assert seen + work[POWERS.index("driver_work")] == pytest.approx(0.5 * J * (49.0 - 25.0))


def test_what_a_slipping_clutch_loses(clutched: tuple[System, Motion]) -> None:
    """Its missed impulse times the mean of its rates of slip, 3 and 2 rad/s, is lost; no driver or torque gives it."""
    system, motion = clutched
    end = after_step(system, motion, 0.0, 0.0)
    end.velocity[system.first_body + system.links[0].front] = 2.0
    impulse, work = np.zeros((2, motion.position.size)), np.zeros(len(POWERS))
    missed_impulses(system, motion, LENGTH, impulse)
    missed_work(system, motion, end, impulse, work)
    lost = 2.5 * impulse[1, system.first_body + system.links[0].back]
    assert work[POWERS.index("coupling_loss")] == pytest.approx(lost)
    assert np.count_nonzero(work) == 1


def test_a_jump_of_a_prescribed_speed_takes_the_kinetic_energy(drive: Drive) -> None:
    for pulley, expected in ((free(speed=TABLE), 0.5 * J * (49.0 - 25.0)), (free(torque=TABLE), 0.0)):
        system, motion = turning(drive, pulley, 5.0, 0.0)
        assert jump_work(system, motion.velocity, after_step(system, motion, 7.0, 0.0).velocity) == pytest.approx(
            expected
        )


def test_dry_friction_that_holds_a_shaft_does_not_turn_round(drive: Drive) -> None:
    """A trembling shaft rests long before the end of the step: no step waits for friction of a speed that never is."""
    dry = {"kind": "resistance", "constant": 9.0, "harmonics": [{"order": 5, "amplitude": 0.15}]}
    speed, length = 3e-3, 0.3
    torque = 9.0 * 1.15 * np.tanh(speed / 0.1)
    system, motion = turning(drive, free(load=[dry]), speed, -torque / J)
    assert missed_action(system, 0, motion, length, np.inf)[0] < 0.5 * torque * length

"""What steps miss of an action, against quadrature with points at every kink."""

import numpy as np
import pytest

from beltdyn.model import Belt, Constant, Drive, Harmonic, Pulley, Table
from beltdyn.system.arrays import Motion, System
from beltdyn.system.build import belt_system
from beltdyn.system.missed_action import missed_action
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


def test_whole_waves(drive: Drive) -> None:
    """A step of five waves, which sees the same phase at both ends."""
    wave = Harmonic(order=1.0, amplitude=0.3)
    mean = 2.0 * np.pi * 5.0 / LENGTH
    speed = Constant(value=mean)
    system, motion = system_of(
        drive, Pulley(name="far", center=(0.0, 50.0), radius=0.1, speed=speed, harmonics=(wave,))
    )
    times = np.linspace(START, START + LENGTH, 100_001)
    integral = deviation_integral(mean * (1.0 + 0.3 * np.cos(mean * times)), times)
    largest, whole = missed_action(system, 0, motion, LENGTH, np.inf)
    assert whole == pytest.approx(integral[-1], rel=0.02)  # the trapezoidal rule in parts of 0.4 rad
    assert largest == pytest.approx(np.max(np.abs(integral)), rel=0.02)

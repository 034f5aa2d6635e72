"""Speeds, torques and loads as they are at an instant, and the speeds of hub chains as unknowns."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.machines.tensioners import tensioner_force
from beltdyn.model import Drive, prepare
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.constant_drive import constant_drive, drive_shafts, rim_of_bodies, twists, with_speeds_unknown
from beltdyn.system.state import at_rest

DRIVEN, FIRST_HUB, SECOND_HUB = 2, 3, 4
"""Numbers of bodies of the drive with machines."""


@pytest.fixture(scope="module")
def system(with_machines: Callable[[str], Drive]) -> System:
    return constant_drive(drive_system(prepare(with_machines("rotary"))), 0.3)


def test_harmonics_are_left_out(system: System) -> None:
    """A load of 1 + 0.03 omega^2 N m against the motion, whatever the angle, and a torque of -1 N m."""
    p = int(np.flatnonzero(system.pulleys.shaft == SECOND_HUB)[0])
    found = [
        shaft_torque(system.profiles, system.shaft_loads, p, 0.0, angle, 10.0, np.zeros(0)).torque
        for angle in (0.0, 1.0)
    ]
    assert found == pytest.approx([-1.0 - 1.0 - 3.0] * 2, rel=1e-12)


def test_speeds_are_those_of_the_instant(drive: Drive) -> None:
    ramp = drive.pulleys[0].replace(speed={"kind": "ramp", "start": 0.0, "end": 1.0, "value": 40.0})
    held = constant_drive(drive_system(prepare(drive.replace(pulley=[ramp, drive.pulleys[1]]))), 0.25)
    velocity = np.zeros(held.first_body + held.bodies.size)
    drive_shafts(with_speeds_unknown(held), velocity)
    assert velocity[held.first_body] == pytest.approx(10.0)


def test_a_tensioner_that_stands_has_neither_damping_nor_friction(system: System) -> None:
    still, moving = (tensioner_force(system.tensioners[0], 0.1, rate).force for rate in (0.0, 0.5))
    assert moving == still


def test_springs_couple_speeds(system: System) -> None:
    """The clutch lets the body behind it have a speed of its own, the spring behind that one does not."""
    unknown = with_speeds_unknown(system).bodies.unknown
    assert unknown[FIRST_HUB] == unknown[SECOND_HUB] != unknown[DRIVEN]
    assert sorted(set(unknown)) == [-1, 0, 1, 2, 3]
    held = with_speeds_unknown(system, (DRIVEN,)).bodies.unknown
    assert held[FIRST_HUB] == held[SECOND_HUB] == -1 < held[DRIVEN]


def test_a_spring_twists_by_the_torque_through_it(system: System) -> None:
    moments = np.zeros(system.pulleys.size)
    moments[DRIVEN] = 5.0
    angles = twists(system, moments, at_rest(system, np.zeros((system.nodes, len(system.scale)))))
    assert rim_of_bodies(system)[[FIRST_HUB, SECOND_HUB]].tolist() == [DRIVEN, DRIVEN]
    assert angles[FIRST_HUB] - angles[SECOND_HUB] == pytest.approx(5.0 / 50.0)
    assert angles[DRIVEN] == angles[FIRST_HUB]

"""Speeds, torques and loads as they are at an instant, and the speeds of hub chains as unknowns."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.machines.tensioners import tensioner_force
from beltdyn.model import Drive, Pulley, prepare
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.constant_drive import (
    constant_drive,
    drive_shafts,
    guess_hubs,
    rim_of_bodies,
    twists,
    with_speeds_unknown,
)
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


def test_speeds_that_are_unknown_stay_as_they_are_guessed(system: System) -> None:
    free = with_speeds_unknown(system)
    unknown = np.asarray(free.bodies.unknown) >= 0
    velocity = np.arange(1.0, 1.0 + free.first_body + free.bodies.size)
    before = velocity.copy()
    drive_shafts(free, velocity)
    np.testing.assert_array_equal(velocity[free.first_body :][unknown], before[free.first_body :][unknown])


@pytest.mark.parametrize(
    ("rim", "expected"), [(20.0, (1.0 / 0.03) ** 0.5), (4.0, 4.0), (-20.0, -((1.0 / 0.03) ** 0.5))]
)
def test_a_hub_turns_where_its_clutch_carries_its_load(drive: Drive, rim: float, expected: float) -> None:
    """1 N m and 0.03 omega^2 against 2 N m of the clutch; with the rim where it does not slip."""
    clutch = {"kind": "friction_clutch", "locking_damping": 1e4, "capacity": 2.0, "inertia": 0.1}
    load = {"kind": "resistance", "constant": 1.0, "creep_speed": 0.1, "quadratic": 0.03}
    pulley = Pulley(name="far", center=(0.0, 50.0), radius=0.1, inertia=0.4, hub=[clutch], load=[load])
    system = with_speeds_unknown(belt_system(drive.belt.replace(elements=3), [pulley], drive.contact))
    velocity = np.zeros(system.first_body + system.bodies.size)
    (link,) = system.links
    velocity[system.first_body + link.front] = rim
    guess_hubs(system, velocity)
    assert velocity[system.first_body + link.back] == pytest.approx(expected, rel=1e-2)
    drive_shafts(system, velocity)
    assert velocity[system.first_body + link.front] == rim


def test_a_spring_twists_by_the_torque_through_it(system: System) -> None:
    moments = np.zeros(system.pulleys.size)
    moments[DRIVEN] = 5.0
    angles = twists(system, moments, at_rest(system, np.zeros((system.nodes, len(system.scale)))))
    assert rim_of_bodies(system)[[FIRST_HUB, SECOND_HUB]].tolist() == [DRIVEN, DRIVEN]
    assert angles[FIRST_HUB] - angles[SECOND_HUB] == pytest.approx(5.0 / 50.0)
    assert angles[DRIVEN] == angles[FIRST_HUB]

"""Machines as arrays: numbering of bodies, schedules, loads; inertia and weight of tensioners."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.machines.links.link import LINKS
from beltdyn.machines.loads.load import LOADS
from beltdyn.machines.profiles.functions import NO_SCHEDULE, profile_value
from beltdyn.model import Belt, FixedTensioner, Pulley, RotaryTensioner, SlidingTensioner
from beltdyn.model.routing import lay_path
from beltdyn.system.build_machines import (
    body_inertias,
    carried_masses,
    machine_arrays,
    shaft_bodies,
    tensioner_inertias,
)

BELT = Belt(length=1.0, width=0.01, thickness=0.01, density=1e3, youngs_modulus=1e8, poissons_ratio=0.3)

ISOLATING = {"kind": "isolator", "stiffness": 30.0, "damping": 0.4, "inertia": 0.1}
OVERRUNNING = {"kind": "one_way_clutch", "locking_damping": 5.0, "drag_torque": 0.2, "inertia": 0.2}
ENGAGING = {
    "kind": "friction_clutch",
    "locking_damping": 5.0,
    "capacity": 2.0,
    "inertia": 0.3,
    "schedule": {"kind": "constant", "value": 0.5},
}
RESISTING = {"kind": "resistance", "linear": 0.1, "schedule": {"kind": "constant", "value": 0.25}}
CURVE = {"kind": "table", "speeds": [0.0, 10.0], "torques": [0.0, -1.0], "harmonics": [{"order": 3, "amplitude": 0.1}]}
MOTOR = {"kind": "motor", "breakdown_torque": 10.0, "breakdown_slip": 0.2, "synchronous_speed": -150.0}
PULLEYS = [
    Pulley(name="crank", center=(0, 0), radius=0.1, speed={"kind": "constant", "value": 7.0}, mass=3.0),
    Pulley(
        name="alternator",
        center=(1, 0),
        radius=0.05,
        inertia=1.0,
        load=[CURVE, RESISTING],
        hub=[ISOLATING, OVERRUNNING],
    ),
    Pulley(name="compressor", center=(0.4, 0.5), radius=0.08, inertia=2.0, mass=1.5, load=[MOTOR], hub=[ENGAGING]),
]
ARM = RotaryTensioner(
    kind="rotary", pulley="compressor", pivot=(0.1, 0.1), inertia=0.3, mass=0.5, center_of_mass=0.4, preload=5.0
)
SLIDE = SlidingTensioner(kind="sliding", pulley="alternator", direction=(1, 0), mass=2.0, preload=50.0)
FIXED = FixedTensioner(kind="fixed", pulley="crank", direction=(0, 2))


def test_bodies_are_the_rims_and_then_the_chains() -> None:
    np.testing.assert_array_equal(shaft_bodies(PULLEYS), [0, 4, 5])
    np.testing.assert_array_equal(body_inertias(PULLEYS), [0.0, 1.0, 2.0, 0.1, 0.2, 0.3])
    links = machine_arrays(PULLEYS).links
    np.testing.assert_array_equal(links.front, [1, 3, 2])
    np.testing.assert_array_equal(links.back, [3, 4, 5])
    assert [list(LINKS)[kind] for kind in links.kind] == ["isolator", "one_way_clutch", "friction_clutch"]
    assert links.isolator.tolist() == [(30.0, 0.4), (0.0, 0.0), (0.0, 0.0)]
    assert links.one_way_clutch.tolist() == [(0.0, 0.0, 0.0), (5.0, 0.2, 1.0), (0.0, 0.0, 0.0)]
    assert links.friction_clutch.tolist() == [(0.0, 0.0), (0.0, 0.0), (5.0, 2.0)]


def test_schedules_follow_the_profiles_of_the_pulleys() -> None:
    machines = machine_arrays(PULLEYS)
    np.testing.assert_array_equal(machines.shaft_loads.table.schedule[:-1], [NO_SCHEDULE, 3, NO_SCHEDULE])
    np.testing.assert_array_equal(machines.links.schedule, [NO_SCHEDULE, NO_SCHEDULE, 4])
    assert [profile_value(machines.profiles, k, 0.0)[0] for k in range(5)] == [7.0, 0.0, 0.0, 0.25, 0.5]


def test_loads_are_sorted_by_pulley() -> None:
    loads = machine_arrays(PULLEYS).shaft_loads
    np.testing.assert_array_equal(loads.first, [0, 0, 2, 3])
    assert [list(LOADS)[kind] for kind in loads.table.kind[:-1]] == ["table", "resistance", "motor"]
    np.testing.assert_array_equal(loads.table.number, [0, 4, 4, 4])
    np.testing.assert_array_equal(loads.numbers, [0.0, 10.0, 0.0, -1.0])
    np.testing.assert_array_equal(loads.table.harmonic, [0, 1, 1, 1])
    np.testing.assert_array_equal(loads.harmonic.tolist(), [(3.0, 0.1, 0.0)])


def test_moving_tensioners_keep_their_order_and_fixed_ones_leave_no_trace() -> None:
    tensioners = machine_arrays(PULLEYS, (FIXED, ARM, SLIDE), lay_path(PULLEYS, BELT)).tensioners
    np.testing.assert_array_equal(tensioners.pulley, [2, 1])
    np.testing.assert_allclose(tensioners.rotary.pivot, [[0.1, 0.1], [0.0, 0.0]])
    np.testing.assert_allclose(tensioners.rotary.direction, [[0.6, 0.8], [0.0, 0.0]])
    np.testing.assert_allclose(tensioners.rotary.length, [0.5, 0.0])
    np.testing.assert_allclose(tensioners.sliding.center, [[0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_allclose(tensioners.sliding.direction, [[0.0, 0.0], [1.0, 0.0]])


def test_inertia_and_weight_of_tensioners() -> None:
    """A pulley on an arm is a point mass; an arm weighs on its coordinate as its share does at the pulley's center."""
    some = (FIXED, ARM, SLIDE)
    np.testing.assert_allclose(tensioner_inertias(PULLEYS, some), [0.3 + 1.5 * 0.5**2, 2.0 + 0.0])
    np.testing.assert_allclose(carried_masses(PULLEYS, some), [1.5 + 0.4 * 0.5, 2.0 + 0.0])


def test_a_drive_without_machines() -> None:
    machines = machine_arrays(())
    assert [len(machines.shaft_loads.table) - 1, len(machines.links), len(machines.tensioners.pulley)] == [0, 0, 0]
    assert [len(item) for item in (machines.profiles.table, machines.shaft_loads.first)] == [1, 1]


def test_tensioners_need_a_path() -> None:
    with pytest.raises(ModelError, match="the path is missing"):
        machine_arrays(PULLEYS, [ARM])

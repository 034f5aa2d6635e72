"""The quantities that a user may leave out of a machine, and the least that each of them may be."""

from math import pi, tanh
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import row
from beltdyn.errors import ModelError
from beltdyn.machines.loads.load import ShaftState
from beltdyn.machines.loads.resistance import RESISTANCE, resistance
from beltdyn.machines.tensioners.tensioner import SPRING, dry_friction
from beltdyn.model import (
    FixedTensioner,
    FrictionClutch,
    Harmonic,
    Isolator,
    Motor,
    OneWayClutch,
    Resistance,
    RotaryTensioner,
    SlidingTensioner,
)

MACHINES: dict[str, Any] = {
    "isolator": Isolator(kind="isolator", stiffness=30.0),
    "one-way clutch": OneWayClutch(kind="one_way_clutch", locking_damping=5.0),
    "friction clutch": FrictionClutch(kind="friction_clutch", locking_damping=5.0, capacity=2.0),
    "motor": Motor(kind="motor", breakdown_torque=10.0, breakdown_slip=0.2, synchronous_speed=150.0),
    "dry resistance": Resistance(kind="resistance", constant=1.0),
    "viscous resistance": Resistance(kind="resistance", linear=1.0),
    "slide": SlidingTensioner(kind="sliding", pulley="idler", direction=(1.0, 0.0), preload=20.0),
    "arm": RotaryTensioner(kind="rotary", pulley="idler", pivot=(0.3, 0.4), preload=20.0),
    "stopped slide": SlidingTensioner(
        kind="sliding", pulley="idler", direction=(1.0, 0.0), preload=20.0, stops=(-0.1, 0.1), stop_stiffness=500.0
    ),
    "stopped arm": RotaryTensioner(
        kind="rotary", pulley="idler", pivot=(0.3, 0.4), preload=20.0, stops=(-0.1, 0.1), stop_stiffness=500.0
    ),
    "harmonic": Harmonic(order=2.0, amplitude=0.1),
}
SPRING_FIELDS = ["rate", "damping", "tensioning_friction", "yielding_friction", "mass"]
ABSENT = [
    ("isolator", "damping"),
    ("isolator", "inertia"),
    ("one-way clutch", "drag_torque"),
    ("viscous resistance", "constant"),
    ("viscous resistance", "quadratic"),
    ("dry resistance", "linear"),
    ("arm", "inertia"),
    *((machine, field) for machine in ("slide", "arm") for field in SPRING_FIELDS),
    *((f"stopped {machine}", "stop_damping") for machine in ("slide", "arm")),
]
"""What is zero unless it is given."""
NEEDED = [
    ("isolator", "stiffness"),
    ("one-way clutch", "locking_damping"),
    ("friction clutch", "locking_damping"),
    ("friction clutch", "capacity"),
    ("motor", "breakdown_torque"),
    ("motor", "breakdown_slip"),
    ("dry resistance", "creep_speed"),
    ("slide", "creep_speed"),
    ("arm", "creep_speed"),
    ("stopped slide", "stop_stiffness"),
    ("stopped arm", "stop_stiffness"),
    ("harmonic", "order"),
]
"""What there is no machine without."""
LITTLE = 1e-6


@pytest.mark.parametrize(("machine", "field"), ABSENT)
def test_what_is_left_out_is_not_there(machine: str, field: str) -> None:
    assert getattr(MACHINES[machine], field) == 0.0


@pytest.mark.parametrize(("machine", "field"), ABSENT)
def test_it_may_be_little_but_not_negative(machine: str, field: str) -> None:
    for value in (0.0, LITTLE):
        assert getattr(MACHINES[machine].replace(**{field: value}), field) == value
    with pytest.raises(ModelError, match="must be at least 0"):
        MACHINES[machine].replace(**{field: -LITTLE})


@pytest.mark.parametrize(("machine", "field"), NEEDED)
def test_what_is_needed_may_be_little_but_not_zero(machine: str, field: str) -> None:
    assert getattr(MACHINES[machine].replace(**{field: LITTLE}), field) == LITTLE
    with pytest.raises(ModelError, match="must be greater than 0"):
        MACHINES[machine].replace(**{field: 0.0})


def test_a_motor_may_have_its_largest_torque_at_standstill() -> None:
    assert MACHINES["motor"].replace(breakdown_slip=1.0)
    with pytest.raises(ModelError, match="must be at most 1"):
        MACHINES["motor"].replace(breakdown_slip=1.0 + LITTLE)


def test_dry_friction_builds_up_over_little_speed_unless_another_is_given() -> None:
    """To tanh(1) = 76 % of itself: 0.1 rad/s at a shaft, 0.01 rad/s at an arm, 1 mm/s at a slide."""
    load = row(RESISTANCE, constant=1.0, creep_speed=MACHINES["dry resistance"].creep_speed)
    assert resistance(load, np.zeros(0), ShaftState(0.0, 0.0, 0.1, 0.0, 0.0)).torque == pytest.approx(
        -tanh(1.0), rel=1e-15
    )
    for machine, speed in (("arm", 0.01), ("slide", 1e-3)):
        spring = row(SPRING, tensioning_friction=1.0, creep_speed=MACHINES[machine].creep_speed)
        assert dry_friction(spring, speed)[0] == pytest.approx(tanh(1.0), rel=1e-15)


def test_a_pulley_stays_where_it_is_unless_it_is_taken_up() -> None:
    assert FixedTensioner(kind="fixed", pulley="idler", direction=(1.0, 0.0)).take_up == 0.0


def test_a_harmonic_has_its_crest_at_the_angle_zero() -> None:
    assert MACHINES["harmonic"].phase == 0.0


def test_the_arm_of_a_tensioner_is_a_uniform_bar() -> None:
    """Its center of mass is in the middle: half of its mass weighs at the pulley's center."""
    arm = MACHINES["arm"].replace(mass=3.0)
    assert arm.weighing_mass(2.0) == pytest.approx(2.0 + 1.5, rel=1e-15)


def test_the_stops_of_an_arm_lie_within_half_a_turn() -> None:
    assert MACHINES["stopped arm"].replace(stops=(-pi, pi)).stops == (-pi, pi)
    for stops in ((-3.2, 0.1), (-0.1, 3.2)):
        with pytest.raises(ModelError, match=r"3\.14159"):
            MACHINES["stopped arm"].replace(stops=stops)

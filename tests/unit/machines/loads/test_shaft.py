"""Loads and motors: exact derivatives, signs, the breakdown point of a motor, schedules and harmonics."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import row
from beltdyn.machines.loads.load import LoadTorque, ShaftState
from beltdyn.machines.loads.motor import MOTOR as MOTOR_CONSTANTS
from beltdyn.machines.loads.motor import kloss as kloss_torque
from beltdyn.machines.loads.resistance import RESISTANCE as RESISTANCE_CONSTANTS
from beltdyn.machines.loads.resistance import resistance as resistance_torque
from beltdyn.machines.loads.shaft import ShaftLoads, load_bend, shaft_loads, shaft_torque
from beltdyn.machines.profiles.functions import NO_SCHEDULE, Profiles, profile_rows
from beltdyn.model import Pulley, Resistance, Step
from beltdyn.system.build_machines import machine_arrays

Machines = tuple[Profiles, ShaftLoads]

HARMONICS = [{"order": 2, "amplitude": 0.4, "phase": 0.3}, {"order": 0.5, "amplitude": 0.2}]
RESISTANCE: dict[str, Any] = {
    "kind": "resistance",
    "constant": 1.5,
    "creep_speed": 2.0,
    "linear": 0.1,
    "quadratic": 0.01,
}
TABLE: dict[str, Any] = {"kind": "table", "speeds": [-5.0, 1.0, 4.0, 20.0], "torques": [2.0, 0.0, -3.0, -2.0]}
MOTOR: dict[str, Any] = {"kind": "motor", "breakdown_torque": 10.0, "breakdown_slip": 0.2, "synchronous_speed": 150.0}
LOADS: dict[str, dict[str, Any]] = {"resistance": RESISTANCE, "table": TABLE, "motor": MOTOR}
STEADY: dict[str, Any] = {"kind": "constant", "value": 8.0}
CATALOGUE: dict[str, Any] = {
    "kind": "induction_motor",
    "rated_power": 400.0,
    "rated_speed": 140.0,
    "locked_rotor_ratio": 2.0,
    "pull_up_ratio": 1.5,
    "breakdown_ratio": 2.6,
}
CRANK: dict[str, Any] = {
    "kind": "angle_table",
    "angles": [0.0, 0.5, 1.2, 3.0, 5.0],
    "torques": [0.0, 1.0, -2.0, 0.5, 1.0],
}
GRID: dict[str, Any] = {
    "kind": "angle_speed_table",
    "angles": [-1.0, 0.5, 1.2, 3.0],
    "speeds": [-10.0, 0.0, 5.0, 100.0],
    "torques": [[0.0, 0.2, 0.4, 0.2], [0.2, -0.2, 0.0, 0.6], [0.4, 0.4, 0.2, -0.2], [0.0, 0.1, 0.1, 0.0]],
}
CURVES: dict[str, dict[str, Any]] = {
    "induction_motor": CATALOGUE,
    "inverter": CATALOGUE | {"supply": STEADY | {"value": 60.0}, "limit_ratio": 1.2},
    "reversed": CATALOGUE | {"supply": STEADY | {"value": -20.0}},
    "angle_table": CRANK,
    "angle_speed_table": GRID,
    "fan": {"kind": "fan", "rated_power": 100.0, "rated_speed": 20.0, "friction_share": 0.1, "creep_speed": 2.0},
    "pump": {"kind": "pump", "displacement": 1e-5, "pressure": STEADY | {"value": 1e5}, "efficiency": 0.9},
    "brake": {"kind": "brake", "torque": STEADY, "backward_ratio": 0.4, "creep_speed": 2.0},
    "band_brake": {"kind": "band_brake", "force": STEADY, "radius": 0.2, "friction": 0.3, "wrap": 4.0},
    "holdback": {"kind": "holdback", "torque": 3.0, "creep_speed": 2.0},
    "generator": {
        "kind": "generator",
        "power": STEADY,
        "efficiency": 0.6,
        "cut_in_speed": 2.0,
        "full_field_power": 20.0,
    },
}
FLOOR = 1e-9  # of central differences of numbers of order one: eps to the power 2/3, some digits lost
STEP = 1e-5
NO_NUMBERS = np.zeros(0)


def kloss(speed: float, torque: float, slip: float, synchronous: float) -> LoadTorque:
    motor = row(MOTOR_CONSTANTS, breakdown_torque=torque, breakdown_slip=slip, synchronous_speed=synchronous)
    return kloss_torque(motor, NO_NUMBERS, ShaftState(0.0, 0.0, speed, 0.0, 0.0))


def machines(*loads: dict[str, Any], **pulley: Any) -> Machines:
    """Arrays of a drive whose second pulley carries the loads; the first has one that must not be counted."""
    other = Pulley(name="other", center=(0, 0), radius=1, inertia=1, load=[RESISTANCE | {"harmonics": HARMONICS}])
    loaded = Pulley(name="loaded", center=(3, 0), radius=1, inertia=1, load=loads, **pulley)
    found = machine_arrays([other, loaded])
    return found.profiles, found.shaft_loads


@pytest.mark.parametrize("kind", [*LOADS, *CURVES])
@pytest.mark.parametrize("speed", [-30.0, -4.0, -0.3, 0.4, 3.0, 12.0, 149.0, 200.0])
@pytest.mark.parametrize("harmonics", [[], HARMONICS], ids=["plain", "wavy"])
def test_derivatives(kind: str, speed: float, harmonics: list[dict[str, float]]) -> None:
    found = machines((LOADS | CURVES)[kind] | {"harmonics": harmonics}, torque={"kind": "constant", "value": 2.0})
    torque, by_angle, by_speed, _ = shaft_torque(*found, 1, 0.0, 0.7, speed, NO_NUMBERS)
    around = [
        [shaft_torque(*found, 1, 0.0, 0.7 + a, speed + b, NO_NUMBERS)[0] for a, b in ((h, 0), (0, h))]
        for h in (-STEP, STEP)
    ]
    numeric = np.diff(around, axis=0)[0] / (2 * STEP)
    assert (by_angle, by_speed) == pytest.approx(numeric, abs=FLOOR * (1 + abs(torque)))


@pytest.mark.parametrize("speed", [-7.0, -0.01, 0.0, 0.01, 7.0])
def test_resistance_opposes_the_motion(speed: float) -> None:
    given = row(RESISTANCE_CONSTANTS, constant=1.5, creep_speed=0.1, linear=0.2, quadratic=0.03)
    torque, _, slope, _ = resistance_torque(given, NO_NUMBERS, ShaftState(0.0, 0.0, speed, 0.0, 0.0))
    assert torque * speed <= 0.0
    assert slope < 0.0
    if abs(speed) > 1.0:  # tanh is 1 to the last digit
        assert abs(torque) == pytest.approx(1.5 + 0.2 * abs(speed) + 0.03 * speed**2, rel=1e-15)


def test_motor_has_its_largest_torque_at_the_breakdown_slip() -> None:
    top = 150.0 * (1 - 0.2)
    assert kloss(top, 10.0, 0.2, 150.0) == pytest.approx((10.0, 0.0, 0.0, 0.0), abs=1e-14)
    torques = [kloss(speed, 10.0, 0.2, 150.0)[0] for speed in np.linspace(-300, 149, 500)]
    assert min(torques) > 0.0
    assert max(torques) <= 10.0


@pytest.mark.parametrize("slip", [-1.0, -0.05, 0.01, 0.2, 0.6, 1.0])
def test_motor_is_kloss_formula(slip: float) -> None:
    expected = 2 * 10.0 / (slip / 0.2 + 0.2 / slip)
    assert kloss(150.0 * (1 - slip), 10.0, 0.2, 150.0)[0] == pytest.approx(expected, rel=1e-12)


def test_motor_drives_below_and_brakes_above_its_synchronous_speed() -> None:
    assert [np.sign(kloss(speed, 10.0, 0.2, 150.0)[0]) for speed in (0.0, 149.0, 150.0, 151.0)] == [1, 1, 0, -1]


@pytest.mark.parametrize("speed", [-10.0, 0.0, 40.0, 170.0])
def test_a_clockwise_motor_is_the_mirror_image(speed: float) -> None:
    torque, _, slope, _ = kloss(speed, 10.0, 0.2, 150.0)
    assert kloss(-speed, 10.0, 0.2, -150.0) == LoadTorque(-torque, 0.0, slope, 0.0)


@pytest.mark.parametrize("synchronous", [0.02, 0.7, 3000.0, -0.02, -0.7])
def test_the_torque_of_a_motor_depends_on_its_slip_alone(synchronous: float) -> None:
    """In the sense of its synchronous speed, slow or fast; its slope falls as the speed that makes the slip grows."""
    share = 0.9  # a slip of 0.1
    torque, _, slope, _ = kloss(share * 150.0, 10.0, 0.2, 150.0)
    found = kloss(share * synchronous, 10.0, 0.2, synchronous)
    expected = np.sign(synchronous) * torque, 0.0, abs(150.0 / synchronous) * slope, 0.0
    assert found == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("speed", [-9.0, -5.0, -2.0, 1.0, 2.0, 4.0, 11.0, 20.0, 50.0])
def test_table_is_linear_between_its_points(speed: float) -> None:
    expected = float(np.interp(speed, [-5.0, 1.0, 4.0, 20.0], [2.0, 0.0, -3.0, -2.0]))
    assert shaft_torque(*machines(TABLE), 1, 0.0, 0.0, speed, NO_NUMBERS)[0] == pytest.approx(expected, abs=1e-15)


def test_loads_add_up_with_the_torque_of_the_pulley() -> None:
    torque = {"kind": "ramp", "start": 0.0, "end": 1.0, "value": 4.0}
    alone = [np.array(shaft_torque(*machines(load), 1, 0.5, 0.7, 3.0, NO_NUMBERS)) for load in LOADS.values()]
    together = shaft_torque(*machines(*LOADS.values(), torque=torque), 1, 0.5, 0.7, 3.0, NO_NUMBERS)
    assert together == pytest.approx(np.sum(alone, axis=0) + np.array([2.0, 0.0, 0.0, 0.0]), rel=1e-14)


def test_a_schedule_switches_its_load_only() -> None:
    switched = MOTOR | {"schedule": {"kind": "step", "time": 0.5, "before": 0.25, "value": 1.0}}
    found = machines(RESISTANCE, switched, TABLE | {"schedule": {"kind": "constant", "value": 0.5}})
    resist, table, motor = (
        np.array(shaft_torque(*machines(load), 1, 0.0, 0.7, 3.0, NO_NUMBERS)) for load in LOADS.values()
    )
    for time, factor in ((0.5, 0.25), (0.6, 1.0)):
        expected = resist + factor * motor + 0.5 * table
        assert shaft_torque(*found, 1, time, 0.7, 3.0, NO_NUMBERS) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("angle", [0.0, 0.4, 9.0])
def test_harmonics_multiply_the_torque(angle: float) -> None:
    factor = 1 + 0.4 * np.cos(2 * angle + 0.3) + 0.2 * np.cos(0.5 * angle)
    plain, _, slope, _ = shaft_torque(*machines(RESISTANCE), 1, 0.0, angle, 3.0, NO_NUMBERS)
    wavy, _, wavy_slope, _ = shaft_torque(
        *machines(RESISTANCE | {"harmonics": HARMONICS}), 1, 0.0, angle, 3.0, NO_NUMBERS
    )
    assert (wavy, wavy_slope) == pytest.approx((plain * factor, slope * factor), rel=1e-14)


@pytest.mark.parametrize(
    ("speed", "rate", "kink"),
    [(0.0, 2.0, 1.0), (0.0, -2.0, -5.0), (1.0, 1.0, 4.0), (1.0, -1.0, -5.0), (30.0, -1.0, 20.0), (-6.0, 3.0, -5.0)],
)
def test_a_table_bends_next_at_the_point_that_its_speed_reaches_first(speed: float, rate: float, kink: float) -> None:
    assert load_bend(*machines(TABLE), 1, 0.5, speed, rate)[0] == pytest.approx(0.5 + (kink - speed) / rate)


@pytest.mark.parametrize(("speed", "rate"), [(20.0, 1.0), (-5.0, -1.0), (0.0, 0.0)])
def test_a_table_whose_speed_reaches_no_point_does_not_bend(speed: float, rate: float) -> None:
    assert load_bend(*machines(TABLE), 1, 0.5, speed, rate)[0] == np.inf


@pytest.mark.parametrize("kind", LOADS)
def test_a_load_without_harmonics_has_no_waves(kind: str) -> None:
    assert load_bend(*machines(LOADS[kind]), 1, 0.5, 3.0, 0.0) == (np.inf, 0.0)


def test_the_first_profile_may_be_a_schedule() -> None:
    """Here one that is the torque of the pulley, too: after 0.7 s it halves that, and the load of -0.3 N m."""
    switched = Step(time=0.7, before=1.0, value=0.5)
    load = Resistance(kind="resistance", linear=0.1, schedule=switched)
    found = profile_rows([switched], [()]), shaft_loads([[load]], [(0, NO_SCHEDULE)], 0)
    assert [shaft_torque(*found, 0, time, 0.0, 3.0, NO_NUMBERS).torque for time in (0.5, 0.8)] == pytest.approx(
        [0.7, 0.35]
    )
    assert load_bend(*found, 0, 0.5, 3.0, 0.0)[0] == 0.7


def test_a_smooth_load_bends_with_its_schedule_and_waves_with_its_harmonics() -> None:
    switched = MOTOR | {"schedule": {"kind": "step", "time": 0.7, "value": 1.0}, "harmonics": HARMONICS}
    assert load_bend(*machines(switched), 1, 0.5, -3.0, 1.0) == (0.7, 6.0)

"""A motor with a speed controller: its torque, limits and derivatives, and what is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.machines.loads.load import LoadTorque, ShaftState
from beltdyn.machines.loads.motor import SERVO_MOTOR, servo_rate, servo_torque
from beltdyn.model import Pulley, ServoMotor
from beltdyn.records import row
from beltdyn.system.build_machines import body_arrays, machine_arrays

Torque = Callable[..., LoadTorque]
SERVO: dict[str, Any] = {
    "kind": "servo_motor",
    "speed": {"kind": "constant", "value": 100.0},
    "proportional_gain": 2.0,
    "integral_time": 0.05,
    "torque_limit": 30.0,
}
DC = SERVO | {"stall_torque": 60.0, "no_load_speed": 120.0}


@pytest.mark.parametrize(
    ("load", "speed", "state", "expected"),
    [
        (SERVO, 95.0, 0.0, 10.0),
        (SERVO, 95.0, 0.3, 10.0 + 2.0 / 0.05 * 0.3),
        (SERVO, 0.0, 0.0, 30.0),
        (SERVO, 190.0, 0.0, -30.0),
        (DC, 0.0, 0.0, 30.0),
        (DC, 90.0, 0.0, 15.0),  # on the line of full voltage, 60 (1 - 90 / 120)
        (DC, 99.0, 0.0, 2.0),
    ],
)
def test_it_is_a_pi_controller_within_its_limits(
    torque: Torque, load: dict[str, Any], speed: float, state: float, expected: float
) -> None:
    assert torque(load, speed, state=state).torque == pytest.approx(expected, rel=1e-12)


def at(load: dict[str, Any], speed: float, state: float, command: float = 100.0) -> tuple[np.record, ShaftState]:
    return row(SERVO_MOTOR, **ServoMotor(**load).values()), ShaftState(0.0, 0.0, speed, command, state)


@pytest.mark.parametrize("load", [SERVO, DC])
@pytest.mark.parametrize(("speed", "state"), [(95.0, 0.1), (99.0, -0.2), (10.0, 0.3), (90.0, 0.1), (180.0, 0.0)])
def test_derivatives(load: dict[str, Any], speed: float, state: float) -> None:
    step, none = 1e-6, np.zeros(0)
    by: dict[str, tuple[float, float]] = {}
    for name, (ds, dz, dc) in {"speed": (step, 0, 0), "state": (0, step, 0), "command": (0, 0, step)}.items():
        ends = [at(load, speed + k * ds, state + k * dz, 100.0 + k * dc) for k in (-1, 1)]
        torques = [servo_torque(constants, none, shaft).torque for constants, shaft in ends]
        rates = [servo_rate(constants, none, shaft).rate for constants, shaft in ends]
        by[name] = ((torques[1] - torques[0]) / (2 * step), (rates[1] - rates[0]) / (2 * step))
    constants, shaft = at(load, speed, state)
    torque, rate = servo_torque(constants, none, shaft), servo_rate(constants, none, shaft)
    found = (torque.by_speed, torque.by_command, rate.torque_by_state, rate.by_speed, rate.by_state)
    expected = (by["speed"][0], by["command"][0], by["state"][0], by["speed"][1], by["state"][1])
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_within_the_limits_the_state_is_the_integral_of_the_error() -> None:
    constants, shaft = at(SERVO, 95.0, 0.2)
    assert servo_rate(constants, np.zeros(0), shaft).rate == pytest.approx(5.0, rel=1e-12)


def test_at_a_limit_the_state_approaches_what_the_limit_stands_for() -> None:
    constants, shaft = at(SERVO, 0.0, 30.0 * 0.05 / 2.0)
    assert servo_rate(constants, np.zeros(0), shaft).rate == pytest.approx(0.0, abs=1e-12)
    assert servo_rate(*at(SERVO, 0.0, 0.0)[:1], np.zeros(0), shaft._replace(state=0.0)).rate > 0.0


def test_its_state_stands_behind_the_hub_chains_and_has_no_kinetic_energy() -> None:
    hub = [{"kind": "isolator", "stiffness": 1.0, "inertia": 0.2}]
    fan = {"kind": "fan", "rated_power": 1.0, "rated_speed": 1.0}
    pulleys = [
        Pulley(name="one", center=(0, 0), radius=0.1, inertia=0.5, load=[fan, SERVO | {"lag": 2e-3}], hub=hub),
        Pulley(name="two", center=(1, 0), radius=0.2, inertia=0.7, load=[SERVO]),
    ]
    bodies = body_arrays(pulleys, np.array([0.1, 0.2]), [])
    np.testing.assert_array_equal(bodies.inertia, [0.5, 0.7, 0.2, 2e-3, 1e-3])
    np.testing.assert_array_equal(bodies.kinetic, [0.5, 0.7, 0.2, 0.0, 0.0])
    np.testing.assert_array_equal(bodies.reach, [0.1, 0.2, 0.1, 0.1, 0.2])
    np.testing.assert_array_equal(bodies.unknown, range(5))
    np.testing.assert_array_equal(machine_arrays(pulleys).shaft_loads.table.state[:-1], [-1, 3, 4])


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"integral_time": 0.0}, "must be greater than 0"),
        ({"torque_limit": -1.0}, "must be greater than 0"),
        ({"stall_torque": 60.0}, "stall_torque and no_load_speed define one line together. Give both, or remove both"),
    ],
)
def test_errors(changes: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        ServoMotor(**SERVO | changes)
    assert sentence in str(caught.value)

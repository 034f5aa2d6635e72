"""Motors with speed controllers, and trimmed ones: torques, limits and derivatives, and what is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import row
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines.loads.load import LOADS, LoadTorque, ShaftState
from beltdyn.machines.loads.motor import SERVO_MOTOR, servo_rate, servo_torque
from beltdyn.machines.loads.trim import TRIM
from beltdyn.model import Pulley, RotaryTensioner, ServoMotor, SlidingTensioner, SpeedTrim
from beltdyn.model.carrier import check_sensors
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


# Control of tension: a dancer or a load cell trims a speed or a torque

SPEED_TRIM: dict[str, Any] = {
    "kind": "speed_trim",
    "speed": 50.0,
    "speed_gain": 4.0,
    "sensor": "dancer",
    "set_position": 0.02,
    "position_gain": 0.5,
    "integral_time": 2.0,
}
TORQUE_TRIM: dict[str, Any] = {
    "kind": "torque_trim",
    "torque": -30.0,
    "sensor": "cell",
    "set_force": 200.0,
    "force_gain": 1e-3,
    "integral_time": 0.5,
}
TRIMS: list[tuple[dict[str, Any], float]] = [(SPEED_TRIM, 50.0), (TORQUE_TRIM, -30.0)]


def trimmed(load: dict[str, Any], error: float, state: float, speed: float, command: float) -> tuple[np.record, Any]:
    kind = LOADS[load["kind"]]
    return row(TRIM, **kind(**load).values()), ShaftState(0.0, 0.0, speed, command, state, error)


@pytest.mark.parametrize(("load", "command"), TRIMS)
@pytest.mark.parametrize(("error", "state"), [(0.01, 0.02), (-0.02, 0.1), (3.0, 9.0), (-3.0, -9.0)])
def test_derivatives_of_trims(load: dict[str, Any], command: float, error: float, state: float) -> None:
    """Within the limit and at it, by the exact differences of functions that are linear there."""
    kind, none, step, given = LOADS[load["kind"]], np.zeros(0), 1e-4, np.array([error, state, 48.0, command])
    slopes = []
    for place in range(4):
        ends = [trimmed(load, *(given + k * step * (np.arange(4) == place))) for k in (-1, 1)]
        torques = [interpreted(kind.torque_at)(own, none, shaft).torque for own, shaft in ends]
        rates = [interpreted(kind.rate_at)(own, none, shaft).rate for own, shaft in ends]
        slopes.append(((torques[1] - torques[0]) / (2 * step), (rates[1] - rates[0]) / (2 * step)))
    own, shaft = trimmed(load, *given)
    torque, rate = interpreted(kind.torque_at)(own, none, shaft), interpreted(kind.rate_at)(own, none, shaft)
    by_error = interpreted(kind.slope_at)(own, none, shaft)
    assert (by_error.torque, by_error.rate) == pytest.approx(slopes[0], rel=1e-8, abs=1e-8)
    assert (rate.torque_by_state, rate.by_state) == pytest.approx(slopes[1], rel=1e-8, abs=1e-8)
    assert (torque.by_speed, rate.by_speed) == pytest.approx(slopes[2], rel=1e-8, abs=1e-8)
    assert (torque.by_command, 0.0) == pytest.approx(slopes[3], rel=1e-8, abs=1e-8)


def test_a_trim_is_pi_control_of_place_or_force() -> None:
    """M = K (w (1 + u) - w'), u = g e + z / T, and M = M_0 (1 + u); the force of a cell is preload - k q."""
    own, shaft = trimmed(SPEED_TRIM, 0.03, 0.02, 49.0, 50.0)
    found = interpreted(LOADS["speed_trim"].torque_at)(own, np.zeros(0), shaft).torque
    assert found == pytest.approx(4.0 * (50.0 * (1.0 + 0.5 * 0.03 + 0.02 / 2.0) - 49.0))
    slide = SlidingTensioner(kind="sliding", pulley="cell", direction=[0, 1], preload=190.0, rate=1e6)
    rate, zero = LOADS["torque_trim"](**TORQUE_TRIM).error_of(slide, 1.0)
    assert rate * 2e-5 + zero == pytest.approx(200.0 - (190.0 - 1e6 * 2e-5))
    arm = RotaryTensioner(kind="rotary", pulley="dancer", pivot=[0, 1], preload="3 N m", rate=10.0)
    assert LOADS["speed_trim"](**SPEED_TRIM).error_of(arm, 0.4) == pytest.approx((0.4, -0.02))


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"position_gain": None, "set_position": None}, "needs one of position_gain"),
        ({"force_gain": 1e-3, "set_force": 100.0}, "needs one of position_gain"),
        ({"set_force": 100.0}, "set_force and force_gain belong together"),
        ({"position_gain": None, "set_force": 100.0, "force_gain": 1e-3}, "set_position needs position_gain"),
    ],
)
def test_a_trim_has_one_sensor(changed: dict[str, Any], told: str) -> None:
    with pytest.raises(ModelError, match=told):
        SpeedTrim(**{name: value for name, value in (SPEED_TRIM | changed).items() if value is not None})


@pytest.mark.parametrize(
    ("tensioners", "told"),
    [
        ([], r'load\[1\].sensor = "cell" of pulley "last" must be a pulley that a moving tensioner carries. Add a'),
        ([{"pulley": "other"}], "Choose one of other"),
        ([{"pulley": "cell"}], "measures a force by its spring, but its tensioner has no constant rate"),
    ],
)
def test_sensors_are_tensioners(tensioners: list[dict[str, Any]], told: str) -> None:
    slide = {"kind": "sliding", "direction": [0, 1], "preload": 100.0}
    last = Pulley(name="last", center=[1, 0], radius=0.1, inertia=1.0, load=[TORQUE_TRIM])
    with pytest.raises(ValueError, match=told):
        check_sensors([SlidingTensioner(**(slide | one)) for one in tensioners], [last])

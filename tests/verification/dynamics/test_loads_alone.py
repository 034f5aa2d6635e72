"""Loads and motors move a pulley far from the belt, of 0.4 kg m^2, as their closed forms say, with their whole work.

Local errors of 0.01 m/s at a radius of 0.1 m are allowed.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.model import Pulley
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.standard import StandardIntegrator
from beltdyn.system.arrays import POWERS
from beltdyn.system.build_machines import machine_arrays

Follow = Callable[..., Any]
Measured = Callable[..., None]
INERTIA = 0.4
ALLOWED = 1e-3 * 10.0 / 0.1
TORQUE_WORK = POWERS.index("torque_work")
MOTOR: dict[str, Any] = {
    "kind": "induction_motor",
    "rated_power": "15 kW",
    "rated_speed": "1465 rpm",
    "locked_rotor_ratio": 2.4,
    "pull_up_ratio": 1.9,
    "breakdown_ratio": 3.0,
}
RATED, SYNCHRONOUS = 15e3 / (1465.0 * np.pi / 30), 50 * np.pi


def steady(value: float) -> dict[str, Any]:
    return {"kind": "constant", "value": value}


def time_between(load: dict[str, Any], start: float, end: float) -> float:
    """Time in which a load alone brings the pulley from one speed to another: the integral of I / M."""
    machines = machine_arrays([Pulley(name="one", center=(0, 0), radius=0.1, inertia=INERTIA, load=[load])])

    def pace(speed: float) -> float:
        return INERTIA / shaft_torque(machines.profiles, machines.shaft_loads, 0, 0.0, 0.0, speed, np.zeros(0)).torque

    return float(quad(pace, start, end, limit=500)[0])


@pytest.mark.parametrize("speed", [100.0, 150.0])
def test_direct_start(follow: Follow, measured: Measured, speed: float) -> None:
    end = follow(load=[MOTOR], until=time_between(MOTOR, 0.0, speed))
    measured(speed=end.speeds[0] / speed - 1, steps=end.steps)
    assert end.speeds[0] == pytest.approx(speed, abs=ALLOWED)
    assert end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * end.speeds[0] ** 2, rel=1e-4)


def test_star_delta_start(follow: Follow) -> None:
    """Until it switches it gathers speed in three times the time."""
    switch, speed = 3.0 * time_between(MOTOR, 0.0, 60.0), 140.0
    end = follow(load=[MOTOR | {"star_until": switch}], until=switch + time_between(MOTOR, 60.0, speed))
    assert end.speeds[0] == pytest.approx(speed, abs=ALLOWED)


def test_counter_current_braking(follow: Follow) -> None:
    """Driven backwards, the motor brakes with its locked-rotor torque."""
    end = follow((-100.0,), load=[MOTOR], until=0.1)
    assert end.speeds[0] == pytest.approx(-100.0 + 2.4 * RATED * 0.1 / INERTIA, abs=ALLOWED)


def test_inverter_on_a_ramp(follow: Follow) -> None:
    """The speed lags by the slip that accelerates the inertia: the torque is nearly in proportion to it."""
    ramp = {"kind": "ramp", "start": 0.0, "end": 4.0, "value": "50 Hz"}
    end = follow(load=[MOTOR | {"supply": ramp}], until=2.0)
    torque = INERTIA * SYNCHRONOUS / 4.0
    ratio = 3.0 * RATED / torque
    breakdown = (1 - 1465 / 1500) * (3.0 + np.sqrt(8.0))
    slip = breakdown * (ratio - np.sqrt(ratio**2 - 1.0))
    assert end.speeds[0] == pytest.approx(SYNCHRONOUS * (0.5 - slip), abs=ALLOWED)


def test_inverter_at_its_limit(follow: Follow) -> None:
    load = MOTOR | {"supply": steady(50.0), "limit_ratio": 0.5}
    end = follow(load=[load], until=1.0)
    assert end.speeds[0] == pytest.approx(0.5 * RATED / INERTIA, abs=ALLOWED)


@pytest.mark.parametrize("width", [1e-4, 1e-2, 0.5])
def test_pulse_of_a_command(follow: Follow, width: float) -> None:
    """A brake that is clamped for a while between two outputs, or over many."""
    clamped = {"kind": "table", "times": [0.6042, 0.6042 + 0.3 * width, 0.6042 + width], "values": [0.0, 20.0, 0.0]}
    end = follow((100.0,), load=[{"kind": "brake", "torque": clamped}])
    assert INERTIA * (100.0 - end.speeds[0]) == pytest.approx(20.0 * 0.5 * width, rel=1e-8)
    assert -end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * (100.0**2 - end.speeds[0] ** 2), rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("width", [0.02, 0.2, 1.0])
@pytest.mark.parametrize("start", [30.0, 2.0 * np.pi * 100.0, 2000.0])
def test_narrow_pulses_over_the_angle(follow: Follow, measured: Measured, width: float, start: float) -> None:
    """Each turn does the work of the area, whatever the turns between outputs and steps: 1 % of the energy in all."""
    energy = 0.5 * INERTIA * start**2
    height = -0.02 * energy / np.floor(2.0 * start / (2 * np.pi)) / width
    load = {"kind": "angle_table", "angles": [0.5, 3.0, 3.0 + width / 2, 3.0 + width], "torques": [0, 0, height, 0]}
    end = follow((start,), load=[load])
    turns, angle = np.divmod(float(end.angles[0]), 2 * np.pi)
    part = np.clip((angle - 3.0) / (0.5 * width), 0.0, 2.0)  # of the smooth steps up and down
    rest = part**3 - 0.5 * part**4 if part <= 1.0 else 1.0 - (2.0 - part) ** 3 + 0.5 * (2.0 - part) ** 4
    work = (turns + rest) * 0.5 * width * height
    speed = np.sqrt(start**2 + 2 * work / INERTIA)
    measured(turns=turns, work=end.work[TORQUE_WORK] / work - 1, speed=end.speeds[0] - speed, steps=end.steps)
    assert end.work[TORQUE_WORK] == pytest.approx(work, rel=2e-3)
    assert end.speeds[0] == pytest.approx(speed, abs=ALLOWED)


def test_an_engine_over_two_turns(follow: Follow) -> None:
    """A measured torque of 720 points: its work is the integral over the angle."""
    angles = np.linspace(0.0, 4.0 * np.pi, 720, endpoint=False)
    torque = 30.0 * np.exp(-(((angles - 0.5) / 0.3) ** 2)) - 3.0 * (1.0 - np.cos(angles))
    table = {"kind": "angle_table", "angles": angles.tolist(), "torques": torque.tolist(), "cycle": "720 deg"}
    end = follow((80.0,), load=[table])
    points, step = np.linspace(0.0, float(end.angles[0]), 400_001, retstep=True)
    curve = np.interp(points % (4 * np.pi), np.append(angles, 4 * np.pi), np.append(torque, torque[0]))
    work = float(np.trapezoid(curve, dx=step))
    assert end.work[TORQUE_WORK] == pytest.approx(work, rel=2e-3)
    assert end.speeds[0] == pytest.approx(np.sqrt(80.0**2 + 2 * work / INERTIA), abs=ALLOWED)


def test_a_generator_takes_constant_power(follow: Follow) -> None:
    load = {"kind": "generator", "power": steady(900.0), "efficiency": 0.6, "cut_in_speed": 20.0}
    end = follow((150.0,), load=[load | {"full_field_power": 5e3}])
    assert -end.work[TORQUE_WORK] == pytest.approx(900.0 / 0.6 * 2.0, rel=1e-4)
    assert end.speeds[0] == pytest.approx(np.sqrt(150.0**2 - 2 * 3000.0 / INERTIA), abs=ALLOWED)


def test_a_generator_that_is_slowed_below_its_cut_in_speed_is_free(follow: Follow) -> None:
    """P / eta all the way to where the full field gives no more than P, then along the full field to the cut-in."""
    load = {"kind": "generator", "power": steady(900.0), "efficiency": 0.6, "cut_in_speed": 100.0}
    load["full_field_power"] = 5e3
    end = follow((115.0,), load=[load])
    assert time_between(load, 115.0, 101.0) < 2.0
    assert 100.0 - ALLOWED < end.speeds[0] < 101.0


def test_a_fan_runs_out(follow: Follow) -> None:
    """I d omega/dt = -q omega^2: 1 / omega grows in proportion to time."""
    end = follow((150.0,), load=[{"kind": "fan", "rated_power": 3e3, "rated_speed": 150.0}])
    assert 1.0 / end.speeds[0] == pytest.approx(1.0 / 150.0 + 3e3 / 150.0**3 * 2.0 / INERTIA, rel=1e-3)


@pytest.mark.parametrize("sense", [-1.0, 1.0])
def test_a_band_brake_brings_the_pulley_to_rest(follow: Follow, sense: float) -> None:
    load = {"kind": "band_brake", "force": steady(100.0), "radius": 0.1, "friction": 0.3, "wrap": 4.0}
    ratio = np.exp(1.2)
    torque = 10.0 * (ratio - 1.0 if sense > 0 else 1.0 - 1.0 / ratio)
    moving = follow((sense * 60.0,), load=[load], until=0.5)
    assert moving.speeds[0] * sense == pytest.approx(60.0 - torque * 0.5 / INERTIA, abs=ALLOWED)
    still = follow((sense * 60.0,), load=[load], until=8.0)
    assert still.speeds[0] == pytest.approx(0.0, abs=ALLOWED)
    assert still.work[TORQUE_WORK] == pytest.approx(-0.5 * INERTIA * 60.0**2, rel=1e-4)


SERVO: dict[str, Any] = {
    "kind": "servo_motor",
    "speed": {"kind": "step", "time": 0.1, "value": 60.0},
    "proportional_gain": 4.0,
    "integral_time": 0.2,
    "torque_limit": 50.0,
    "lag": 2e-3,
}


def controlled(end: float, drag: float) -> Any:
    """Speed of the pulley under the controller, integrated by itself from the step on."""
    gain, integral, limit, lag = 4.0, 4.0 / 0.2, 50.0, 2e-3

    def rates(_: float, state: Any) -> list[float]:
        speed, z, follow = state
        torque = float(np.clip(gain * (60.0 - speed) + integral * z, -limit, limit))
        return [(torque - drag * speed) / INERTIA, follow, ((torque - integral * z) / gain - follow) / lag]

    return solve_ivp(rates, (0.0, end - 0.1), [0.0, 0.0, 0.0], method="LSODA", rtol=1e-9, atol=1e-9).y


@pytest.mark.parametrize("until", [0.3, 0.6, 0.9, 2.0])
@pytest.mark.parametrize("drag", [0.0, 0.4])
def test_a_servo_runs_up_at_its_limit_and_settles(follow: Follow, drag: float, until: float) -> None:
    """At the limit for half a second, then as its own integration has it; work is energy and drag."""
    loads = [SERVO, *([{"kind": "resistance", "linear": drag}] if drag else [])]
    end = follow((0.0, 0.0), load=loads, until=until)
    exact = controlled(until, drag)
    assert end.speeds[0] == pytest.approx(exact[0, -1], abs=ALLOWED)
    assert end.angles[1] == pytest.approx(exact[1, -1], abs=0.01 * max(np.abs(exact[1])))
    if not drag:
        assert end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * end.speeds[0] ** 2, rel=1e-3)


def test_a_servo_does_not_wind_up(follow: Follow) -> None:
    """Its integral part alone would pass the set speed by what a time of 0.5 s at the limit has gathered."""
    passed = max(follow((0.0, 0.0), load=[SERVO], until=until).speeds[0] for until in (0.6, 0.7, 0.8, 1.0, 1.2))
    wound_up = 0.5 * 60.0 * 0.48 * (4.0 / 0.2) / 4.0  # integral of the error over the run-up, as a speed
    assert passed - 60.0 < 0.15 * wound_up


@pytest.mark.parametrize("name", ["bdf", "radau"])
def test_standard_integrators_solve_for_the_state_of_a_controller(follow: Follow, name: Any) -> None:
    end = follow((0.0, 0.0), StandardIntegrator(name, 1e-3), load=[SERVO], until=0.9)
    assert end.speeds[0] == pytest.approx(controlled(0.9, 0.0)[0, -1], abs=ALLOWED)


def test_a_function_is_resolved_to_its_highest_order(follow: Follow) -> None:
    """A stroke of a twentieth of a turn, which steps may pass; errors of steps add up, so that they are a tenth."""
    width = 0.3

    def stroke(_time: float, angle: float, _speed: float) -> float:
        phase = (angle % 6.283185307179586 - 3.0) / width
        return -40.0 * (1.0 - math.cos(6.283185307179586 * phase)) if 0.0 < phase < 1.0 else 0.0

    load = {"kind": "function", "function": stroke, "highest_order": 40}
    end = follow((300.0,), GeneralizedAlpha(0.6, 1e-4), load=[load], until=1.0)
    turns, angle = np.divmod(float(end.angles[0]), 2 * np.pi)
    phase = float(np.clip((angle - 3.0) / width, 0.0, 1.0))
    work = -40.0 * width * (turns + phase - np.sin(2 * np.pi * phase) / (2 * np.pi))
    assert end.work[TORQUE_WORK] == pytest.approx(work, rel=5e-3)
    assert end.speeds[0] == pytest.approx(np.sqrt(300.0**2 + 2 * work / INERTIA), abs=ALLOWED)

"""Closed forms that the laws of the machines around a belt must give when they move bodies on their own."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from beltdyn.arrays import FloatArray
from beltdyn.machines.links import link_torque
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.machines.profiles.functions import prescribed_motion, profile_integral
from beltdyn.machines.tensioners import tensioner_force
from beltdyn.model import Belt, Pulley, SlidingTensioner
from beltdyn.model.routing import lay_path
from beltdyn.system.build_machines import Machines, body_inertias, machine_arrays

BELT = Belt(length=1.0, width=0.01, thickness=0.01, density=1e3, youngs_modulus=1e8, poissons_ratio=0.3)

RTOL = 1e-10
SOLVER: dict[str, Any] = {"rtol": RTOL, "atol": 1e-12, "method": "DOP853"}


def pulley(**keys: Any) -> tuple[Pulley, Machines]:
    one = Pulley(name="one", center=(0, 0), radius=0.1, **keys)
    return one, machine_arrays([one])


def test_a_free_chain_swings_at_its_eigenfrequency() -> None:
    """Two bodies: twist a exp(-z w t) cos(w sqrt(1 - z^2) t + phi) with w^2 = k (1/I1 + 1/I2), while both turn on."""
    link = {"kind": "isolator", "stiffness": 40.0, "damping": 0.02, "inertia": 0.004}
    one, machines = pulley(inertia=0.01, hub=[link])
    inertia = body_inertias([one])

    def rates(time: float, state: FloatArray) -> FloatArray:
        twist, rate = state[0] - state[1], state[2] - state[3]
        torque = link_torque(machines.profiles, machines.links[0], time, twist, rate)[0]
        return np.array([state[2], state[3], -torque / inertia[0], torque / inertia[1]])

    times = np.linspace(0.0, 0.3, 61)
    found = solve_ivp(rates, (0.0, 0.3), [0.1, 0.0, 5.0, 5.0], t_eval=times, **SOLVER).y
    mobility = float(np.sum(1 / inertia))
    root = np.roots([1.0, 0.02 * mobility, 40.0 * mobility])[0]
    exact = 0.1 * (np.exp(root * times) * (1 + 1j * root.real / root.imag)).real
    np.testing.assert_allclose(found[0] - found[1], exact, atol=1e-9)
    np.testing.assert_allclose(inertia @ found[2:], 5.0 * np.sum(inertia), rtol=1e-9)


def test_a_motor_runs_up_in_the_time_of_its_closed_form() -> None:
    """I d omega/dt = M gives t = I omega_s / (2 M_b) ((1 - s^2) / (2 s_b) - s_b ln s) from rest to the slip s."""
    motor = {"kind": "motor", "breakdown_torque": 10.0, "breakdown_slip": 0.2, "synchronous_speed": 150.0}
    _, machines = pulley(inertia=0.3, load=[motor])

    def rates(time: float, state: FloatArray) -> list[float]:
        torque = shaft_torque(machines.profiles, machines.shaft_loads, 0, time, state[0], state[1], np.zeros(0)).torque
        return [state[1], torque / 0.3]

    slip = 0.01
    time = 0.3 * 150.0 / 20.0 * ((1 - slip**2) / 0.4 - 0.2 * np.log(slip))
    found = solve_ivp(rates, (0.0, time), [0.0, 0.0], **SOLVER).y[1, -1]
    assert found == pytest.approx(150.0 * (1 - slip), rel=1e-9)


@pytest.mark.slow
def test_a_one_way_clutch_takes_its_body_to_the_largest_speed_of_the_rim() -> None:
    """Without load nothing slows the body behind: it approaches m (1 + a), the crank's largest speed, from below."""
    clutch = {"kind": "one_way_clutch", "locking_damping": 0.5, "inertia": 0.01}
    mean, amplitude = 80.0, 0.2
    _, machines = pulley(
        inertia=1.0,
        speed={"kind": "constant", "value": mean},
        harmonics=[{"order": 2, "amplitude": amplitude}],
        hub=[clutch],
    )

    def rates(time: float, state: FloatArray) -> list[float]:
        rate = prescribed_motion(machines.profiles, 0, time)[1] - state[0]
        return [link_torque(machines.profiles, machines.links[0], time, 0.0, rate)[0] / 0.01]

    end, step = 2.0, 1e-4  # a step resolves both the wave of 160 rad/s and the time constant of 0.02 s
    speed = solve_ivp(rates, (0.0, end), [0.0], max_step=step, method="RK45").y[0]
    top = mean * (1 + amplitude)
    assert np.all(np.diff(speed) >= 0.0)
    assert np.max(speed) <= top
    assert speed[-1] == pytest.approx(top, rel=2e-3)  # closing in ever more slowly, as the contact gets short


@pytest.mark.parametrize("order", [2.0, 0.5])
def test_a_crank_turns_by_its_mean_speed_in_whole_waves(order: float) -> None:
    """The integral of omega over time is theta + sum a_k / k (sin(k theta + phi_k) - sin phi_k), in a run-up too."""
    harmonic = {"order": order, "amplitude": 0.1, "phase": 0.4}
    _, machines = pulley(speed={"kind": "cosine_ramp", "start": 0.1, "end": 0.7, "value": 60.0}, harmonics=[harmonic])
    whole = quad(lambda t: prescribed_motion(machines.profiles, 0, t)[1], 0.0, 1.0, points=[0.1, 0.7], limit=400)[0]
    theta = profile_integral(machines.profiles, 0, 1.0)
    assert theta == pytest.approx(60.0 * (0.3 + 0.3), rel=1e-14)
    expected = theta + 0.1 / order * (np.sin(order * theta + 0.4) - np.sin(0.4))
    assert whole == pytest.approx(expected, rel=1e-10)


def test_losses_of_a_tensioner_in_a_cycle() -> None:
    """For q = A sin(w t): pi c w A^2 of the damper, 2 A (f+ + f-) of dry friction but for its build-up.

    The friction missing while |v| is of the size of v_c is (f+ + f-) times the integral of (1 - tanh) |v| dt
    = pi^2 v_c^2 / (12 A w^2), since the integral of (1 - tanh x) x from zero to infinity is pi^2 / 24.
    """
    amplitude, omega, creep = 0.01, 50.0, 1e-3
    pulleys = [
        Pulley(name="fast", center=(0, 0), radius=0.1, speed={"kind": "constant", "value": 1.0}),
        Pulley(name="loose", center=(1, 0), radius=0.1, inertia=1.0),
    ]
    slide = SlidingTensioner(
        kind="sliding", pulley="loose", direction=(1, 0), preload=40.0, rate=900.0, damping=3.0,
        tensioning_friction=2.0, yielding_friction=6.0, creep_speed=creep,
    )  # fmt: skip
    tensioners = machine_arrays(pulleys, [slide], lay_path(pulleys, BELT)).tensioners

    def power(time: float, pick: Callable[[tuple[float, ...], float], float]) -> float:
        rate = amplitude * omega * np.cos(omega * time)
        return pick(tensioner_force(tensioners[0], amplitude * np.sin(omega * time), rate), rate)

    period = 2 * np.pi / omega
    turns = [0.25 * period, 0.75 * period]
    loss = quad(lambda t: power(t, lambda found, _: found[4]), 0.0, period, points=turns, limit=1000)[0]
    work = quad(lambda t: power(t, lambda found, v: -found[0] * v), 0.0, period, points=turns, limit=1000)[0]
    viscous = np.pi * 3.0 * omega * amplitude**2
    missing = 8.0 * np.pi**2 * creep**2 / (12 * amplitude * omega**2)
    assert missing > 1e-8
    assert loss == pytest.approx(viscous + 2 * amplitude * 8.0 - missing, abs=1e-3 * missing + 1e-9)
    assert work == pytest.approx(loss, abs=1e-7)  # the spring gives back what it took

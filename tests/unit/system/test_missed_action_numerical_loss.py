"""What the damping of the time integrator takes in a step: nothing by the trapezoidal rule, else as by dense sums."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, prepare
from beltdyn.system.arrays import Motion, System
from beltdyn.system.build import drive_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.first_order import mass_matrix
from beltdyn.system.missed_action import numerical_loss
from beltdyn.system.state import State

LENGTH = 2e-4


def lost(system: System, before: Motion, after: Motion, impulse: FloatArray | None = None) -> float:
    given = np.zeros((2, before.position.size)) if impulse is None else impulse
    return float(numerical_loss(system, before, after, given, element_workspace(system)))


def some_motion(system: System, time: float, seed: int) -> Motion:
    """Anything but the motion of a belt."""
    parts = np.random.default_rng(seed).normal(size=(3, system.first_body + system.bodies.size))
    return Motion(time, *parts)


def whole_mass(system: System) -> FloatArray:
    """Mass matrix of belt and free bodies, dense; prescribed bodies count for nothing."""
    belt, inertia = mass_matrix(system), np.where(system.bodies.unknown >= 0, system.bodies.inertia, 0.0)
    rest = np.zeros((len(belt), inertia.size))
    return np.block([[belt, rest], [rest.T, np.diag(inertia)]])


@pytest.fixture(params=["rotary", "sliding"])
def machines(request: pytest.FixtureRequest, with_machines: Callable[[str], Drive]) -> System:
    return drive_system(prepare(with_machines(request.param)))


def assert_trapezoidal_is_free(system: System) -> None:
    """Means of the rates at both ends of the step make its changes, which keeps the energy of linear systems."""
    before, after = (some_motion(system, time, seed) for time, seed in ((0.0, 1), (LENGTH, 2)))
    velocity = before.velocity + 0.5 * LENGTH * (before.acceleration + after.acceleration)
    position = before.position + 0.5 * LENGTH * (before.velocity + velocity)
    end = Motion(LENGTH, position, velocity, after.acceleration)
    rough = lost(system, before, after)
    assert lost(system, before, end) == pytest.approx(0.0, abs=1e-10 * abs(rough))


def test_the_trapezoidal_rule_takes_nothing(system: System) -> None:
    assert_trapezoidal_is_free(system)


def test_the_trapezoidal_rule_takes_nothing_from_machines(machines: System) -> None:
    assert_trapezoidal_is_free(machines)


def assert_is_the_sum_over_the_mass(system: System) -> None:
    """Work of the mean force of inertia on the way of the step, less the gain of kinetic energy."""
    before, after = (some_motion(system, time, seed) for time, seed in ((0.0, 1), (LENGTH, 2)))
    mass = whole_mass(system)
    way, mean = after.position - before.position, 0.5 * (before.acceleration + after.acceleration)
    kinetic = [0.5 * motion.velocity @ mass @ motion.velocity for motion in (before, after)]
    assert lost(system, before, after) == pytest.approx(mean @ mass @ way - (kinetic[1] - kinetic[0]), rel=1e-12)


def test_is_work_of_inertia_less_kinetic_energy(system: System) -> None:
    assert_is_the_sum_over_the_mass(system)


def test_is_work_of_inertia_less_kinetic_energy_of_machines(machines: System) -> None:
    assert_is_the_sum_over_the_mass(machines)


def test_impulses_between_the_ends_do_their_work(machines: System) -> None:
    """A shaft that impulses alone bring from one speed to another: their work is the kinetic energy it gains."""
    system = machines
    still = some_motion(system, 0.0, 1)
    still.acceleration[:] = 0.0
    body = system.first_body + int(np.flatnonzero(system.bodies.unknown >= 0)[-1])
    inertia = float(system.bodies.inertia[body - system.first_body])
    for row in (0, 1):
        velocity, impulse = still.velocity.copy(), np.zeros((2, still.velocity.size))
        velocity[body] += 3.0
        impulse[row, body] = 3.0 * inertia
        end = Motion(LENGTH, still.position, velocity, still.acceleration)
        assert lost(system, still, end, impulse) == pytest.approx(0.0, abs=1e-12 * inertia)
        assert lost(system, still, end) < 0.0
    driver = system.first_body + int(np.flatnonzero(system.bodies.unknown < 0)[0])
    pushed = np.zeros((2, still.velocity.size))
    pushed[:, driver] = 1.0
    assert lost(system, still, still, pushed) == pytest.approx(0.0, abs=1e-12)  # rounding of some joules


def test_backward_differences_take_half_the_mass_times_the_square_of_the_change(system: System, moving: State) -> None:
    """A free flight that the backward rule slows down: q1 = q0 + h v1 and v1 = v0 + h a1, with the force at the end."""
    mass, size = whole_mass(system), moving.position.size
    push = np.random.default_rng(4).normal(size=size)
    velocity = moving.velocity + LENGTH * push
    before = Motion(0.0, moving.position, moving.velocity, push)
    after = Motion(LENGTH, moving.position + LENGTH * velocity, velocity, push)
    change = velocity - moving.velocity
    assert lost(system, before, after) == pytest.approx(0.5 * change @ mass @ change, rel=1e-6)  # cancellation

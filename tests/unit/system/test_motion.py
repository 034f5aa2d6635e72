"""Accelerations (Eqs. 23, 25 and 27): they leave no residual, and prescribed and unloaded pulleys do what they must."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Belt, Constant, Drive, Pulley
from beltdyn.solvers.engine import accelerate
from beltdyn.system.arrays import NO_TANGENT, Motion, System
from beltdyn.system.build import belt_system
from beltdyn.system.motion import new_equations, subtract_multipliers, subtract_solution
from beltdyn.system.state import State, straight
from beltdyn.system.steady_assembly import assemble

TIME = 0.3


def test_accelerations_leave_no_residual(system: System, moving: State) -> None:
    equations = new_equations(system)
    motion = Motion(TIME, moving.position, moving.velocity.copy(), np.empty_like(moving.position))
    multipliers = np.empty(len(system.scale))
    assert accelerate(system, motion, multipliers, equations)
    forces = np.max(np.abs(equations.matrix.node_side))
    assemble(system, motion, multipliers, NO_TANGENT, equations)
    np.testing.assert_allclose(equations.matrix.node_side, 0.0, atol=1e-10 * forces)  # rounding
    np.testing.assert_allclose(equations.matrix.border_side, 0.0, atol=1e-10 * forces)


def test_prescribed_pulley_keeps_its_profile(small: Drive, system: System, moving: State) -> None:
    equations = new_equations(system)
    motion = Motion(TIME, moving.position, moving.velocity.copy(), np.empty_like(moving.position))
    accelerate(system, motion, np.empty(len(system.scale)), equations)
    speed = small.pulleys[0].speed
    assert speed is not None
    assert motion.velocity[-2] == pytest.approx(float(speed.at(TIME)))
    assert motion.acceleration[-2] == pytest.approx(12.0 / 0.55)


@pytest.fixture
def untouched(drive: Drive) -> Callable[[Pulley], System]:
    """An open belt, straight and far from a pulley."""
    belt = Belt(**drive.belt.model_dump() | {"elements": 3})
    return lambda pulley: belt_system(belt, [pulley], drive.contact)


def test_free_pulley_turns_by_torque_over_inertia(untouched: Callable[[Pulley], System]) -> None:
    system = untouched(Pulley(name="far", center=(0, 50), radius=0.1, inertia=0.4, torque=Constant(value=-2.0)))
    state, equations = straight(system), new_equations(system)
    assert accelerate(system, state.at(TIME), np.empty(len(system.scale)), equations)
    np.testing.assert_allclose(state.acceleration[:-1], 0.0, atol=1e-7)  # rounding of 1e4 N on grams
    assert state.acceleration[-1] == pytest.approx(-5.0)


def test_massless_belt_is_singular(untouched: Callable[[Pulley], System]) -> None:
    system = untouched(Pulley(name="far", center=(0, 50), radius=0.1, inertia=0.4))
    system = system._replace(mass=0.0 * system.mass)
    state = straight(system)
    assert not accelerate(system, state.at(TIME), np.empty(len(system.scale)), new_equations(system))


def test_subtraction_leaves_prescribed_pulleys(system: System, moving: State) -> None:
    equations = new_equations(system)
    equations.node_part[:], equations.border_part[:] = 1.0, np.arange(equations.border_part.size)
    vector, multipliers = moving.position.copy(), np.zeros(len(system.scale))
    subtract_solution(system, equations, 0.5, vector)
    subtract_multipliers(system, equations, 0.5, multipliers)
    np.testing.assert_allclose(moving.position[:-2] - vector[:-2], 0.5)
    np.testing.assert_array_equal(vector[-2:], moving.position[-2:])
    np.testing.assert_array_equal(multipliers, -0.5 * np.arange(1, 7) if system.joint else 0.0)

"""The first guess of a time step."""

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.solvers.alpha_step import follow_trend, method_of, predict
from beltdyn.solvers.integrator_state import IntegratorState, new_state
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system, flowing_system, staying_system

METHOD = method_of(0.6)
STEP = 2e-3


@pytest.fixture
def flowing(drive: Drive) -> System:
    """A drive on a mesh that stays."""
    drive = drive.replace(belt=drive.belt.replace(discretization="quintic"))
    mesh = staying_system(prepare(drive), np.full(16, drive.belt_length / 16))
    return flowing_system(mesh, np.array([0.6, 0.8]))


def begun(system: System) -> IntegratorState:
    """An integration in the middle of some motion."""
    random, size = np.random.default_rng(3), system.first_body + system.bodies.size
    state = new_state(system, 0.1, STEP, random.normal(size=size), random.normal(size=size))
    for vector in (state.acceleration, state.auxiliary, state.trend):
        vector[:] = random.normal(size=size)
    return state


def end_with(state: IntegratorState, change: np.ndarray) -> None:
    """Let the step on trial change A by an amount."""
    state.trial.auxiliary[:] = state.auxiliary + change


@pytest.mark.slow
@pytest.mark.parametrize("persistence", [0.0, 0.4, 1.0])
def test_guess_is_a_step_of_the_method(flowing: System, persistence: float) -> None:
    """Equations of `alpha_step` with A1 = A0 + persistence times the change before, in all that is not prescribed."""
    state = begun(flowing)
    state.clock.persistence = persistence
    predict(flowing, METHOD, state, STEP, 0.1 + STEP)
    a, before, after = state.acceleration, state.auxiliary, state.auxiliary + persistence * STEP * state.trend
    nodes = slice(flowing.first_body)
    position = state.position + STEP * state.velocity
    position += STEP**2 * ((0.5 - METHOD.beta) * before + METHOD.beta * after)
    velocity = state.velocity + STEP * ((1.0 - METHOD.gamma) * before + METHOD.gamma * after)
    both = (1.0 - METHOD.af) * state.trial.acceleration + METHOD.af * a
    np.testing.assert_allclose(state.trial.position[nodes], position[nodes], rtol=1e-12)
    np.testing.assert_allclose(state.trial.velocity[nodes], velocity[nodes], rtol=1e-12)
    np.testing.assert_allclose(both[nodes], ((1.0 - METHOD.am) * after + METHOD.am * before)[nodes], rtol=1e-9)


@pytest.mark.parametrize(("factor", "expected"), [(1.0, 1.0), (0.5, 0.5), (3.0, 1.0), (0.0, 0.0), (-1.0, 0.0)])
def test_a_trend_persists_as_far_as_it_foretold_the_step(flowing: System, factor: float, expected: float) -> None:
    state = begun(flowing)
    change = factor * STEP * state.trend
    end_with(state, change)
    follow_trend(flowing, state, STEP)
    assert state.clock.persistence == pytest.approx(expected, abs=1e-12)
    np.testing.assert_allclose(state.trend, change / STEP, atol=1e-12)


def test_nothing_persists_after_a_restart(flowing: System) -> None:
    state = begun(flowing)
    state.trend[:] = 0.0
    end_with(state, np.ones_like(state.trend))
    follow_trend(flowing, state, STEP)
    assert state.clock.persistence == 0.0


def test_nothing_persists_where_nodes_travel(drive: Drive) -> None:
    system = drive_system(prepare(drive))
    state = begun(system)
    end_with(state, STEP * state.trend)
    follow_trend(system, state, STEP)
    assert state.clock.persistence == 0.0

"""One step of generalized-alpha: coefficients, the error that it may make, and its solution."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.solvers.alpha_step import method_of, new_step, try_step
from beltdyn.solvers.engine import restart
from beltdyn.solvers.integrator_state import Settings, allowed_error, new_state
from beltdyn.system.arrays import System
from beltdyn.system.state import straight
from beltdyn.system.steady_assembly import new_equations

SETTINGS = Settings(0.8, 1e-3, 1e-3, 1.0, long_step=0.02)
ACCELERATION = 5.0
STEP = 0.1
METHOD = method_of(0.8)


@given(st.floats(0.0, 1.0))
def test_coefficients_are_those_of_chung_and_hulbert(radius: float) -> None:
    method = method_of(radius)
    assert method.gamma == pytest.approx(0.5 - method.am + method.af)  # second order
    assert method.beta == pytest.approx(0.25 * (1 - method.am + method.af) ** 2)  # as much damping as can be
    assert method.am <= method.af <= 0.5  # unconditionally stable
    assert method.af / (1 - method.af) == pytest.approx(radius)  # the roots at infinite frequency
    assert 1 - (0.5 + method.gamma) / (2 * method.beta) == pytest.approx(-radius)


def test_error_grows_with_the_step_until_it_is_long() -> None:
    assert allowed_error(SETTINGS, 0.01) == pytest.approx(1e-5)
    assert allowed_error(SETTINGS, 0.02) == allowed_error(SETTINGS, 5.0) == pytest.approx(2e-5)


def test_a_step_ends_on_the_stop_that_rounding_would_miss() -> None:
    beside = float(np.nextafter(0.1, 1.0))
    assert new_step(METHOD, 0.0, beside, 0.1).end == 0.1
    assert new_step(METHOD, 0.0, 0.1, 0.2).end == 0.1


@pytest.mark.slow
def test_constant_acceleration_is_exact(spinning: System) -> None:
    state = straight(spinning)
    integration, equations = (
        new_state(spinning, 0.0, STEP, state.position, state.velocity),
        new_equations(spinning),
    )
    restart(spinning, integration, equations)
    iterations = try_step(spinning, SETTINGS, METHOD, integration, new_step(METHOD, 0.0, STEP, 1.0), equations)
    assert iterations == integration.counts.iterations == 1  # the first guess is right
    position, velocity, acceleration, auxiliary = (vector[-1] for vector in integration.trial)
    assert position == pytest.approx(0.5 * ACCELERATION * STEP**2)
    assert velocity == pytest.approx(ACCELERATION * STEP)
    assert acceleration == pytest.approx(ACCELERATION)
    assert auxiliary == pytest.approx(ACCELERATION)
    assert integration.clock.time == 0.0


@pytest.mark.slow
def test_no_solution_without_mass(spinning: System) -> None:
    state = straight(spinning)
    integration, equations = (
        new_state(spinning, 0.0, STEP, state.position, state.velocity),
        new_equations(spinning),
    )
    broken = spinning._replace(mass=np.full_like(spinning.mass, np.nan))
    assert try_step(broken, SETTINGS, METHOD, integration, new_step(METHOD, 0.0, STEP, 1.0), equations) == 0

"""One integration of generalized-alpha: stops, budget, interpolation, works, and how it gives up."""

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.solvers.alpha_advance import REACHED, STEP_TOO_SMALL
from beltdyn.solvers.engine import advance, restart
from beltdyn.solvers.integrator_state import IntegratorState, Settings, empty_steps, new_state
from beltdyn.solvers.trajectory import Chunk
from beltdyn.system.arrays import ENERGY_WORKS, BodyForces, System
from beltdyn.system.state import straight
from beltdyn.system.steady_assembly import new_equations

SETTINGS = Settings(0.8, 1e-3, 1e-3, 1.0)
ACCELERATION = 5.0
ROUNDING = 1e-10


def start(system: System, step: float = 1e-3) -> IntegratorState:
    state = straight(system)
    return new_state(system, 0.0, step, state.position, state.velocity)


def run(
    system: System,
    integration: IntegratorState,
    stop: float,
    room: int,
    budget: int = 10_000,
    settings: Settings = SETTINGS,
) -> Chunk:
    steps, equations = empty_steps(system, room), new_equations(system)
    restart(system, integration, equations)
    status, filled = advance(system, settings, integration, equations, stop, budget, steps)
    assert status == REACHED
    rows = {name: array[:filled] for name, array in steps._asdict().items() if name != "forces"}
    return Chunk(**rows, forces=BodyForces(*(array[:filled] for array in steps.forces)), reached=stop)


def test_states_within_steps_are_exact_for_constant_acceleration(spinning: System) -> None:
    times = np.array([0.0123, 0.1, 0.25, 0.7])
    chunk = Chunk.join([Chunk.start(spinning, straight(spinning)), run(spinning, start(spinning), 0.7, 10_000)])
    assert chunk.time[-1] == 0.7
    position, velocity = chunk.at(times)
    np.testing.assert_allclose(position[:, -1], 0.5 * ACCELERATION * times**2, atol=ROUNDING)
    np.testing.assert_allclose(velocity[:, -1], ACCELERATION * times, atol=ROUNDING)
    works = np.zeros((len(chunk.time), len(ENERGY_WORKS)))
    works[:, 1] = 2.0 * 0.5 * ACCELERATION * chunk.time**2  # torque times angle
    np.testing.assert_allclose(chunk.work, works, atol=ROUNDING)


@pytest.mark.parametrize("interval", [0.01, 0.003, 1e-4])
def test_steps_end_on_multiples_of_the_interval(spinning: System, interval: float) -> None:
    """Every step, or the last of some equal ones, ends on an output; but for those that it cannot reach yet."""
    settings = SETTINGS._replace(max_step=0.0041, output_interval=interval)
    chunk = run(spinning, start(spinning), 0.7, 10_000, settings=settings)
    late = chunk.time[chunk.time > 0.1]
    off = np.abs(late / interval - np.round(late / interval)) * interval
    assert np.mean(off < 1e-11) > (0.3 if interval > 0.0041 else 0.99)
    passed = np.arange(np.ceil(0.1 / interval), 0.7 / interval) * interval
    if interval > 0.0041:
        assert all(np.min(np.abs(late - instant)) < 1e-11 for instant in passed[1:])


def test_stops_exactly(spinning: System) -> None:
    integration = start(spinning)
    run(spinning, integration, 0.1 + 0.2, 0)
    assert integration.clock.time == 0.1 + 0.2


def test_budget_is_kept(spinning: System) -> None:
    integration = start(spinning, 1e-6)
    run(spinning, integration, 0.7, 10, budget=3)
    assert integration.counts.steps == 3
    assert integration.clock.time < 1e-4


def test_ends_when_there_is_no_room(spinning: System) -> None:
    integration = start(spinning)
    assert len(run(spinning, integration, 0.7, 2).time) == 2
    assert integration.counts.steps == 2
    assert integration.clock.time < 0.7


def test_steps_grow_to_the_longest_allowed(spinning: System) -> None:
    integration = start(spinning, 1e-6)
    steps = run(spinning, integration, 1.0, 10_000, settings=SETTINGS._replace(max_step=1e-3)).step
    assert steps.max() <= 1e-3 * (1 + 1e-5)  # rounding of the stop
    assert integration.counts.steps == pytest.approx(1000, abs=15)


def test_steps_shorten_where_numerical_damping_takes_too_much_of_the_losses(spinning: System) -> None:
    """Its part goes with the cube of the step: eight times too much asks for half the step that is aimed at."""
    step, aim, share, losses = 1e-3, 0.8, 0.01, 5.0
    settings = SETTINGS._replace(numerical_share=share, averaging_time=1e9)
    equations = new_equations(spinning)
    following = []
    for times_allowed in (0.0, 8.0):
        integration = start(spinning, step)
        integration.losses.physical = losses
        integration.losses.numerical = times_allowed * share * losses / step**3
        restart(spinning, integration, equations)
        integration.auxiliary[-1] += 60.0  # a local error
        status = advance(spinning, settings, integration, equations, 1.0, 1, empty_steps(spinning, 1))
        assert status == (REACHED, 1)
        following.append(integration.clock.next_step / step)
    assert 0.5 < following[0] < 2.0
    assert following[1] == pytest.approx(0.5 * aim ** (1 / 3), rel=1e-3)


def test_nan_forces_end_with_too_small_a_step(spinning: System) -> None:
    integration = start(spinning)
    broken = spinning._replace(mass=np.full_like(spinning.mass, np.nan))
    steps = empty_steps(spinning, 1)
    found = advance(broken, SETTINGS, integration, new_equations(spinning), 1.0, 10_000, steps)
    assert found == (STEP_TOO_SMALL, 0)
    assert integration.counts.failed > 0
    assert integration.clock.time == 0.0


def test_massless_belt_is_refused(spinning: System) -> None:
    massless = spinning._replace(mass=np.zeros_like(spinning.mass))
    with pytest.raises(ConvergenceError, match="a moving part of the drive has no mass"):
        restart(massless, start(spinning), new_equations(spinning))

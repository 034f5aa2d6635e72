"""One march of generalised-alpha: stops, budget, interpolation, works, and how it gives up."""

import numpy as np
import pytest
from numpy.typing import NDArray

from beltdyn.errors import ConvergenceError
from beltdyn.solve.engine import advance, restart
from beltdyn.solve.generalized_alpha import REACHED, STEP_TOO_SMALL
from beltdyn.solve.march import FAILED, STEPS, March, Outputs, Settings, empty_outputs, new_march
from beltdyn.solve.trajectory import Chunk
from beltdyn.system.arrays import POWERS, System
from beltdyn.system.motion import new_equations
from beltdyn.system.state import straight

FloatArray = NDArray[np.float64]
SETTINGS = Settings(0.8, 1e-3, 1e-3, 1.0)
ACCELERATION = 5.0
ROUNDING = 1e-10


def start(system: System, step: float = 1e-3) -> March:
    state = straight(system)
    return new_march(0.0, step, state.position, state.velocity)


def run(
    system: System, march: March, stop: float, times: list[float], budget: int = 10_000, settings: Settings = SETTINGS
) -> tuple[int, Outputs]:
    outputs, equations = empty_outputs(np.array(times), march.position.size), new_equations(system)
    restart(system, march, equations)
    status, filled = advance(system, settings, march, equations, stop, budget, outputs)
    assert status == REACHED
    return filled, outputs


def test_outputs_within_steps_are_exact_for_constant_acceleration(spinning: System) -> None:
    times = [0.0123, 0.1, 0.25, 0.7]
    march = start(spinning)
    filled, outputs = run(spinning, march, 0.7, times)
    assert filled == len(times)
    chunk = Chunk(**{name: getattr(outputs, name) for name in Chunk.__annotations__ if name != "reached"}, reached=0.7)
    position, velocity = chunk.interpolate()
    np.testing.assert_allclose(position[:, -1], 0.5 * ACCELERATION * outputs.time**2, atol=ROUNDING)
    np.testing.assert_allclose(velocity[:, -1], ACCELERATION * outputs.time, atol=ROUNDING)
    works = np.zeros((len(times), len(POWERS)))
    works[:, 1] = 2.0 * 0.5 * ACCELERATION * outputs.time**2  # torque times angle
    np.testing.assert_allclose(outputs.work, works, atol=ROUNDING)


def test_stops_exactly(spinning: System) -> None:
    march = start(spinning)
    run(spinning, march, 0.1 + 0.2, [])
    assert march.clock[0] == 0.1 + 0.2


def test_budget_is_kept(spinning: System) -> None:
    march = start(spinning, 1e-6)
    run(spinning, march, 0.7, [0.7], budget=3)
    assert march.counts[STEPS] == 3
    assert march.clock[0] < 1e-4


def test_ends_when_all_outputs_are_filled(spinning: System) -> None:
    march = start(spinning)
    filled, _ = run(spinning, march, 0.7, [0.01])
    assert filled == 1
    assert 0.01 <= march.clock[0] < 0.7


def test_steps_grow_to_the_longest_allowed(spinning: System) -> None:
    march = start(spinning, 1e-6)
    _, outputs = run(spinning, march, 1.0, [1.0], settings=SETTINGS._replace(max_step=1e-3))
    assert outputs.step[0] <= 1e-3 * (1 + 1e-5)  # rounding of the stop
    assert march.counts[STEPS] == pytest.approx(1000, abs=15)


def test_nan_forces_end_with_too_small_a_step(spinning: System) -> None:
    march = start(spinning)
    broken = spinning._replace(mass=np.full_like(spinning.mass, np.nan))
    outputs = empty_outputs(np.array([1.0]), march.position.size)
    found = advance(broken, SETTINGS, march, new_equations(spinning), 1.0, 10_000, outputs)
    assert found == (STEP_TOO_SMALL, 0)
    assert march.counts[FAILED] > 0
    assert march.clock[0] == 0.0


def test_massless_belt_is_refused(spinning: System) -> None:
    massless = spinning._replace(mass=np.zeros_like(spinning.mass))
    with pytest.raises(ConvergenceError, match="singular"):
        restart(massless, start(spinning), new_equations(spinning))

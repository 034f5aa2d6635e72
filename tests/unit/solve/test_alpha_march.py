"""Generalised-alpha as an integrator: chunks, statistics, longest step."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.solve.alpha_march import GeneralizedAlpha
from beltdyn.solve.trajectory import Chunk, Task

Spin = Callable[..., Task]
TIMES = np.linspace(0.0, 0.5, 201)


def test_hands_out_every_instant_once(spin: Spin) -> None:
    """Also where breakpoints lie between, on and beside them, and with more outputs than fit in a buffer."""
    chunks = list(GeneralizedAlpha(0.8, 1e-3)(spin(TIMES, (0.1, 0.2001))))
    np.testing.assert_array_equal(Chunk.join(chunks).time, TIMES)
    angles = Chunk.join(chunks).interpolate()[0][:, -1]
    np.testing.assert_allclose(angles, 2.5 * TIMES**2, atol=1e-10)  # rounding
    reached = [chunk.reached for chunk in chunks]
    assert reached == sorted(reached)
    assert reached[-1] == TIMES[-1]


def test_statistics_and_longest_step(spin: Spin) -> None:
    task = spin(TIMES)
    steps = np.concatenate([chunk.step for chunk in GeneralizedAlpha(0.8, 1e-3, max_step=2.5e-3)(task)])
    assert steps[0] == 0.0
    assert np.max(steps) <= 2.5e-3 * (1 + 1e-5)  # rounding of the instants
    assert task.statistics.steps == pytest.approx(200, abs=15)
    assert task.statistics.newton_iterations >= task.statistics.steps
    assert task.statistics.rejected_steps == 0

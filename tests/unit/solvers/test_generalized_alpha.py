"""Generalized-alpha as an integrator: chunks, statistics, longest step."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, records
from beltdyn.contact.surface.toothed import TEETH, ToothedRims
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.trajectory import Chunk, Task
from beltdyn.system.arrays import System

Spin = Callable[..., Task]
INTERVAL = 2.5e-3
TIMES: FloatArray = INTERVAL * np.arange(201, dtype=np.float64)


def test_steps_end_on_outputs_and_breakpoints(spin: Spin) -> None:
    """Also where breakpoints lie between, on and beside outputs, and with more steps than fit in a buffer."""
    chunks = list(GeneralizedAlpha(0.8, 1e-3, max_step=INTERVAL)(spin(INTERVAL, (0.1, 0.2001))))
    joined = Chunk.join(chunks)
    assert len(chunks) > 3
    assert np.all(np.diff(joined.time) > 0.0)
    np.testing.assert_allclose(joined.step[1:], np.diff(joined.time), rtol=1e-6)
    apart = np.min(np.abs(joined.time - TIMES[:, None]), axis=1)
    passed_by = (TIMES < 0.01) | (np.abs(TIMES - 0.205) < 0.005)  # by steps that begin shortly before
    assert np.all(apart[~passed_by] < 1e-11)
    assert np.all(np.isin([0.1, 0.2001], joined.time))
    angles = joined.at(TIMES)[0][:, -1]
    np.testing.assert_allclose(angles, 2.5 * TIMES**2, atol=1e-10)  # rounding
    reached = [chunk.reached for chunk in chunks]
    assert reached == sorted(reached)
    assert reached[-1] == TIMES[-1]


def test_newtons_method_leaves_more_where_teeth_hold_the_belt(spin: Spin, spinning: System) -> None:
    """What it leaves adds up where the belt can slide."""

    def left(stiffness: float) -> float:
        teeth = records(TEETH, stiffness=np.array([stiffness]))
        rims = ToothedRims(spinning.rims.radius, teeth, np.zeros(spinning.length.size))
        task = spin(INTERVAL, system=spinning._replace(rims=rims))
        return GeneralizedAlpha(0.8, 1e-3).begin(task).settings.newton_fraction

    smooth = GeneralizedAlpha(0.8, 1e-3).begin(spin(INTERVAL)).settings.newton_fraction
    assert left(0.0) == smooth == 0.01
    assert left(1e8) == 0.1


def test_statistics_and_longest_step(spin: Spin) -> None:
    task = spin(INTERVAL)
    steps = np.concatenate([chunk.step for chunk in GeneralizedAlpha(0.8, 1e-3, max_step=2.5e-3)(task)])
    assert steps[0] == 0.0
    assert np.max(steps) <= 2.5e-3 * (1 + 1e-5)  # rounding of the instants
    assert task.statistics.steps == pytest.approx(200, abs=15)
    assert task.statistics.newton_iterations >= task.statistics.steps
    assert task.statistics.rejected_steps == 0

"""SUNDIALS and SciPy behind the same call: every instant once, breakpoints, failure, a missing package."""

import sys
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, get_args

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf.element import Ancf
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.solvers.standard import Name, StandardIntegrator, _Leg, _SciPy
from beltdyn.solvers.trajectory import Chunk, Task
from beltdyn.stretch import Green, as_common
from beltdyn.system.arrays import System

Spin = Callable[..., Task]
INTERVAL = 0.025
TIMES: FloatArray = INTERVAL * np.arange(21, dtype=np.float64)
NAMES = get_args(Name)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("breakpoints", [(), (0.1, 0.2001)], ids=["smooth", "breakpoints"])
def test_hands_out_every_instant_once(spin: Spin, name: Name, breakpoints: tuple[float, ...]) -> None:
    task = spin(INTERVAL, breakpoints)
    chunks = list(StandardIntegrator(name, 1e-3)(task))
    joined = Chunk.join(chunks)
    position, velocity = joined.at(TIMES)
    assert np.all(np.diff(joined.time) > 0.0)
    for instant in TIMES:  # the solver's own interpolation
        assert np.min(np.abs(joined.time - instant)) < 1e-11
    allowed = 1e-3 / 0.1  # the tolerance of 1e-4 m/s at a radius of 0.1 m, for some steps
    np.testing.assert_allclose(velocity[:, -1], 5.0 * TIMES, atol=allowed)
    np.testing.assert_allclose(position[:, -1], 2.5 * TIMES**2, atol=allowed)
    np.testing.assert_allclose(joined.work[:, 1], 5.0 * joined.time**2, atol=5 * allowed)
    assert chunks[-1].reached == TIMES[-1]
    assert task.statistics.evaluations > task.statistics.steps > 0


@pytest.mark.parametrize("name", NAMES)
def test_longest_step(spin: Spin, name: Name) -> None:
    task = spin(INTERVAL)
    list(StandardIntegrator(name, 1e-3, max_step=5e-3)(task))
    assert task.statistics.steps >= 100


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")  # SciPy's, of the nan that is meant
def test_failure_names_the_integrator_and_a_remedy(spin: Spin, spinning: System, name: Name) -> None:
    section = spinning.element.section._replace(stretch=as_common(Green(np.nan)))
    broken = spinning._replace(element=Ancf(section, spinning.element.elastic))
    with pytest.raises(ConvergenceError, match=f"integrator {name} fails.*generalized_alpha"):
        list(StandardIntegrator(name, 1e-3)(spin(INTERVAL, system=broken)))


def test_a_missing_package_is_named(spin: Spin, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sksundae", None)
    with pytest.raises(ModelError, match="scikit-sundae"):
        list(StandardIntegrator("cvode", 1e-3)(spin(INTERVAL)))


@pytest.mark.parametrize("name", ["bdf", "radau"])
def test_a_stop_that_rounding_keeps_away_is_reached(name: Name) -> None:
    """Steps up to a stop may end one rounding before it, less than SciPy's methods step."""
    decay: Any = SimpleNamespace(rates=lambda time, y: -y, jacobian=lambda time, y: -np.eye(1))
    solver = _SciPy(_Leg(StandardIntegrator(name, 1e-4), decay, np.full(1, 1e-6), 0.0, np.ones(1), 1.0))
    solver.step(0.1)
    begun = solver.time
    for _ in range(20):
        solver.step(float(np.nextafter(solver.time, 1.0)))
    assert begun < solver.time < begun + 1e-12

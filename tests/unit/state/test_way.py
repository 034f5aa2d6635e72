"""Steady running between two settings: the derivative by the parameter, and increments."""

from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import load, prepare
from beltdyn.state.search import SteadySearch
from beltdyn.state.slip_limit import Setting
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.way import Way, between

FARTHER = 1e-3
"""Part of the loads by which solutions differ."""


@pytest.fixture(scope="module")
def search() -> SteadySearch:
    """The alternator drive in steady running."""
    drive = load(str(files("beltdyn") / "examples" / "alternator_drive.toml"))
    rest = bring_to_stand(prepare(drive))
    found = SteadySearch(rest.prepared, rest.system, rest.state, drive.simulation.end)
    found.run(rest)
    return found


def test_the_tangent_is_the_derivative_of_solutions(search: SteadySearch) -> None:
    here, begin = search.unknowns(), search.setting
    way = Way(search, begin, Setting(load=1.0 + FARTHER))
    tangent, ahead = way.tangent(0.0), way.solve(1.0, here)
    assert tangent is not None
    assert ahead is not None
    assert np.max(np.abs(ahead - here - tangent)) < 0.01 * np.max(np.abs(tangent))
    assert way.solve(0.0, here) is not None


def test_newtons_correction_of_a_solution_vanishes(search: SteadySearch) -> None:
    way = Way(search, search.setting, search.setting._replace(load=0.5))
    found = way.linearize(0.0)
    assert found is not None
    assert np.linalg.norm(way.weights * found.correction) < 1e-8
    assert np.linalg.norm(way.weights * found.tangent) > 1e-4


def test_what_smooths_changes_by_equal_factors() -> None:
    middle = between(Setting(smoothing=100.0, load=0.0), Setting(), 0.5)
    assert middle.smoothing == pytest.approx(10.0)
    assert middle.load == 0.5

"""Steady running between two settings: the derivative by the parameter, and increments."""

from collections.abc import Callable
from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import Drive, load, prepare
from beltdyn.state.search import SteadySearch
from beltdyn.state.slip_limit import Setting
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.way import Way, between
from beltdyn.system.constant_drive import controllers
from beltdyn.system.web import content
from tests.unit.state.test_search import solved, two, unsolved, web

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


def test_all_that_smooths_changes_by_equal_factors() -> None:
    """Speeds, loads and losses by equal steps."""
    begin = Setting(speed=0.2, load=0.0, smoothing=16.0, stretch_length=0.01, bending_loss=0.0, support=1.0)
    result = between(begin, Setting(smoothing=1.0), 0.25)
    assert result.smoothing == pytest.approx(8.0)
    assert result.stretch_length == pytest.approx(0.01**0.75)
    assert (result.speed, result.load, result.bending_loss, result.support) == pytest.approx((0.4, 0.25, 0.25, 0.75))
    assert between(begin, Setting(), 1.0) == Setting()
    assert between(begin, Setting(), 0.0) == begin


@pytest.mark.parametrize("drive", [two, web], ids=["closed", "web"])
def test_ways_of_unknowns_are_lengths(drive: Callable[[], Drive]) -> None:
    """Of nodes alike in their root mean square; of a rim, and of the speed itself, that of the belt."""
    search = unsolved(drive())
    search.constant.frame.speed[0] = -5.0
    way = Way(search, Setting(load=0.0), Setting())
    ((place, unknowns), weights) = (way.solutions[0], way.weights)
    assert place == 0.0
    np.testing.assert_array_equal(unknowns, search.unknowns())
    system, border = search.system, search.work.ahead_border.size
    nodes, others = weights[:-border].reshape(system.nodes, -1), weights[-border:]
    np.testing.assert_allclose(nodes[:, :2], system.nodes**-0.5)
    assert not nodes[:, 2:].any()
    expected = np.zeros(border)
    last = system.bodies.size - system.tensioners.size
    for body, row in enumerate(system.bodies):
        if row.unknown >= 0:
            turns = body < last and body not in controllers(system)
            expected[row.unknown] = row.reach**2 / 5.0 if turns else row.reach
    if content(system).size:
        expected[-2] = system.length.sum()
    expected[-1] = system.rims.radius.min() / 5.0
    np.testing.assert_allclose(others, expected)
    assert np.count_nonzero(expected) == border


@pytest.mark.parametrize("change", ["load", "smoothing"])
def test_the_tangent_of_a_small_drive_is_the_derivative_of_solutions(change: str) -> None:
    """Two pulleys on 30 elements: a load acts on a shaft, and friction on all that touches."""
    search = solved(two())
    start, way = search.unknowns(), Way(search, search.setting, search.setting._replace(**{change: 1.0 + FARTHER}))
    tangent, ahead = way.tangent(0.0), way.solve(1.0, start)
    assert tangent is not None
    assert ahead is not None
    size = search.state.position.size
    for part in (slice(size), slice(size, None)):
        assert np.max(np.abs(ahead - start - tangent)[part]) < 0.01 * np.max(np.abs(tangent[part]))

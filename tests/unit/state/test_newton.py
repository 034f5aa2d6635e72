"""Newton's method for steady running and rest, on a few elements: where it ends, and what it changes."""

from typing import Any, NamedTuple

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import prepare
from beltdyn.state.newton import FOUND, NOT_FOUND, SteadyWork, _linearise, _size, find_steady, make_step, steady_work
from beltdyn.state.search import SteadySearch
from beltdyn.state.staying import _lying, without_friction
from beltdyn.system.arrays import System
from beltdyn.system.build import staying_system
from beltdyn.system.constant_drive import controllers
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import Anchor, anchor_at, assemble_steady
from beltdyn.system.web import content, set_content
from tests.unit.state.test_search import two, unsolved, web

TOLERANCE = 1e-13
"""Of the last step, m."""


class Rest(NamedTuple):
    """A belt in equilibrium, without friction, and what found it."""

    system: System
    state: State
    work: SteadyWork
    anchor: Anchor

    def again(self, tolerance: float, most: int, factorised: bool = False) -> tuple[int, int]:
        return find_steady(self.system, self.state.at(0.0), self.anchor, tolerance, most, factorised, self.work)


@pytest.fixture
def rest() -> Rest:
    """Six elements around two pulleys."""
    prepared = prepare(two())
    system = staying_system(prepared, prepared.equal_lengths(6))
    still, state = without_friction(system), _lying(prepared, system, 1.0)
    result = Rest(still, state, steady_work(still), anchor_at(state, True))
    assert result.again(TOLERANCE, 20)[0] == FOUND
    return result


def test_a_belt_at_rest_is_found(rest: Rest) -> None:
    """With forces in balance, of 200 N, and on the line of the centers one half of it as the other."""
    equations, motion = rest.work.equations, rest.state.at(0.0)
    assemble_steady(rest.system, motion, rest.anchor, False, equations)
    assert np.abs(equations.matrix.node_side).max() < 1e-6
    nodes = rest.state.nodes(rest.system)
    np.testing.assert_allclose(nodes[:, 1].min(), -nodes[:, 1].max(), rtol=1e-6)


def test_equilibrium_is_confirmed_in_an_iteration(rest: Rest) -> None:
    place = rest.state.position.copy()
    assert rest.again(TOLERANCE, 9) == (FOUND, 1)
    np.testing.assert_allclose(rest.state.position, place, atol=1e-10)


def test_too_few_iterations_find_nothing(rest: Rest) -> None:
    rest.state.position[: rest.system.first_body] += 1e-4 * np.random.default_rng(0).normal(size=rest.system.first_body)
    assert rest.again(TOLERANCE, 1) == (NOT_FOUND, 1)


@pytest.mark.parametrize("factorised", [True, False])
def test_a_tangent_serves_states_nearby(rest: Rest, factorised: bool) -> None:
    """Also that of the state before it was moved: corrections shrink, one after the other, in a single iteration."""
    place, size = rest.state.position.copy(), rest.system.first_body
    assert rest.again(0.0, 0)[1] == 0
    rest.state.position[:size] += 1e-7 * np.random.default_rng(0).normal(size=size)
    assert rest.again(1e-12, 9, factorised) == (FOUND, 1)
    np.testing.assert_allclose(rest.state.position, place, atol=2e-9)


def test_where_no_step_helps_the_search_ends_where_it_is(rest: Rest) -> None:
    """Of rounding alone nothing can be made smaller, and a tolerance of zero asks for it."""
    place = rest.state.position.copy()
    assert rest.again(0.0, 20)[0] == NOT_FOUND
    np.testing.assert_allclose(rest.state.position, place, atol=1e-9)


def test_what_is_not_finite_ends_the_search(rest: Rest) -> None:
    rest.state.position[0] = np.nan
    status, iterations = rest.again(TOLERANCE, 9)
    assert status != FOUND
    assert iterations == 1


@pytest.fixture(params=["closed", "web"])
def search(request: pytest.FixtureRequest) -> SteadySearch:
    """Two pulleys, or a web line with a load cell and a controller; 2 m/s."""
    result = unsolved(two() if request.param == "closed" else web(), 6)
    result.constant.frame.speed[0] = 2.0
    return result


def parts(search: SteadySearch) -> tuple[FloatArray, FloatArray]:
    """Changes of nodes and other unknowns, each another one."""
    shape, border = search.work.ahead_node.shape, search.work.ahead_border.size
    return 1e-3 * (1.0 + np.arange(float(np.prod(shape))).reshape(shape)), 1e-4 * (1.0 + np.arange(float(border)))


@pytest.mark.parametrize("at_rest", [True, False])
def test_a_step_changes_nodes_bodies_and_the_flow(search: SteadySearch, at_rest: bool) -> None:
    """Rims by their speeds, controllers and tensioners by their places; at rest neither flow nor content changes."""
    nodes, border = parts(search)
    system, state = search.system, search.state
    place, speeds, line = state.position.copy(), state.velocity.copy(), content(system).copy()
    make_step(system, state.at(0.0), at_rest, -0.5, nodes, border)
    expected, turning = place.copy(), speeds.copy()
    expected[: nodes.size] -= 0.5 * nodes.ravel()
    held = {*controllers(system).tolist(), *range(system.bodies.size - system.tensioners.size, system.bodies.size)}
    for body, row in enumerate(system.bodies):
        if row.unknown >= 0:
            moved = expected if body in held else turning
            moved[system.first_body + body] -= 0.5 * border[row.unknown]
    np.testing.assert_allclose(state.position, expected, rtol=1e-14, atol=1e-15)
    np.testing.assert_allclose(state.velocity, turning, rtol=1e-14, atol=1e-15)
    change = 0.0 if at_rest else -0.5
    assert search.constant.frame.speed[0] == pytest.approx(2.0 + change * border[-1], rel=1e-14)
    np.testing.assert_allclose(content(system), line + change * border[-2], rtol=1e-14)
    make_step(system, state.at(0.0), at_rest, 0.5, nodes, border)
    np.testing.assert_allclose(state.position, place, atol=1e-15)
    np.testing.assert_allclose(content(system), line, rtol=1e-14)


def test_the_size_of_a_step_is_the_largest_of_all_ways(search: SteadySearch) -> None:
    """In m: of nodes their root mean square, of rims that of a part of the belt's speed along the radius."""
    system, (nodes, border) = search.system, parts(search)

    def size(*changes: tuple[FloatArray, Any, float]) -> float:
        nodes[:], border[:] = 0.0, 0.0
        for part, place, value in changes:
            part[place] = value
        return float(interpreted(_size)(system, nodes, border))

    assert size() == 0.0
    assert size((nodes, (slice(None), 0), 3e-3), (nodes, (slice(None), 1), -4e-3)) == pytest.approx(5e-3)
    assert size((nodes, (1, 0), 3e-3)) == pytest.approx(3e-3 / system.nodes**0.5)
    assert size((nodes, (1, 1), 3e-3)) == pytest.approx(3e-3 / system.nodes**0.5)
    assert size((nodes, (slice(None), slice(2, None)), 9.0)) == 0.0
    moving = range(system.bodies.size - system.tensioners.size, system.bodies.size)
    for body, row in enumerate(system.bodies):
        if row.unknown >= 0 and body not in controllers(system).tolist():
            way = 1e-2 * row.reach if body in moving else 1e-2 * row.reach**2 / 2.0
            assert size((border, row.unknown, -1e-2)) == pytest.approx(way)
            assert size((border, row.unknown, 1e-2), (nodes, (slice(None), 0), 7.0)) == pytest.approx(7.0)
    if content(system).size:
        assert size((border, -2, -1e-3)) == pytest.approx(1e-3 * system.length.sum())


def test_the_tangent_has_the_derivative_by_the_content() -> None:
    """That of all residuals, by central differences; the content itself stays, as does the residual."""
    search = unsolved(web(), 6)
    search.constant.frame.speed[0] = 2.0
    search.state.velocity[search.system.first_body :][:3] = 40.0
    system, work, motion = search.system, search.work, search.state.at(0.0)
    anchor, matrix = anchor_at(search.state, False), search.work.equations.matrix

    def residual(value: float) -> FloatArray:
        set_content(system.carriage, system, value)
        assemble_steady(system, motion, anchor, False, work.equations)
        return np.append(matrix.node_side, matrix.border_side)

    residuals, before, after = (residual(value) for value in (1.0, 1.0 - 1e-5, 1.0 + 1e-5))
    set_content(system.carriage, system, 1.0)
    interpreted(_linearise)(system, motion, anchor, work)
    np.testing.assert_array_equal(content(system), [1.0])
    rounding = 1e-12 * np.abs(residuals).max()
    np.testing.assert_allclose(np.append(matrix.node_side, matrix.border_side), residuals, rtol=1e-12, atol=rounding)
    column = np.append(matrix.column[:, :, -2], matrix.corner[:, -2])
    np.testing.assert_allclose(column, (after - before) / 2e-5, rtol=1e-6, atol=1e-5 * np.abs(column).max())

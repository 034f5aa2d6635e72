"""Supports and nodal loads: fixed coordinates stay, forces and moments are what they say, with their tangent."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive
from beltdyn.solvers.engine import linearise
from beltdyn.system.arrays import Equations, RingMatrix, System, TangentFactors
from beltdyn.system.build import belt_system
from beltdyn.system.element_state import add_nodal_loads
from beltdyn.system.state import straight
from beltdyn.system.steady_assembly import new_equations, no_multipliers

Dense = Callable[[RingMatrix, bool], tuple[FloatArray, FloatArray]]
FIXED = [(0, 0), (2, 3), (-1, 5)]


@pytest.fixture(scope="module")
def belt(drive: Drive) -> Belt:
    return Belt(**drive.belt.model_dump() | {"elements": 4})


def solved(system: System) -> Equations:
    state, equations = straight(system), new_equations(system)
    assert linearise(system, state.at(0.0), no_multipliers(system), TangentFactors(1.0, 0.0, 1.0), equations)
    return equations


@pytest.mark.parametrize("closure", ["open", "shared_node", "multipliers"])
def test_fixed_coordinates_do_not_move(belt: Belt, dense: Dense, closure: str) -> None:
    system = belt_system(belt, closure=closure, fixed=FIXED, forces=[(1, (3.0, 4.0))])  # type: ignore[arg-type]
    equations = solved(system)
    matrix, side = dense(equations.matrix, system.closed)
    held = np.flatnonzero(system.supports.fixed)
    assert held.tolist() == [0, 15, system.first_body - 1]
    np.testing.assert_array_equal(matrix[held], np.eye(len(matrix))[held])
    np.testing.assert_array_equal(matrix[:, held], np.eye(len(matrix))[:, held])
    np.testing.assert_array_equal(side[held], 0.0)
    np.testing.assert_array_equal(equations.node_part.ravel()[held], 0.0)


def test_forces_of_a_node_add_up(belt: Belt) -> None:
    forces = belt_system(belt, forces=[(1, (3.0, 4.0)), (1, (1.0, 0.0)), (-1, (0.0, 2.0))]).supports.force.reshape(
        -1, 6
    )
    np.testing.assert_array_equal(forces[1], [4.0, 4.0, 0, 0, 0, 0])
    np.testing.assert_array_equal(forces[-1], [0.0, 2.0, 0, 0, 0, 0])
    assert not np.any(forces[[0, 2, 3]])


@pytest.fixture
def loaded(belt: Belt, dense: Dense) -> Callable[[FloatArray], tuple[FloatArray, FloatArray]]:
    """Tangent and residual of a moment and a force alone."""
    system = belt_system(belt, moments=[(2, 0.7)], forces=[(1, (3.0, 4.0))])

    def at(position: FloatArray) -> tuple[FloatArray, FloatArray]:
        matrix = new_equations(system).matrix
        add_nodal_loads(system, position, 1.0, matrix)
        return dense(matrix, False)

    return at


@pytest.fixture
def position() -> FloatArray:
    return np.random.default_rng(3).normal(size=5 * 6)


def test_work_of_a_moment_is_moment_times_turn(
    loaded: Callable[[FloatArray], tuple[FloatArray, FloatArray]], position: FloatArray
) -> None:
    section, change = position[16:18], np.array([0.3, -0.2])
    turn = (section[0] * change[1] - section[1] * change[0]) / (section @ section)
    assert -loaded(position)[1][16:18] @ change == pytest.approx(0.7 * turn)


def test_tangent_of_loads(loaded: Callable[[FloatArray], tuple[FloatArray, FloatArray]], position: FloatArray) -> None:
    step = 1e-6
    shifts = step * np.eye(position.size)
    found = [(loaded(position + shift)[1] - loaded(position - shift)[1]) / (2 * step) for shift in shifts]
    np.testing.assert_allclose(loaded(position)[0], np.transpose(found), atol=1e-8)  # truncation, the step squared

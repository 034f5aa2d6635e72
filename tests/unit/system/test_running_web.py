"""A web line over time: shares of rollers in shifts, flows of the ends, power and kinetic energy of the web."""

import numpy as np
import pytest

from beltdyn.kernel import interpreted
from beltdyn.model import Prepared, prepare
from beltdyn.state.settling import with_passage
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import NO_TANGENT, TORQUE_WORK, System
from beltdyn.system.body_forces import new_body_forces
from beltdyn.system.build import flowing_system, open_ended, staying_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.frame import FlowingByArcs, node_shift
from beltdyn.system.guide import rows_of_ties
from beltdyn.system.running_web import carry_web, gone_with_web, push_running
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import new_equations
from tests.unit.model.test_web import line

ENTERS, LEAVES, SPEED = 100.0, 150.0, 2.0


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return prepare(line())


@pytest.fixture
def begun(prepared: Prepared) -> tuple[System, State]:
    given = open_ended(prepared, staying_system(prepared, prepared.graded_lengths(0.6)))
    state = laid_state(prepared.laid, given, np.zeros(0))
    return flowing_system(given, np.array([1.0, 0.0])), with_passage(given, state, SPEED)


def test_the_mesh_stays_at_rollers_and_at_the_winder(begun: tuple[System, State]) -> None:
    system, state = begun
    frame = system.frame
    assert isinstance(frame, FlowingByArcs)
    assert frame.arcs.node.size == 3
    assert frame.arcs.node[-1] == system.nodes - 1
    assert not frame.direction.any()
    assert not frame.arcs.direction[-1].any()
    for arc in range(3):
        state.position[frame.place - 3 + arc] = 1e-3 * (arc + 1)
    shifts = [interpreted(node_shift)(frame, state.position, node) for node in range(system.nodes)]
    assert shifts[0] == 0.0
    assert shifts[-1] == pytest.approx(3e-3, rel=1e-12)
    assert [shifts[node] for node in frame.arcs.node[:-1]] == pytest.approx([1e-3, 2e-3], rel=1e-12)
    assert np.all(np.diff(shifts) >= 0.0)


def test_tensions_are_the_equations_of_the_flows(begun: tuple[System, State]) -> None:
    """Rows along the web go to the flow at the unwinder and to the shift at the winder, and the ends stay."""
    system, state = begun
    equations = new_equations(system)
    matrix, rng = equations.matrix, np.random.default_rng(2)
    for name in ("diagonal", "upper", "lower", "column", "row", "corner", "node_side", "border_side"):
        array = getattr(matrix, name)
        array[:] = rng.standard_normal(array.shape)
    matrix.row[:, -2:], matrix.corner[-2:], matrix.border_side[-2:] = 0.0, 0.0, 0.0
    given = {name: getattr(matrix, name).copy() for name in ("diagonal", "upper", "lower", "column", "node_side")}
    interpreted(carry_web)(system.carriage, system, state.at(0.0), True, matrix)
    dof, last = len(system.scale), system.nodes - 1
    for row, node, sign, tension in ((-1, 0, 1.0, ENTERS), (-2, last, -1.0, LEAVES)):
        slope = state.position[dof * node + 2 : dof * node + 4]
        along = slope / np.hypot(*slope)
        assert matrix.border_side[row] == pytest.approx(along @ given["node_side"][node, :2] + sign * tension)
        np.testing.assert_allclose(matrix.corner[row], along @ given["column"][node, :2], rtol=1e-12)
        np.testing.assert_allclose(matrix.row[node, row, 2:], along @ given["diagonal"][node, :2, 2:], rtol=1e-12)
        beside = given["upper"][0, :2] if node == 0 else given["lower"][last - 1, :2]
        np.testing.assert_allclose(matrix.row[1 if node == 0 else last - 1, row], along @ beside, rtol=1e-12)
        np.testing.assert_array_equal(matrix.diagonal[node, :2], np.eye(dof)[:2])
        assert not matrix.node_side[node, :2].any()
        assert not matrix.column[node, :2].any()


def test_ties_are_those_of_rollers_and_ends(begun: tuple[System, State]) -> None:
    """The flows of both ends have mass and damping."""
    system, _ = begun
    size = system.first_body + len(new_equations(system).matrix.corner)
    rows = rows_of_ties(system, size)
    end = system.first_body - len(system.scale)
    assert sorted(rows.tolist()) == [0, 1, end, end + 1, size - 4, size - 3]


def test_tensions_and_the_web_that_passes_do_work(begun: tuple[System, State]) -> None:
    """T c g - (W + rho A c^2 g^2 / 2) c at the winder, the same with the other sign at the unwinder."""
    system, state = begun
    faster = 1.01
    state.velocity[system.frame.place - 1] = (faster - 1.0) * SPEED
    forces = new_body_forces(system)
    interpreted(push_running)(system.carriage, system, state.at(0.0), NO_TANGENT, False, np.zeros((0, 0)), forces)
    section, dof = system.element.section, len(system.scale)
    powers = []
    for node, tension, flow in ((0, ENTERS, SPEED), (system.nodes - 1, LEAVES, faster * SPEED)):
        g = np.hypot(*state.position[dof * node + 2 : dof * node + 4])
        steps = np.linspace(1.0, g, 2001)
        energy = float(np.trapezoid(section.stretch.tension(steps), steps))
        powers.append(flow * (tension * g - energy - 0.5 * section.mass * flow**2 * g**2))
    assert forces.power[TORQUE_WORK] == pytest.approx(powers[1] - powers[0], rel=1e-6)


def test_kinetic_energy_that_goes_out(begun: tuple[System, State]) -> None:
    """With equal flows nothing; with a faster end what goes out beyond that of the lost content."""
    system, state = begun
    work = element_workspace(system)
    before, after = state.at(0.0), state.at(1e-4)
    gone = interpreted(gone_with_web)
    assert gone(system.carriage, system, before, after, work) == pytest.approx(0.0, abs=1e-15)
    faster = 1e-3
    moved = State(state.position.copy(), state.velocity.copy(), state.acceleration.copy())
    for one in (state, moved):
        one.velocity[system.frame.place - 1] = faster * SPEED
    moved.position[system.frame.place - 1] = 1e-4 * faster * SPEED
    mass, g = system.element.section.mass, np.hypot(*state.position[2:4])
    expected = 1e-4 * mass * SPEED**2 * g**2 * faster * SPEED
    found = gone(system.carriage, system, state.at(0.0), moved.at(1e-4), work)
    assert found == pytest.approx(expected, rel=0.02)  # small parts of second order, and arcs where the web turns

"""A web line over time: shares of rollers in shifts, flows of the ends, power and kinetic energy of the web."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.model import Prepared, prepare
from beltdyn.state.settling import with_passage
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import NO_TANGENT, TORQUE_WORK, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.body_forces import new_body_forces
from beltdyn.system.build import flowing_system, open_ended, staying_system
from beltdyn.system.element_state import element_workspace
from beltdyn.system.frame import FlowingByArcs, node_shift
from beltdyn.system.guide import rolls_energy, rows_of_ties
from beltdyn.system.running_web import carry_web, gone_with_web, push_running
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import new_equations
from tests.unit.model.test_web import BELT, line

ENTERS, LEAVES, SPEED = 100.0, 150.0, 2.0
CORE, CORE_INERTIA = 0.05, 1e-3
ROLL = {"core_radius": CORE, "radius": 0.1, "core_inertia": CORE_INERTIA}
DRIVEN = {
    "unwinder": {"point": [0.0, 0.3], "torque": 10.0, "roll": ROLL},
    "winder": {"point": [1.5, 0.0], "torque": 15.0, "roll": ROLL},
}


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    return prepare(line())


@pytest.fixture
def begun(prepared: Prepared) -> tuple[System, State]:
    return running(prepared)


def running(prepared: Prepared) -> tuple[System, State]:
    """Laid on its path, and moved."""
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
    interpreted(carry_web)(system.carriage, system, state.at(0.0), NO_TANGENT, True, matrix)
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


def moving_rolls() -> tuple[System, State, FloatArray]:
    """A line with torques on its rolls that gains speed as it stretches; places of what its end tensions depend on."""
    system, state = running(prepare(line(**DRIVEN)))
    ends = [end * (system.nodes - 1) * len(system.scale) + 2 for end in range(2)]
    for at, rate in zip(ends, (0.3, -0.2), strict=True):
        state.velocity[at : at + 2] = rate, 0.1
    place = system.frame.place
    state.velocity[place - 1], state.position[place - 1 : place + 1] = 0.01 * SPEED, (2.0, 20.0)
    state.acceleration[place - 1 : place + 1] = 0.3, 4.0
    return system, state, np.array([*(at + axis for at in ends for axis in range(2)), place - 1, place])


def pulls(system: System, motion: Motion, factors: TangentFactors) -> RingMatrix:
    """The equations of the ends alone."""
    equations = new_equations(system)
    interpreted(carry_web)(system.carriage, system, motion, factors, factors != NO_TANGENT, equations.matrix)
    return equations.matrix


def test_a_roll_with_a_torque_is_a_mass_at_the_end() -> None:
    """T = M/R -/+ (J/R^2) (dv/dt - v^2 (dR/dl) / (R g)), with R^2 = R_0^2 -/+ h l / pi; both signs at the unwinder."""
    system, state, places = moving_rolls()
    found = pulls(system, state.at(0.0), NO_TANGENT).border_side
    length = np.pi * (0.1**2 - CORE**2) / BELT["thickness"]
    for row, first, sense, torque, passed, flow, gain in (
        (-1, 0, -1.0, 10.0, 20.0, SPEED, 4.0),
        (-2, 2, 1.0, 15.0, 22.0, 1.01 * SPEED, 4.3),
    ):
        slope, rate = state.position[places[first : first + 2]], state.velocity[places[first : first + 2]]
        stretch, wound = np.hypot(*slope), length + sense * passed
        square = CORE**2 + BELT["thickness"] * wound / np.pi
        mass = (CORE_INERTIA + 0.5 * BELT["mass_per_length"] * wound * (square + CORE**2)) / square
        grows = 0.5 * BELT["thickness"] / np.pi / square
        change = gain * stretch + flow * (slope @ rate) / stretch - sense * grows * flow**2 * stretch
        assert -sense * found[row] == pytest.approx(torque / np.sqrt(square) - sense * mass * change, rel=1e-12)


@pytest.mark.parametrize(
    ("kind", "factors"),
    [
        ("position", TangentFactors(by_position=1.0)),
        ("velocity", TangentFactors(by_velocity=1.0)),
        ("acceleration", TangentFactors(by_acceleration=1.0)),
    ],
)
def test_derivatives_of_the_tensions_of_rolls(kind: str, factors: TangentFactors) -> None:
    """By central differences; the size of the rolls is kept."""
    system, state, places = moving_rolls()
    dof, last, step = len(system.scale), system.nodes - 1, 1e-6
    exact = pulls(system, state.at(0.0), factors)
    for row, node in ((-1, 0), (-2, last)):
        for place in places[:4] if kind == "position" else places:
            sides = []
            for sense in (1.0, -1.0):
                moved = State(state.position.copy(), state.velocity.copy(), state.acceleration.copy())
                getattr(moved, kind)[place] += sense * step
                sides.append(pulls(system, moved.at(0.0), NO_TANGENT).border_side[row])
            own = place // dof == node if place < system.first_body else None
            flow = exact.corner[row, -1 if place == places[-1] else -2]
            found = flow if own is None else exact.row[node, row, place % dof] if own else 0.0
            assert found == pytest.approx((sides[0] - sides[1]) / (2.0 * step), rel=1e-6, abs=1e-6)


def test_kinetic_energy_of_rolls() -> None:
    """J w^2 / 2 of those with a torque, and none of those that keep a tension."""
    system, state, places = moving_rolls()
    length = np.pi * (0.1**2 - CORE**2) / BELT["thickness"]
    expected = 0.0
    for first, wound, flow in ((0, length - 20.0, SPEED), (2, length + 22.0, 1.01 * SPEED)):
        square = CORE**2 + BELT["thickness"] * wound / np.pi
        inertia = CORE_INERTIA + 0.5 * BELT["mass_per_length"] * wound * (square + CORE**2)
        speed = flow * np.hypot(*state.position[places[first : first + 2]])
        expected += 0.5 * inertia * speed**2 / square
    found = interpreted(rolls_energy)
    assert found(system.carriage, system, state.position, state.velocity) == pytest.approx(expected, rel=1e-12)
    kept, state = running(prepare(line()))
    assert found(kept.carriage, kept, state.position, state.velocity) == 0.0


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
    before, after = state.at(0.7), state.at(0.7 + 1e-4)
    gone = interpreted(gone_with_web)
    assert gone(system.carriage, system, before, after, work) == pytest.approx(0.0, abs=1e-15)
    faster = 1e-3
    moved = State(state.position.copy(), state.velocity.copy(), state.acceleration.copy())
    for one in (state, moved):
        one.velocity[system.frame.place - 1] = faster * SPEED
    moved.position[system.frame.place - 1] = 1e-4 * faster * SPEED
    mass, g = system.element.section.mass, np.hypot(*state.position[2:4])
    expected = 1e-4 * mass * SPEED**2 * g**2 * faster * SPEED
    found = gone(system.carriage, system, state.at(0.7), moved.at(0.7 + 1e-4), work)
    assert found == pytest.approx(expected, rel=0.02)  # small parts of second order, and arcs where the web turns

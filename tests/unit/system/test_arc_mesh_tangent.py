"""A mesh that stays at every arc: tangents over time and of steady running, lengths, accelerations of its material."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.kernel import interpreted
from beltdyn.model import Path, Prepared, prepare
from beltdyn.model.resolution import Laid
from beltdyn.state.newton import steady_work
from beltdyn.state.staying import laid_state
from beltdyn.system.arc_mesh import change_shifts, fit_mesh, hold_arcs, largest_shift, passed_at, shifts_of, zones_of
from beltdyn.system.arrays import NO_TANGENT, Equations, Motion, System, TangentFactors
from beltdyn.system.build import flowing_system, staying_system
from beltdyn.system.constant_drive import constant_drive, with_speeds_unknown
from beltdyn.system.frame import FlowingByArcs, StayingByArcs, centreline_places, node_shift
from beltdyn.system.missed_action import numerical_loss
from beltdyn.system.moving_center import pulley_center
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at, assemble, assemble_steady, new_equations, no_multipliers
from tests.unit.model.test_carrying import conveyor

ELEMENTS, SPEED = 9, 3.0
FACTORS = TangentFactors(1.0, 7e2, 4e5)
PULLEYS = [
    {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "speed": 15.0},
    {"name": "tail", "center": [2.0, 0.7], "radius": 0.25, "inertia": 0.15, "torque": -5.0},
]
SPAN = ["tail", "head"]
LOADED: dict[str, Any] = {
    "support": [{"kind": "idlers", "span": SPAN, "spacing": 1.0, "idler_mass": 6.0, "stiffness": 2e4}],
    "goods": [{"span": SPAN, "mass_per_length": 30.0}],
}
BARE: dict[str, Any] = {"support": [], "goods": [{"span": SPAN, "mass_per_length": 1e-9}], "gravity": [0.0, -1e-9]}
"""Goods alone, so light that they do nothing but ask for such a mesh."""
ARM: dict[str, Any] = {
    "kind": "rotary",
    "pulley": "tail",
    "pivot": [2.1, -0.1],
    "inertia": 0.8,
    "mass": 5.0,
    "preload": 300.0,
}
ARM |= {"rate": 2e3, "damping": 20.0}
LOSSES = {"stretch_damping_time": 1e-5, "bending_damping_time": 1e-3}


def laid(belt: dict[str, Any] | None = None, **changes: Any) -> tuple[System, State]:
    """The belt laid 1 mm deep on its drums, disturbed."""
    fabric = {"profile": "flat-polyester-fabric", "width": "400 mm", "installed_tension": "2 kN"}
    prepared = prepare(conveyor(**{"pulley": PULLEYS, "belt": fabric | (belt or {})} | changes))
    arms = np.full(len(prepared.drive.tensioners), 2e-3)
    system = staying_system(prepared, prepared.equal_lengths(ELEMENTS))
    assert isinstance(system.frame, StayingByArcs)
    path = prepared.path
    drawn_in = Path(path.centers, path.radii - 1e-3 * np.sign(path.radii))
    state = laid_state(Laid.on(drawn_in, prepared.belt_length, 0), system, arms)
    state.position[: system.first_body] += 1e-4 * np.random.default_rng(5).normal(size=system.first_body)
    return system, state


def over_time(system: System, state: State, spread: float) -> tuple[System, State]:
    """With flows that differ from arc to arc by a share."""
    random, flowing = np.random.default_rng(6), flowing_system(system, np.array([1.0, 0.0]))
    frame, nodes = flowing.frame, system.first_body
    assert isinstance(frame, FlowingByArcs)
    size = nodes + flowing.bodies.size
    vectors = [np.append(state.position, np.zeros(size - state.position.size)), *np.zeros((2, size))]
    moved = State(*vectors)
    moved.velocity[:nodes] = 1e-2 * random.normal(size=nodes)
    moved.velocity[nodes:] = 15.0
    moved.acceleration[:] = random.normal(size=size)
    shifts = slice(frame.place - frame.arcs.node.size, frame.place)
    moved.position[shifts] = spread * 0.01 * random.normal(size=frame.arcs.node.size)
    moved.velocity[shifts] = spread * SPEED * random.normal(size=frame.arcs.node.size)
    moved.acceleration[shifts] = spread * 20.0 * random.normal(size=frame.arcs.node.size)
    moved.velocity[frame.place], moved.acceleration[frame.place] = SPEED, 20.0
    return flowing, moved


def residual(system: System, state: State, equations: Equations, factors: TangentFactors = NO_TANGENT) -> FloatArray:
    interpreted(assemble)(system, state.at(0.3), no_multipliers(system), factors, equations)
    return np.concatenate([equations.matrix.node_side.ravel(), equations.matrix.border_side])


def dense(equations: Equations) -> FloatArray:
    matrix = equations.matrix
    size = matrix.node_side.size + matrix.border_side.size
    tangent = np.zeros((size, size))
    np.add.at(tangent, places(matrix), entries(matrix))
    return tangent


def on_spans(system: System, state: State) -> IntArray:
    """Rows of nodes between elements that touch nothing: contact with an element of changed length is left out."""
    share = (np.arange(20) + 0.5) / 20.0
    ends = np.cumsum(system.length)
    along = (ends[:, None] - np.outer(system.length, share)).ravel()
    away = centreline_places(system, state.position, along)[:, None] - system.pulleys.center
    touching = np.any(np.hypot(away[..., 0], away[..., 1]) < system.pulleys.radius, axis=1).reshape(-1, 20).any(axis=1)
    free = ~touching & ~np.roll(touching, 1)
    assert free.sum() > 2
    return np.flatnonzero(np.repeat(free, len(system.scale)))


@pytest.mark.parametrize(
    ("load", "belt"), [(LOADED, {}), (BARE | {"tensioner": [ARM]}, LOSSES)], ids=["loaded", "lossy-on-an-arm"]
)
def test_tangent_over_time(load: dict[str, Any], belt: dict[str, float]) -> None:
    """Along a direction of all unknowns but shifts, then by these: lengths leave out weight and bending."""
    system, state = over_time(*laid(belt, **load), spread=0.0)
    equations, frame, nodes = new_equations(system), system.frame, system.first_body
    residual(system, state, equations, FACTORS)
    tangent, random = dense(equations), np.random.default_rng(7)
    unknown = np.asarray(system.bodies.unknown)
    shifts = nodes + unknown[frame.place - nodes - frame.arcs.node.size : frame.place - nodes]

    def at(change: FloatArray) -> FloatArray:
        step = np.zeros_like(state.position)
        step[:nodes] = change[:nodes]
        step[nodes:][unknown >= 0] = change[nodes + unknown[unknown >= 0]]
        vectors = (state.position, state.velocity, state.acceleration)
        moved = State(*(vector + factor * step for vector, factor in zip(vectors, FACTORS[:3], strict=True)))
        return residual(system, moved, equations)

    def check(way: FloatArray, tolerance: float, rows: IntArray | slice = slice(None)) -> None:
        difference = 0.5 * (at(way) - at(-way))[rows]
        most = np.abs(difference).max()
        np.testing.assert_allclose((tangent @ way)[rows], difference, rtol=tolerance, atol=tolerance * most)
        if isinstance(rows, slice):  # what holds arcs are accelerations, smaller than forces
            np.testing.assert_allclose((tangent @ way)[nodes:], difference[nodes:], rtol=1e-3, atol=1e-7)

    scale = np.concatenate([np.tile([1.0, 1.0, 10.0, 10.0, 100.0, 100.0], system.nodes), np.ones(len(tangent) - nodes)])
    way = 1e-9 * scale * random.normal(size=len(tangent))
    way[shifts] = 0.0
    check(way, 1e-4)
    way = np.zeros(len(tangent))
    way[shifts] = 1e-8, -2e-8
    check(way, 2e-3, on_spans(system, state))


def test_equations_are_linear_in_accelerations() -> None:
    """Of nodes, bodies, flow and shifts: their tangent is exact, and tells them apart from elastic forces."""
    system, state = over_time(*laid(**LOADED), spread=1.0)
    equations, nodes = new_equations(system), system.first_body
    before = residual(system, state, equations, TangentFactors(0.0, 0.0, 1.0))
    tangent, unknown = dense(equations), np.asarray(system.bodies.unknown)
    way = np.random.default_rng(12).normal(size=len(tangent))
    moved = State(state.position, state.velocity, state.acceleration.copy())
    moved.acceleration[:nodes] += way[:nodes]
    moved.acceleration[nodes:][unknown >= 0] += way[nodes + unknown[unknown >= 0]]
    difference = residual(system, moved, equations) - before
    np.testing.assert_allclose(tangent @ way, difference, rtol=1e-8, atol=1e-10 * np.abs(before).max())


@pytest.mark.parametrize("load", [LOADED, BARE | {"tensioner": [ARM]}], ids=["loaded", "on-an-arm"])
def test_tangent_of_steady_running(load: dict[str, Any]) -> None:
    """By nodes and the arm along a direction, by the flow, and by the shifts."""
    given, state = laid(**load)
    system = with_speeds_unknown(constant_drive(given, 1.0))
    system.frame.speed[0] = SPEED
    state.velocity[:] = 0.0
    state.velocity[system.first_body : system.first_body + 2] = 15.0
    anchor, equations, nodes = anchor_at(state, False), steady_work(system).equations, system.first_body

    def side(position: FloatArray, wanted: bool = False) -> FloatArray:
        motion = Motion(0.0, position, state.velocity, np.zeros_like(position))
        interpreted(assemble_steady)(system, motion, anchor, wanted, equations)
        return np.concatenate([equations.matrix.node_side.ravel(), equations.matrix.border_side])

    side(state.position, wanted=True)
    tangent, random = dense(equations), np.random.default_rng(8)
    scale = np.tile([1.0, 1.0, 10.0, 10.0, 100.0, 100.0], system.nodes)
    way = np.zeros_like(state.position)
    way[:nodes] = 1e-8 * scale * random.normal(size=nodes)
    found = tangent[:, :nodes] @ way[:nodes]
    if system.tensioners.size:
        way[-1] = 1e-8
        found += tangent[:, nodes + system.bodies.unknown[-1]] * way[-1]
    difference = 0.5 * (side(state.position + way) - side(state.position - way))
    np.testing.assert_allclose(found, difference, rtol=1e-4, atol=1e-4 * np.abs(difference).max())

    def by(change: Callable[[float], None], step: float) -> FloatArray:
        sides = []
        for sense in (step, -2.0 * step):
            change(sense)
            sides.append(side(state.position))
        change(step)
        return np.asarray(0.5 * (sides[0] - sides[1]) / step)

    shifts, speed = shifts_of(system.frame), system.frame.speed

    def shift(number: int) -> Callable[[float], None]:
        def change(step: float) -> None:
            shifts[number] += step

        return change

    def faster(step: float) -> None:
        speed[0] += step

    columns: dict[int, tuple[Callable[[float], None], float, float]] = {len(tangent) - 1: (faster, 1e-5, 1e-4)}
    columns |= {len(tangent) - 1 - len(shifts) + k: (shift(k), 1e-6, 2e-3) for k in range(len(shifts))}
    for column, (change, step, tolerance) in columns.items():
        rows = on_spans(system, state)
        expected = by(change, step)[rows]
        np.testing.assert_allclose(tangent[rows, column], expected, atol=tolerance * np.abs(expected).max())


def on_an_arm() -> tuple[System, State, int, int]:
    """A drum on an arm that turns at 1 rad/s; the number of its arc, and the place of the arm's coordinate."""
    system, state = over_time(*laid(**BARE, tensioner=[ARM]), spread=0.0)
    (arc,) = np.flatnonzero(system.frame.arcs.carrier >= 0)
    place = state.position.size - 1
    state.velocity[place] = 1.0
    return system, state, int(arc), place


def holding(system: System, state: State, factors: TangentFactors = NO_TANGENT, moving: bool = True) -> Any:
    """Matrix with the equations that hold the arcs alone."""
    matrix = new_equations(system).matrix
    interpreted(hold_arcs)(system.frame, system, state.at(0.0), factors, moving, matrix)
    return matrix


def test_belt_and_drum_that_move_together_keep_their_place() -> None:
    """By an arm that turns far, along its arc: places shift, and accelerations are those of the drum's center."""
    system, state, arc, place = on_an_arm()
    node, row = 6 * int(system.frame.arcs.node[arc]), arc - system.frame.arcs.node.size - 1

    def center(angle: float) -> FloatArray:
        position = state.position.copy()
        position[place] = angle
        return np.array(pulley_center(system, 1, position))

    turned = State(*(vector.copy() for vector in (state.position, state.velocity, state.acceleration)))
    turned.position[place] += 0.3
    turned.position[node : node + 2] += center(turned.position[place]) - center(state.position[place])
    along = system.frame.arcs.direction[arc] @ (center(0.3) - center(0.0))
    assert abs(along) > 0.05
    before, after = (holding(system, each, moving=False).border_side[row] for each in (state, turned))
    assert after == pytest.approx(before, abs=1e-12)
    speed, rate, step = 1.0, state.acceleration[place], 1e-4
    ways = [state.position[place] + speed * time + 0.5 * rate * time**2 for time in (-step, 0.0, step)]
    turned.acceleration[node : node + 2] = np.diff([center(way) for way in ways], n=2, axis=0)[0] / step**2
    assert holding(system, state).border_side[row] != pytest.approx(0.0, abs=0.1)
    turned.position[:] = state.position
    assert holding(system, turned).border_side[row] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("moving", [True, False])
def test_tangent_of_what_holds_an_arc_on_an_arm(moving: bool) -> None:
    system, state, arc, place = on_an_arm()
    factors = FACTORS if moving else TangentFactors(by_position=1.0)
    node, row = int(system.frame.arcs.node[arc]), arc - system.frame.arcs.node.size - 1
    matrix, random = holding(system, state, factors, moving), np.random.default_rng(9)
    way = 1e-7 * random.normal(size=3)
    unknown = system.bodies[place - system.first_body].unknown
    found = matrix.row[node, row, :2] @ way[:2] + matrix.corner[row, unknown] * way[2]
    sides = []
    for sense in (1.0, -1.0):
        moved = State(*(vector.copy() for vector in (state.position, state.velocity, state.acceleration)))
        for vector, factor in zip((moved.position, moved.velocity, moved.acceleration), factors[:3], strict=True):
            vector[[6 * node, 6 * node + 1, place]] += sense * factor * way
        sides.append(holding(system, moved, moving=moving).border_side[row])
    assert found == pytest.approx(0.5 * (sides[0] - sides[1]), rel=1e-5)


def test_an_arc_on_an_arm_that_is_the_first_unknown_is_held_too() -> None:
    system, state, arc, place = on_an_arm()
    row = arc - system.frame.arcs.node.size - 1
    unknowns = np.asarray(system.bodies.unknown)
    own = int(unknowns[place - system.first_body])
    before = holding(system, state, FACTORS).corner[row, own]
    unknowns[place - system.first_body] = 0
    after = holding(system, state, FACTORS).corner[row, 0]
    unknowns[place - system.first_body] = own
    assert before == after != 0.0


@pytest.mark.parametrize(("shifting", "order"), [([0.0, 0.0], 3.0), ([20.0, -30.0], 2.0)])
def test_inertia_does_the_change_of_the_kinetic_energy(shifting: list[float], order: float) -> None:
    """What is left falls with the third power of the step; with the second where the lengths of elements change."""
    system, state = over_time(*laid(**BARE), spread=0.0)
    losses, random = [], np.random.default_rng(11)
    for vector in (state.velocity, state.acceleration):
        vector[: system.first_body] = random.normal(size=system.first_body)
    state.acceleration[system.frame.place - system.frame.arcs.node.size : system.frame.place] = shifting
    for step in (1e-4, 5e-5):
        later = State(
            state.position + step * state.velocity + 0.5 * step**2 * state.acceleration,
            state.velocity + step * state.acceleration,
            state.acceleration,
        )
        interpreted(fit_mesh)(system.frame, system, later.position)
        impulse, work = np.zeros((2, state.position.size)), new_equations(system).work
        losses.append(interpreted(numerical_loss)(system, state.at(0.0), later.at(step), impulse, work))
    assert np.log2(losses[0] / losses[1]) == pytest.approx(order, abs=0.1)


def test_zones_end_within_a_fifth_of_short_spans() -> None:
    """Of rollers side by side, where layers at the ends of arcs would meet."""
    rollers = [
        {"name": name, "center": center, "radius": 0.02, "inertia": 0.1}
        for name, center in (("snub", [2.0, -0.1]), ("tail", [2.034, -0.075]))
    ]
    prepared = prepare(conveyor(pulley=[PULLEYS[0], *rollers], support=[], goods=BARE["goods"]))
    path, stretch = prepared.installation.path, prepared.laid.stretch
    zones = zones_of(prepared)
    assert len(zones) == path.on.size
    reached = 0
    for zone in zones:
        p = int(path.on[zone.arc])
        arc = abs(path.radii[p]) * path.wrap_angles[p] / stretch
        shortest = min(path.span_lengths[path.reaching[p]], path.span_lengths[path.leaving[p]]) / stretch
        beyond = 0.5 * (zone.end - zone.start - arc)
        assert 0.0 < beyond <= 0.2 * shortest * (1.0 + 1e-9)
        reached += beyond == pytest.approx(0.2 * shortest)
    assert reached


def test_without_flows_that_differ_it_is_the_mesh_without_arcs() -> None:
    """A load so light that it does nothing: the equations of nodes of a drive that carries nothing."""
    system, state = over_time(*laid(**BARE), spread=0.0)
    bare = prepare(conveyor(pulley=PULLEYS, support=[], goods=[], gravity=[0.0, 0.0]))
    plain = flowing_system(staying_system(bare, bare.equal_lengths(ELEMENTS)), np.array([1.0, 0.0]))
    assert shifts_of(plain.frame).size == 0
    shifts = system.frame.place - system.frame.arcs.node.size + np.arange(system.frame.arcs.node.size)
    same = State(*(np.delete(v, shifts) for v in (state.position, state.velocity, state.acceleration)))
    found, known = (residual(one, at, new_equations(one)) for one, at in ((system, state), (plain, same)))
    nodes = system.first_body
    np.testing.assert_allclose(found[:nodes], known[:nodes], rtol=1e-9, atol=1e-7 * np.abs(known).max())


def test_belt_is_neither_made_nor_lost_by_shifts() -> None:
    """Elements change by the difference of the shifts at their nodes, and hold the belt as a whole."""
    system, state = over_time(*laid(**BARE), spread=1.0)
    still = State(*(vector.copy() for vector in (state.position, state.velocity, state.acceleration)))
    frame = system.frame
    shifts = slice(frame.place - frame.arcs.node.size, frame.place)
    still.position[shifts] = 0.0
    lengths = []
    for each in (still, state):
        interpreted(fit_mesh)(frame, system, each.position)
        lengths.append(system.length.copy())
    change = lengths[1] - lengths[0]
    assert np.abs(change).max() > 1e-4
    assert change.sum() == pytest.approx(0.0, abs=1e-14)
    for shift, node in zip(state.position[shifts], frame.arcs.node, strict=True):
        assert change[: int(node)].sum() == pytest.approx(-shift, abs=1e-12)
    at = np.array(system.vectors)[np.array(system.shift) != 0.0]
    masses = [float(mass[np.ix_(at, at)].sum()) for mass in system.mass]
    np.testing.assert_allclose(masses, system.element.section.mass * system.length, rtol=1e-9)


def test_belt_on_an_arc_moves_with_it_and_belt_on_spans_by_its_share() -> None:
    """Zones reach beyond arcs by the same at both ends; the driver's arc holds a belt at rest, all of it along it."""
    prepared = prepare(conveyor(pulley=PULLEYS, **LOADED))
    lengths = prepared.graded_lengths(2.0)
    system = staying_system(prepared, lengths)
    frame, laid, path = system.frame, prepared.laid, prepared.path
    assert isinstance(frame, StayingByArcs)
    zones = zones_of(prepared)
    assert [zone.start for zone in zones] == sorted(zone.start for zone in zones)
    for zone in zones:
        middle = path.arc_start(zone.arc) + 0.5 * abs(path.radii[zone.arc]) * path.wrap_angles[zone.arc]
        assert laid.start + 0.5 * laid.stretch * (zone.start + zone.end) == pytest.approx(middle)
        arc = abs(path.radii[zone.arc]) * path.wrap_angles[zone.arc] / laid.stretch
        assert 0.0 < zone.end - zone.start - arc <= 0.4 * path.span_lengths.min() + 1e-12
    starts = np.cumsum(lengths) - lengths
    for arc in range(2):
        frame.shift[:] = np.arange(2) == arc
        shifts = np.array([interpreted(node_shift)(frame, np.zeros(0), node) for node in range(system.nodes)])
        ends = [(zone.start, float(zone.arc == arc)) for zone in zones] + [
            (zone.end, float(zone.arc == arc)) for zone in zones
        ]
        at, values = np.array(sorted([(0.0, 0.0), *ends, (prepared.belt_length, 0.0)])).T
        np.testing.assert_allclose(shifts, np.interp(starts, at, values), atol=1e-12)
        away = path.centers[arc] - nodes_of(prepared, starts[frame.arcs.node[arc]])
        assert np.hypot(*away) == pytest.approx(abs(path.radii[arc]), rel=1e-9)
        assert away @ frame.arcs.direction[arc] == pytest.approx(0.0, abs=1e-9)
    held = np.flatnonzero(frame.arcs.holding.any(axis=1))
    driver = next(zone for zone in zones if zone.arc == 0)
    size = abs(path.radii[0]) * path.wrap_angles[0] / laid.stretch
    away_from_middle = np.abs(starts - 0.5 * (driver.start + driver.end)) / (0.5 * size)
    inside, reached = (set(np.flatnonzero(away_from_middle < limit).tolist()) for limit in (1.0 - 1e-9, 1.0 + 1e-9))
    assert inside <= set(held.tolist()) <= reached  # nodes at both ends of the arc are on it by rounding
    assert held.size > 2
    assert np.linalg.norm(frame.arcs.holding, axis=1).sum() == pytest.approx(1.0)
    tangents = path.tangent(laid.start + laid.stretch * starts[held])
    assert np.sum(frame.arcs.holding[held] * tangents) == pytest.approx(1.0)


def test_belt_that_passes_is_that_of_node_0_and_the_shifts() -> None:
    """Linear between nodes, and around the belt: at its end as at node 0, which has no shift."""
    system, state = over_time(*laid(**BARE), spread=1.0)
    frame = system.frame
    way: ComplexArray = state.position[system.first_body : frame.place + 1].astype(np.complex128)
    way[-1] = 0.3 + 0.2j
    shifts = np.array([interpreted(node_shift)(frame, state.position, node) for node in range(system.nodes)])
    ends = np.append(0.0, np.cumsum(system.length))
    assert shifts[0] == 0.0
    along = np.append(ends, 0.5 * (ends[1:] + ends[:-1]))
    expected: ComplexArray = way[-1] + np.interp(along, ends, np.append(shifts, 0.0))
    np.testing.assert_allclose(passed_at(system, way, along), expected, atol=1e-15)


def nodes_of(prepared: Prepared, along: float) -> FloatArray:
    """Place on the path of a belt coordinate, m."""
    return np.asarray(prepared.laid.path.position(np.array([prepared.laid.start + prepared.laid.stretch * along]))[0])


def test_at_rest_a_force_along_the_belt_is_unknown() -> None:
    """It takes the place of the flow, and pulls by one newton in all; steps go to the shifts."""
    system, state = laid(**LOADED)
    state.velocity[:] = 0.0
    equations, anchor = steady_work(system).equations, anchor_at(state, True)
    interpreted(assemble_steady)(system, state.at(0.0), anchor, True, equations)
    matrix = equations.matrix
    np.testing.assert_array_equal(matrix.column[:, :2, -1], system.frame.arcs.holding)
    assert not matrix.corner[:, -1].any()
    solution, before = np.arange(1.0, 1.0 + len(matrix.corner)), shifts_of(system.frame).copy()
    interpreted(change_shifts)(system.frame, solution, -0.5)
    np.testing.assert_allclose(shifts_of(system.frame) - before, -0.5 * solution[-3:-1], rtol=1e-12)
    assert interpreted(largest_shift)(system.frame, -solution) == solution[-2]

"""Supports and goods on one element: forces known by hand, power, tangents, accelerations along paths."""

from math import comb
from typing import Any, NamedTuple

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.machines.carrying import resistance_of_kind
from beltdyn.model import prepare
from beltdyn.state.staying import laid_state
from beltdyn.system.arc_mesh import fit_mesh
from beltdyn.system.arrays import CARRYING_LOSS, Carrying, System
from beltdyn.system.body_forces import new_body_forces
from beltdyn.system.build import flowing_system, staying_system
from beltdyn.system.carrying import NO_CARRYING_TANGENT, CarryingFactors, add_carrying, find_accelerations
from beltdyn.system.element_state import element_workspace, gather_motion
from beltdyn.system.frame import FlowingByArcs, StayingByArcs, flow_at_ends
from beltdyn.system.state import State
from tests.unit.model.test_carrying import conveyor

ELEMENTS, SPEED, MASS, GRAVITY = 9, 3.0, 30.0, 9.81
IDLERS = {"kind": "idlers", "span": ["tail", "head"], "spacing": 1.0, "idler_mass": 6.0, "friction": 0.02}
IDLERS |= {"linear": 0.5, "stiffness": 2e4, "damping": 40.0}
GUIDE = {"kind": "guide", "span": ["tail", "head"], "friction": 0.2, "pressing": 15.0, "stiffness": 3e3}
GOODS = {"span": ["tail", "head"], "mass_per_length": MASS}
STEEP = [
    {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "speed": 5.0},
    {"name": "tail", "center": [16.0, 9.0], "radius": 0.2, "inertia": 0.15},
]
HALF = {"kind": "constant", "value": 0.5}


class Carried(NamedTuple):
    """What an element of a state has from its supports and goods."""

    residual: FloatArray
    tangent: FloatArray
    by_flow: FloatArray
    by_end: FloatArray
    power: float
    velocity: FloatArray
    """Of material points."""


class Case(NamedTuple):
    """An element in the middle of the carried span, whose nodes the tests place."""

    system: System
    state: State
    element: int
    direction: FloatArray
    normal: FloatArray
    start: FloatArray
    """Where its first node is laid."""
    length: float
    """Of span, m."""

    @property
    def support(self) -> Any:
        """Row of its first support."""
        assert isinstance(self.system.carrying, Carrying)
        return self.system.carrying.supports[0]

    @property
    def goods(self) -> Any:
        assert isinstance(self.system.carrying, Carrying)
        return self.system.carrying.goods[0]

    def lay(self, depth: float, bend: float = 0.0, stretch: float = 1.0) -> None:
        """Lay it straight along its span, or as a parabola with a second derivative along the normal, 1/m."""
        dof, along = len(self.system.scale), self.system.length[self.element]
        for end in range(2):
            node, way = (self.element + end) % self.system.nodes, end * along
            place = self.start + stretch * way * self.direction + (0.5 * bend * way**2 - depth) * self.normal
            slope, second = stretch * self.direction + bend * way * self.normal, bend * self.normal
            self.state.position[dof * node : dof * (node + 1)] = np.concatenate([place, slope, second])

    def carried(self, factors: CarryingFactors = NO_CARRYING_TANGENT, state: State | None = None) -> Carried:
        """Residual and tangent of supports and goods alone."""
        system, motion = self.system, (state or self.state).at(0.0)
        work, forces = element_workspace(system), new_body_forces(system)
        interpreted(fit_mesh)(system.frame, system, motion.position)
        interpreted(gather_motion)(system, self.element, motion.position, motion.velocity, work.coordinates)
        interpreted(add_carrying)(system.carrying, system, motion, self.element, factors, work, forces)
        own, flow = work.element, work.flow
        return Carried(
            own.gradient.copy(),
            own.tangent.copy(),
            flow.by_speed.copy(),
            flow.by_end.copy(),
            float(forces.power[CARRYING_LOSS]),
            work.coordinates[1].copy(),
        )

    def force(self) -> FloatArray:
        """Along the span and along its normal: what an even displacement of the element does, N."""
        vectors = np.array(self.system.vectors)[np.array(self.system.shift) != 0.0]
        total = -np.array([self.carried().residual[vectors + axis].sum() for axis in range(2)])
        return np.array([total @ self.direction, total @ self.normal])

    def moment(self) -> float:
        """About the first node: what an even turn of the element does, N m."""
        residual, dof, shift = self.carried().residual, len(self.system.scale), self.system.shift
        total = 0.0
        for a, first in enumerate(self.system.vectors):
            arm = self.length * (first >= dof) if shift[a] else float(a % 3 == 1)
            total -= arm * float(residual[first : first + 2] @ self.normal)
        return total


def vectors(state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
    return state.position, state.velocity, state.acceleration


def case(over_time: bool = True, **changes: object) -> Case:
    prepared = prepare(conveyor(**{"pulley": STEEP, "support": [], "goods": []} | changes))
    lengths = prepared.equal_lengths(ELEMENTS)
    system = staying_system(prepared, lengths)
    state = laid_state(prepared.laid, system, np.zeros(0))
    direction, (first, _) = prepared.path.span_directions[1], prepared.path.span_points[1]
    normal = np.array([direction[1], -direction[0]])
    assert normal[1] > 0.0
    places = state.position[: system.first_body].reshape(system.nodes, -1)[:, :2]
    along = (places - first) @ direction
    inside = (along > 2.0) & (along < 14.0) & (np.abs((places - first) @ normal) < 0.1)
    element = int(np.flatnonzero(inside)[1])
    if over_time:
        system = flowing_system(system, direction)
        assert isinstance(system.frame, FlowingByArcs)
        more = system.first_body + system.bodies.size - state.position.size
        state = State(*(np.append(vector, np.zeros(more)) for vector in vectors(state)))
        state.velocity[system.frame.place] = SPEED
    else:
        assert isinstance(system.frame, StayingByArcs)
        system.frame.speed[0] = SPEED
    start = first + along[element] * direction
    return Case(system, state, element, direction, normal, start, float(system.length[element]))


@pytest.mark.parametrize("over_time", [False, True])
@pytest.mark.parametrize("support", [IDLERS, GUIDE], ids=["idlers", "guide"])
def test_a_support_pushes_by_its_depth_and_resists(support: dict[str, object], over_time: bool) -> None:
    """A straight element 2 mm deep, stretched by 1 %, on which both ends of the support lie."""
    here, depth = case(over_time, support=[support]), 2e-3
    first = float((here.start - here.support.line.origin) @ here.direction)
    here = case(over_time, support=[support | {"start": first + 0.4, "end": first + 1.5}])
    here.lay(depth, stretch=1.01)
    row = here.support
    normal = row.stiffness * (row.raised + depth)
    drag = interpreted(resistance_of_kind)(row, normal, 1.01 * SPEED).force
    assert drag > 0.0
    assert here.force() == pytest.approx(1.1 * np.array([-drag, normal]), rel=1e-12)
    assert here.carried().power == pytest.approx(1.1 * drag * 1.01 * SPEED, rel=1e-12)
    assert not here.carried().tangent.any()


@pytest.mark.parametrize("over_time", [False, True])
def test_a_support_on_an_arc_pushes_by_its_height(over_time: bool) -> None:
    """A straight element on an arc: the sagitta (x - a) (b - x) / (2 R) is missing from its depth."""
    belt = {"profile": "flat-polyester-fabric", "width": "400 mm", "installed_tension": "300 N"}
    here, radius, depth = case(over_time, support=[IDLERS]), 200.0, 0.05
    first = float((here.start - here.support.line.origin) @ here.direction)
    arc = IDLERS | {
        "start": first - 0.5,
        "end": first + 5.5,
        "stiffness": 500.0,
        "curve_radius": radius,
        "friction": 0.0,
    }
    here = case(over_time, support=[arc], belt=belt)
    here.lay(depth)
    row = here.support
    x = np.linspace(0.5, 0.5 + here.length, 2001)
    line = 500.0 * (row.raised + depth - x * (6.0 - x) / (2.0 * radius))
    assert line.min() > 0.0
    slope = -(3.0 - x) / radius
    assert here.force()[1] == pytest.approx(np.trapezoid(line, x), rel=1e-6)
    drag = interpreted(resistance_of_kind)(row, 0.0, SPEED).force
    assert here.force()[0] == pytest.approx(-np.trapezoid(line * slope, x) - drag * here.length, rel=1e-6)
    assert here.moment() == pytest.approx(np.trapezoid(line * (x - 0.5), x), rel=1e-6)


def test_a_belt_that_leaves_its_idlers_is_pushed_by_nothing() -> None:
    """A guide holds it on both sides."""
    for support, holds in ((IDLERS | {"friction": 0.0, "linear": 0.0, "idler_mass": 0.0}, False), (GUIDE, True)):
        here = case(support=[support])
        here.lay(-2e-3 - float(here.support.raised))
        _, normal = here.force()
        assert holds or not here.carried(CarryingFactors(1.0, 1.0, 0.0, 0.0)).tangent.any()
        assert normal == pytest.approx(-here.length * here.support.stiffness * 2e-3 if holds else 0.0)


def test_a_support_damps_the_mesh_and_never_pulls() -> None:
    """2 d v a meter while the belt sinks in; nothing where it rises so fast that damping would hold it."""
    here, dof = case(support=[IDLERS | {"friction": 0.0}]), 6
    row = here.support
    for rise, expected in ((-0.05, row.stiffness * (row.raised + 1e-3) + 40.0 * 0.05), (50.0, 0.0)):
        here.lay(1e-3)
        for node in (here.element, here.element + 1):
            here.state.velocity[dof * node : dof * node + 2] = rise * here.normal
        assert here.force()[1] == pytest.approx(here.length * expected, rel=1e-12)


@pytest.mark.parametrize("over_time", [False, True])
def test_goods_have_weight_and_follow_the_belt(over_time: bool) -> None:
    """Half a load on a parabola: m (g - c^2 r''), over the part that lies on the span."""
    here = case(over_time, goods=[GOODS | {"schedule": HALF}])
    bend = 0.02
    here.lay(0.0, bend)
    along, normal = here.force()
    mass, gravity = 0.5 * MASS, np.array([0.0, -GRAVITY])
    assert along == pytest.approx(mass * here.length * (gravity @ here.direction), rel=1e-9)
    assert normal == pytest.approx(mass * here.length * (gravity @ here.normal - SPEED**2 * bend), rel=1e-9)


@pytest.mark.parametrize("passed", [0.0, 0.7])
def test_a_batch_moves_with_the_belt(passed: float) -> None:
    """From 0.3 m behind the first node on, stretched by the way that has passed."""
    first = case(goods=[GOODS])
    at = float((first.start - first.goods.line.origin) @ first.direction)
    here = case(goods=[GOODS | {"batch": [at + 0.3, at + 1.1]}])
    here.lay(0.0)
    here.state.position[here.system.frame.place] = passed
    gravity = np.array([0.0, -GRAVITY])
    assert here.force() == pytest.approx(0.8 * MASS * np.array([gravity @ here.direction, gravity @ here.normal]))
    middle = 0.7 + passed * here.goods.stretch
    assert here.moment() == pytest.approx(middle * here.force()[1])


def test_rotating_mass_and_goods_are_sped_up() -> None:
    """(m_R + m_L) dc/dt; idlers turn with the belt that passes at a place, goods go with the belt."""
    here = case(support=[IDLERS | {"friction": 0.0, "linear": 0.0}], goods=[GOODS])
    here.lay(1e-3)
    before = here.force()
    here.state.acceleration[here.system.frame.place] = 2.0
    rotating = here.support.rotating
    assert rotating == pytest.approx(6.0)
    assert here.force() - before == pytest.approx([-2.0 * (rotating + MASS) * here.length, 0.0], abs=1e-9)


@pytest.fixture(scope="module")
def loaded() -> Case:
    """Supports on an arc and goods over the whole element, disturbed, with flows that differ along the belt."""
    at = case(support=[IDLERS])
    first = float((at.start - at.support.line.origin) @ at.direction)
    arc = IDLERS | {"start": first - 0.5, "end": first + 5.5, "stiffness": 500.0, "curve_radius": 100.0}
    belt = {"profile": "flat-polyester-fabric", "width": "400 mm", "installed_tension": "300 N"}
    goods = [GOODS | {"batch": [first - 0.2, first + 5.7]}]
    here = case(belt=belt, support=[arc, GUIDE | {"start": first - 0.3}], goods=goods)
    here.lay(0.1, bend=1e-3, stretch=1.1)
    return disturbed(here)


def disturbed(here: Case) -> Case:
    random, frame = np.random.default_rng(3), here.system.frame
    nodes = here.system.first_body
    here.state.position[:nodes] += 1e-4 * random.normal(size=nodes)
    here.state.velocity[:nodes] = 0.1 * random.normal(size=nodes)
    here.state.acceleration[:nodes] = random.normal(size=nodes)
    if isinstance(frame, FlowingByArcs):
        shifts = slice(frame.place - frame.arcs.node.size, frame.place)
        here.state.position[shifts] = 1e-3 * random.normal(size=frame.arcs.node.size)
        here.state.velocity[shifts] = 0.2 * random.normal(size=frame.arcs.node.size)
        here.state.acceleration[shifts] = random.normal(size=frame.arcs.node.size)
        here.state.acceleration[frame.place] = 1.5
    return here


def test_power_is_that_of_the_forces_on_the_material(loaded: Case) -> None:
    found = loaded.carried()
    assert found.power == pytest.approx(found.residual @ found.velocity, rel=1e-12)


def moved(case: Case, steps: FloatArray, places: FloatArray, factors: tuple[float, float, float]) -> FloatArray:
    """Derivative of the residual where steps move the position, the velocity and the acceleration at some places."""
    sides = []
    for sense in (1.0, -1.0):
        state = State(*(vector.copy() for vector in vectors(case.state)))
        for vector, factor in zip(vectors(state), factors, strict=True):
            vector[places] += sense * factor * steps
        sides.append(case.carried(state=state).residual)
    return np.asarray(0.5 * (sides[0] - sides[1]))


def test_tangent_over_time(loaded: Case) -> None:
    """By nodes with all factors, where the flow is even; by flow and shifts without their places, which are lengths."""
    system, random, factors = loaded.system, np.random.default_rng(4), (1.0, 5e2, 2e5)
    even = loaded._replace(state=State(*(vector.copy() for vector in vectors(loaded.state))))
    shifts = slice(system.frame.place - system.frame.arcs.node.size, system.frame.place)
    even.state.velocity[shifts] = even.state.acceleration[shifts] = 0.0
    found = even.carried(CarryingFactors(factors[0], factors[1], factors[1], factors[2]))
    dof = len(system.scale)
    nodes = np.concatenate([np.arange(dof) + dof * (loaded.element + end) for end in range(2)])
    for _ in range(2):
        steps = 1e-9 * random.normal(size=2 * dof)
        expected = moved(even, steps, nodes, factors)
        np.testing.assert_allclose(found.tangent @ steps, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max())
    found = loaded.carried(CarryingFactors(0.0, factors[1], factors[1], factors[2]))
    frame, rates = system.frame, (0.0, *factors[1:])
    by_flow = moved(loaded, np.array([1e-7]), np.array([frame.place]), rates) / 1e-7
    np.testing.assert_allclose(found.by_flow, by_flow, rtol=1e-5, atol=1e-6 * np.abs(by_flow).max())
    ends = interpreted(flow_at_ends)
    for arc in range(frame.arcs.node.size):
        place = np.array([frame.place - frame.arcs.node.size + arc])
        unit = np.zeros_like(loaded.state.velocity)
        unit[place] = 1.0
        first, last = ends(frame, loaded.element, unit)
        by_shift = moved(loaded, np.array([1e-7]), place, rates) / 1e-7
        expected = first * found.by_flow + (last - first) * found.by_end
        np.testing.assert_allclose(expected, by_shift, rtol=1e-5, atol=1e-6 * np.abs(by_shift).max() + 1e-9)


def test_tangent_of_steady_running() -> None:
    here = case(False, support=[IDLERS, GUIDE], goods=[GOODS])
    here.lay(1e-3, bend=5e-3, stretch=1.002)
    disturbed(here)
    here.state.velocity[:] = 0.0
    found, dof = here.carried(CarryingFactors(1.0, 0.0, 1.0, 0.0)), len(here.system.scale)
    nodes = np.concatenate([np.arange(dof) + dof * (here.element + end) for end in range(2)])
    steps = 1e-8 * np.random.default_rng(5).normal(size=2 * dof)
    expected = moved(here, steps, nodes, (1.0, 0.0, 0.0))
    np.testing.assert_allclose(found.tangent @ steps, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max())
    sides = []
    for speed in (SPEED + 1e-5, SPEED - 1e-5):
        here.system.frame.speed[0] = speed
        sides.append(here.carried().residual)
    by_flow = (sides[0] - sides[1]) / 2e-5
    np.testing.assert_allclose(found.by_flow, by_flow, rtol=1e-5, atol=1e-6 * np.abs(by_flow).max())


def test_accelerations_are_those_of_material_points_on_their_way(loaded: Case) -> None:
    """Second differences of the places of points that go with the belt, while elements change their lengths."""
    system, state, element = loaded.system, loaded.state, loaded.element
    frame, first_of = system.frame, np.array(system.vectors)
    interpreted(fit_mesh)(frame, system, state.position)
    length, ends = float(system.length[element]), interpreted(flow_at_ends)
    first, rise = (ends(frame, element, rate)[0] for rate in (state.velocity, state.acceleration))
    work = element_workspace(system)
    interpreted(gather_motion)(system, element, state.position, state.velocity, work.coordinates)
    interpreted(find_accelerations)(frame, system, state.at(0.0), element, work)
    velocities = np.stack([work.coordinates[1][first_of + axis] for axis in range(2)], 1)
    accelerations = work.flow.moved.copy()

    def shapes(place: float) -> FloatArray:
        xi = place / float(system.length[element])
        weights = np.array([comb(5, k) * xi**k * (1.0 - xi) ** (5 - k) for k in range(6)])
        return np.asarray(weights @ system.control[element, 0])

    dof = len(system.scale)
    for begun in (0.2 * length, 0.7 * length):
        own, places = shapes(begun), []
        for time in (-1e-4, 0.0, 1e-4):
            position = state.position + time * state.velocity + 0.5 * time**2 * state.acceleration
            interpreted(fit_mesh)(frame, system, position)
            nodes = position[dof * element : dof * (element + 2)]
            at = shapes(begun + time * first + 0.5 * time**2 * rise)
            places.append(at @ np.stack([nodes[first_of + axis] for axis in range(2)], 1))
        interpreted(fit_mesh)(frame, system, state.position)
        np.testing.assert_allclose(own @ velocities, (places[2] - places[0]) / 2e-4, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(own @ accelerations, (places[2] - 2.0 * places[1] + places[0]) / 1e-8, atol=1e-5)


def test_nothing_is_carried_where_nothing_lies() -> None:
    here = case(support=[IDLERS | {"start": 0.0, "end": 0.1}], goods=[GOODS | {"batch": [0.0, 0.1]}])
    assert isinstance(here.system.carrying, Carrying)
    here.lay(5e-3)
    assert not here.carried(CarryingFactors(1.0, 1.0, 1.0, 1.0)).tangent.any()
    assert not here.force().any()

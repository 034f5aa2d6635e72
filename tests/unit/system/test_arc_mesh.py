"""A mesh that stays at every arc, and what carries its elements: lengths, tangents by differences, flow."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import prepare
from beltdyn.state.newton import steady_work
from beltdyn.state.settling import with_passage
from beltdyn.state.staying import Standing, bring_to_stand
from beltdyn.system.arc_mesh import arc_count, base_coordinates, fitted, shifts_of, zones_of
from beltdyn.system.arrays import NO_TANGENT, Carrying, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.build import flowing_system, staying_system
from beltdyn.system.build_machines import carrying_arrays, with_resistance
from beltdyn.system.constant_drive import constant_drive, with_speeds_unknown
from beltdyn.system.frame import FlowingByArcs, StayingByArcs
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import (
    Anchor,
    anchor_at,
    assemble,
    assemble_steady,
    new_equations,
    no_multipliers,
)
from tests.unit.model.test_carrying import conveyor

SPEED = 1.0


@pytest.fixture(scope="module")
def standing() -> Standing:
    return bring_to_stand(prepare(conveyor()))


def side(
    system: System, anchor: Anchor, position: FloatArray, velocity: FloatArray, *, wanted: bool = False
) -> RingMatrix:
    """Residual of steady running, and the matrix."""
    work = steady_work(system)
    state = Motion(0.0, position, velocity, np.zeros_like(position))
    assemble_steady(system, state, anchor, wanted, work.equations)
    return work.equations.matrix


@pytest.mark.slow
def test_every_pulley_has_a_zone(standing: Standing) -> None:
    zones = zones_of(standing.prepared)
    assert sorted(zone.arc for zone in zones) == [0, 1]
    assert all(zone.start < zone.end for zone in zones)
    assert arc_count(standing.system.frame) == 2


def test_a_support_takes_elements_of_its_own_span_alone() -> None:
    """Here the span before the second drum runs below the lower strand in the same direction."""
    keys = {"radius": 0.2, "inertia": 1.0}
    pulleys = [
        {"name": "head", "center": [0.0, 2.0], "radius": 0.2, "speed": 1.0},
        keys | {"name": "second", "center": [3.0, 0.9]},
        keys | {"name": "bend", "center": [1.8, 1.5], "side": "outside"},
        keys | {"name": "tail", "center": [200.0, 0.0]},
    ]
    support = {"kind": "idlers", "span": ["bend", "tail"], "spacing": 1.0}
    prepared = prepare(conveyor(pulley=pulleys, support=[support], goods=[]))
    lengths = prepared.graded_lengths(1.0)
    carrying = carrying_arrays(prepared, lengths)
    assert isinstance(carrying, Carrying)
    held, path = np.flatnonzero(np.diff(carrying.first_support)), prepared.installation.path
    middles = prepared.laid.start + prepared.laid.stretch * (np.cumsum(lengths) - 0.5 * lengths)
    before, after = (0.5 * path.wrap_angles * np.abs(path.radii))[[2, 3]]
    away = (middles[held] - path.span_start(2) + before) % path.length
    own = path.span_lengths[2] + before + after
    assert np.all((away <= own + lengths[held]) | (away >= path.length - lengths[held]))
    assert lengths[held].sum() * prepared.laid.stretch > 0.999 * path.span_lengths[2]


@pytest.mark.slow
def test_shifts_lengthen_one_span_by_what_they_take_from_another(standing: Standing) -> None:
    system, position = standing.system, standing.state.position
    frame = system.frame
    assert isinstance(frame, StayingByArcs)
    fitted(system, position)
    before, shifts = system.length.copy(), shifts_of(frame).copy()
    frame.shift[1] += 0.01
    fitted(system, position)
    change = system.length - before
    assert change.sum() == pytest.approx(0.0, abs=1e-12)
    assert np.abs(change).sum() == pytest.approx(0.02, rel=1e-9)
    assert base_coordinates(system, np.cumsum(system.length))[-1] == pytest.approx(frame.arcs.length.sum())
    frame.shift[:] = shifts
    fitted(system, position)
    np.testing.assert_allclose(system.length, before, rtol=1e-15)


@pytest.mark.slow
def test_the_tangent_of_steady_running_is_that_of_its_residual(standing: Standing) -> None:
    system = with_speeds_unknown(constant_drive(standing.system, 1.0))
    system = system._replace(carrying=with_resistance(system.carrying, 1.0))
    anchor = anchor_at(standing.state, False)
    rng = np.random.default_rng(1)
    position, velocity = standing.state.position.copy(), standing.state.velocity.copy()
    position[: system.first_body] += 1e-6 * rng.standard_normal(system.first_body)
    velocity[system.first_body :] = 5.0
    system.frame.speed[0] = SPEED
    matrix = side(system, anchor, position, velocity, wanted=True)
    assert isinstance(system.carrying, Carrying)
    carried = np.flatnonzero(np.diff(system.carrying.first_support))
    node = int(carried[carried.size // 2])
    for c in range(6):
        step = 1e-7
        sides = []
        for sign in (1.0, -1.0):
            moved = position.copy()
            moved[6 * node + c] += sign * step
            sides.append(side(system, anchor, moved, velocity).node_side.copy())
        found = (sides[0] - sides[1]) / (2.0 * step)
        np.testing.assert_allclose(matrix.diagonal[node, :, c], found[node], rtol=1e-4, atol=1e-5 * np.abs(found).max())
    shifts, step = shifts_of(system.frame), 1e-5
    columns = matrix.column[:, :, matrix.column.shape[2] - 3]
    sides = []
    for sign in (1.0, -1.0):
        shifts[0] += sign * step
        sides.append(side(system, anchor, position, velocity).node_side.copy())
        shifts[0] -= sign * step
    found = (sides[0] - sides[1]) / (2.0 * step)
    np.testing.assert_allclose(columns, found, atol=2e-3 * np.abs(found).max())  # weight and bending are left out


@pytest.mark.slow
def test_flows_are_coordinates_of_a_system_over_time(standing: Standing) -> None:
    system = flowing_system(standing.system, np.array([1.0, 0.0]))
    assert isinstance(system.frame, FlowingByArcs)
    assert system.bodies.size == standing.system.bodies.size + 3
    assert system.bodies.unknown.max() == np.asarray(system.bodies.unknown)[system.frame.place - system.first_body]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "factors"),
    [("velocity", TangentFactors(by_velocity=1.0)), ("acceleration", TangentFactors(by_acceleration=1.0))],
)
def test_goods_move_with_flows_that_differ(standing: Standing, kind: str, factors: TangentFactors) -> None:
    """Columns of flow and shifts are the derivatives of the residual: goods have the acceleration of the material."""
    system = flowing_system(standing.system, anchor_at(standing.state, True).direction)
    state = with_passage(standing.system, standing.state, SPEED)
    assert isinstance(system.frame, FlowingByArcs)
    assert isinstance(system.carrying, Carrying)
    assert system.carrying.goods.size
    equations, no_joint = new_equations(system), no_multipliers(system)
    assemble(system, state.at(0.0), no_joint, factors, equations)
    unknowns = np.asarray(system.bodies.unknown)[system.frame.place - system.first_body + np.arange(-2, 1)]
    arcs = system.frame.arcs
    between = arcs.before != arcs.after  # on spans: friction on arcs is no straight line
    columns = equations.matrix.column[:, :, unknowns].copy()
    for number, place in enumerate(system.frame.place + np.arange(-2, 1)):
        sides = []
        for sense in (1.0, -1.0):
            moved = State(state.position.copy(), state.velocity.copy(), state.acceleration.copy())
            getattr(moved, kind)[place] += sense * 1e-3
            assemble(system, moved.at(0.0), no_joint, NO_TANGENT, equations)
            sides.append(equations.matrix.node_side.copy())
        found = (sides[0] - sides[1]) / 2e-3
        assert np.abs(found[between, 0]).max() > 0.1
        np.testing.assert_allclose(columns[between, :4, number], found[between, :4], rtol=1e-4, atol=1e-4)


@pytest.mark.slow
def test_a_mesh_without_a_node_on_the_arc_of_the_driver_holds_the_belt_there_too() -> None:
    """Four equal elements of 10 m, as before a mesh is graded."""
    prepared = prepare(conveyor())
    frame = staying_system(prepared, prepared.equal_lengths(4)).frame
    assert isinstance(frame, StayingByArcs)
    assert np.linalg.norm(frame.arcs.holding, axis=1).sum() == pytest.approx(1.0)

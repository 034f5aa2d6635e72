"""A mesh that stays at every arc: lengths of belt go over from one span to another as they stretch.

Where a belt is long, its stretch moves material past pulleys by more than they are wide.  The length of unstretched
belt that has passed then differs from arc to arc.  It is s + U, with s that at node 0 and U the shift of the mesh at a
node: that of an arc at all its nodes, zero at node 0, and linear in between over the belt coordinate at rest.  An
element has the reference length l = l_0 - (U_j - U_i).

On the belt of an axis no belt flows past node 0 or the last node, where the carriage holds it: s is zero, and its spans
become longer and shorter as the carriage moves.
"""

from collections.abc import Callable
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray, IntArray
from beltdyn.contact.surface import move_start, with_own_starts
from beltdyn.kernel import by_type, kernel
from beltdyn.machines.tensioners import tensioner_center
from beltdyn.model import Prepared
from beltdyn.model.end import free_stroke
from beltdyn.model.resolution import shifts_at_nodes
from beltdyn.system.arrays import Motion, RingMatrix, System, TangentFactors
from beltdyn.system.frame import (
    ArcMesh,
    ByArcs,
    Flowing,
    FlowingByArcs,
    Staying,
    StayingByArcs,
    Travelling,
    node_shift,
)
from beltdyn.system.moving_center import pulley_center, tensioner_coordinate
from beltdyn.system.state import curve_lengths

if TYPE_CHECKING:
    import xarray as xr

_ORDERS = np.array([0, 1, 2, 0, 1, 2])
"""Of the derivatives that the vectors of a quintic element are."""
_LAYERS = 8.0
"""Belt at either end of an arc that moves with it, in layers."""


class Zone(NamedTuple):
    """The belt that moves with an arc."""

    start: float
    """On the unstretched belt at rest, m."""
    end: float
    arc: int
    """Number among the arcs, in the order of their pulleys."""


def zones_of(prepared: Prepared) -> list[Zone]:
    """The belt on every arc, with layers at its ends, in order along the belt."""
    laid, path, margin = prepared.laid, prepared.installation.path, min(_LAYERS * prepared.layer, _nearest(prepared))
    found = list[Zone]()
    for arc, p in enumerate(path.on.tolist()):
        size = abs(float(path.radii[p])) * float(path.wrap_angles[p])
        first = (path.arc_start(p) - laid.start) % path.length
        shortest = float(path.span_lengths[[path.reaching[p], path.leaving[p]]].min()) / laid.stretch
        beyond = min(margin, 0.2 * shortest)
        found.append(Zone(first / laid.stretch - beyond, (first + size) / laid.stretch + beyond, arc))
    return sorted(found)


def _nearest(prepared: Prepared) -> float:
    """Half of the way that the carriage of an axis keeps from pulleys, m; infinite without a carriage."""
    carriage = prepared.carriage
    if carriage is None:
        return np.inf
    (first, last), room = prepared.carriage_range, free_stroke(carriage, prepared.path)
    return 0.5 * max(min(first - room[0], room[1] - last), 0.0)


def staying_by_arcs(prepared: Prepared, system: System) -> System:
    """The same drive on a mesh that stays at every arc, with arrays of its own."""
    zones = zones_of(prepared)
    held = [Zone(0.0, 0.0, -1), *zones, Zone(prepared.belt_length, prepared.belt_length, -1)]
    moved = by_arcs(prepared, system, zones, held)
    if prepared.ends:
        return moved
    holding = _holding(prepared, zones, system.length)
    return moved._replace(frame=moved.frame._replace(arcs=moved.frame.arcs._replace(holding=holding)))


def by_arcs(prepared: Prepared, system: System, zones: list[Zone], held: list[Zone]) -> System:
    """The same drive on a mesh that stays at the arcs of zones, between places held along the belt, without force."""
    frame, lengths = system.frame, system.length.copy()
    assert isinstance(frame, Staying)
    vectors = np.array(system.vectors)
    before, after, share = _shares(held, np.append(0.0, np.cumsum(lengths))[: system.nodes])
    starts = np.cumsum(lengths) - lengths
    node = np.zeros(len(zones), dtype=np.int64)
    place, direction = np.zeros((len(zones), 2)), np.zeros((len(zones), 2))
    for zone in zones:
        node[zone.arc] = int(np.argmin(np.abs(starts - 0.5 * (zone.start + zone.end))))
        along = prepared.laid.start + prepared.laid.stretch * starts[node[zone.arc]]
        place[zone.arc] = prepared.laid.path.position(np.array([along]))[0]
        direction[zone.arc] = prepared.laid.path.tangent(np.array([along]))[0]
    on = prepared.path.on
    carrier = np.asarray(system.pulleys.carrier)[on]
    for arc in np.flatnonzero(carrier >= 0):
        at_rest = np.zeros(system.first_body + system.bodies.size)
        position = at_rest.copy()
        position[position.size - len(system.tensioners) :] = prepared.installation.tensioner_positions
        p = int(on[arc])
        place[arc] += np.array(pulley_center(system, p, at_rest)) - pulley_center(system, p, position)
    growth = _growth(system, frame.derivative, lengths)
    arcs = ArcMesh(
        node=node,
        holding=np.zeros((0, 2)),
        direction=direction,
        place=place,
        carrier=carrier,
        gravity=np.array(prepared.gravity),
        before=before,
        after=after,
        share=share,
        length=lengths,
        control=system.control.copy(),
        derivative=frame.derivative.copy(),
        growth=growth,
        mass=np.ascontiguousarray(system.mass[:, vectors[:, None], vectors]),
        inertia=frame.inertia.copy(),
        metric=system.hysteresis.metric.copy(),
    )
    own = StayingByArcs(
        frame.speed.copy(), np.zeros(len(zones)), frame.derivative.copy(), growth.copy(), frame.inertia.copy(), arcs
    )
    return with_own_mesh(system)._replace(frame=own)


def with_own_mesh(system: System) -> System:
    """The same system with arrays of its own of what follows the lengths of elements."""
    return system._replace(
        length=system.length.copy(),
        control=system.control.copy(),
        mass=system.mass.copy(),
        rims=with_own_starts(system.rims),
        hysteresis=system.hysteresis.copy(),
        supports=system.supports._replace(force=system.supports.force.copy()),
    )


def _shares(held: list[Zone], nodes: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Arcs on both sides of each node, -1 where nothing goes over, and the share of the second."""
    before, after, share = np.full(nodes.size, -1), np.full(nodes.size, -1), np.zeros(nodes.size)
    for one, other in pairwise(held):
        between = (nodes >= one.start) & (nodes < other.start)
        before[between], after[between] = one.arc, other.arc
        share[between] = np.clip((nodes[between] - one.end) / (other.start - one.end), 0.0, 1.0)
    return before, after, share


def with_shares(system: System, before: IntArray, after: IntArray, share: FloatArray) -> System:
    """The same mesh over time with other arcs beside its nodes."""
    arcs = system.frame.arcs._replace(before=before, after=after, share=share)
    return system._replace(frame=system.frame._replace(arcs=arcs))


def _holding(prepared: Prepared, zones: list[Zone], lengths: FloatArray) -> FloatArray:
    """A unit of force along the belt, spread evenly over the arc of the driver, on the nodes, shape (N, 2).

    On a mesh without a node inside that arc, the one next to it has it all.
    """
    driver = prepared.reference
    zone = next(one for one in zones if prepared.path.on[one.arc] == driver)
    laid, starts = prepared.laid, np.cumsum(lengths) - lengths
    tangents = laid.path.tangent(laid.start + laid.stretch * starts)
    arc = abs(float(laid.path.radii[driver]) * float(laid.path.wrap_angles[driver])) / laid.stretch
    beyond = 0.5 * (zone.end - zone.start - arc)
    inner = (starts > zone.start + beyond) & (starts < zone.end - beyond)
    inner[np.argmin(np.abs(starts - 0.5 * (zone.start + zone.end)))] = True
    weight = np.where(inner, 0.5 * (lengths + np.roll(lengths, 1)), 0.0)
    return np.asarray((weight / weight.sum())[:, None] * tangents)


def _growth(system: System, derivative: FloatArray, lengths: FloatArray) -> FloatArray:
    """G: vectors of xi dr/dsigma, less what the growing element does to those of r."""
    made = np.zeros((lengths.size, 6, 6))
    made[:, 1, 0], made[:, 2, 1] = 1.0 / lengths, 2.0 / lengths
    made[:, 3, 3] = made[:, 4, 4] = made[:, 5, 5] = 1.0
    made[:, 4, 3], made[:, 5, 4] = 1.0 / lengths, 2.0 / lengths
    return np.ascontiguousarray(made @ derivative - np.diag(_ORDERS) / lengths[:, None, None])


# The mesh at a state


@kernel
def _fit(frame: Any, system: System, position: FloatArray) -> None:
    """Give the elements the lengths that they have at a position of shape (n N + D,)."""
    arcs, changed, vectors, start = frame.arcs, False, system.vectors, 0.0
    following = node_shift(frame, position, 0)
    for element in range(system.length.size):
        move_start(system.rims, element, start - following)
        start += arcs.length[element]
        shift, following = following, node_shift(frame, position, (element + 1) % system.nodes)
        length = arcs.length[element] - (following - shift)
        if length == system.length[element]:
            continue
        changed, system.length[element] = True, length
        ratio, turn = length / arcs.length[element], arcs.length[element] / length
        if system.hysteresis.size > 0:
            system.hysteresis[element].length = length
        for a in range(len(vectors)):
            of_a = _power(ratio, a % 3)
            for b in range(len(vectors)):
                of_b = _power(ratio, b % 3)
                system.control[element, 0, a, b] = arcs.control[element, 0, a, b] * of_b
                factor = turn * of_b / of_a
                frame.derivative[element, a, b] = factor * arcs.derivative[element, a, b]
                frame.growth[element, a, b] = factor * arcs.growth[element, a, b]
                frame.inertia[element, a, b] = turn * of_a * of_b * arcs.inertia[element, a, b]
                mass = ratio * of_a * of_b * arcs.mass[element, a, b]
                if system.hysteresis.size > 0:
                    metric = turn * turn * of_a * of_b * arcs.metric[element, a, b]
                    system.hysteresis[element].metric[a, b] = metric
                for axis in range(2):
                    system.mass[element, vectors[a] + axis, vectors[b] + axis] = mass
    if changed:
        _weigh(frame.arcs.gravity, system)


@kernel(inline=True)
def _power(ratio: float, order: int) -> float:
    return 1.0 if order == 0 else ratio if order == 1 else ratio * ratio


@kernel
def _weigh(gravity: FloatArray, system: System) -> None:
    """Weight of the belt as nodal forces."""
    force, dof, vectors = system.supports.force, len(system.scale), system.vectors
    force[:] = 0.0
    for element in range(system.length.size):
        node_j = (element + 1) % system.nodes
        for a in range(len(vectors)):
            c = vectors[a]
            row = dof * element + c if c < dof else dof * node_j + c - dof
            mass = system.mass[element, c, vectors[0]] + system.mass[element, c, vectors[3]]
            force[row] += mass * gravity[0]
            force[row + 1] += mass * gravity[1]


@kernel(inline=True)
def _as_it_is(frame: Any, system: System, position: FloatArray) -> None:
    """Elements keep their lengths."""


fit_mesh: Callable[[Any, System, FloatArray], None] = by_type(
    {Travelling: _as_it_is, Staying: _as_it_is, Flowing: _as_it_is, StayingByArcs: _fit, FlowingByArcs: _fit},
    "fit_mesh",
)
"""Give the elements of a system, whose frame is the first argument, the lengths that they have at a position."""


def fitted(system: System, position: FloatArray) -> None:
    """Give the elements their lengths at a position."""
    if isinstance(system.frame, ByArcs):
        _fit(system.frame, system, position)


def base_coordinates(system: System, along: FloatArray) -> FloatArray:
    """Belt coordinates (m) by the lengths that elements have where no length of belt has gone over."""
    if not isinstance(system.frame, ByArcs):
        return along
    now, then = (np.append(0.0, np.cumsum(one)) for one in (system.length, system.frame.arcs.length))
    return np.asarray(np.interp(along, now, then))


def base_lengths(system: System) -> FloatArray:
    """Lengths of elements where no length of belt has gone over, m."""
    return system.frame.arcs.length if isinstance(system.frame, ByArcs) else system.length


def recorded_lengths(system: System) -> FloatArray:
    """Lengths of the curves between the belt coordinates of results, m; over time those of `base_lengths`."""
    return system.frame.arcs.length if isinstance(system.frame, FlowingByArcs) else curve_lengths(system)


MESH_LENGTHS, MESH_SHIFTS = "mesh_lengths", "mesh_shifts"
"""Attributes of results on such a mesh: lengths of elements where no length of belt has gone over, and shifts, m."""


def shifts_of(frame: Any) -> FloatArray:
    """Shifts of a mesh in steady running or at rest, m; none of another mesh."""
    return frame.shift if isinstance(frame, StayingByArcs) else np.zeros(0)


def mesh_attributes(system: System) -> dict[str, FloatArray]:
    """What results tell of a mesh that stays at every arc; nothing of another one."""
    if not isinstance(system.frame, StayingByArcs):
        return {}
    return {MESH_LENGTHS: system.frame.arcs.length.copy(), MESH_SHIFTS: system.frame.shift.copy()}


def lengths_of(dataset: "xr.Dataset", prepared: Prepared) -> FloatArray:
    """Lengths of the elements of a result where no length of belt has gone over, m."""
    lengths = dataset.attrs.get(MESH_LENGTHS)
    if lengths is not None:
        return np.asarray(lengths)
    nodes = dataset["node_coordinate"].values
    return np.asarray(np.diff(nodes) if prepared.ends else np.diff(nodes, append=prepared.belt_length))


def passed_at(system: System, ways: ComplexArray, along: FloatArray) -> ComplexArray:
    """Lengths of belt that pass places along it (m), shape (q,), from the ways of bodies, the last of which is flow."""
    passed = np.full(along.size, ways[-1])
    if isinstance(system.frame, FlowingByArcs):
        arcs = system.frame.arcs
        nodes = shifts_at_nodes(arcs.before, arcs.after, arcs.share, ways[-1 - arcs.node.size : -1])
        ends = np.append(0.0, np.cumsum(system.length))
        nodes = nodes if nodes.size == ends.size else np.append(nodes, nodes[0])
        passed += np.interp(along, ends, nodes.real) + 1j * np.interp(along, ends, nodes.imag)
    return passed


def arc_count(frame: Any) -> int:
    """Number of arcs at which a mesh stays beside node 0."""
    return len(frame.arcs.node) if isinstance(frame, ByArcs) else 0


# What holds the mesh at its arcs


@kernel(inline=True)
def first_arc(frame: Any, border: int) -> int:
    """Place of the first shift in a border, which ends with the flow at node 0."""
    return int(border - 1 - frame.arcs.node.size)


@kernel
def _hold_arcs(
    frame: Any, system: System, motion: Motion, factors: TangentFactors, moving: bool, matrix: RingMatrix
) -> None:
    """Let the node of each arc keep its place along the belt, against the center of its pulley.

    Of accelerations where the mesh is moving, or of places. The third derivative of a center is left out.
    """
    arcs, first = frame.arcs, first_arc(frame, matrix.corner.shape[0])
    dof = len(system.scale)
    tie = factors.by_acceleration if factors.by_acceleration != 0.0 else factors.by_position
    for arc in range(arcs.node.size):
        node, row, value = arcs.node[arc], first + arc, 0.0
        tx, ty = arcs.direction[arc]
        for axis in range(2):
            t, i = arcs.direction[arc, axis], dof * node + axis
            value += t * (motion.acceleration[i] if moving else motion.position[i] - arcs.place[arc, axis])
            if tie != 0.0:
                matrix.row[node, row, axis] = tie * t
        if arcs.carrier[arc] >= 0:
            at = tensioner_coordinate(system, arcs.carrier[arc])
            item = system.tensioners[arcs.carrier[arc]]
            center = tensioner_center(item, motion.position[at])
            along, bend = tx * center.dx + ty * center.dy, tx * center.ddx + ty * center.ddy
            change = tie * along
            if moving:
                speed, rate = motion.velocity[at], motion.acceleration[at]
                value -= along * rate + bend * speed * speed
                if factors.by_acceleration != 0.0:
                    change += bend * (2.0 * factors.by_velocity * speed + factors.by_position * rate)
            else:
                zero = tensioner_center(item, 0.0)
                value -= tx * (center.x - zero.x) + ty * (center.y - zero.y)
            unknown = system.bodies[at - system.first_body].unknown
            if unknown >= 0 and tie != 0.0:
                matrix.corner[row, unknown] = -change
        matrix.border_side[row] = value


@kernel(inline=True)
def _hold_none(
    frame: Any, system: System, motion: Motion, factors: TangentFactors, moving: bool, matrix: RingMatrix
) -> None:
    """Node 0 alone is held."""


hold_arcs: Callable[..., None] = by_type(
    {Travelling: _hold_none, Staying: _hold_none, Flowing: _hold_none}
    | {StayingByArcs: _hold_arcs, FlowingByArcs: _hold_arcs},
    "hold_arcs",
)
"""Let the mesh keep its place at every arc; the frame comes first."""


@kernel(inline=True)
def _hold_by_arc(frame: StayingByArcs, direction: FloatArray, matrix: RingMatrix) -> None:
    holding, last = frame.arcs.holding, matrix.corner.shape[0] - 1
    matrix.corner[:, last] = 0.0
    for node in range(holding.shape[0]):
        for axis in range(2):
            matrix.column[node, axis, last] = holding[node, axis]


@kernel(inline=True)
def _hold_by_node(frame: Staying, direction: FloatArray, matrix: RingMatrix) -> None:
    for axis in range(2):
        matrix.column[0, axis, matrix.corner.shape[0] - 1] = direction[axis]


add_holding_force: Callable[[Any, FloatArray, RingMatrix], None] = by_type(
    {Staying: _hold_by_node, StayingByArcs: _hold_by_arc}, "add_holding_force"
)
"""The force that holds a belt at rest, as last unknown: on node 0 along a direction, or at the arc of the driver."""


@kernel
def _change_shifts(frame: StayingByArcs, border_part: FloatArray, factor: float) -> None:
    first = first_arc(frame, border_part.size)
    for arc in range(frame.shift.size):
        frame.shift[arc] += factor * border_part[first + arc]


@kernel(inline=True)
def _no_shifts(frame: Staying, border_part: FloatArray, factor: float) -> None:
    """No length of belt goes over."""


change_shifts: Callable[[Any, FloatArray, float], None] = by_type(
    {Staying: _no_shifts, StayingByArcs: _change_shifts}, "change_shifts"
)
"""Add factor times their part of a solution to the shifts of a mesh."""


@kernel
def _largest_shift(frame: StayingByArcs, border_part: FloatArray) -> float:
    first, largest = first_arc(frame, border_part.size), 0.0
    for arc in range(frame.shift.size):
        largest = max(largest, abs(border_part[first + arc]))
    return largest


@kernel(inline=True)
def _none_largest(frame: Staying, border_part: FloatArray) -> float:
    return 0.0


largest_shift: Callable[[Any, FloatArray], float] = by_type(
    {Staying: _none_largest, StayingByArcs: _largest_shift}, "largest_shift"
)
"""Largest change of a shift in a solution, m."""

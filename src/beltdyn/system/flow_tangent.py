"""An element through which the belt flows: losses, contact, equations of motion, and their tangents.

Losses and contact depend on the vectors e of the element and on the velocity v = de/dt + c D e of its material points,
with c the speed of the belt through the mesh.  With F_e and F_v their derivatives by both, what moves e, de/dt and c by
p, q and r times a change of the unknowns has the tangent p F_e + F_v (q + p c D), and for c the column r F_v D e.

In a mesh that stays at every arc the belt passes an element at w = w_i + (w_j - w_i) xi.  With e the vectors of the
element, those of velocity and acceleration of its material points are

    v = de/dt + A e,   a = dv/dt + A v,   A = w_i D + (w_j - w_i) G,

where D e are vectors of dr/dsigma, and G e those of xi dr/dsigma, less what the growing element does to derivatives.
In the tangent, derivatives of D and G by the length of the element are left out, and those of inertia, weight and
bending: shifts change stretch above all.
"""

from collections.abc import Callable
from typing import Any, Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import ContactFactors, contact_force
from beltdyn.elements.kind import DampingFactors
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import first_arc
from beltdyn.system.arrays import BENDING_LOSS, STRETCH_LOSS, Equations, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.body_forces import add_contact, differentiates_forces
from beltdyn.system.carrying import CarryingFactors, add_carried, find_accelerations
from beltdyn.system.element_state import centreline, couple_rim, loses_in_belt, material_forces, reaches, take_contact
from beltdyn.system.frame import (
    ArcMesh,
    Flowing,
    FlowingByArcs,
    Staying,
    StayingByArcs,
    Travelling,
    element_speed,
    flow_at_ends,
)
from beltdyn.system.material_loss import add_hysteresis_flow
from beltdyn.system.moving_center import couple_center, keep_drift, moving_center, pulley_state


class FlowFactors(NamedTuple):
    """What a unit of the unknowns changes; with all of them zero no tangent is wanted."""

    place: float = 0.0
    """p, of the vectors, and of places of tensioners."""
    rate: float = 0.0
    """q, of their rates, 1/s."""
    flow: float = 0.0
    """r, of the speed of the belt."""
    turning: float = 0.0
    """Of the speeds of pulleys, 1/s; their angles change by p."""
    secant: bool = False
    """Friction changes by its secant from no slip, in place of its slope."""


NO_FLOW_TANGENT: Final = FlowFactors()


@kernel(inline=True)
def find_rate(system: System, element: int, work: np.record) -> None:
    """Vectors D e of an element."""
    derivative, e, vectors = system.frame.derivative[element], work.coordinates[0], system.vectors
    flow = work.flow
    for a in range(len(vectors)):
        for axis in range(2):
            flow.rate[a, axis] = 0.0
            for b in range(len(vectors)):
                flow.rate[a, axis] += derivative[a, b] * e[vectors[b] + axis]


@kernel
def add_flow_forces(system: System, motion: Motion, element: int, factors: FlowFactors, equations: Equations) -> None:
    """Add losses of the material and contact to residual and tangent of an element.

    `system`: a closed belt in a staying mesh; `element`: which one; its coordinates and their rates are in the
    workspace; `factors`: of the tangent; `equations`: changed in place; the last unknown of the border is that of the
    flow. Its workspace has the rate D e, and the column so far.
    """
    if loses_in_belt(system):
        stretch, bending = _add_damping(system, motion, element, factors, equations.work)
        equations.forces.power[STRETCH_LOSS] += stretch
        equations.forces.power[BENDING_LOSS] += bending
    _add_contact(system, motion, element, factors, equations)


@kernel
def _add_damping(
    system: System, motion: Motion, element: int, factors: FlowFactors, work: np.record
) -> tuple[float, float]:
    """Add the losses of the belt's material, with their tangent through velocities; gives the powers lost, W."""
    own, flow, derivative = work.element, work.flow, system.frame.derivative[element]
    by_flow = factors.place * element_speed(system.frame, element, motion.velocity)
    own.by_flow[:] = 0.0
    lost = material_forces(system, element, DampingFactors(factors.place, factors.rate, by_flow, factors.secant), work)
    if factors.place != 0.0 or factors.rate != 0.0:
        if system.hysteresis.size > 0:
            add_hysteresis_flow(system.vectors, derivative, flow.rate, by_flow, work)
        for row in range(own.by_flow.size):
            flow.by_speed[row] += factors.flow * own.by_flow[row]
    return lost


@kernel
def _add_contact(system: System, motion: Motion, element: int, factors: FlowFactors, equations: Equations) -> None:
    """Take the contact forces off the residual of an element, and couple it to the pulleys it touches."""
    work, flow, matrix = equations.work, equations.work.flow, equations.matrix
    law, rule = system.law, system.contact
    wanted, piece = factors.place != 0.0 or factors.rate != 0.0, centreline(system, element, 0, work)
    by_slope = factors.place * element_speed(system.frame, element, motion.velocity)
    by = ContactFactors(factors.place, factors.rate, factors.turning, by_slope, factors.flow, factors.secant)
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if not reaches(system, element, 0, pulley, work):
            continue
        center = moving_center(system, p, motion.position, motion.velocity)
        drifting = factors.rate != 0.0 and center.unknown >= 0 and center.turning
        if drifting:
            contact_force(piece, pulley, law, rule, ContactFactors(0.0, 1.0, 0.0, 0.0, 0.0, False), work.contact)
            keep_drift(system, center, work.contact, work.drift)
        add_contact(equations.forces, p, contact_force(piece, pulley, law, rule, by, work.contact))
        take_contact(system, wanted, work)
        if not wanted:
            continue
        if center.rim >= 0:
            matrix.corner[center.rim, center.rim] -= work.contact.moment_by_turn
            couple_rim(system, element, center.rim, work.contact, matrix)
        if center.unknown >= 0:
            drift = factors.place if drifting else 0.0
            couple_center(system, element, center, drift, work.contact, work.drift, matrix)
        x = y = 0.0
        for a in range(len(system.vectors)):
            fx, fy = work.contact.by_flow[a, 0], work.contact.by_flow[a, 1]
            flow.by_speed[system.vectors[a]] -= fx
            flow.by_speed[system.vectors[a] + 1] -= fy
            x, y = x + system.shift[a] * fx, y + system.shift[a] * fy
        if center.rim >= 0:
            _add_by_flow(system.frame, matrix, element, center.rim, -work.contact.moment_by_flow)
        if center.unknown >= 0:
            _add_by_flow(system.frame, matrix, element, center.unknown, x * center.x + y * center.y)


@kernel(inline=True)
def _by_flow(frame: Any, matrix: RingMatrix, element: int, row: int, value: float) -> None:
    matrix.corner[row, matrix.corner.shape[0] - 1] += value


@kernel(inline=True)
def _by_flow_and_shift(frame: FlowingByArcs, matrix: RingMatrix, element: int, row: int, value: float) -> None:
    arcs, last = frame.arcs, matrix.corner.shape[0] - 1
    matrix.corner[row, last] += value
    for arc, share in ((arcs.before[element], 1.0 - arcs.share[element]), (arcs.after[element], arcs.share[element])):
        if arc >= 0:
            matrix.corner[row, last - arcs.node.size + arc] += share * value


_add_by_flow = by_type(
    {Staying: _by_flow, Flowing: _by_flow, StayingByArcs: _by_flow, FlowingByArcs: _by_flow_and_shift}, "add_by_flow"
)
"""Add a derivative by the flow on an element to the row of a body."""


@kernel(inline=True)
def scatter_column(system: System, element: int, equations: Equations) -> None:
    """Add the column of the flow of an element to that of its nodes."""
    matrix, flow = equations.matrix, equations.work.flow
    dof, node_j, last = len(system.scale), (element + 1) % system.nodes, matrix.corner.shape[0] - 1
    for c in range(dof):
        matrix.column[element, c, last] += flow.by_speed[c]
        matrix.column[node_j, c, last] += flow.by_speed[dof + c]


# An element of a staying mesh while the belt flows through it at a speed that changes: its equations of motion


@kernel(inline=True)
def flow_factors(factors: TangentFactors) -> FlowFactors:
    """Factors of the forces of an element through which the belt flows, for those of the equations of motion."""
    if not differentiates_forces(factors):
        return NO_FLOW_TANGENT
    place, rate = factors.by_position, factors.by_velocity
    return FlowFactors(place, rate, rate, rate, factors.secant)


@kernel
def flowing_element(
    frame: Flowing, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses and contact of an element through which the belt flows.

    `frame`: that of the system; `system`, `motion`, `factors`: as for `steady_assembly.assemble`; `element`: which one;
    position, velocity of its material points and second derivative over time of its coordinates are in the workspace,
    and residual and tangent are those of its elasticity; `equations`: changed in place.
    """
    work, flow = equations.work, equations.work.flow
    wanted, differentiated = factors.by_acceleration != 0.0 or differentiates_forces(factors), flow_factors(factors)
    find_rate(system, element, work)
    flow.by_speed[:] = 0.0
    _add_inertia(frame, system, motion, factors, element, wanted, work)
    add_flow_forces(system, motion, element, differentiated, equations)
    if wanted:
        scatter_column(system, element, equations)


@kernel(inline=True)
def _add_inertia(
    frame: Flowing,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    element: int,
    wanted: bool,
    work: np.record,
) -> None:
    """Add inertia to the residual of an element, make the tangent that of elasticity and inertia, begin the column."""
    flow, vectors = work.flow, system.vectors
    gradient, tangent = work.element.gradient, work.element.tangent
    derivative, second, mass = frame.derivative[element], frame.second[element], frame.mass[element]
    speed, change = motion.velocity[frame.place], motion.acceleration[frame.place]
    place, velocity, acceleration = work.coordinates[0], work.coordinates[1], work.coordinates[2]
    if wanted:
        for row in range(gradient.size):
            for column in range(gradient.size):
                tangent[row, column] *= factors.by_position
    for a in range(len(vectors)):
        for axis in range(2):
            turn, bend = 0.0, 0.0
            for b in range(len(vectors)):
                turn += derivative[a, b] * velocity[vectors[b] + axis]
                bend += second[a, b] * place[vectors[b] + axis]
            moved = acceleration[vectors[a] + axis] + 2.0 * speed * turn + change * flow.rate[a, axis]
            moved -= speed * speed * bend
            by_flow = factors.by_acceleration * flow.rate[a, axis] + 2.0 * factors.by_velocity * turn
            for k in range(len(vectors)):
                gradient[vectors[k] + axis] += mass[k, a] * moved
                flow.by_speed[vectors[k] + axis] += mass[k, a] * by_flow
        for b in range(len(vectors)):
            if wanted:
                part = 2.0 * factors.by_velocity * speed * derivative[a, b]
                part += factors.by_position * (change * derivative[a, b] + speed * speed * second[a, b])
                if a == b:
                    part += factors.by_acceleration
                for k in range(len(vectors)):
                    for axis in range(2):
                        tangent[vectors[k] + axis, vectors[b] + axis] += mass[k, a] * part


@kernel
def hold_mesh(frame: Flowing, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    """Let node 0 keep its place along the belt: of accelerations, or of steps where they do not move these.

    `frame`: of the mesh; `factors`: of the tangent; `matrix`: changed in place.
    """
    last = matrix.corner.shape[0] - 1
    tie = factors.by_acceleration if factors.by_acceleration != 0.0 else factors.by_position
    for axis in range(2):
        matrix.border_side[last] += frame.direction[axis] * motion.acceleration[axis]
        if tie != 0.0:
            matrix.row[0, last, axis] = tie * frame.direction[axis]


@kernel
def hold_nothing(frame: Travelling, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    """A travelling mesh is free."""


@kernel
def arcs_element(
    frame: FlowingByArcs, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses, contact, supports and goods of an element; arguments as for `flowing_element`."""
    work, flow = equations.work, equations.work.flow
    wanted, differentiated = factors.by_acceleration != 0.0 or differentiates_forces(factors), flow_factors(factors)
    find_rate(system, element, work)
    flow.by_speed[:], flow.by_end[:] = 0.0, 0.0
    node_j = (element + 1) % system.nodes
    if wanted and factors.by_position != 0.0 and not keeps_length(frame.arcs, element, node_j):
        by_length(system, element, factors.by_position, work)
    find_accelerations(frame, system, motion, element, work)
    _add_inertia_at_arcs(frame, system, motion, factors, element, wanted, work)
    if loses_in_belt(system) and differentiated.flow != 0.0 and not keeps_length(frame.arcs, element, node_j):
        _damping_by_end(system, element, differentiated, work)
    add_flow_forces(system, motion, element, differentiated, equations)
    by = CarryingFactors(factors.by_position, factors.by_velocity, factors.by_velocity, factors.by_acceleration)
    add_carried(system.carrying, system, motion, element, by, work, equations.forces)
    if wanted:
        scatter_column(system, element, equations)
        scatter_shifts(frame, system, element, work.flow.by_speed, equations)


@kernel(inline=True)
def keeps_length(arcs: ArcMesh, node_i: int, node_j: int) -> bool:
    """Whether shifts are the same at both nodes of an element, which then keeps its length."""
    return bool(arcs.share[node_i] == arcs.share[node_j] and arcs.before[node_i] == arcs.before[node_j])


@kernel
def by_length(system: System, element: int, by_position: float, work: np.record) -> None:
    """Begin the column of the shift at the second node with minus the derivative of stretching by the length."""
    own, e, vectors, length = work.element, work.coordinates[0], system.vectors, system.length[element]
    for a in range(len(vectors)):
        for axis in range(2):
            row = vectors[a] + axis
            total = (a % 3) * own.gradient[row]
            for b in range(len(vectors)):
                order = b % 3 - 1.0
                total += order * own.tangent[row, vectors[b]] * e[vectors[b]]
                total += order * own.tangent[row, vectors[b] + 1] * e[vectors[b] + 1]
            work.flow.by_end[row] = -by_position * total / length


@kernel
def _damping_by_end(system: System, element: int, factors: FlowFactors, work: np.record) -> None:
    """Add to the column of the shift at the second node the derivative of damping by its rate, F_v G e."""
    own, flow, vectors = work.element, work.flow, system.vectors
    for row in range(own.gradient.size):
        flow.gradient[row] = own.gradient[row]
        for column in range(own.gradient.size):
            flow.tangent[row, column], own.tangent[row, column] = own.tangent[row, column], 0.0
    material_forces(system, element, DampingFactors(0.0, 1.0, 0.0, factors.secant), work)
    for row in range(own.gradient.size):
        total = 0.0
        for b in range(len(vectors)):
            total += own.tangent[row, vectors[b]] * flow.grown[b, 0]
            total += own.tangent[row, vectors[b] + 1] * flow.grown[b, 1]
        flow.by_end[row] += factors.flow * total
        own.gradient[row] = flow.gradient[row]
    for row in range(own.gradient.size):
        for column in range(own.gradient.size):
            own.tangent[row, column] = flow.tangent[row, column]


@kernel(inline=True)
def _add_inertia_at_arcs(
    frame: FlowingByArcs,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    element: int,
    wanted: bool,
    work: np.record,
) -> None:
    """Add inertia to the residual of an element, make the tangent that of elasticity and inertia, begin the columns."""
    flow, vectors, mass = work.flow, system.vectors, system.mass[element]
    gradient, tangent = work.element.gradient, work.element.tangent
    derivative, growth = frame.derivative[element], frame.growth[element]
    for a in range(len(vectors)):
        for axis in range(2):
            moved = flow.moved[a, axis]
            for k in range(len(vectors)):
                gradient[vectors[k] + axis] += mass[vectors[k], vectors[a]] * moved
    if not wanted:
        return
    for row in range(gradient.size):
        for column in range(gradient.size):
            tangent[row, column] *= factors.by_position
    (first, last), (rise, top) = (
        flow_at_ends(frame, element, motion.velocity),
        flow_at_ends(frame, element, motion.acceleration),
    )
    change, bend = last - first, top - rise
    for a in range(len(vectors)):
        for b in range(len(vectors)):
            flow.powers[a, b] = 0.0
            for c in range(len(vectors)):
                left = first * derivative[a, c] + change * growth[a, c]
                flow.powers[a, b] += left * (first * derivative[c, b] + change * growth[c, b])
    velocity = work.coordinates[1]
    for a in range(len(vectors)):
        for b in range(len(vectors)):
            own = first * derivative[a, b] + change * growth[a, b]
            part = 2.0 * factors.by_velocity * own + factors.by_position * flow.powers[a, b]
            part += factors.by_position * (rise * derivative[a, b] + bend * growth[a, b])
            if a == b:
                part += factors.by_acceleration
            for k in range(len(vectors)):
                for axis in range(2):
                    tangent[vectors[k] + axis, vectors[b] + axis] += mass[vectors[k], vectors[a]] * part
        for axis in range(2):
            by_flow = factors.by_acceleration * flow.rate[a, axis]
            by_end = factors.by_acceleration * flow.grown[a, axis] + factors.by_velocity * flow.moved_by_end[a, axis]
            for b in range(len(vectors)):
                by_flow += 2.0 * factors.by_velocity * derivative[a, b] * velocity[vectors[b] + axis]
            for k in range(len(vectors)):
                flow.by_speed[vectors[k] + axis] += mass[vectors[k], vectors[a]] * by_flow
                flow.by_end[vectors[k] + axis] += mass[vectors[k], vectors[a]] * by_end


@kernel
def scatter_shifts(frame: Any, system: System, element: int, by_both: FloatArray, equations: Equations) -> None:
    """Add the columns of the shifts on an element to those of its nodes.

    `by_both` is the derivative of its residual by equal shifts of both nodes; that by the second one is in the
    workspace.
    """
    matrix, by_end, arcs = equations.matrix, equations.work.flow.by_end, frame.arcs
    dof, node_j, first = len(system.scale), (element + 1) % system.nodes, first_arc(frame, matrix.corner.shape[0])
    for arc in range(arcs.node.size):
        at_i, at_j = _share_of(arcs, element, arc), _share_of(arcs, node_j, arc)
        if at_i == 0.0 and at_j == 0.0:
            continue
        for c in range(dof):
            value = at_i * by_both[c] + (at_j - at_i) * by_end[c]
            other = at_i * by_both[dof + c] + (at_j - at_i) * by_end[dof + c]
            matrix.column[element, c, first + arc] += value
            matrix.column[node_j, c, first + arc] += other


@kernel(inline=True)
def _share_of(arcs: ArcMesh, node: int, arc: int) -> float:
    """Share of an arc in the shift of a node."""
    share = 0.0
    if arcs.before[node] == arc:
        share += 1.0 - arcs.share[node]
    if arcs.after[node] == arc:
        share += arcs.share[node]
    return share


@kernel
def _steady_shifts(frame: StayingByArcs, system: System, element: int, equations: Equations) -> None:
    """Add the columns of the shifts in steady running, by stretching and momentum of an element."""
    node_j, work = (element + 1) % system.nodes, equations.work
    if keeps_length(frame.arcs, element, node_j):
        return
    by_length(system, element, 1.0, work)
    work.coordinates[2, :] = 0.0
    scatter_shifts(frame, system, element, work.coordinates[2], equations)


@kernel(inline=True)
def _no_shifts(frame: Staying, system: System, element: int, equations: Equations) -> None:
    """Elements keep their lengths."""


add_steady_shifts: Callable[[Any, System, int, Equations], None] = by_type(
    {Staying: _no_shifts, StayingByArcs: _steady_shifts}, "add_steady_shifts"
)
"""Add the columns of shifts in steady running, from residual and tangent of stretch and momentum of an element."""

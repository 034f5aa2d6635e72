"""An element of a mesh that stays at every arc: its equations of motion, and its derivatives by shifts of the mesh.

The belt passes an element at w = w_i + (w_j - w_i) xi.  With e the vectors of the element, those of velocity and
acceleration of its material points are

    v = de/dt + A e,   a = dv/dt + A v,   A = w_i D + (w_j - w_i) G,

where D e are vectors of dr/dsigma, and G e those of xi dr/dsigma, less what the growing element does to derivatives.
In the tangent, derivatives of D and G by the length of the element are left out, and those of inertia, weight and
bending: shifts change stretch above all.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import first_arc
from beltdyn.system.arrays import Equations, Motion, System, TangentFactors
from beltdyn.system.body_forces import differentiates_forces
from beltdyn.system.carrying import CarryingFactors, add_carried, find_accelerations
from beltdyn.system.flow_tangent import add_flow_forces, find_rate, flow_factors, scatter_column
from beltdyn.system.frame import ArcMesh, FlowingByArcs, Staying, StayingByArcs, flow_at_ends


@kernel
def arcs_element(
    frame: FlowingByArcs, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses, contact, supports and goods of an element.

    Parameters
    ----------
    frame
        That of the system.
    system, motion, factors
        As for `steady_assembly.assemble`.
    element
        Which one; position, velocity of its material points and second derivative over time of its coordinates are in
        the workspace, and residual and tangent are those of its elasticity.
    equations
        Changed in place.
    """
    work, flow = equations.work, equations.work.flow
    wanted, differentiated = factors.by_acceleration != 0.0 or differentiates_forces(factors), flow_factors(factors)
    find_rate(system, element, work)
    flow.by_speed[:], flow.by_end[:] = 0.0, 0.0
    if wanted and factors.by_position != 0.0 and not keeps_length(frame.arcs, element, (element + 1) % system.nodes):
        by_length(system, element, factors.by_position, work)
    find_accelerations(frame, system, motion, element, work)
    _add_inertia(frame, system, motion, factors, element, wanted, work)
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


@kernel(inline=True)
def _add_inertia(
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
            by_flow, by_end = factors.by_acceleration * flow.rate[a, axis], 0.0
            for b in range(len(vectors)):
                turn = 2.0 * factors.by_velocity * velocity[vectors[b] + axis]
                by_flow += derivative[a, b] * turn
                by_end += growth[a, b] * (turn + factors.by_acceleration * work.coordinates[0, vectors[b] + axis])
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

"""Equations of steady running in a staying mesh: residual and exact tangent.

dU/de + dR/dv - c^2 C e - Q_c(e, v, omega) - F = 0,   v = c D e     belt
moment + T_a = 0                                             free bodies
t . (r_0 - p) = 0                                            node 0 keeps its place along the belt

Unknowns are e, the speeds of free pulleys, states of controllers, places of tensioners, and c.  What depends on
velocities has the tangent
d/de + c (d/dv) D, and the column (d/dv) D e of c.  At rest a force along t on node 0 is unknown
in the place of c.  A belt with teeth has other unknowns (`beltdyn.system.meshing`).

Equations of motion of belt and bodies: residual and exact tangent (Eqs. 23, 25 and 27).

M a + dU/de + dR/dv - Q_c(e, v, omega) - F + C^T lambda = 0        belt
I domega/dt - moment - T_a = 0                              free bodies (Eq. 23)
C a = 0                                                      joint, where the ring is closed by multipliers (Eq. 25)

In a staying mesh a is the acceleration of material points (`flowing_element`).
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import ContactFactors, contact_force
from beltdyn.elements import elastic_force
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import add_holding_force, fit_mesh, hold_arcs
from beltdyn.system.arrays import (
    NO_TANGENT,
    BodyForces,
    Equations,
    Motion,
    NoCarriage,
    RingMatrix,
    System,
    TangentFactors,
)
from beltdyn.system.body_forces import (
    add_contact,
    add_machines,
    clear_body_forces,
    controls,
    differentiates_forces,
    new_body_forces,
)
from beltdyn.system.carrying import CarryingFactors, add_carrying
from beltdyn.system.element_state import (
    add_material_damping,
    add_nodal_loads,
    centreline,
    couple_rim,
    element_workspace,
    gather,
    gather_motion,
    hold_fixed,
    reaches,
    scatter,
    take_contact,
)
from beltdyn.system.flow_tangent import (
    NO_FLOW_TANGENT,
    FlowFactors,
    add_flow_forces,
    add_steady_shifts,
    arcs_element,
    find_rate,
    flowing_element,
    hold_mesh,
    hold_nothing,
    scatter_column,
)
from beltdyn.system.frame import Flowing, FlowingByArcs, Travelling
from beltdyn.system.guide import carry_ends
from beltdyn.system.meshing import add_steady_machines, clear_last_row, flow_unknown
from beltdyn.system.moving_center import couple_center, keep_drift, moving_center, pulley_state
from beltdyn.system.ring_matrix import clear, ring_matrix
from beltdyn.system.state import State
from beltdyn.system.web import WebLine, hold_web


def border_size(system: System) -> int:
    """Unknowns beside the nodes: free bodies, and the multipliers of the joint where there is one."""
    free = int(np.count_nonzero(system.bodies.unknown >= 0))
    return free + (len(system.scale) if system.joint else 0)


@kernel
def assemble(
    system: System, motion: Motion, multipliers: FloatArray, factors: TangentFactors, equations: Equations
) -> None:
    """Residual of the equations of motion and its tangent at a state.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    motion
        The state; prescribed bodies must already have their motion in it (`prescribed.prescribe`).
    multipliers : ndarray, shape (n,)
        Lagrange multipliers of the joint; ignored without joint.
    factors
        What the tangent is the sum of; where all of them are zero it is kept as it is.
    equations
        Its residual and body forces are overwritten, and the tangent if it is wanted; the solution is left as it is.
    """
    work, matrix, forces = equations.work, equations.matrix, equations.forces
    wanted = factors.by_acceleration != 0.0 or differentiates_forces(factors)
    clear(matrix, wanted)
    clear_body_forces(forces)
    fit_mesh(system.frame, system, motion.position)
    for element in range(system.length.size):
        gather_motion(system, element, motion.position, motion.velocity, work.coordinates)
        gather(system, element, motion.acceleration, work.coordinates[2])
        elastic_force(system.element, work.coordinates[0], system.length[element], wanted, work.element)
        _add_element(system.frame, system, motion, factors, element, equations)
        scatter(system, element, wanted, work, matrix)
    add_machines(system, motion, factors, matrix.corner, forces)
    _bodies(system, motion.acceleration, factors.by_acceleration, matrix, forces)
    _hold_mesh(system.frame, motion, factors, matrix)
    hold_arcs(system.frame, system, motion, factors, True, matrix)
    if system.joint:
        _joint(system, motion.acceleration, multipliers, factors.by_acceleration, wanted, matrix)
    add_nodal_loads(system, motion.position, factors.by_position, matrix)
    if system.supports.any_fixed:
        hold_fixed(system, matrix)
    carry_ends(system.carriage, system, motion, factors, wanted, matrix)


@kernel(inline=True)
def _travelling_element(
    frame: Travelling, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses and contact of an element that travels with the belt."""
    wanted = factors.by_acceleration != 0.0 or differentiates_forces(factors)
    _add_inertia(system, element, factors, wanted, equations.work)
    add_material_damping(system, element, factors, equations.work, equations.forces)
    for curve in range(system.control.shape[1]):
        _contact(system, motion, factors, element, curve, equations)


@kernel(inline=True)
def _add_inertia(system: System, element: int, factors: TangentFactors, wanted: bool, work: np.record) -> None:
    """Add inertia to the residual of an element, and make the tangent that of elasticity and inertia."""
    gradient, whole = work.element.gradient, work.element.tangent
    dof, mass, acceleration = len(system.scale), system.mass[element], work.coordinates[2]
    for row in range(2 * dof):
        total = 0.0
        for column in range(2 * dof):
            total += mass[row, column] * acceleration[column]
        gradient[row] += total
        if wanted:
            for column in range(2 * dof):
                whole[row, column] = (
                    factors.by_position * whole[row, column] + factors.by_acceleration * mass[row, column]
                )


@kernel(inline=True)
def _contact(
    system: System, motion: Motion, factors: TangentFactors, element: int, curve: int, equations: Equations
) -> None:
    """Take the contact forces of a curve off the residual of its element, and couple it to the pulleys it touches."""
    work, matrix = equations.work, equations.matrix
    wanted, piece = differentiates_forces(factors), centreline(system, element, curve, work)
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if not reaches(system, element, curve, pulley, work):
            continue
        center = moving_center(system, p, motion.position, motion.velocity)
        drifting = center.unknown >= 0 and factors.by_position != 0.0 and center.turning
        rounds = 2 if drifting else 1
        for last in range(2 - rounds, 2):
            by_position = factors.by_position if last == 1 else 0.0
            by_velocity = factors.by_velocity if last == 1 else 1.0
            totals = contact_force(
                piece,
                pulley,
                system.law,
                system.contact,
                ContactFactors(by_position, by_velocity, by_velocity, 0.0, 0.0, factors.secant),
                work.contact,
            )
            if last == 0:
                keep_drift(system, center, work.contact, work.drift)
        take_contact(system, wanted, work)
        add_contact(equations.forces, p, totals)
        if center.rim >= 0 and wanted:
            matrix.corner[center.rim, center.rim] -= work.contact.moment_by_turn
            couple_rim(system, element, center.rim, work.contact, matrix)
        if center.unknown >= 0 and wanted:
            factor = factors.by_position if drifting else 0.0
            couple_center(system, element, center, factor, work.contact, work.drift, matrix)


_add_element = by_type(
    {Travelling: _travelling_element, Flowing: flowing_element, FlowingByArcs: arcs_element}, "add_element"
)
"""Add inertia, losses and contact to residual and tangent of an element, which are those of its elasticity."""

_hold_mesh = by_type({Travelling: hold_nothing, Flowing: hold_mesh, FlowingByArcs: hold_mesh}, "hold_mesh")
"""Keep a staying mesh in its place along the belt."""


@kernel(inline=True)
def _bodies(
    system: System, acceleration: FloatArray, by_acceleration: float, matrix: RingMatrix, forces: BodyForces
) -> None:
    """Motion of the free bodies (Eq. 23)."""
    bodies, first = system.bodies, system.first_body
    for body in range(bodies.size):
        unknown = bodies[body].unknown
        if unknown >= 0:
            matrix.corner[unknown, unknown] += by_acceleration * bodies[body].inertia
            matrix.border_side[unknown] = bodies[body].inertia * acceleration[first + body] - forces.force[body]


@kernel(inline=True)
def _joint(
    system: System,
    acceleration: FloatArray,
    multipliers: FloatArray,
    by_acceleration: float,
    wanted: bool,
    matrix: RingMatrix,
) -> None:
    """Tie the last node to the first (Eq. 25): forces +-lambda on them, equal accelerations; at rest, equal steps."""
    dof, last = len(system.scale), system.nodes - 1
    first_unknown = matrix.corner.shape[0] - dof
    tie = by_acceleration if by_acceleration != 0.0 else 1.0
    for c in range(dof):
        matrix.node_side[0, c] += multipliers[c]
        matrix.node_side[last, c] -= multipliers[c]
        matrix.border_side[first_unknown + c] = acceleration[c] - acceleration[dof * last + c]
        if not wanted:
            continue
        matrix.column[0, c, first_unknown + c] = 1.0
        matrix.column[last, c, first_unknown + c] = -1.0
        matrix.row[0, first_unknown + c, c] = tie
        matrix.row[last, first_unknown + c, c] = -tie


class Anchor(NamedTuple):
    """What keeps the mesh in its place along the belt."""

    place: FloatArray
    """p, where node 0 is held, m, shape (2,)."""
    direction: FloatArray
    """t, unit vector along the belt there, shape (2,)."""
    at_rest: bool
    """Whether the belt stands still."""


def anchor_at(state: State, at_rest: bool) -> Anchor:
    """Hold node 0 where it is along the belt."""
    slope = state.position[2:4]
    return Anchor(state.position[:2].copy(), slope / np.hypot(*slope), at_rest)


@kernel
def assemble_steady(system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations) -> None:
    """Residual of the equations of steady running, and its tangent.

    `system`: a closed belt in a staying mesh, or a web line; unknowns of its bodies are the speeds of pulleys, the
    states of controllers, and the places of tensioners; `motion`: the state; its nodes and tensioners have no velocity;
    `anchor`: what keeps the mesh in place; `wanted`: whether the tangent is wanted; `equations`: with one unknown more
    than the system's bodies have, two of a web line. Residual and body forces are overwritten, and the tangent if it is
    wanted.
    """
    work, matrix, forces = equations.work, equations.matrix, equations.forces
    clear(matrix, wanted)
    clear_body_forces(forces)
    fit_mesh(system.frame, system, motion.position)
    of_flow = FlowFactors(1.0, 0.0, flow_unknown(system.rims), 1.0, False) if wanted else NO_FLOW_TANGENT
    of_carrying = CarryingFactors(of_flow.place, of_flow.rate, of_flow.flow, 0.0)
    for element in range(system.length.size):
        gather_motion(system, element, motion.position, motion.velocity, work.coordinates)
        elastic_force(system.element, work.coordinates[0], system.length[element], wanted, work.element)
        find_rate(system, element, work)
        _add_momentum(system, element, work)
        if wanted:
            add_steady_shifts(system.frame, system, element, equations)
        add_flow_forces(system, motion, element, of_flow, equations)
        add_carrying(system.carrying, system, motion, element, of_carrying, work, forces)
        scatter(system, element, wanted, work, matrix)
        if wanted and not anchor.at_rest and flow_unknown(system.rims) != 0.0:
            scatter_column(system, element, equations)
    factors = TangentFactors(1.0, 1.0, 0.0, False) if wanted else NO_TANGENT
    add_steady_machines(system.rims, system, motion, factors, matrix.corner, forces)
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            matrix.border_side[unknown] -= forces.force[body]
            if wanted and controls(system.bodies[body]):
                matrix.corner[unknown, unknown] -= 1.0  # its value is unknown, not its rate, which is zero
    add_nodal_loads(system, motion.position, factors.by_position, matrix)
    if wanted:
        clear_last_row(system.rims, matrix)
    if system.supports.any_fixed:
        hold_fixed(system, matrix)
    _hold(system.carriage, system, motion, anchor, wanted, equations)
    hold_arcs(system.frame, system, motion, factors, False, matrix)


@kernel(inline=True)
def _add_momentum(system: System, element: int, work: np.record) -> None:
    """Take c^2 C e off the residual of an element, and begin its column of c with -2 c C e."""
    inertia, e, vectors = system.frame.inertia[element], work.coordinates[0], system.vectors
    speed, flow = system.frame.speed[0], work.flow
    flow.by_speed[:] = 0.0
    for a in range(len(vectors)):
        for b in range(len(vectors)):
            row, column, part = vectors[a], vectors[b], inertia[a, b]
            for axis in range(2):
                work.element.gradient[row + axis] -= speed * speed * part * e[column + axis]
                work.element.tangent[row + axis, column + axis] -= speed * speed * part
                flow.by_speed[row + axis] -= 2.0 * speed * part * e[column + axis]


@kernel(inline=True)
def _hold_belt(
    carriage: NoCarriage, system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations
) -> None:
    """The equation that keeps node 0 in its place along the belt."""
    matrix, last = equations.matrix, equations.matrix.corner.shape[0] - 1
    for axis in range(2):
        away = motion.position[axis] - anchor.place[axis]
        matrix.border_side[last] += anchor.direction[axis] * away
        if wanted:
            matrix.row[0, last, axis] = anchor.direction[axis]
    if wanted and anchor.at_rest:
        add_holding_force(system.frame, anchor.direction, matrix)


@kernel(inline=True)
def _hold_line(
    line: WebLine, system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations
) -> None:
    """The equations of the ends of a web line, which keep the mesh in its place."""
    hold_web(line, system, motion, anchor.at_rest, wanted, equations)


_hold = by_type({NoCarriage: _hold_belt, WebLine: _hold_line}, "hold")
"""What keeps the mesh in its place."""


def new_equations(system: System) -> Equations:
    """Make the arrays for a system."""
    dof, border = len(system.scale), border_size(system)
    return Equations(
        ring_matrix(dof, system.nodes, border),
        np.zeros((system.nodes, dof)),
        np.zeros(border),
        new_body_forces(system),
        element_workspace(system),
    )


def no_multipliers(system: System) -> FloatArray:
    """Multipliers of a joint that transmits nothing, or where there is none, shape (n,)."""
    return np.zeros(len(system.scale))


@kernel
def subtract_solution(system: System, equations: Equations, factor: float, vector: FloatArray) -> None:
    """Take factor times the solution off a state vector.

    `equations`: with a solution; `factor`: dimensionless, or the factor between unknown and vector; `vector`:
    positions, velocities or accelerations, changed in place; prescribed bodies keep theirs, shape (n N + D,).
    """
    dof = len(system.scale)
    for node in range(system.nodes):
        for c in range(dof):
            vector[dof * node + c] -= factor * equations.node_part[node, c]
    first = system.first_body
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            vector[first + body] -= factor * equations.border_part[unknown]


@kernel
def subtract_multipliers(system: System, equations: Equations, factor: float, multipliers: FloatArray) -> None:
    """Take factor times the solution off the multipliers of the joint, if there is one."""
    if system.joint:
        dof = len(system.scale)
        first = equations.border_part.size - dof
        for c in range(dof):
            multipliers[c] -= factor * equations.border_part[first + c]

"""Equations of motion of belt and bodies: residual and exact tangent (Eqs. 23, 25 and 27).

M a + dU/de + dR/dv - Q_c(e, v, omega) - F + C^T lambda = 0        belt
I domega/dt - moment - T_a = 0                              free bodies (Eq. 23)
C a = 0                                                      joint, where the ring is closed by multipliers (Eq. 25)

In a staying mesh a is the acceleration of material points (`flowing_element`).
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import ContactFactors, contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.elements.dispatch import elastic_force
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import fit_mesh, hold_arcs
from beltdyn.system.arc_tangent import arcs_element
from beltdyn.system.arrays import BodyForces, Equations, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.body_forces import add_contact, add_machines, clear_body_forces, differentiates_forces
from beltdyn.system.element_state import add_material_damping, centreline, gather, gather_motion
from beltdyn.system.flow_tangent import flowing_element, hold_mesh, hold_nothing
from beltdyn.system.frame import Flowing, FlowingByArcs, Travelling
from beltdyn.system.guide import carry_ends
from beltdyn.system.moving_center import couple_center, keep_drift, moving_center, pulley_state
from beltdyn.system.ring_matrix import clear
from beltdyn.system.supports import add_nodal_loads, couple_rim, hold_fixed, scatter, take_contact


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
    carry_ends(system.carriage, system, motion, wanted, matrix)


@kernel(inline=True)
def _travelling_element(
    frame: Travelling, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses and contact of an element that travels with the belt."""
    wanted = factors.by_acceleration != 0.0 or differentiates_forces(factors)
    _add_inertia(system, element, factors, wanted, equations.work)
    add_material_damping(system, element, factors, equations.work, equations.forces)
    for curve in range(system.control.shape[1]):
        piece = centreline(system, element, curve, equations.work)
        _contact(system, motion, factors, element, piece, equations)


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
    system: System, motion: Motion, factors: TangentFactors, element: int, piece: Curve, equations: Equations
) -> None:
    """Take the contact forces of a curve off the residual of its element, and couple it to the pulleys it touches."""
    work, matrix = equations.work, equations.matrix
    wanted = differentiates_forces(factors)
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if out_of_reach(piece.control, pulley):
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

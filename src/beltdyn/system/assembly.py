"""Equations of motion of belt and bodies: residual and exact tangent (Eqs. 23, 25 and 27).

M a + dU/de + dR/dv - Q_c(e, v, omega) - F + C^T lambda = 0        belt
I domega/dt - moment - T_a = 0                              free bodies (Eq. 23)
C a = 0                                                      joint, where the ring is closed by multipliers (Eq. 25)
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import contact_force, contact_record
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.elements.dispatch import damping_force, elastic_force
from beltdyn.elements.section import is_damped
from beltdyn.kernel import kernel
from beltdyn.records import blank, record
from beltdyn.system.arrays import MATERIAL_LOSS, BodyForces, RingMatrix, System
from beltdyn.system.body_forces import add_contact, add_machines, clear_loads
from beltdyn.system.discretization import element_kind
from beltdyn.system.moving_center import couple_center, drift_record, keep_drift, moving_center
from beltdyn.system.pulley_state import pulley_state
from beltdyn.system.ring_matrix import clear
from beltdyn.system.supports import add_nodal_loads, hold_fixed


def assembly_workspace(system: System) -> np.record:
    """Make the scratch arrays of `assemble` for a system."""
    count, vectors = system.control.shape[2:]
    return blank(
        record(
            element=element_kind(system).workspace,  # residual and tangent of one element
            contact=contact_record(count, vectors),
            coordinates=f"(3,{2 * len(system.scale)})f8",  # position, velocity and acceleration of one element
            control=f"({count},2)f8",  # control points of a curve of the centreline
            control_velocity=f"({count},2)f8",
            drift=drift_record(vectors),  # by a change of the velocity of a pulley's centre
        )
    )


def border_size(system: System) -> int:
    """Unknowns beside the nodes: free bodies, and the multipliers of the joint where there is one."""
    free = int(np.count_nonzero(system.bodies.unknown >= 0))
    return free + (len(system.scale) if system.joint else 0)


@kernel
def assemble(
    system: System,
    time: float,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    multipliers: FloatArray,
    by_position: float,
    by_velocity: float,
    by_acceleration: float,
    work: np.record,
    matrix: RingMatrix,
    loads: BodyForces,
) -> None:
    """Residual of the equations of motion and its tangent at a state.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    time
        s; prescribed bodies must already have their motion in the state (`prescribed.prescribe`).
    position, velocity, acceleration : ndarray, shape (6 N + D,)
        State: nodal coordinates, then coordinates of bodies, and their rates.
    multipliers : ndarray, shape (6,)
        Lagrange multipliers of the joint; ignored without joint.
    by_position, by_velocity, by_acceleration : float
        The tangent is the sum of these times the derivatives with respect to position, velocity and acceleration,
        which is what an integrator needs whose unknown moves all three; with all three zero it is kept as it is.
    work
        Scratch arrays.
    matrix
        Overwritten: the residual as right-hand side, and the tangent if it is wanted.
    loads
        Overwritten: moments, hub forces, powers.
    """
    wanted = by_position != 0.0 or by_velocity != 0.0 or by_acceleration != 0.0
    clear(matrix, wanted)
    clear_loads(loads)
    damped = is_damped(system.element.section)
    for element in range(system.length.size):
        node_j = (element + 1) % system.nodes
        gather(system, element, position, work.coordinates[0])
        gather(system, element, velocity, work.coordinates[1])
        gather(system, element, acceleration, work.coordinates[2])
        _elastic_and_inertia(system, element, by_position, by_acceleration, wanted, work)
        if damped:
            loads.power[MATERIAL_LOSS] += damping_force(
                system.element,
                work.coordinates[0],
                work.coordinates[1],
                system.length[element],
                by_position,
                by_velocity,
                work.element,
            )
        for curve in range(system.control.shape[1]):
            _contact(system, element, curve, node_j, position, velocity, by_position, by_velocity, work, matrix, loads)
        _scatter(element, node_j, wanted, work, matrix)
    add_machines(system, time, position, velocity, acceleration, by_position, by_velocity, matrix.corner, loads)
    _bodies(system, acceleration, by_acceleration, matrix, loads)
    if system.joint:
        _joint(system, acceleration, multipliers, by_acceleration, wanted, matrix)
    add_nodal_loads(system, position, by_position, matrix)
    if system.supports.any_fixed:
        hold_fixed(system, matrix)


@kernel(inline=True)
def gather(system: System, element: int, vector: FloatArray, coordinates: FloatArray) -> None:
    """Coordinates of an element from those of its nodes.

    Parameters
    ----------
    system
        The system.
    element
        Which one.
    vector : ndarray, shape (n N + D,)
        Positions, velocities or accelerations.
    coordinates : ndarray, shape (2 n,)
        Overwritten.
    """
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for c in range(dof):
        coordinates[c] = vector[dof * element + c]
        coordinates[dof + c] = vector[dof * node_j + c]


@kernel(inline=True)
def _elastic_and_inertia(
    system: System, element: int, by_position: float, by_acceleration: float, wanted: bool, work: np.record
) -> None:
    """Overwrite residual and tangent of the element by those of elasticity and inertia."""
    elastic_force(system.element, work.coordinates[0], system.length[element], wanted, work.element)
    gradient, whole = work.element.gradient, work.element.tangent
    dof, mass, acceleration = len(system.scale), system.mass[element], work.coordinates[2]
    for row in range(2 * dof):
        total = 0.0
        for column in range(2 * dof):
            total += mass[row, column] * acceleration[column]
        gradient[row] += total
        if wanted:
            for column in range(2 * dof):
                whole[row, column] = by_position * whole[row, column] + by_acceleration * mass[row, column]


@kernel
def fill_control(system: System, element: int, curve: int, coordinates: FloatArray, points: FloatArray) -> None:
    """Control points of a curve of the centreline from the coordinates of its element.

    Parameters
    ----------
    system
        The system.
    element, curve
        Which curve of which element.
    coordinates : ndarray, shape (2 n,)
        Nodal coordinates (or velocities) of the element.
    points : ndarray, shape (n, 2)
        Overwritten.
    """
    control, vectors = system.control[element, curve], system.vectors
    for a in range(points.shape[0]):
        for axis in range(2):
            points[a, axis] = 0.0
            for b in range(len(vectors)):
                points[a, axis] += control[a, b] * coordinates[vectors[b] + axis]


@kernel(inline=True)
def _contact(
    system: System,
    element: int,
    curve: int,
    node_j: int,
    position: FloatArray,
    velocity: FloatArray,
    by_position: float,
    by_velocity: float,
    work: np.record,
    matrix: RingMatrix,
    loads: BodyForces,
) -> None:
    """Take the contact forces of a curve off the residual of its element, and couple it to the pulleys it touches."""
    fill_control(system, element, curve, work.coordinates[0], work.control)
    fill_control(system, element, curve, work.coordinates[1], work.control_velocity)
    bodies, wanted = system.bodies, by_position != 0.0 or by_velocity != 0.0
    piece = Curve(
        work.control,
        work.control_velocity,
        system.control[element, curve],
        system.length[element] / system.control.shape[1],
    )
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, position, velocity)
        if out_of_reach(work.control, pulley):
            continue
        center = moving_center(system, p, position, velocity)
        rounds = 2 if center.unknown >= 0 and by_position != 0.0 and center.turning else 1
        for last in range(2 - rounds, 2):
            totals = contact_force(
                piece,
                pulley,
                system.law,
                system.contact,
                by_position if last == 1 else 0.0,
                by_velocity if last == 1 else 1.0,
                work.contact,
            )
            if last == 0:
                keep_drift(system, center, work.contact, work.drift)
        _take_contact(system, wanted, work)
        add_contact(loads, p, totals)
        if bodies[p].unknown >= 0 and wanted:
            matrix.corner[bodies[p].unknown, bodies[p].unknown] -= work.contact.moment_by_turn
            _couple(system, element, node_j, bodies[p].unknown, work.contact, matrix)
        if center.unknown >= 0 and wanted:
            drifting = by_position if rounds == 2 else 0.0
            couple_center(
                system,
                element,
                node_j,
                bodies[p].unknown,
                center,
                drifting,
                work.contact,
                work.drift,
                matrix,
            )


@kernel(inline=True)
def _take_contact(system: System, wanted: bool, work: np.record) -> None:
    """Take contact force and tangent off the residual and tangent of the element."""
    contact, gradient, tangent = work.contact, work.element.gradient, work.element.tangent
    for a in range(len(system.vectors)):
        row = system.vectors[a]
        gradient[row] -= contact.force[a, 0]
        gradient[row + 1] -= contact.force[a, 1]
        if not wanted:
            continue
        for b in range(len(system.vectors)):
            column = system.vectors[b]
            tangent[row, column] -= contact.xx[a, b]
            tangent[row, column + 1] -= contact.xy[a, b]
            tangent[row + 1, column] -= contact.yx[a, b]
            tangent[row + 1, column + 1] -= contact.yy[a, b]


@kernel(inline=True)
def _couple(
    system: System,
    node_i: int,
    node_j: int,
    unknown: int,
    contact: np.record,
    matrix: RingMatrix,
) -> None:
    """Coupling of the element with angle and speed of a free pulley."""
    dof = len(system.scale)
    for a in range(len(system.vectors)):
        first = system.vectors[a]
        node, c = (node_i, first) if first < dof else (node_j, first - dof)
        for axis in range(2):
            matrix.column[node, c + axis, unknown] -= contact.by_turn[a, axis]
            matrix.row[node, unknown, c + axis] -= contact.moment[a, axis]


@kernel(inline=True)
def _scatter(i: int, j: int, wanted: bool, work: np.record, matrix: RingMatrix) -> None:
    """Add residual and tangent of the element between nodes i and j."""
    dof, gradient, tangent = len(matrix.unknowns), work.element.gradient, work.element.tangent
    for row in range(dof):
        matrix.node_side[i, row] += gradient[row]
        matrix.node_side[j, row] += gradient[dof + row]
        if not wanted:
            continue
        for column in range(dof):
            matrix.diagonal[i, row, column] += tangent[row, column]
            matrix.upper[i, row, column] += tangent[row, dof + column]
            matrix.lower[i, row, column] += tangent[dof + row, column]
            matrix.diagonal[j, row, column] += tangent[dof + row, dof + column]


@kernel(inline=True)
def _bodies(
    system: System, acceleration: FloatArray, by_acceleration: float, matrix: RingMatrix, loads: BodyForces
) -> None:
    """Motion of the free bodies (Eq. 23)."""
    bodies, first = system.bodies, system.first_body
    for body in range(bodies.size):
        unknown = bodies[body].unknown
        if unknown >= 0:
            matrix.corner[unknown, unknown] += by_acceleration * bodies[body].inertia
            matrix.border_side[unknown] = bodies[body].inertia * acceleration[first + body] - loads.force[body]


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

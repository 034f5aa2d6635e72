"""Equations of steady running in a mesh that stays: residual and exact tangent.

dU/de + dR/dv - c^2 C e - Q_c(e, v, omega) - F = 0,   v = c D e     belt
moment + T_a = 0                                             free bodies
t . (r_0 - p) = 0                                            node 0 keeps its place along the belt

Unknowns are e, the speeds of free pulleys, places of tensioners, and c.  What depends on velocities has the tangent
d/de + c (d/dv) D, and the column (d/dv) D e of c.  At rest a force along t on node 0 is unknown
in the place of c.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.elements.dispatch import elastic_force
from beltdyn.kernel import kernel
from beltdyn.records import record
from beltdyn.system.arrays import BENDING_LOSS, NO_TANGENT, STRETCH_LOSS, Equations, Motion, System, TangentFactors
from beltdyn.system.assembly import couple_rim, scatter, take_contact
from beltdyn.system.body_forces import add_contact, add_machines, clear_body_forces
from beltdyn.system.element_state import centreline, gather_motion, loses_in_belt, material_forces
from beltdyn.system.moving_center import couple_center, moving_center
from beltdyn.system.pulley_state import pulley_state
from beltdyn.system.ring_matrix import clear
from beltdyn.system.supports import add_nodal_loads


class Anchor(NamedTuple):
    """What keeps the mesh in its place along the belt."""

    place: FloatArray
    """p, where node 0 is held, m, shape (2,)."""
    direction: FloatArray
    """t, unit vector along the belt there, shape (2,)."""
    at_rest: bool
    """Whether the belt stands still."""


def flow_record(vectors: int, coordinates: int) -> np.dtype[np.void]:
    """Kind of the scratch arrays for the derivatives by velocity of one element.

    Parameters
    ----------
    vectors
        Number v of its vectors.
    coordinates
        Number 2 n of its coordinates.
    """
    square = f"({vectors},{vectors})f8"
    return record(
        xx=square,  # derivatives of contact forces by velocity, as in `contact_record`
        xy=square,
        yx=square,
        yy=square,
        moment=f"({vectors},2)f8",
        by_turn=f"({vectors},2)f8",
        moment_by_turn="f8",
        rate=f"({vectors},2)f8",  # vectors D e
        by_speed=f"{coordinates}f8",  # derivative of the residual with respect to c
        gradient=f"{coordinates}f8",  # residual and tangent of an element without damping
        tangent=f"({coordinates},{coordinates})f8",
    )


@kernel
def assemble_steady(
    system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations, flow: np.record
) -> None:
    """Residual of the equations of steady running, and its tangent.

    Parameters
    ----------
    system
        A closed belt in a mesh that stays; unknowns of its bodies are the speeds of pulleys and the places of
        tensioners.
    motion
        The state; its nodes and tensioners have no velocity.
    anchor
        What keeps the mesh in place.
    wanted
        Whether the tangent is.
    equations
        With one unknown more than the system's bodies have. Residual and body forces are overwritten, and the tangent
        if it is wanted.
    flow
        Scratch arrays, of the kind `flow_record`.
    """
    work, matrix, forces = equations.work, equations.matrix, equations.forces
    clear(matrix, wanted)
    clear_body_forces(forces)
    for element in range(system.length.size):
        gather_motion(system, element, motion.position, motion.velocity, work.coordinates)
        elastic_force(system.element, work.coordinates[0], system.length[element], wanted, work.element)
        _find_rate(system, element, work, flow)
        _add_momentum(system, element, work, flow)
        if loses_in_belt(system):
            stretch, bending = _add_damping(system, element, wanted, work, flow)
            forces.power[STRETCH_LOSS] += stretch
            forces.power[BENDING_LOSS] += bending
        _add_contact(system, motion, element, centreline(system, element, 0, work), wanted, equations, flow)
        scatter(system, element, wanted, work, matrix)
        if wanted and not anchor.at_rest:
            _scatter_column(system, element, equations, flow)
    factors = TangentFactors(1.0, 1.0, 0.0) if wanted else NO_TANGENT
    add_machines(system, motion, factors, matrix.corner, forces)
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            matrix.border_side[unknown] -= forces.force[body]
    add_nodal_loads(system, motion.position, factors.by_position, matrix)
    _hold(motion, anchor, wanted, equations)


@kernel(inline=True)
def _find_rate(system: System, element: int, work: np.record, flow: np.record) -> None:
    """Vectors D e of an element."""
    derivative, e, vectors = system.frame.derivative[element], work.coordinates[0], system.vectors
    for a in range(len(vectors)):
        for axis in range(2):
            flow.rate[a, axis] = 0.0
            for b in range(len(vectors)):
                flow.rate[a, axis] += derivative[a, b] * e[vectors[b] + axis]


@kernel(inline=True)
def _add_momentum(system: System, element: int, work: np.record, flow: np.record) -> None:
    """Take c^2 C e off the residual of an element, and begin its column of c with -2 c C e."""
    inertia, e, vectors = system.frame.inertia[element], work.coordinates[0], system.vectors
    speed = system.frame.speed[0]
    flow.by_speed[:] = 0.0
    for a in range(len(vectors)):
        for b in range(len(vectors)):
            row, column, part = vectors[a], vectors[b], inertia[a, b]
            for axis in range(2):
                work.element.gradient[row + axis] -= speed * speed * part * e[column + axis]
                work.element.tangent[row + axis, column + axis] -= speed * speed * part
                flow.by_speed[row + axis] -= 2.0 * speed * part * e[column + axis]


@kernel(inline=True)
def _copy(source: FloatArray, target: FloatArray) -> None:
    for k in range(source.size):
        target[k] = source[k]


@kernel
def _add_damping(system: System, element: int, wanted: bool, work: np.record, flow: np.record) -> tuple[float, float]:
    """Add the losses of the belt's material, with their tangent through velocities; gives the powers lost, W."""
    own, place, vectors = work.element, work.coordinates[0], system.vectors
    if wanted:
        _copy(own.gradient, flow.gradient)
        _copy(own.tangent.reshape(own.tangent.size), flow.tangent.reshape(own.tangent.size))
        own.tangent[:] = 0.0
        material_forces(system, element, 0.0, 1.0, work)
        derivative, speed = system.frame.derivative[element], system.frame.speed[0]
        for row in range(place.size):
            for b in range(len(vectors)):
                for axis in range(2):
                    by_rate = 0.0
                    for k in range(len(vectors)):
                        by_rate += own.tangent[row, vectors[k] + axis] * derivative[k, b]
                    flow.tangent[row, vectors[b] + axis] += speed * by_rate
                    flow.by_speed[row] += own.tangent[row, vectors[b] + axis] * flow.rate[b, axis]
        _copy(flow.gradient, own.gradient)
        _copy(flow.tangent.reshape(own.tangent.size), own.tangent.reshape(own.tangent.size))
    return material_forces(system, element, 1.0 if wanted else 0.0, 0.0, work)


@kernel
def _add_contact(
    system: System, motion: Motion, element: int, piece: Curve, wanted: bool, equations: Equations, flow: np.record
) -> None:
    """Take the contact forces off the residual of an element, and couple it to the pulleys it touches."""
    work, matrix, law, rule = equations.work, equations.matrix, system.law, system.contact
    last = matrix.corner.shape[0] - 1
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if out_of_reach(piece.control, pulley):
            continue
        if wanted:
            contact_force(piece, pulley, law, rule, 0.0, 1.0, work.contact)
            _keep_by_velocity(work.contact, flow)
        by_position = 1.0 if wanted else 0.0
        add_contact(equations.forces, p, contact_force(piece, pulley, law, rule, by_position, 0.0, work.contact))
        if wanted:
            _follow_flow(system, element, work.contact, flow)
        take_contact(system, wanted, work)
        if not wanted:
            continue
        center = moving_center(system, p, motion.position, motion.velocity)
        if center.rim >= 0:
            matrix.corner[center.rim, center.rim] -= work.contact.moment_by_turn
            couple_rim(system, element, center.rim, work.contact, matrix)
        if center.unknown >= 0:
            couple_center(system, element, center, 0.0, work.contact, work.drift, matrix)
        moment = x = y = 0.0
        for a in range(len(system.vectors)):
            fx = fy = 0.0
            for b in range(len(system.vectors)):
                fx += flow.xx[a, b] * flow.rate[b, 0] + flow.xy[a, b] * flow.rate[b, 1]
                fy += flow.yx[a, b] * flow.rate[b, 0] + flow.yy[a, b] * flow.rate[b, 1]
            flow.by_speed[system.vectors[a]] -= fx
            flow.by_speed[system.vectors[a] + 1] -= fy
            moment += flow.moment[a, 0] * flow.rate[a, 0] + flow.moment[a, 1] * flow.rate[a, 1]
            x, y = x + system.shift[a] * fx, y + system.shift[a] * fy
        if center.rim >= 0:
            matrix.corner[center.rim, last] -= moment
        if center.unknown >= 0:
            matrix.corner[center.unknown, last] += x * center.x + y * center.y


@kernel(inline=True)
def _keep_by_velocity(contact: np.record, flow: np.record) -> None:
    """Keep the derivatives of a contact by velocity."""
    count = contact.xx.shape[0]
    for a in range(count):
        for b in range(count):
            flow.xx[a, b], flow.xy[a, b] = contact.xx[a, b], contact.xy[a, b]
            flow.yx[a, b], flow.yy[a, b] = contact.yx[a, b], contact.yy[a, b]
        for axis in range(2):
            flow.moment[a, axis], flow.by_turn[a, axis] = contact.moment[a, axis], contact.by_turn[a, axis]
    flow.moment_by_turn = contact.moment_by_turn


@kernel(inline=True)
def _follow_flow(system: System, element: int, contact: np.record, flow: np.record) -> None:
    """Add to the derivatives by position those by velocity times c D, and put those by speed of the pulley in place."""
    speed, derivative = system.frame.speed[0], system.frame.derivative[element]
    count = len(system.vectors)
    for b in range(count):
        for k in range(count):
            part = speed * derivative[k, b]
            for a in range(count):
                contact.xx[a, b] += flow.xx[a, k] * part
                contact.xy[a, b] += flow.xy[a, k] * part
                contact.yx[a, b] += flow.yx[a, k] * part
                contact.yy[a, b] += flow.yy[a, k] * part
            contact.moment[b, 0] += flow.moment[k, 0] * part
            contact.moment[b, 1] += flow.moment[k, 1] * part
        contact.by_turn[b, 0], contact.by_turn[b, 1] = flow.by_turn[b, 0], flow.by_turn[b, 1]
    contact.moment_by_turn = flow.moment_by_turn


@kernel(inline=True)
def _scatter_column(system: System, element: int, equations: Equations, flow: np.record) -> None:
    """Add the column of c of an element to that of its nodes."""
    matrix = equations.matrix
    dof, node_j, last = len(system.scale), (element + 1) % system.nodes, matrix.corner.shape[0] - 1
    for c in range(dof):
        matrix.column[element, c, last] += flow.by_speed[c]
        matrix.column[node_j, c, last] += flow.by_speed[dof + c]


@kernel(inline=True)
def _hold(motion: Motion, anchor: Anchor, wanted: bool, equations: Equations) -> None:
    """The equation that keeps node 0 in its place along the belt."""
    matrix, last = equations.matrix, equations.matrix.corner.shape[0] - 1
    for axis in range(2):
        away = motion.position[axis] - anchor.place[axis]
        matrix.border_side[last] += anchor.direction[axis] * away
        if wanted:
            matrix.row[0, last, axis] = anchor.direction[axis]
            if anchor.at_rest:
                matrix.column[0, axis, last] = anchor.direction[axis]

"""Losses and contact of an element through which the belt flows, with their tangent.

These forces depend on the vectors e of the element and on the velocity v = de/dt + c D e of its material points, with c
the speed of the belt through the mesh.  With F_e and F_v their derivatives by both, what moves e, de/dt and c by
p, q and r times a change of the unknowns has the tangent p F_e + F_v (q + p c D), and for c the column r F_v D e.
"""

from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.kernel import kernel
from beltdyn.system.arrays import BENDING_LOSS, STRETCH_LOSS, Equations, Motion, System
from beltdyn.system.body_forces import add_contact
from beltdyn.system.coupling import couple_rim, take_contact
from beltdyn.system.element_state import centreline, loses_in_belt, material_forces
from beltdyn.system.frame import flow_speed
from beltdyn.system.moving_center import couple_center, keep_drift, moving_center
from beltdyn.system.pulley_state import pulley_state


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

    Parameters
    ----------
    system
        A closed belt in a mesh that stays.
    motion
        The state.
    element
        Which one; its coordinates and their rates are in the workspace.
    factors
        Of the tangent.
    equations
        Changed in place; the last unknown of the border is that of the flow. Its workspace has the rate D e, and the
        column so far.
    """
    if loses_in_belt(system):
        stretch, bending = _add_damping(system, motion, element, factors, equations.work)
        equations.forces.power[STRETCH_LOSS] += stretch
        equations.forces.power[BENDING_LOSS] += bending
    _add_contact(system, motion, element, factors, equations)


@kernel(inline=True)
def _copy(source: FloatArray, target: FloatArray) -> None:
    for k in range(source.size):
        target[k] = source[k]


@kernel
def _add_damping(
    system: System, motion: Motion, element: int, factors: FlowFactors, work: np.record
) -> tuple[float, float]:
    """Add the losses of the belt's material, with their tangent through velocities; gives the powers lost, W."""
    own, flow, place, vectors = work.element, work.flow, work.coordinates[0], system.vectors
    if factors.place != 0.0 or factors.rate != 0.0:
        _copy(own.gradient, flow.gradient)
        _copy(own.tangent.reshape(own.tangent.size), flow.tangent.reshape(own.tangent.size))
        own.tangent[:] = 0.0
        material_forces(system, element, 0.0, 1.0, work)
        convected, derivative = (
            factors.place * flow_speed(system.frame, motion.velocity),
            system.frame.derivative[element],
        )
        for row in range(place.size):
            for b in range(len(vectors)):
                for axis in range(2):
                    by_rate = 0.0
                    for k in range(len(vectors)):
                        by_rate += own.tangent[row, vectors[k] + axis] * derivative[k, b]
                    direct = own.tangent[row, vectors[b] + axis]
                    flow.tangent[row, vectors[b] + axis] += convected * by_rate + factors.rate * direct
                    flow.by_speed[row] += factors.flow * direct * flow.rate[b, axis]
        _copy(flow.gradient, own.gradient)
        _copy(flow.tangent.reshape(own.tangent.size), own.tangent.reshape(own.tangent.size))
    return material_forces(system, element, factors.place, 0.0, work)


@kernel
def _add_contact(system: System, motion: Motion, element: int, factors: FlowFactors, equations: Equations) -> None:
    """Take the contact forces off the residual of an element, and couple it to the pulleys it touches."""
    work, flow, matrix = equations.work, equations.work.flow, equations.matrix
    law, rule = system.law, system.contact
    wanted, piece = factors.place != 0.0 or factors.rate != 0.0, centreline(system, element, 0, work)
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if out_of_reach(piece.control, pulley):
            continue
        center = moving_center(system, p, motion.position, motion.velocity)
        drifting = factors.rate != 0.0 and center.unknown >= 0 and center.turning
        if wanted:
            contact_force(piece, pulley, law, rule, 0.0, 1.0, work.contact)
            _keep_by_velocity(work.contact, flow)
            if drifting:
                keep_drift(system, center, work.contact, work.drift)
        add_contact(equations.forces, p, contact_force(piece, pulley, law, rule, factors.place, 0.0, work.contact))
        if wanted:
            _follow_flow(system, motion, element, factors, work.contact, flow)
        take_contact(system, wanted, work)
        if not wanted:
            continue
        if center.rim >= 0:
            matrix.corner[center.rim, center.rim] -= work.contact.moment_by_turn
            couple_rim(system, element, center.rim, work.contact, matrix)
        if center.unknown >= 0:
            drift = factors.place if drifting else 0.0
            couple_center(system, element, center, drift, work.contact, work.drift, matrix)
        last = matrix.corner.shape[0] - 1
        moment = x = y = 0.0
        for a in range(len(system.vectors)):
            fx = fy = 0.0
            for b in range(len(system.vectors)):
                fx += flow.xx[a, b] * flow.rate[b, 0] + flow.xy[a, b] * flow.rate[b, 1]
                fy += flow.yx[a, b] * flow.rate[b, 0] + flow.yy[a, b] * flow.rate[b, 1]
            flow.by_speed[system.vectors[a]] -= factors.flow * fx
            flow.by_speed[system.vectors[a] + 1] -= factors.flow * fy
            moment += flow.moment[a, 0] * flow.rate[a, 0] + flow.moment[a, 1] * flow.rate[a, 1]
            x, y = x + system.shift[a] * fx, y + system.shift[a] * fy
        if center.rim >= 0:
            matrix.corner[center.rim, last] -= factors.flow * moment
        if center.unknown >= 0:
            matrix.corner[center.unknown, last] += factors.flow * (x * center.x + y * center.y)


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
def _follow_flow(
    system: System, motion: Motion, element: int, factors: FlowFactors, contact: np.record, flow: np.record
) -> None:
    """Add to p F_e what goes through velocities, F_v (q + p c D), and the same of pulleys that turn."""
    convected, derivative = factors.place * flow_speed(system.frame, motion.velocity), system.frame.derivative[element]
    count = len(system.vectors)
    for b in range(count):
        for k in range(count):
            part = convected * derivative[k, b]
            if k == b:
                part += factors.rate
            for a in range(count):
                contact.xx[a, b] += flow.xx[a, k] * part
                contact.xy[a, b] += flow.xy[a, k] * part
                contact.yx[a, b] += flow.yx[a, k] * part
                contact.yy[a, b] += flow.yy[a, k] * part
            contact.moment[b, 0] += flow.moment[k, 0] * part
            contact.moment[b, 1] += flow.moment[k, 1] * part
        for axis in range(2):
            contact.by_turn[b, axis] += factors.turning * flow.by_turn[b, axis]
    contact.moment_by_turn += factors.turning * flow.moment_by_turn


@kernel(inline=True)
def scatter_column(system: System, element: int, equations: Equations) -> None:
    """Add the column of the flow of an element to that of its nodes."""
    matrix, flow = equations.matrix, equations.work.flow
    dof, node_j, last = len(system.scale), (element + 1) % system.nodes, matrix.corner.shape[0] - 1
    for c in range(dof):
        matrix.column[element, c, last] += flow.by_speed[c]
        matrix.column[node_j, c, last] += flow.by_speed[dof + c]

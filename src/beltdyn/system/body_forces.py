"""Forces on the bodies at a state: contact summed over the belt, machines, and the powers of the energy account."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import NO_CONTACT_TANGENT, ContactTotals, contact_force
from beltdyn.kernel import kernel
from beltdyn.machines.links import link_torque
from beltdyn.machines.loads.shaft import sensor_slope, shaft_torque, state_rate
from beltdyn.machines.profiles.functions import prescribed_motion
from beltdyn.machines.tensioners import tensioner_center, tensioner_force
from beltdyn.system.arc_mesh import fit_mesh
from beltdyn.system.arrays import (
    COMPRESSION_LOSS,
    COUPLING_LOSS,
    DAMPING_LOSS,
    DRIVER_WORK,
    FRICTION_LOSS,
    NO_TANGENT,
    PENALTY_ENERGY,
    POWERS,
    SPRING_ENERGY,
    TENSIONER_LOSS,
    TORQUE_WORK,
    BodyForces,
    Motion,
    System,
    TangentFactors,
)
from beltdyn.system.carrying import NO_CARRYING_TANGENT, add_carrying
from beltdyn.system.element_state import add_material_damping, centreline, element_workspace, gather_motion, reaches
from beltdyn.system.guide import push_carriage
from beltdyn.system.moving_center import pulley_state, tensioner_coordinate


def new_body_forces(system: System) -> BodyForces:
    """Make body forces of zero for a system."""
    pulleys, bodies = system.pulleys.size, system.bodies.size
    return BodyForces(
        np.zeros(pulleys),
        np.zeros((pulleys, 2)),
        np.zeros(pulleys),
        np.zeros(pulleys),
        np.zeros(pulleys),
        np.zeros(bodies),
        np.zeros(len(POWERS)),
        np.zeros(2),
    )


def body_forces_history(system: System, count: int) -> BodyForces:
    """Make room for the body forces of a number of states, one row for each."""
    return BodyForces(*(np.zeros((count, *array.shape)) for array in new_body_forces(system)))


@kernel
def keep_body_forces(forces: BodyForces, history: BodyForces, k: int) -> None:
    """Write the body forces of a state into row k of a history."""
    for p in range(forces.moment.size):
        history.moment[k, p], history.shaft[k, p] = forces.moment[p], forces.shaft[p]
        history.hub[k, p, 0], history.hub[k, p, 1] = forces.hub[p, 0], forces.hub[p, 1]
        history.friction[k, p], history.damping[k, p] = forces.friction[p], forces.damping[p]
    for body in range(forces.force.size):
        history.force[k, body] = forces.force[body]
    for number in range(forces.power.size):
        history.power[k, number] = forces.power[number]
    for number in range(forces.stored.size):
        history.stored[k, number] = forces.stored[number]


@kernel
def clear_body_forces(forces: BodyForces) -> None:
    """Set everything to zero but the torques on the shafts, which are overwritten later."""
    forces.moment[:] = 0.0
    forces.hub[:] = 0.0
    forces.friction[:] = 0.0
    forces.damping[:] = 0.0
    forces.force[:] = 0.0
    forces.power[:] = 0.0
    forces.stored[:] = 0.0


@kernel
def add_contact(forces: BodyForces, pulley: int, totals: ContactTotals) -> None:
    """Add the contact of a curve of the belt with a pulley."""
    forces.moment[pulley] += totals.moment
    forces.hub[pulley, 0] += totals.hub_x
    forces.hub[pulley, 1] += totals.hub_y
    forces.friction[pulley] += totals.friction_power
    forces.damping[pulley] += totals.damping_power
    forces.power[COMPRESSION_LOSS] += totals.compression_power
    forces.stored[PENALTY_ENERGY] += totals.penalty_energy


@kernel(inline=True)
def controls(body: np.record) -> bool:
    """Whether a body is the state of a controller, which has a lag and no kinetic energy."""
    return bool(body.inertia > 0.0 and body.kinetic == 0.0)


@kernel(inline=True)
def differentiates_forces(factors: TangentFactors) -> bool:
    """Whether derivatives of forces are wanted, which do not depend on accelerations."""
    return factors.by_position != 0.0 or factors.by_velocity != 0.0


@kernel
def add_machines(
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces
) -> None:
    """Forces on the bodies and their powers, when all contact is summed, and what they add to the tangent.

    `factors`: of the derivatives in the tangent; `corner`: tangent of the bodies' equations, changed in place, shape
    (m, m); `forces`: contact is there already.  The torque on a free shaft is that applied to it; that on a prescribed
    one is the reaction of its driver (Eq. 23).
    """
    for p in range(system.pulleys.size):
        forces.force[p] += forces.moment[p]
        forces.power[FRICTION_LOSS] += forces.friction[p]
        forces.power[COMPRESSION_LOSS if system.pulleys[p].lossy else DAMPING_LOSS] += forces.damping[p]
    _add_tensioners(system, motion, factors, corner, forces)
    _add_links(system, motion, factors, corner, forces)
    _take_shafts(system, motion, factors, corner, forces)
    push_carriage(system.carriage, system, motion, factors, differentiates_forces(factors), corner, forces)


@kernel(inline=True)
def _add_tensioners(
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces
) -> None:
    """Springs, dampers, stops and weight of the tensioners, and the force of the belt through the pulley they carry."""
    tensioners, first = system.tensioners, system.first_body
    for k in range(tensioners.size):
        at = tensioner_coordinate(system, k)
        center = tensioner_center(tensioners[k], motion.position[at])
        own = tensioner_force(tensioners[k], motion.position[at], motion.velocity[at])
        hub, weight = forces.hub[tensioners[k].pulley], tensioners[k].weight
        x, y = hub[0] + weight[0], hub[1] + weight[1]
        forces.force[at - first] += own.force + tensioners[k].push + x * center.dx + y * center.dy
        forces.power[TENSIONER_LOSS] += own.loss
        forces.stored[SPRING_ENERGY] += own.energy
        unknown = system.bodies[at - first].unknown
        if unknown < 0:  # what moves it holds the balance
            forces.power[DRIVER_WORK] -= forces.force[at - first] * motion.velocity[at]
        elif differentiates_forces(factors):
            by_place = own.by_position + x * center.ddx + y * center.ddy
            corner[unknown, unknown] -= factors.by_position * by_place + factors.by_velocity * own.by_velocity


@kernel(inline=True)
def _add_links(system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces) -> None:
    """Torques between the bodies of hub chains."""
    links, first = system.links, system.first_body
    for number in range(links.size):
        front, back = links[number].front, links[number].back
        twist = motion.position[first + front] - motion.position[first + back]
        rate = motion.velocity[first + front] - motion.velocity[first + back]
        link = link_torque(system.profiles, links[number], motion.time, twist, rate)
        forces.force[front] -= link.torque
        forces.force[back] += link.torque
        forces.power[COUPLING_LOSS] += link.loss
        forces.stored[SPRING_ENERGY] += link.energy
        if differentiates_forces(factors):
            slope = factors.by_position * link.by_twist + factors.by_velocity * link.by_rate
            i, j = system.bodies[front].unknown, system.bodies[back].unknown
            if i >= 0:
                corner[i, i] += slope
            if j >= 0:
                corner[j, j] += slope
            if i >= 0 and j >= 0:
                corner[i, j] -= slope
                corner[j, i] -= slope


@kernel(inline=True)
def _take_shafts(
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces
) -> None:
    """Torques on the shafts from outside, and their powers; what moves the states of controllers."""
    states = motion.position[system.first_body :]
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        at, unknown = system.first_body + body, system.bodies[body].unknown
        angle, speed = motion.position[at], motion.velocity[at]
        if unknown < 0:
            forces.shaft[p] = system.bodies[body].inertia * motion.acceleration[at] - forces.force[body]
            forces.power[DRIVER_WORK] += forces.shaft[p] * speed
            continue
        load = shaft_torque(system.profiles, system.shaft_loads, p, motion.time, angle, speed, states)
        forces.shaft[p] = load.torque
        forces.force[body] += load.torque
        forces.power[TORQUE_WORK] += load.torque * speed
        if differentiates_forces(factors):
            corner[unknown, unknown] -= factors.by_position * load.by_angle + factors.by_velocity * load.by_speed
        for number in range(system.shaft_loads.first[p], system.shaft_loads.first[p + 1]):
            if system.shaft_loads.table[number].state >= 0:
                _move_state(system, motion, factors, number, body, corner, forces)
            if system.shaft_loads.table[number].sensor > 0 and differentiates_forces(factors):
                _couple_sensor(system, motion, factors, number, body, corner)


@kernel
def _move_state(
    system: System,
    motion: Motion,
    factors: TangentFactors,
    number: int,
    shaft: int,
    corner: FloatArray,
    forces: BodyForces,
) -> None:
    """Let the state z of a load's controller follow its rate r: lag d2z/dt2 = r - dz/dt."""
    loads, first = system.shaft_loads, system.first_body
    angle, speed, states = motion.position[first + shaft], motion.velocity[first + shaft], motion.position[first:]
    found = state_rate(system.profiles, loads, number, motion.time, angle, speed, states)
    place = loads.table[number].state
    forces.force[place] += found.rate - motion.velocity[first + place]
    i, j = system.bodies[place].unknown, system.bodies[shaft].unknown
    if i >= 0 and j >= 0 and differentiates_forces(factors):
        corner[i, i] += factors.by_velocity - factors.by_position * found.by_state
        corner[i, j] -= factors.by_velocity * found.by_speed
        corner[j, i] -= factors.by_position * found.torque_by_state


@kernel
def _couple_sensor(
    system: System, motion: Motion, factors: TangentFactors, number: int, shaft: int, corner: FloatArray
) -> None:
    """Couple a load and the state of its controller to the tensioner that is its sensor."""
    loads, first = system.shaft_loads, system.first_body
    angle, speed, states = motion.position[first + shaft], motion.velocity[first + shaft], motion.position[first:]
    found = sensor_slope(system.profiles, loads, number, motion.time, angle, speed, states)
    own, place = system.bodies[shaft].unknown, loads.table[number].state
    seen = system.bodies[system.bodies.size - loads.table[number].sensor].unknown
    if seen >= 0:
        corner[own, seen] -= factors.by_position * found.torque
        if place >= 0 and system.bodies[place].unknown >= 0:
            corner[system.bodies[place].unknown, seen] -= factors.by_position * found.rate


# The motion of shafts whose speed is prescribed


@kernel
def prescribe(system: System, motion: Motion) -> None:
    """Overwrite the motion of the prescribed bodies by what is prescribed at its time."""
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        if system.bodies[body].unknown < 0:
            i = system.first_body + body
            motion.position[i], motion.velocity[i], motion.acceleration[i] = prescribed_motion(
                system.profiles, p, motion.time
            )


class BodyForcesScratch(NamedTuple):
    """Scratch arrays for finding body forces."""

    acceleration: FloatArray
    """Shape (n N + D,)."""
    work: np.record
    corner: FloatArray
    """No tangent, shape (0, 0)."""
    forces: BodyForces


def body_forces_at(system: System, time: FloatArray, position: FloatArray, velocity: FloatArray) -> BodyForces:
    """Body forces at k states, into which the motion of prescribed bodies is written."""
    history = body_forces_history(system, time.size)
    acceleration = np.zeros(system.first_body + system.bodies.size)
    scratch = BodyForcesScratch(acceleration, element_workspace(system), np.zeros((0, 0)), new_body_forces(system))
    fill_body_forces(system, time, position, velocity, scratch, history)
    return history


@kernel
def fill_body_forces(
    system: System,
    time: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    scratch: BodyForcesScratch,
    history: BodyForces,
) -> None:
    """Fill a history of body forces; see `body_forces_at`."""
    for k in range(time.size):
        motion = Motion(time[k], position[k], velocity[k], scratch.acceleration)
        prescribe(system, motion)
        find_body_forces(system, motion, scratch.work, scratch.corner, scratch.forces)
        keep_body_forces(scratch.forces, history, k)


@kernel
def find_body_forces(system: System, motion: Motion, work: np.record, corner: FloatArray, forces: BodyForces) -> None:
    """Forces on bodies and powers at a state, without residual and tangent.

    Newton's method stops when the state is known well enough.  The body forces that it leaves are those before its last
    change, which in stiff contact are off by much more: they have to be found anew.

    `motion`: the state; prescribed bodies must already have their motion in it; `work`: from `element_workspace`;
    `corner`: left as it is, shape (m, m).
    """
    clear_body_forces(forces)
    fit_mesh(system.frame, system, motion.position)
    for element in range(system.length.size):
        gather_motion(system, element, motion.position, motion.velocity, work.coordinates)
        add_material_damping(system, element, NO_TANGENT, work, forces)
        add_carrying(system.carrying, system, motion, element, NO_CARRYING_TANGENT, work, forces)
        for curve in range(system.control.shape[1]):
            piece = centreline(system, element, curve, work)
            for p in range(system.pulleys.size):
                pulley = pulley_state(system, p, motion.position, motion.velocity)
                if reaches(system, element, curve, pulley, work):
                    totals = contact_force(piece, pulley, system.law, system.contact, NO_CONTACT_TANGENT, work.contact)
                    add_contact(forces, p, totals)
    add_machines(system, motion, NO_TANGENT, corner, forces)

"""What the bodies feel at one state: contact summed over the belt, machines, and the powers of the energy account."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import ContactTotals
from beltdyn.kernel import kernel
from beltdyn.machines.links.registry import link_torque
from beltdyn.machines.loads.shaft import shaft_torque
from beltdyn.machines.tensioners.registry import tensioner_center, tensioner_force
from beltdyn.system.arrays import (
    COUPLING_LOSS,
    DAMPING_LOSS,
    DRIVER_WORK,
    FRICTION_LOSS,
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
from beltdyn.system.pulley_state import tensioner_coordinate


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
def keep_body_forces(loads: BodyForces, history: BodyForces, k: int) -> None:
    """Write the body forces of a state into row k of a history."""
    for p in range(loads.moment.size):
        history.moment[k, p], history.shaft[k, p] = loads.moment[p], loads.shaft[p]
        history.hub[k, p, 0], history.hub[k, p, 1] = loads.hub[p, 0], loads.hub[p, 1]
        history.friction[k, p], history.damping[k, p] = loads.friction[p], loads.damping[p]
    for body in range(loads.force.size):
        history.force[k, body] = loads.force[body]
    for number in range(loads.power.size):
        history.power[k, number] = loads.power[number]
    for number in range(loads.stored.size):
        history.stored[k, number] = loads.stored[number]


@kernel
def clear_body_forces(loads: BodyForces) -> None:
    """Set everything to zero but the torques on the shafts, which are overwritten later."""
    loads.moment[:] = 0.0
    loads.hub[:] = 0.0
    loads.friction[:] = 0.0
    loads.damping[:] = 0.0
    loads.force[:] = 0.0
    loads.power[:] = 0.0
    loads.stored[:] = 0.0


@kernel
def add_contact(loads: BodyForces, pulley: int, totals: ContactTotals) -> None:
    """Add the contact of a curve of the belt with a pulley."""
    loads.moment[pulley] += totals.moment
    loads.hub[pulley, 0] += totals.hub_x
    loads.hub[pulley, 1] += totals.hub_y
    loads.friction[pulley] += totals.friction_power
    loads.damping[pulley] += totals.damping_power
    loads.stored[PENALTY_ENERGY] += totals.penalty_energy


@kernel(inline=True)
def differentiates_forces(factors: TangentFactors) -> bool:
    """Whether derivatives of forces are wanted, which do not depend on accelerations."""
    return factors.by_position != 0.0 or factors.by_velocity != 0.0


@kernel
def add_machines(
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, loads: BodyForces
) -> None:
    """Forces on the bodies and their powers, when all contact is summed, and what they add to the tangent.

    Parameters
    ----------
    system
        The system.
    motion
        The state.
    factors
        Of the derivatives in the tangent.
    corner : ndarray, shape (m, m)
        Tangent of the bodies' equations, changed in place.
    loads
        Contact is there already.  The torque on a free shaft is that applied to it; that on a prescribed one is the
        reaction of its driver (Eq. 23).
    """
    for p in range(system.pulleys.size):
        loads.force[p] += loads.moment[p]
        loads.power[FRICTION_LOSS] += loads.friction[p]
        loads.power[DAMPING_LOSS] += loads.damping[p]
    _add_tensioners(system, motion, factors, corner, loads)
    _add_links(system, motion, factors, corner, loads)
    _take_shafts(system, motion, factors, corner, loads)


@kernel(inline=True)
def _add_tensioners(
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, loads: BodyForces
) -> None:
    """Springs, dampers, stops and weight of the tensioners, and the force of the belt through the pulley they carry."""
    tensioners, first = system.tensioners, system.first_body
    for k in range(tensioners.size):
        at = tensioner_coordinate(system, k)
        center = tensioner_center(tensioners[k], motion.position[at])
        own = tensioner_force(tensioners[k], motion.position[at], motion.velocity[at])
        hub, weight = loads.hub[tensioners[k].pulley], tensioners[k].weight
        x, y = hub[0] + weight[0], hub[1] + weight[1]
        loads.force[at - first] += own.force + tensioners[k].push + x * center.dx + y * center.dy
        loads.power[TENSIONER_LOSS] += own.loss
        loads.stored[SPRING_ENERGY] += own.energy
        unknown = system.bodies[at - first].unknown
        if unknown >= 0 and differentiates_forces(factors):
            by_place = own.by_position + x * center.ddx + y * center.ddy
            corner[unknown, unknown] -= factors.by_position * by_place + factors.by_velocity * own.by_velocity


@kernel(inline=True)
def _add_links(system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, loads: BodyForces) -> None:
    """Torques between the bodies of hub chains."""
    links, first = system.links, system.first_body
    for number in range(links.size):
        front, back = links[number].front, links[number].back
        twist = motion.position[first + front] - motion.position[first + back]
        rate = motion.velocity[first + front] - motion.velocity[first + back]
        link = link_torque(system.profiles, links[number], motion.time, twist, rate)
        loads.force[front] -= link.torque
        loads.force[back] += link.torque
        loads.power[COUPLING_LOSS] += link.loss
        loads.stored[SPRING_ENERGY] += link.energy
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
    system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, loads: BodyForces
) -> None:
    """Torques on the shafts from outside, and their powers."""
    for p in range(system.pulleys.size):
        body = system.pulleys[p].shaft
        at, unknown = system.first_body + body, system.bodies[body].unknown
        angle, speed = motion.position[at], motion.velocity[at]
        if unknown < 0:
            loads.shaft[p] = system.bodies[body].inertia * motion.acceleration[at] - loads.force[body]
            loads.power[DRIVER_WORK] += loads.shaft[p] * speed
            continue
        load = shaft_torque(system.profiles, system.shaft_loads, p, motion.time, angle, speed)
        loads.shaft[p] = load.torque
        loads.force[body] += load.torque
        loads.power[TORQUE_WORK] += load.torque * speed
        if differentiates_forces(factors):
            corner[unknown, unknown] -= factors.by_position * load.by_angle + factors.by_velocity * load.by_speed

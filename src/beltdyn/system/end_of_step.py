"""What the energy account needs of a step that is accepted: the loads at its end, and what the integrator took."""

import numpy as np

from beltdyn.ancf.material_damping import damping_force
from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.kernel import kernel
from beltdyn.system.arrays import Loads, System
from beltdyn.system.assembly import fill_control
from beltdyn.system.loads import add_contact, add_machines, clear_loads
from beltdyn.system.missed_action import Motion
from beltdyn.system.pulley_state import law_of, pulley_state


@kernel
def find_loads(
    system: System,
    motion: Motion,
    work: np.record,
    corner: FloatArray,
    loads: Loads,
) -> None:
    """Loads and powers at a state, without residual and tangent.

    Newton's method stops when the state is known well enough.  The loads that it leaves are those before its last
    change, which in stiff contact are off by much more: they have to be found anew.

    Parameters
    ----------
    system
        Belt, bodies, supports.
    motion
        The state; prescribed bodies must already have their motion in it.
    work
        Scratch arrays of `assembly`.
    corner : ndarray, shape (m, m)
        Left as it is.
    loads
        Overwritten.
    """
    clear_loads(loads)
    damped = system.section.axial_damping > 0.0 or system.section.bending_damping > 0.0
    for element in range(system.length.size):
        _gather(system, element, motion.position, work.coordinates[0])
        _gather(system, element, motion.velocity, work.coordinates[1])
        if damped:
            loads.power[4] += damping_force(
                work.coordinates[0],
                work.coordinates[1],
                system.section,
                system.length[element],
                system.elastic.points,
                system.elastic.weights,
                0.0,
                0.0,
                work.damping,
                work.gradient,
                work.tangent,
            )
        for curve in range(system.control.shape[1]):
            fill_control(system, element, curve, work.coordinates[0], work.control)
            fill_control(system, element, curve, work.coordinates[1], work.control_velocity)
            _add_contacts(system, element, curve, motion, work, loads)
    time, position, velocity, acceleration = motion.time, motion.position, motion.velocity, motion.acceleration
    add_machines(system, time, position, velocity, acceleration, 0.0, 0.0, corner, loads)


@kernel
def numerical_loss(
    system: System,
    before: Motion,
    after: Motion,
    impulse: FloatArray,
    work: np.record,
) -> float:
    """Energy that the damping of the time integrator takes in a step.

    The change of the kinetic energy should be the work of the forces of inertia M a on the way of the step.  What
    generalised-alpha leaves between them is

        (a0 + a1)/2 . M (q1 - q0) - (v0 + v1)/2 . M (v1 - v0),

    which is exactly its dissipation where forces are linear in the positions: the mean of their values at both ends,
    times the way, is then their work.

    Parameters
    ----------
    system
        Belt and bodies.
    before, after
        Both ends of the step.
    impulse : ndarray, shape (2, 6 N + D)
        What acts on the bodies beside the forces at the ends, from `missed_impulses`, N m s.
    work
        Scratch arrays of `assembly`.

    Returns
    -------
    float
        J; of belt and free bodies.
    """
    way, change, mean, speed = work.coordinates[0], work.coordinates[1], work.coordinates[2], work.gradient
    dof, total = len(system.scale), 0.0
    for element in range(system.length.size):
        node_j = (element + 1) % system.nodes
        for c in range(2 * dof):
            i = dof * element + c if c < dof else dof * node_j + c - dof
            way[c], change[c] = after.position[i] - before.position[i], after.velocity[i] - before.velocity[i]
            mean[c] = 0.5 * (after.acceleration[i] + before.acceleration[i])
            speed[c] = 0.5 * (after.velocity[i] + before.velocity[i])
        mass = system.mass[element]
        for row in range(2 * dof):
            inertia = momentum = 0.0
            for column in range(2 * dof):
                inertia += mass[row, column] * way[column]
                momentum += mass[row, column] * change[column]
            total += mean[row] * inertia - speed[row] * momentum
    first = system.first_body
    for body in range(system.bodies.size):
        if system.bodies[body].unknown >= 0:
            i = first + body
            inertia = 0.5 * (after.acceleration[i] + before.acceleration[i]) * (after.position[i] - before.position[i])
            momentum = 0.5 * (after.velocity[i] ** 2 - before.velocity[i] ** 2)
            given = 0.5 * (impulse[0, i] + impulse[1, i]) * (before.velocity[i] + after.velocity[i])
            total += system.bodies[body].inertia * (inertia - momentum) + given
    return total


@kernel(inline=True)
def _gather(system: System, element: int, vector: FloatArray, coordinates: FloatArray) -> None:
    """Entries of an element, shape (12,)."""
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for c in range(dof):
        coordinates[c] = vector[dof * element + c]
        coordinates[dof + c] = vector[dof * node_j + c]


@kernel(inline=True)
def _add_contacts(
    system: System,
    element: int,
    curve: int,
    motion: Motion,
    work: np.record,
    loads: Loads,
) -> None:
    """Add the contact of a curve with all pulleys."""
    piece = Curve(
        work.control,
        work.control_velocity,
        system.control[element, curve],
        system.length[element] / system.control.shape[1],
    )
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, motion.position, motion.velocity)
        if out_of_reach(work.control, pulley):
            continue
        totals = contact_force(piece, pulley, law_of(system, p), system.contact, 0.0, 0.0, work.contact)
        add_contact(loads, p, totals)

"""Forces on bodies, and powers, at states, without the equations of motion."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_force import NO_CONTACT_TANGENT, contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.kernel import kernel
from beltdyn.machines.profiles.functions import prescribed_motion
from beltdyn.system.arc_mesh import fit_mesh
from beltdyn.system.arrays import NO_TANGENT, BodyForces, Motion, System
from beltdyn.system.body_forces import (
    add_contact,
    add_machines,
    body_forces_history,
    clear_body_forces,
    keep_body_forces,
    new_body_forces,
)
from beltdyn.system.carrying import NO_CARRYING_TANGENT, add_carrying
from beltdyn.system.element_state import add_material_damping, centreline, element_workspace, gather_motion
from beltdyn.system.moving_center import pulley_state

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

    Parameters
    ----------
    system
        Belt, bodies, supports.
    motion
        The state; prescribed bodies must already have their motion in it.
    work
        From `element_workspace`.
    corner : ndarray, shape (m, m)
        Left as it is.
    forces
        Overwritten.
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
                if not out_of_reach(piece.control, pulley):
                    totals = contact_force(piece, pulley, system.law, system.contact, NO_CONTACT_TANGENT, work.contact)
                    add_contact(forces, p, totals)
    add_machines(system, motion, NO_TANGENT, corner, forces)

"""Forces on bodies, and powers, at states, without the equations of motion."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Curve
from beltdyn.contact.contact_force import contact_force
from beltdyn.contact.contact_zone import out_of_reach
from beltdyn.elements.dispatch import damping_force
from beltdyn.elements.section import is_damped
from beltdyn.kernel import kernel
from beltdyn.system.arrays import MATERIAL_LOSS, BodyForces, Motion, System
from beltdyn.system.assembly import assembly_workspace, fill_control, gather
from beltdyn.system.body_forces import add_contact, add_machines, clear_loads, keep_loads, load_history, new_loads
from beltdyn.system.prescribed import prescribe
from beltdyn.system.pulley_state import pulley_state


class LoadsScratch(NamedTuple):
    """Scratch arrays for finding loads."""

    acceleration: FloatArray
    """Shape (6 N + D,)."""
    work: np.record
    corner: FloatArray
    """No tangent, shape (0, 0)."""
    loads: BodyForces


def loads_at(system: System, time: FloatArray, position: FloatArray, velocity: FloatArray) -> BodyForces:
    """Find the loads at a number of states.

    Parameters
    ----------
    system
        Belt, bodies, supports.
    time : ndarray, shape (k,)
        s.
    position, velocity : ndarray, shape (k, 6 N + D)
        The states; the motion of prescribed bodies is written into them.

    Returns
    -------
    BodyForces
        One row for each state.
    """
    history = load_history(system, time.size)
    acceleration = np.zeros(system.first_body + system.bodies.size)
    scratch = LoadsScratch(acceleration, assembly_workspace(system), np.zeros((0, 0)), new_loads(system))
    fill_loads(system, time, position, velocity, scratch, history)
    return history


@kernel
def fill_loads(
    system: System,
    time: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    scratch: LoadsScratch,
    history: BodyForces,
) -> None:
    """Fill a history of loads; see `loads_at`."""
    for k in range(time.size):
        prescribe(system, time[k], position[k], velocity[k], scratch.acceleration)
        motion = Motion(time[k], position[k], velocity[k], scratch.acceleration)
        find_loads(system, motion, scratch.work, scratch.corner, scratch.loads)
        keep_loads(scratch.loads, history, k)


@kernel
def find_loads(system: System, motion: Motion, work: np.record, corner: FloatArray, loads: BodyForces) -> None:
    """Forces on bodies and powers at a state, without residual and tangent.

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
    damped = is_damped(system.element.section)
    for element in range(system.length.size):
        gather(system, element, motion.position, work.coordinates[0])
        gather(system, element, motion.velocity, work.coordinates[1])
        if damped:
            loads.power[MATERIAL_LOSS] += damping_force(
                system.element,
                work.coordinates[0],
                work.coordinates[1],
                system.length[element],
                0.0,
                0.0,
                work.element,
            )
        for curve in range(system.control.shape[1]):
            fill_control(system, element, curve, work.coordinates[0], work.control)
            fill_control(system, element, curve, work.coordinates[1], work.control_velocity)
            length = system.length[element] / system.control.shape[1]
            piece = Curve(work.control, work.control_velocity, system.control[element, curve], length)
            for p in range(system.pulleys.size):
                pulley = pulley_state(system, p, motion.position, motion.velocity)
                if not out_of_reach(work.control, pulley):
                    totals = contact_force(piece, pulley, system.law, system.contact, 0.0, 0.0, work.contact)
                    add_contact(loads, p, totals)
    time, position, velocity, acceleration = motion.time, motion.position, motion.velocity, motion.acceleration
    add_machines(system, time, position, velocity, acceleration, 0.0, 0.0, corner, loads)

"""What the pulleys feel: contact summed over the belt, torques on the shafts, and the powers of the energy account."""

import numpy as np
from numpy.typing import NDArray

from beltdyn.contact.contact_force import ContactTotals
from beltdyn.kernel import kernel
from beltdyn.system.arrays import Loads, System
from beltdyn.system.excitation import profile_value

FloatArray = NDArray[np.float64]


def new_loads(pulleys: int) -> Loads:
    """Make zero loads for a number of pulleys."""
    return Loads(np.zeros(pulleys), np.zeros((pulleys, 2)), np.zeros(pulleys), np.zeros(4), np.zeros(1))


@kernel
def clear_loads(loads: Loads) -> None:
    """Set moments, hub forces, powers and penalty energy to zero; shaft torques are overwritten later."""
    loads.moment[:] = 0.0
    loads.hub[:] = 0.0
    loads.power[:] = 0.0
    loads.penalty[:] = 0.0


@kernel
def add_contact(loads: Loads, pulley: int, totals: ContactTotals) -> None:
    """Add the contact of a curve of the belt with a pulley."""
    loads.moment[pulley] += totals.moment
    loads.hub[pulley, 0] += totals.hub_x
    loads.hub[pulley, 1] += totals.hub_y
    loads.penalty[0] += totals.penalty_energy
    loads.power[2] += totals.friction_power
    loads.power[3] += totals.damping_power


@kernel
def take_shafts(system: System, time: float, velocity: FloatArray, acceleration: FloatArray, loads: Loads) -> None:
    """Torques on the shafts and their powers, when all contact is summed.

    Parameters
    ----------
    system
        The system.
    time
        s.
    velocity, acceleration : ndarray, shape (6 N + P,)
        Rates of the state.
    loads
        The torque of a free pulley is that applied to it; that of a prescribed one is the reaction of its driver
        (Eq. 23).
    """
    pulleys = system.pulleys
    first = velocity.size - pulleys.radius.size
    for p in range(pulleys.radius.size):
        if pulleys.unknown[p] < 0:
            loads.shaft[p] = pulleys.inertia[p] * acceleration[first + p] - loads.moment[p]
            loads.power[0] += loads.shaft[p] * velocity[first + p]
        else:
            loads.shaft[p] = profile_value(pulleys, p, time)[0]
            loads.power[1] += loads.shaft[p] * velocity[first + p]

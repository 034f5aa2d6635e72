"""Arrays for what is observed at states, and scratch arrays for observing one."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.contact.contact_force import contact_workspace
from beltdyn.system.arrays import PENALTY_ENERGY, SPRING_ENERGY, BodyForces, System


class Observations(NamedTuple):
    """Derived quantities at k states; P pulleys (and spans), n curves of the belt with c contact points each.

    What belongs to the inside of the belt is there for m of the states, those that are shown.
    """

    pulley_torque: FloatArray
    """Moment of the belt on each pulley, N m, shape (k, P)."""
    shaft_torque: FloatArray
    """Torque on each pulley from outside, N m, shape (k, P)."""
    hub_force: FloatArray
    """Force of the belt on each pulley, N, shape (k, P, 2)."""
    pulley_center: FloatArray
    """m, shape (k, P, 2)."""
    friction_power: FloatArray
    """Power lost in friction on each pulley, W, shape (k, P)."""
    contact_damping_power: FloatArray
    """Power lost in the contact dampers of each pulley, W, shape (k, P)."""
    wrap_angle: FloatArray
    """rad, shape (k, P)."""
    belt_tension: FloatArray
    """Mean axial force of each curve, N, shape (m, n)."""
    tension_variation: FloatArray
    """Root mean square deviation of the axial force within each curve from that mean, N, shape (m, n)."""
    span_tension: FloatArray
    """Mean axial force of the free belt after each pulley, N, shape (k, P); nan where the belt does not leave it."""
    belt_speed: FloatArray
    """Mean speed along the belt of the same, m/s, shape (k, P)."""
    normal_force: FloatArray
    """N/m, shape (k, n c)."""
    friction_force: FloatArray
    slip_velocity: FloatArray
    """m/s, zero where the belt is free."""
    contact_position: FloatArray
    """m, shape (k, n c, 2)."""
    contact_pulley: IntArray
    """Number of the pulley that a point touches, -1 where it is free, shape (k, n c)."""
    kinetic_energy: FloatArray
    """J, shape (m,)."""
    strain_energy: FloatArray
    """J, shape (m,)."""
    penalty_energy: FloatArray
    """J, shape (k,)."""
    spring_energy: FloatArray
    """Of hub chains and tensioners."""
    potential_energy: FloatArray
    """Of weight, zero where everything is at the origin."""


class Samples(NamedTuple):
    """Scratch arrays for one state."""

    tension: FloatArray
    speed: FloatArray
    velocity: FloatArray
    """Of the sampling points, m/s, shape (n c, 2)."""
    weight: FloatArray
    """Length of the free belt in each span."""
    touched: IntArray
    """Pulley that each point counts to, -1 where it is free."""
    nearest: IntArray
    """A point that touches each pulley, or is nearest to where the belt touches it, -1 without contact."""
    element: FloatArray
    """Coordinates and velocities of one element, shape (2, 12)."""
    control: FloatArray
    control_velocity: FloatArray
    contact: np.record


def new_observations(system: System, loads: BodyForces, shown: int) -> Observations:
    """Make observations of states whose loads are known.

    Parameters
    ----------
    system
        The system.
    loads
        One row for each state.
    shown
        Number of states that are shown.
    """
    count, pulleys = loads.moment.shape
    curves = system.length.size * system.control.shape[1]
    points = curves * system.contact.points.size
    return Observations(
        pulley_torque=loads.moment,
        shaft_torque=loads.shaft,
        hub_force=loads.hub,
        pulley_center=np.zeros((count, pulleys, 2)),
        friction_power=loads.friction,
        contact_damping_power=loads.damping,
        wrap_angle=np.zeros((count, pulleys)),
        belt_tension=np.zeros((shown, curves)),
        tension_variation=np.zeros((shown, curves)),
        span_tension=np.zeros((count, pulleys)),
        belt_speed=np.zeros((count, pulleys)),
        normal_force=np.zeros((count, points)),
        friction_force=np.zeros((count, points)),
        slip_velocity=np.zeros((count, points)),
        contact_position=np.zeros((count, points, 2)),
        contact_pulley=np.full((count, points), -1, dtype=np.int8),
        kinetic_energy=np.zeros(shown),
        strain_energy=np.zeros(shown),
        penalty_energy=loads.stored[:, PENALTY_ENERGY].copy(),
        spring_energy=loads.stored[:, SPRING_ENERGY].copy(),
        potential_energy=np.zeros(count),
    )


def new_samples(system: System) -> Samples:
    """Make scratch arrays for a system."""
    points = system.length.size * system.control.shape[1] * system.contact.points.size
    count, vectors = system.control.shape[2:]
    return Samples(
        tension=np.zeros(points),
        speed=np.zeros(points),
        velocity=np.zeros((points, 2)),
        weight=np.zeros(system.pulleys.size),
        touched=np.zeros(points, dtype=np.int64),
        nearest=np.zeros(system.pulleys.size, dtype=np.int64),
        element=np.zeros((2, 2 * len(system.scale))),
        control=np.zeros((count, 2)),
        control_velocity=np.zeros((count, 2)),
        contact=contact_workspace(count, vectors),
    )

"""Arrays for what is observed at states, and scratch arrays for observing one."""

from collections.abc import Mapping
from typing import Annotated, NamedTuple, get_type_hints

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.records import blank
from beltdyn.system.arrays import PENALTY_ENERGY, SPRING_ENERGY, BodyForces, System
from beltdyn.system.element_state import element_workspace
from beltdyn.system.wrap_angle import WALK


class Per(NamedTuple):
    """What an observation has a value for, at every state."""

    dims: tuple[str, ...] = ()
    """Names out of "pulley", "span", "curve" of the belt, "point" of contact, and "axis"."""
    shown: bool = False
    """Whether it is there for the states alone that are shown."""
    dtype: type = float


OfState = Annotated[FloatArray, Per()]
OfShownState = Annotated[FloatArray, Per(shown=True)]
OfPulley = Annotated[FloatArray, Per(("pulley",))]
OfSpan = Annotated[FloatArray, Per(("span",))]
OfPulleyByAxis = Annotated[FloatArray, Per(("pulley", "axis"))]
OfShownCurve = Annotated[FloatArray, Per(("curve",), shown=True)]
OfPoint = Annotated[FloatArray, Per(("point",))]
OfPointByAxis = Annotated[FloatArray, Per(("point", "axis"))]
NumberOfPoint = Annotated[IntArray, Per(("point",), dtype=np.int8)]


class Observations(NamedTuple):
    """Derived quantities at a number of states; the names are those of the results."""

    pulley_torque: OfPulley
    """Moment of the belt on each pulley, N m."""
    shaft_torque: OfPulley
    """Torque on each pulley from outside, N m."""
    hub_force: OfPulleyByAxis
    """Force of the belt on each pulley, N."""
    pulley_center: OfPulleyByAxis
    """m."""
    friction_power: OfPulley
    """Power lost in friction on each pulley, W."""
    contact_damping_power: OfPulley
    """Power lost in the contact dampers of each pulley, W."""
    wrap_angle: OfPulley
    """rad."""
    belt_tension: OfShownCurve
    """Mean axial force of each curve, N."""
    tension_variation: OfShownCurve
    """Root mean square deviation of the axial force within each curve from that mean, N."""
    span_tension: OfSpan
    """Mean axial force of the free belt after each pulley, N; nan where the belt does not leave it. The last span of an
    open belt is the one before the first pulley."""
    belt_speed: OfSpan
    """Mean speed along the belt of the same, m/s."""
    normal_force: OfPoint
    """N/m."""
    friction_force: OfPoint
    """N/m."""
    slip_velocity: OfPoint
    """m/s, zero where the belt is free."""
    contact_position: OfPointByAxis
    """m."""
    contact_pulley: NumberOfPoint
    """Number of the pulley that a point touches, -1 where it is free."""
    kinetic_energy: OfShownState
    """J."""
    strain_energy: OfShownState
    """J."""
    penalty_energy: OfState
    """J."""
    spring_energy: OfState
    """Of hub chains and tensioners, J."""
    potential_energy: OfState
    """Of weight and of forces on the belt's ends, zero where everything is at the origin, J."""


OBSERVED: Mapping[str, Per] = {
    name: hint.__metadata__[0] for name, hint in get_type_hints(Observations, include_extras=True).items()
}
"""What each observation has a value for."""


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
    walk: np.record
    """Row of `wrap_angle.WALK`."""
    work: np.record
    """From `element_workspace`."""


def span_count(system: System) -> int:
    """Number of spans: one for each pulley, and one more of an open belt."""
    return system.pulleys.size + (not system.closed and not system.joint)


def new_observations(system: System, forces: BodyForces, shown: int) -> Observations:
    """Make observations of states whose body forces are known.

    Parameters
    ----------
    system
        The system.
    forces
        One row for each state.
    shown
        Number of states that are shown.
    """
    curves = system.length.size * system.control.shape[1]
    sizes = {
        "pulley": system.pulleys.size,
        "span": span_count(system),
        "curve": curves,
        "point": curves * system.contact.points.size,
        "axis": 2,
    }
    states = len(forces.moment)
    empty = {
        name: np.zeros((shown if per.shown else states, *(sizes[dim] for dim in per.dims)), per.dtype)
        for name, per in OBSERVED.items()
    }
    return Observations(**empty)._replace(
        pulley_torque=forces.moment,
        shaft_torque=forces.shaft,
        hub_force=forces.hub,
        friction_power=forces.friction,
        contact_damping_power=forces.damping,
        penalty_energy=forces.stored[:, PENALTY_ENERGY].copy(),
        spring_energy=forces.stored[:, SPRING_ENERGY].copy(),
    )


def new_samples(system: System) -> Samples:
    """Make scratch arrays for a system."""
    points = system.length.size * system.control.shape[1] * system.contact.points.size
    return Samples(
        tension=np.zeros(points),
        speed=np.zeros(points),
        velocity=np.zeros((points, 2)),
        weight=np.zeros(span_count(system)),
        touched=np.zeros(points, dtype=np.int64),
        nearest=np.zeros(system.pulleys.size, dtype=np.int64),
        walk=blank(WALK),
        work=element_workspace(system),
    )

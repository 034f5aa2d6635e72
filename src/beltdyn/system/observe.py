"""What a state means: energies, loads, tensions, contact forces, wrap angles (Eqs. 8, 13, 17-23)."""

from math import atan2, sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.ancf.elastic_force import centreline, element_energy
from beltdyn.ancf.shape_functions import slopes
from beltdyn.ancf.strain_energy import axial_force
from beltdyn.contact.bezier import bernstein, combine
from beltdyn.contact.contact_zone import MAX_INTERVALS, out_of_reach, touching_intervals
from beltdyn.contact.law import Wheel
from beltdyn.contact.penetration import approach, slip_velocity
from beltdyn.contact.point_force import point_force
from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, System
from beltdyn.system.assembly import assemble, fill_control
from beltdyn.system.excitation import prescribe
from beltdyn.system.motion import Equations, new_equations

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int8]


class Observations(NamedTuple):
    """Derived quantities at k instants; P pulleys (and spans), n elements with c contact points each."""

    pulley_torque: FloatArray
    """Moment of the belt on each pulley, N m, shape (k, P)."""
    shaft_torque: FloatArray
    """Torque on each pulley from outside, N m, shape (k, P)."""
    hub_force: FloatArray
    """Force of the belt on each pulley, N, shape (k, P, 2)."""
    wrap_angle: FloatArray
    """rad, shape (k, P)."""
    belt_tension: FloatArray
    """Mean axial force of each element, N, shape (k, n)."""
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
    """J, shape (k,)."""
    strain_energy: FloatArray
    penalty_energy: FloatArray


class Samples(NamedTuple):
    """Scratch arrays for one state."""

    tension: FloatArray
    speed: FloatArray
    weight: FloatArray
    """Length of the free belt in each span."""
    element: FloatArray
    """Coordinates and velocities of one element, shape (2, 12)."""
    control: FloatArray
    control_velocity: FloatArray
    intervals: FloatArray
    overlap: FloatArray
    acceleration: FloatArray
    multipliers: FloatArray


def _new_observations(system: System, count: int) -> Observations:
    """Make empty observations for a number of instants."""
    pulleys, elements = system.pulleys.radius.size, system.length.size
    points = elements * system.contact.points.size
    return Observations(
        pulley_torque=np.zeros((count, pulleys)),
        shaft_torque=np.zeros((count, pulleys)),
        hub_force=np.zeros((count, pulleys, 2)),
        wrap_angle=np.zeros((count, pulleys)),
        belt_tension=np.zeros((count, elements)),
        span_tension=np.zeros((count, pulleys)),
        belt_speed=np.zeros((count, pulleys)),
        normal_force=np.zeros((count, points)),
        friction_force=np.zeros((count, points)),
        slip_velocity=np.zeros((count, points)),
        contact_position=np.zeros((count, points, 2)),
        contact_pulley=np.full((count, points), -1, dtype=np.int8),
        kinetic_energy=np.zeros(count),
        strain_energy=np.zeros(count),
        penalty_energy=np.zeros(count),
    )


def observe(system: System, time: FloatArray, position: FloatArray, velocity: FloatArray) -> Observations:
    """Observe a number of states.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    time : ndarray, shape (k,)
        s.
    position, velocity : ndarray, shape (k, 6 N + P)
        The states.

    Returns
    -------
    Observations
        Derived quantities at every instant.
    """
    result = _new_observations(system, time.size)
    points = system.length.size * system.contact.points.size
    samples = Samples(
        tension=np.zeros(points),
        speed=np.zeros(points),
        weight=np.zeros(system.pulleys.radius.size),
        element=np.zeros((2, 2 * NODE)),
        control=np.zeros((4, 2)),
        control_velocity=np.zeros((4, 2)),
        intervals=np.zeros((MAX_INTERVALS, 2)),
        overlap=np.zeros((3, 7)),
        acceleration=np.zeros(NODE * system.nodes + system.pulleys.radius.size),
        multipliers=np.zeros(NODE),
    )
    fill_observations(
        system,
        np.ascontiguousarray(time),
        np.ascontiguousarray(position),
        np.ascontiguousarray(velocity),
        new_equations(system),
        samples,
        result,
    )
    return result


@kernel
def fill_observations(
    system: System,
    time: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    equations: Equations,
    samples: Samples,
    result: Observations,
) -> None:
    """Fill the observations."""
    for k in range(time.size):
        _observe_loads(system, time[k], position[k], velocity[k], samples, equations, result, k)
        for element in range(system.length.size):
            _gather(system, element, position[k], velocity[k], samples)
            _observe_element(system, element, samples, result, k)
            _observe_contact(system, element, velocity[k], samples, result, k)
        _observe_spans(system, samples, result, k)
        _observe_pulleys(system, velocity[k], result, k)


@kernel
def _observe_loads(
    system: System,
    time: float,
    position: FloatArray,
    velocity: FloatArray,
    samples: Samples,
    equations: Equations,
    result: Observations,
    k: int,
) -> None:
    """Torques, hub forces and penalty energy, from the same assembly that moves the system."""
    prescribe(system, time, velocity, samples.acceleration)
    assemble(
        system,
        time,
        position,
        velocity,
        samples.acceleration,
        samples.multipliers,
        0.0,
        0.0,
        0.0,
        equations.work,
        equations.matrix,
        equations.loads,
    )
    loads = equations.loads
    result.penalty_energy[k] = loads.penalty[0]
    for p in range(system.pulleys.radius.size):
        result.pulley_torque[k, p] = loads.moment[p]
        result.shaft_torque[k, p] = loads.shaft[p]
        result.hub_force[k, p, 0] = loads.hub[p, 0]
        result.hub_force[k, p, 1] = loads.hub[p, 1]
        result.wrap_angle[k, p] = 0.0


@kernel
def _gather(system: System, element: int, position: FloatArray, velocity: FloatArray, samples: Samples) -> None:
    """Coordinates, velocities and control points of an element."""
    node_j = (element + 1) % system.nodes
    for c in range(NODE):
        samples.element[0, c] = position[NODE * element + c]
        samples.element[0, NODE + c] = position[NODE * node_j + c]
        samples.element[1, c] = velocity[NODE * element + c]
        samples.element[1, NODE + c] = velocity[NODE * node_j + c]
    fill_control(system.control[element], samples.element[0], samples.control)
    fill_control(system.control[element], samples.element[1], samples.control_velocity)


@kernel
def _observe_element(system: System, element: int, samples: Samples, result: Observations, k: int) -> None:
    """Energies and mean axial force of an element."""
    e, v, length = samples.element[0], samples.element[1], system.length[element]
    if element == 0:
        result.kinetic_energy[k] = result.strain_energy[k] = 0.0
    result.strain_energy[k] += element_energy(e, system.section, length, system.elastic.points, system.elastic.weights)
    for row in range(2 * NODE):
        for column in range(2 * NODE):
            result.kinetic_energy[k] += 0.5 * v[row] * system.mass[element, row, column] * v[column]
    mean = 0.0
    for point in range(system.elastic.points.size):
        qx, qy = centreline(e, slopes(system.elastic.points[point], length))
        mean += system.elastic.weights[point] * axial_force(qx * qx + qy * qy, system.section)
    result.belt_tension[k, element] = mean


@kernel
def _observe_contact(
    system: System, element: int, velocity: FloatArray, samples: Samples, result: Observations, k: int
) -> None:
    """Contact at the Gauss points of an element, and the angle over which it touches each pulley."""
    pulleys, length = system.pulleys, system.length[element]
    first = velocity.size - pulleys.radius.size
    count = system.contact.points.size
    for point in range(count):
        row = element * count + point
        xi = system.contact.points[point]
        weights = bernstein(xi)
        x, y = combine(samples.control, weights)
        vx, vy = combine(samples.control_velocity, weights)
        qx, qy = centreline(samples.element[0], slopes(xi, length))
        metric = qx * qx + qy * qy
        samples.tension[row] = axial_force(metric, system.section)
        samples.speed[row] = (qx * vx + qy * vy) / sqrt(metric)
        result.contact_position[k, row, 0] = x
        result.contact_position[k, row, 1] = y
        result.contact_pulley[k, row] = -1
        result.normal_force[k, row] = result.friction_force[k, row] = result.slip_velocity[k, row] = 0.0
        for p in range(pulleys.radius.size):
            wheel = Wheel(pulleys.center[p, 0], pulleys.center[p, 1], pulleys.radius[p], velocity[first + p])
            here = approach(x, y, vx, vy, wheel)
            if here.penetration >= 0.0:
                force = point_force(here, wheel, system.law)
                result.contact_pulley[k, row] = p
                result.normal_force[k, row] = force.normal
                result.friction_force[k, row] = force.friction
                result.slip_velocity[k, row] = slip_velocity(here, wheel)
    for p in range(pulleys.radius.size):
        wheel = Wheel(pulleys.center[p, 0], pulleys.center[p, 1], pulleys.radius[p], velocity[first + p])
        if not out_of_reach(samples.control, wheel):
            for interval in range(touching_intervals(samples.control, wheel, samples.overlap, samples.intervals)):
                result.wrap_angle[k, p] += _angle(
                    samples.control, wheel, samples.intervals[interval, 0], samples.intervals[interval, 1]
                )


@kernel
def _angle(control: FloatArray, wheel: Wheel, start: float, end: float) -> float:
    """Angle at the pulley's centre between two points of the centreline, rad."""
    ax, ay = combine(control, bernstein(start))
    bx, by = combine(control, bernstein(end))
    ax, ay, bx, by = ax - wheel.center_x, ay - wheel.center_y, bx - wheel.center_x, by - wheel.center_y
    return abs(atan2(ax * by - ay * bx, ax * bx + ay * by))


@kernel
def _observe_spans(system: System, samples: Samples, result: Observations, k: int) -> None:
    """Mean tension and speed of the free belt between two pulleys.

    Going along the belt, free points belong to the span of the pulley that was touched last, if the next one
    touched is another.
    """
    spans = system.pulleys.radius.size
    touched = result.contact_pulley[k]
    count, points = touched.size, system.contact.points.size
    weight = samples.weight
    for p in range(spans):
        weight[p] = result.span_tension[k, p] = result.belt_speed[k, p] = 0.0
    for row in range(count):
        if touched[row] >= 0:
            continue
        before, after = -1, -1
        for shift in range(1, count):
            if before < 0:
                before = touched[(row - shift) % count]
            if after < 0:
                after = touched[(row + shift) % count]
            if before >= 0 and after >= 0:
                break
        if before >= 0 and before != after:
            share = system.length[row // points] * system.contact.weights[row % points]
            weight[before] += share
            result.span_tension[k, before] += share * samples.tension[row]
            result.belt_speed[k, before] += share * samples.speed[row]
    for p in range(spans):
        result.span_tension[k, p] = result.span_tension[k, p] / weight[p] if weight[p] > 0.0 else np.nan
        result.belt_speed[k, p] = result.belt_speed[k, p] / weight[p] if weight[p] > 0.0 else np.nan


@kernel
def _observe_pulleys(system: System, velocity: FloatArray, result: Observations, k: int) -> None:
    """Add the rotation of the pulleys to the kinetic energy."""
    first = velocity.size - system.pulleys.radius.size
    for p in range(system.pulleys.radius.size):
        result.kinetic_energy[k] += 0.5 * system.pulleys.inertia[p] * velocity[first + p] ** 2

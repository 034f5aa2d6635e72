"""What a state means: energies, loads, tensions, contact forces, wrap angles (Eqs. 8, 13, 17-23)."""

from math import atan2, sqrt

import numpy as np

from beltdyn.ancf.elastic_force import element_energy
from beltdyn.ancf.material_damping import damping_tension
from beltdyn.ancf.strain_energy import axial_force
from beltdyn.arrays import FloatArray
from beltdyn.chain.chain_force import chain_energy
from beltdyn.contact.bezier import Curve, combine, fill_bernstein, fill_bernstein_rates
from beltdyn.contact.contact_force import contact_force
from beltdyn.contact.contact_zone import out_of_reach, touching_intervals
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.penetration import approach, slip_velocity
from beltdyn.contact.point_force import point_force
from beltdyn.kernel import kernel
from beltdyn.system.arrays import Loads, System
from beltdyn.system.assembly import fill_control
from beltdyn.system.excitation import prescribe
from beltdyn.system.loads import add_contact, add_machines, clear_loads
from beltdyn.system.observations import Observations, Samples, new_observations, new_samples
from beltdyn.system.pulley_state import law_of, pulley_state, tensioner_coordinate
from beltdyn.system.tensioner import tensioner_place


def observe(system: System, time: FloatArray, position: FloatArray, velocity: FloatArray) -> Observations:
    """Observe a number of states.

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    time : ndarray, shape (k,)
        s.
    position, velocity : ndarray, shape (k, 6 N + D)
        The states.

    Returns
    -------
    Observations
        Derived quantities at every instant.
    """
    result = new_observations(system, time.size)
    fill_observations(
        system,
        np.ascontiguousarray(time),
        np.ascontiguousarray(position),
        np.ascontiguousarray(velocity),
        new_samples(system),
        result,
    )
    return result


@kernel
def fill_observations(
    system: System,
    time: FloatArray,
    position: FloatArray,
    velocity: FloatArray,
    samples: Samples,
    result: Observations,
) -> None:
    """Fill the observations."""
    for k in range(time.size):
        clear_loads(samples.loads)
        result.kinetic_energy[k] = result.strain_energy[k] = result.potential_energy[k] = 0.0
        result.wrap_angle[k] = 0.0
        samples.nearest[:] = -1
        prescribe(system, time[k], position[k], velocity[k], samples.acceleration)
        for element in range(system.length.size):
            _gather(system, element, position[k], velocity[k], samples)
            _observe_energy(system, element, samples, result, k)
            for curve in range(system.control.shape[1]):
                fill_control(system, element, curve, samples.element[0], samples.control)
                fill_control(system, element, curve, samples.element[1], samples.control_velocity)
                number = element * system.control.shape[1] + curve
                length = system.length[element] / system.control.shape[1]
                _observe_tension(system, length, number, samples, result, k)
                _observe_points(system, length, number, samples, result, k)
                _observe_contact(system, element, curve, length, position[k], velocity[k], samples, result, k)
        add_machines(
            system,
            time[k],
            position[k],
            velocity[k],
            samples.acceleration,
            0.0,
            0.0,
            samples.corner,
            samples.loads,
        )
        _keep_loads(samples.loads, result, k)
        _observe_spans(system, samples, result, k)
        _observe_bodies(system, position[k], velocity[k], result, k)


@kernel(inline=True)
def _keep_loads(loads: Loads, result: Observations, k: int) -> None:
    """Torques, hub forces, losses and energies of springs."""
    result.penalty_energy[k] = loads.stored[0]
    result.spring_energy[k] = loads.stored[1]
    for p in range(loads.moment.size):
        result.pulley_torque[k, p] = loads.moment[p]
        result.shaft_torque[k, p] = loads.shaft[p]
        result.hub_force[k, p, 0] = loads.hub[p, 0]
        result.hub_force[k, p, 1] = loads.hub[p, 1]
        result.friction_power[k, p] = loads.friction[p]
        result.contact_damping_power[k, p] = loads.damping[p]


@kernel(inline=True)
def _gather(system: System, element: int, position: FloatArray, velocity: FloatArray, samples: Samples) -> None:
    """Coordinates and velocities of an element."""
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for c in range(dof):
        samples.element[0, c] = position[dof * element + c]
        samples.element[0, dof + c] = position[dof * node_j + c]
        samples.element[1, c] = velocity[dof * element + c]
        samples.element[1, dof + c] = velocity[dof * node_j + c]


@kernel(inline=True)
def _observe_energy(system: System, element: int, samples: Samples, result: Observations, k: int) -> None:
    """Energies of an element."""
    e, v, section, length = samples.element[0], samples.element[1], system.section, system.length[element]
    if system.chain:
        result.strain_energy[k] += chain_energy(e, section.axial, section.bending, length)
    else:
        result.strain_energy[k] += element_energy(e, section, length, system.elastic.points, system.elastic.weights)
    dof, kinetic, mass = len(system.scale), 0.0, system.mass[element]
    for row in range(2 * dof):
        momentum = 0.0
        for column in range(2 * dof):
            momentum += mass[row, column] * v[column]
        kinetic += 0.5 * v[row] * momentum
    result.kinetic_energy[k] += kinetic


@kernel(inline=True)
def _stretch(system: System, samples: Samples, xi: float, length: float) -> tuple[float, float, float]:
    """Derivative of the centreline with respect to the belt coordinate, and the tension."""
    rates = samples.contact.rates
    fill_bernstein_rates(xi, rates)
    x, y = combine(samples.control, rates)
    vx, vy = combine(samples.control_velocity, rates)
    square = length * length
    metric = (x * x + y * y) / square
    tension = axial_force(metric, system.section)
    tension += damping_tension(metric, 2.0 * (x * vx + y * vy) / square, system.section)
    return x / length, y / length, tension


@kernel(inline=True)
def _observe_tension(system: System, length: float, curve: int, samples: Samples, result: Observations, k: int) -> None:
    """Axial force of a curve: its mean, and how much it varies."""
    mean = square = 0.0
    for point in range(system.elastic.points.size):
        weight = system.elastic.weights[point]
        _, _, force = _stretch(system, samples, system.elastic.points[point], length)
        mean += weight * force
        square += weight * force * force
    result.belt_tension[k, curve] = mean
    result.tension_variation[k, curve] = sqrt(max(0.0, square - mean * mean))


@kernel(inline=True)
def _observe_points(system: System, length: float, curve: int, samples: Samples, result: Observations, k: int) -> None:
    """Places, tension and speed of the sampling points of a curve, as if they were free."""
    count, weights = system.contact.points.size, samples.contact.weights
    for point in range(count):
        row = curve * count + point
        xi = system.contact.points[point]
        fill_bernstein(xi, weights)
        x, y = combine(samples.control, weights)
        vx, vy = combine(samples.control_velocity, weights)
        qx, qy, samples.tension[row] = _stretch(system, samples, xi, length)
        samples.speed[row] = (qx * vx + qy * vy) / sqrt(qx * qx + qy * qy)
        result.contact_position[k, row, 0] = x
        result.contact_position[k, row, 1] = y
        result.contact_pulley[k, row] = -1
        result.normal_force[k, row] = result.friction_force[k, row] = result.slip_velocity[k, row] = 0.0


@kernel(inline=True)
def _observe_contact(
    system: System,
    element: int,
    curve: int,
    length: float,
    position: FloatArray,
    velocity: FloatArray,
    samples: Samples,
    result: Observations,
    k: int,
) -> None:
    """Contact of a curve as it moves the system and at its sampling points, and the angle over which it touches."""
    zone, number = samples.contact.zone, element * system.control.shape[1] + curve
    piece = Curve(samples.control, samples.control_velocity, system.control[element, curve], length)
    for p in range(system.pulleys.size):
        pulley, law = pulley_state(system, p, position, velocity), law_of(system, p)
        if out_of_reach(samples.control, pulley):
            continue
        add_contact(samples.loads, p, contact_force(piece, pulley, law, system.contact, 0.0, 0.0, samples.contact))
        for interval in range(touching_intervals(samples.control, pulley, zone)):
            start, end = zone.intervals[interval]
            result.wrap_angle[k, p] += _angle(samples, pulley, start, end)
            samples.nearest[p] = number * system.contact.points.size + _nearest_point(system, 0.5 * (start + end))
        _touch_points(system, number, p, pulley, law, samples, result, k)


@kernel(inline=True)
def _touch_points(
    system: System,
    curve: int,
    number: int,
    pulley: PulleyState,
    law: ContactLaw,
    samples: Samples,
    result: Observations,
    k: int,
) -> None:
    """Contact at the sampling points of a curve that touch a pulley."""
    count, weights = system.contact.points.size, samples.contact.weights
    for point in range(count):
        row = curve * count + point
        fill_bernstein(system.contact.points[point], weights)
        vx, vy = combine(samples.control_velocity, weights)
        x, y = result.contact_position[k, row, 0], result.contact_position[k, row, 1]
        here = approach(x, y, vx, vy, pulley)
        if here.penetration >= 0.0:
            force = point_force(here, pulley, law)
            result.contact_pulley[k, row] = number
            result.normal_force[k, row] = force.normal
            result.friction_force[k, row] = force.friction
            result.slip_velocity[k, row] = slip_velocity(here, pulley)


@kernel(inline=True)
def _nearest_point(system: System, xi: float) -> int:
    """Contact point of a curve that is nearest to a place on it, 0 to 1."""
    nearest = 0
    for point in range(1, system.contact.points.size):
        if abs(system.contact.points[point] - xi) < abs(system.contact.points[nearest] - xi):
            nearest = point
    return nearest


@kernel(inline=True)
def _angle(samples: Samples, pulley: PulleyState, start: float, end: float) -> float:
    """Angle at the pulley's centre between two points of the centreline, rad."""
    control, weights = samples.control, samples.contact.weights
    fill_bernstein(start, weights)
    ax, ay = combine(control, weights)
    fill_bernstein(end, weights)
    bx, by = combine(control, weights)
    ax, ay, bx, by = ax - pulley.center_x, ay - pulley.center_y, bx - pulley.center_x, by - pulley.center_y
    return abs(atan2(ax * by - ay * bx, ax * bx + ay * by))


@kernel(inline=True)
def _observe_spans(system: System, samples: Samples, result: Observations, k: int) -> None:
    """Mean tension and speed of the free belt between two pulleys.

    Going along the belt, free points belong to the span of the pulley that was touched last, if the next one
    touched is another. On coarse meshes a pulley may be touched between points alone, and a span may have none: then
    the nearest point counts to the pulley, and the points at its ends to the span.
    """
    spans = system.pulleys.size
    touched, weight = samples.touched, samples.weight
    for row in range(touched.size):
        touched[row] = pulley = result.contact_pulley[k, row]
        if pulley >= 0:
            samples.nearest[pulley] = row
    for p in range(spans):
        weight[p] = result.span_tension[k, p] = result.belt_speed[k, p] = 0.0
        if samples.nearest[p] >= 0:
            touched[samples.nearest[p]] = p
    count, points, curves = touched.size, system.contact.points.size, system.control.shape[1]
    before, first = -1, 0
    for row in range(count):
        if touched[row] >= 0:
            before, first = touched[row], row
            break
    length = tension = speed = 0.0
    for walk in range(first + 1, first + 1 + count):
        row = walk % count
        after = touched[row]
        if after < 0:
            share = system.length[row // (points * curves)] * system.contact.weights[row % points]
            length += share
            tension += share * samples.tension[row]
            speed += share * samples.speed[row]
            continue
        if before != after:
            if length == 0.0:
                last = (row - 1) % count
                length, speed = 1.0, 0.5 * (samples.speed[last] + samples.speed[row])
                tension = 0.5 * (samples.tension[last] + samples.tension[row])
            weight[before] += length
            result.span_tension[k, before] += tension
            result.belt_speed[k, before] += speed
        before, length, tension, speed = after, 0.0, 0.0, 0.0
    for p in range(spans):
        result.span_tension[k, p] = result.span_tension[k, p] / weight[p] if weight[p] > 0.0 else np.nan
        result.belt_speed[k, p] = result.belt_speed[k, p] / weight[p] if weight[p] > 0.0 else np.nan


@kernel(inline=True)
def _observe_bodies(system: System, position: FloatArray, velocity: FloatArray, result: Observations, k: int) -> None:
    """Centres of the pulleys, kinetic energy of the bodies and potential energy of weight."""
    first = system.first_body
    for body in range(system.bodies.size):
        result.kinetic_energy[k] += 0.5 * system.bodies[body].inertia * velocity[first + body] ** 2
    for c in range(first):
        result.potential_energy[k] -= system.supports.force[c] * position[c]
    for p in range(system.pulleys.size):
        x, y = system.pulleys[p].center
        carrier = system.pulleys[p].carrier
        if carrier >= 0:
            x, y, _, _, _, _ = tensioner_place(
                system.tensioners, carrier, position[tensioner_coordinate(system, carrier)]
            )
            weight = system.tensioners[carrier].weight
            result.potential_energy[k] -= weight[0] * x + weight[1] * y
        result.pulley_center[k, p, 0], result.pulley_center[k, p, 1] = x, y

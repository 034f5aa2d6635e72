"""What a state means: energies, body forces, tensions, contact forces, wrap angles (Eqs. 8, 13, 17-23)."""

from math import sqrt

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.contact.contact_zone import (
    Curve,
    combine,
    fill_bernstein,
    fill_bernstein_rates,
    out_of_reach,
    second_rate,
    touching_intervals,
)
from beltdyn.contact.law import PulleyState
from beltdyn.contact.penetration import approach, slip_velocity
from beltdyn.contact.point_force import point_force
from beltdyn.contact.teeth import tooth_at, tooth_push, tooth_reach, tooth_traction
from beltdyn.elements import strain_energy, tension
from beltdyn.kernel import kernel
from beltdyn.machines.tensioners import tensioner_center
from beltdyn.system.arc_mesh import fit_mesh
from beltdyn.system.arrays import BodyForces, System
from beltdyn.system.body_forces import body_forces_at, body_forces_history
from beltdyn.system.element_state import centreline, gather_motion, move_centreline
from beltdyn.system.guide import rolls_energy
from beltdyn.system.material_loss import hysteresis_tension
from beltdyn.system.moving_center import pulley_state, tensioner_coordinate
from beltdyn.system.observations import (
    Observations,
    Samples,
    begin_walk,
    new_observations,
    new_samples,
    next_curve,
    turned_at,
    turned_at_the_end,
)


def observe(system: System, time: FloatArray, position: FloatArray, velocity: FloatArray) -> Observations:
    """Observe k states; the motion of prescribed bodies is written into them if they are contiguous."""
    time, position, velocity = (np.ascontiguousarray(array) for array in (time, position, velocity))
    forces = body_forces_at(system, time, position, velocity)
    return observe_motion(system, position, velocity, forces, np.ones(time.size, dtype=np.bool_))


def observe_contact(system: System, position: FloatArray, velocity: FloatArray) -> Observations:
    """Observe contact, tensions and speeds of spans in k contiguous states; what body forces tell is zero."""
    count = len(position)
    forces = body_forces_history(system, count)
    return observe_motion(system, position, velocity, forces, np.zeros(count, dtype=np.bool_))


def observe_motion(
    system: System, position: FloatArray, velocity: FloatArray, forces: BodyForces, shown: BoolArray
) -> Observations:
    """Observe contiguous states whose body forces are known; energies and belt tensions only of those shown."""
    result = new_observations(system, forces, int(np.count_nonzero(shown)))
    fill_observations(system, position, velocity, shown, new_samples(system), result)
    return result


@kernel
def fill_observations(
    system: System, position: FloatArray, velocity: FloatArray, shown: BoolArray, samples: Samples, result: Observations
) -> None:
    """Fill the observations but for the body forces; see `observe_motion`."""
    show, work, curves = -1, samples.work, system.control.shape[1]
    for k in range(position.shape[0]):
        show += shown[k]
        samples.nearest[:] = -1
        begin_walk(samples.walk)
        fit_mesh(system.frame, system, position[k])
        for element in range(system.length.size):
            gather_motion(system, element, position[k], velocity[k], work.coordinates)
            pull = 0.0
            if system.hysteresis.size > 0:
                pull = hysteresis_tension(system.hysteresis[element], system.vectors, work)
            if shown[k]:
                _observe_energy(system, element, samples, result, show)
            for curve in range(curves):
                piece, number = centreline(system, element, curve, work), element * curves + curve
                move_centreline(system, element, curve, work)
                if shown[k]:
                    _observe_tension(system, piece, number, pull, work, result, show)
                _observe_points(system, piece, number, pull, samples, result, k)
                next_curve(samples.walk, piece.length)
                _observe_contact(system, number, position[k], velocity[k], samples, result, k)
        if not samples.is_open and samples.walk.first.pulley >= 0:
            result.wrap_angle[k, samples.walk.first.pulley] += turned_at_the_end(samples.walk)
        _observe_spans(system, samples, result, k)
        _observe_bodies(system, position[k], result, k)
        if shown[k]:
            result.kinetic_energy[show] += rolls_energy(system.carriage, system, position[k], velocity[k])
            for body in range(system.bodies.size):
                speed = velocity[k, system.first_body + body]
                result.kinetic_energy[show] += 0.5 * system.bodies[body].kinetic * speed**2


@kernel(inline=True)
def _observe_energy(system: System, element: int, samples: Samples, result: Observations, k: int) -> None:
    """Energies of an element."""
    e, v = samples.work.coordinates[0], samples.work.coordinates[1]
    result.strain_energy[k] += strain_energy(system.element, e, system.length[element])
    dof, kinetic, mass = len(system.scale), 0.0, system.mass[element]
    for row in range(2 * dof):
        momentum = 0.0
        for column in range(2 * dof):
            momentum += mass[row, column] * v[column]
        kinetic += 0.5 * v[row] * momentum
    result.kinetic_energy[k] += kinetic


@kernel(inline=True)
def stretch_at(system: System, piece: Curve, xi: float, pull: float, rates: FloatArray) -> tuple[float, float, float]:
    """Derivative of the centerline with respect to the belt coordinate, and the tension, with that by hysteresis."""
    fill_bernstein_rates(xi, rates)
    x, y = combine(piece.control, rates)
    vx, vy = combine(piece.velocity, rates)
    square = piece.length * piece.length
    metric, rate = (x * x + y * y) / square, 2.0 * (x * vx + y * vy) / square
    return x / piece.length, y / piece.length, tension(system.element, metric, rate) + pull * sqrt(metric)


@kernel(inline=True)
def _observe_tension(
    system: System, piece: Curve, curve: int, pull: float, work: np.record, result: Observations, k: int
) -> None:
    """Axial force of a curve: its mean, and how much it varies."""
    mean = square = 0.0
    for point in range(system.element.elastic.points.size):
        weight = system.element.elastic.weights[point]
        _, _, force = stretch_at(system, piece, system.element.elastic.points[point], pull, work.contact.rates)
        mean += weight * force
        square += weight * force * force
    result.belt_tension[k, curve] = mean
    result.tension_variation[k, curve] = sqrt(max(0.0, square - mean * mean))


@kernel(inline=True)
def _observe_points(
    system: System, piece: Curve, curve: int, pull: float, samples: Samples, result: Observations, k: int
) -> None:
    """Places, tension and speed of the sampling points of a curve, as if they were free."""
    count, weights, rates = system.contact.points.size, samples.work.contact.weights, samples.work.contact.rates
    for point in range(count):
        row = curve * count + point
        xi = system.contact.points[point]
        fill_bernstein(xi, weights)
        x, y = combine(piece.control, weights)
        vx, vy = combine(piece.velocity, weights)
        qx, qy, force = stretch_at(system, piece, xi, pull, rates)
        samples.tension[row] = force + _tension_by_bending(piece, xi, qx, qy, samples.bending, rates)
        samples.speed[row] = (qx * vx + qy * vy) / sqrt(qx * qx + qy * qy)
        samples.velocity[row, 0], samples.velocity[row, 1] = vx, vy
        result.contact_position[k, row, 0] = x
        result.contact_position[k, row, 1] = y
        result.contact_pulley[k, row] = -1
        result.normal_force[k, row] = result.friction_force[k, row] = result.slip_velocity[k, row] = 0.0


@kernel(inline=True)
def _tension_by_bending(piece: Curve, xi: float, qx: float, qy: float, bending: float, rates: FloatArray) -> float:
    """What a bent belt carries of its tension by shear forces and moments, N: see `Samples.bending`."""
    if bending == 0.0:
        return 0.0
    wx, wy = second_rate(piece.control, xi, rates)
    metric = qx * qx + qy * qy
    turning = (qx * wy - qy * wx) / (piece.length * piece.length)
    return bending * turning * turning / (metric * metric * metric)


@kernel(inline=True)
def _observe_contact(
    system: System,
    number: int,
    position: FloatArray,
    velocity: FloatArray,
    samples: Samples,
    result: Observations,
    k: int,
) -> None:
    """Contact of a curve at its sampling points, and the angle to the places that touch."""
    control, zone = samples.work.control, samples.work.contact.zone
    for p in range(system.pulleys.size):
        pulley = pulley_state(system, p, position, velocity)
        if system.pulleys[p].beside == 1 or out_of_reach(control, pulley):
            continue
        for interval in range(touching_intervals(control, pulley, zone)):
            start, end = zone.intervals[interval]
            for xi in (start, end):
                result.wrap_angle[k, p] += turned_at(samples.walk, xi, p, pulley, samples.work)
            samples.nearest[p] = number * system.contact.points.size + _nearest_point(system, 0.5 * (start + end))
        _touch_points(system, number, p, pulley, samples, result, k)


@kernel(inline=True)
def _touch_points(
    system: System,
    curve: int,
    number: int,
    pulley: PulleyState,
    samples: Samples,
    result: Observations,
    k: int,
) -> None:
    """Contact at the sampling points of a curve that touch a pulley."""
    count = system.contact.points.size
    for point in range(count):
        row = curve * count + point
        vx, vy = samples.velocity[row, 0], samples.velocity[row, 1]
        x, y = result.contact_position[k, row, 0], result.contact_position[k, row, 1]
        here = approach(x, y, vx, vy, pulley)
        if here.penetration >= 0.0:
            force = point_force(here, pulley, system.law, False)
            along = samples.walk.along + system.contact.points[point] * samples.walk.length
            tooth = tooth_at(pulley.surface, here, pulley.speed, along)
            result.contact_pulley[k, row] = number
            result.normal_force[k, row] = force.normal.force + tooth_push(tooth)
            result.friction_force[k, row] = force.friction + tooth_traction(tooth, here)
            result.slip_velocity[k, row] = slip_velocity(here, pulley)
        elif here.penetration > -tooth_reach(pulley.surface):
            along = samples.walk.along + system.contact.points[point] * samples.walk.length
            tooth = tooth_at(pulley.surface, here, pulley.speed, along)
            result.friction_force[k, row] += tooth_traction(tooth, here)


@kernel(inline=True)
def _nearest_point(system: System, xi: float) -> int:
    """Contact point of a curve that is nearest to a place on it, 0 to 1."""
    nearest = 0
    for point in range(1, system.contact.points.size):
        if abs(system.contact.points[point] - xi) < abs(system.contact.points[nearest] - xi):
            nearest = point
    return nearest


@kernel(inline=True)
def _observe_spans(system: System, samples: Samples, result: Observations, k: int) -> None:
    """Tension of the free belt between two pulleys, its mean, extremes and values at both ends, and its mean speed.

    Going along the belt, free curves belong to the span of the pulley that was touched last, if the next one touched
    is another; where no curve is free as a whole, free points do. A point that comes free thus changes no mean by the
    swing of the tension within its curve. On coarse meshes a pulley may be touched between points alone, and a span
    may have none: then the nearest point counts to the pulley, and the points at its ends to the span. The last span
    of an open belt is the one before the first pulley; behind the last pulley its end counts as touched.
    """
    touched, weight, is_open, spans = samples.touched, samples.weight, samples.is_open, samples.weight.size
    for row in range(touched.size):
        touched[row] = pulley = result.contact_pulley[k, row]
        if pulley >= 0:
            samples.nearest[pulley], touched[row] = row, samples.leaving[pulley]
    for span in range(spans):
        weight[span] = result.span_tension[k, span] = result.belt_speed[k, span] = 0.0
        result.largest_span_tension[k, span], result.least_span_tension[k, span] = -np.inf, np.inf
        result.span_tension_at_start[k, span] = result.span_tension_at_end[k, span] = np.nan
    for p in range(system.pulleys.size):
        if samples.nearest[p] >= 0:
            touched[samples.nearest[p]] = samples.leaving[p]
    count, points, curves = touched.size, system.contact.points.size, system.control.shape[1]
    before, first = -1, 0
    for row in range(count):
        if touched[row] >= 0:
            before, first = touched[row], row
            break
    if is_open:
        before, first = spans - 1, -1
    length = tension = speed = free_length = free_tension = free_speed = 0.0
    start, end, largest, least = np.nan, np.nan, -np.inf, np.inf
    for walk in range(first + 1, first + 1 + count + is_open):
        row = walk % count
        after = touched[row]
        if is_open and walk == count:
            row, after = count - 1, spans
        if after < 0:
            if result.friction_force[k, row] == 0.0:  # teeth reach farther than rims
                share = system.length[row // (points * curves)] * system.contact.weights[row % points]
                length += share
                tension += share * samples.tension[row]
                speed += share * samples.speed[row]
            if row % points == 0 and _is_free(row, points, samples, result, k):
                share = system.length[row // (points * curves)]
                end = _over_curve(samples.transmitted[row // points % curves], samples.tension, row)
                free_length += share
                free_tension += share * end
                free_speed += share * _over_curve(samples.mean, samples.speed, row)
                start = end if largest < least else start
                largest, least = max(largest, end), min(least, end)
            continue
        if before != after:
            if free_length > 0.0:
                length, tension, speed = free_length, free_tension, free_speed
            if length == 0.0:
                last = (row - 1) % count if not is_open else max(row - 1, 0)
                length, speed = 1.0, 0.5 * (samples.speed[last] + samples.speed[row])
                tension = 0.5 * (samples.tension[last] + samples.tension[row])
            if largest < least:
                start = end = largest = least = tension / length
            if weight[before] == 0.0:
                result.span_tension_at_start[k, before] = start
            result.span_tension_at_end[k, before] = end
            result.largest_span_tension[k, before] = max(largest, result.largest_span_tension[k, before])
            result.least_span_tension[k, before] = min(least, result.least_span_tension[k, before])
            weight[before] += length
            result.span_tension[k, before] += tension
            result.belt_speed[k, before] += speed
        before, length, tension, speed, largest, least = after, 0.0, 0.0, 0.0, -np.inf, np.inf
        free_length = free_tension = free_speed = 0.0
    for span in range(spans):
        free = weight[span] > 0.0
        result.span_tension[k, span] = result.span_tension[k, span] / weight[span] if free else np.nan
        result.belt_speed[k, span] = result.belt_speed[k, span] / weight[span] if free else np.nan
        if not free:
            result.largest_span_tension[k, span] = result.least_span_tension[k, span] = np.nan


@kernel(inline=True)
def _is_free(first: int, points: int, samples: Samples, result: Observations, k: int) -> bool:
    """Whether a curve, of which a row is the first point, touches no pulley and no tooth."""
    for row in range(first, first + points):
        if samples.touched[row] >= 0 or result.friction_force[k, row] != 0.0:
            return False
    return True


@kernel(inline=True)
def _over_curve(weights: FloatArray, values: FloatArray, first: int) -> float:
    """Weighted sum over the points of a curve, the first of which has a row."""
    total = 0.0
    for point in range(weights.size):
        total += weights[point] * values[first + point]
    return total


@kernel(inline=True)
def _observe_bodies(system: System, position: FloatArray, result: Observations, k: int) -> None:
    """Centers of the pulleys and potential energy of weight and of constant forces on nodes."""
    for c in range(system.first_body):
        result.potential_energy[k] -= system.supports.force[c] * position[c]
    for p in range(system.pulleys.size):
        x, y = system.pulleys[p].center
        carrier = system.pulleys[p].carrier
        if carrier >= 0:
            center = tensioner_center(system.tensioners[carrier], position[tensioner_coordinate(system, carrier)])
            x, y = center.x, center.y
            weight = system.tensioners[carrier].weight
            result.potential_energy[k] -= weight[0] * x + weight[1] * y
        result.pulley_center[k, p, 0], result.pulley_center[k, p, 1] = x, y

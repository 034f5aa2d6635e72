"""Supports along spans and goods on them, spread over the elements of a staying mesh, with their tangent.

A meter of a span with the direction d acts on the belt with

    f = m_L (g - a) + n N - R(n, v) d - m_R (d . da_R) d,

where goods of the mass m_L have weight and follow the belt, a support pushes by n along N and resists by R, and
rotating mass m_R follows the speed of the belt at its place.  a is the acceleration of material points, a_R the rate of
their velocity at a place of the mesh.  A meter of belt lies on lambda = d . dr/dsigma meters of span.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_zone import fill_bernstein, fill_shape_functions
from beltdyn.kernel import by_type, kernel
from beltdyn.machines.carrying import resistance_of_kind
from beltdyn.machines.profiles.functions import schedule_value
from beltdyn.system.arrays import CARRYING_LOSS, Bare, BodyForces, Carrying, Motion, System
from beltdyn.system.element_state import gather
from beltdyn.system.frame import FlowingByArcs, StayingByArcs, flow_at_ends, passed_length


class CarryingFactors(NamedTuple):
    """What a unit of the unknowns changes; with all of them zero no tangent is wanted."""

    place: float
    """Of the vectors."""
    rate: float
    """Of their rates, 1/s."""
    flow: float
    """Of the speed of the belt through the mesh."""
    acceleration: float
    """Of the second derivatives of the vectors and of the passed length, 1/s^2."""


NO_CARRYING_TANGENT = CarryingFactors(0.0, 0.0, 0.0, 0.0)


class _Point(NamedTuple):
    """The belt at a point: place, slope, velocity of the material, and parts of its acceleration."""

    x: float
    y: float
    slope_x: float
    slope_y: float
    velocity_x: float
    velocity_y: float
    turn_x: float
    """Derivative of the velocity over the belt coordinate."""
    turn_y: float
    bend_x: float
    """Second derivative of the place over the belt coordinate."""
    bend_y: float
    still_x: float
    """Rate of the velocity at a place of the mesh."""
    still_y: float
    moved_x: float
    """Acceleration of the material."""
    moved_y: float


class _Flow(NamedTuple):
    """The flow of the belt through the mesh at a point."""

    speed: float
    change: float
    """Rate of the speed, m/s^2."""
    place: float
    """Where on the element, 0 to 1."""


@kernel
def _of_steady(frame: StayingByArcs, system: System, motion: Motion, element: int, work: np.record) -> None:
    """A v of a belt that passes at the same speed everywhere."""
    flow, speed, velocity, derivative = work.flow, frame.speed[0], work.coordinates[1], frame.derivative[element]
    for a in range(len(system.vectors)):
        for axis in range(2):
            turn = 0.0
            for b in range(len(system.vectors)):
                turn += derivative[a, b] * velocity[system.vectors[b] + axis]
            flow.still[a, axis], flow.moved[a, axis] = 0.0, speed * turn


@kernel
def _of_flow(frame: FlowingByArcs, system: System, motion: Motion, element: int, work: np.record) -> None:
    """dv/dt and a = dv/dt + A v, and derivatives by the rate of the shift at the second node, by which G is in A."""
    gather(system, element, motion.acceleration, work.coordinates[2])
    flow, vectors, length = work.flow, system.vectors, system.length[element]
    place, velocity, second = work.coordinates[0], work.coordinates[1], work.coordinates[2]
    derivative, growth = frame.derivative[element], frame.growth[element]
    first, last = flow_at_ends(frame, element, motion.velocity)
    rise, top = flow_at_ends(frame, element, motion.acceleration)
    change, bend = last - first, top - rise
    for a in range(len(vectors)):
        for axis in range(2):
            still, turned = second[vectors[a] + axis], 0.0
            grown = still_by_end = moved_by_end = 0.0
            for b in range(len(vectors)):
                c = vectors[b] + axis
                own = first * derivative[a, b] + change * growth[a, b]
                order = (b % 3 - a % 3 - 1.0) / length
                own_rate = velocity[c]
                for d in range(len(vectors)):
                    own_rate -= (first * derivative[b, d] + change * growth[b, d]) * place[vectors[d] + axis]
                still += (rise * derivative[a, b] + bend * growth[a, b] - own * change * order) * place[
                    c
                ] + own * own_rate
                turned += own * velocity[c]
                grown += growth[a, b] * place[c]
                still_by_end += growth[a, b] * (own_rate - change * order * place[c]) - own * order * place[c]
                moved_by_end += 2.0 * (growth[a, b] * velocity[c] - own * order * place[c])
            flow.still[a, axis], flow.moved[a, axis] = still, still + turned
            flow.grown[a, axis] = grown
            flow.still_by_end[a, axis], flow.moved_by_end[a, axis] = still_by_end, moved_by_end


find_accelerations: Callable[[Any, System, Motion, int, np.record], None] = by_type(
    {StayingByArcs: _of_steady, FlowingByArcs: _of_flow}, "find_accelerations"
)
"""Find the acceleration of an element's material points, and the rate of their velocity at places of the mesh."""


@kernel(inline=True)
def _no_rates(frame: StayingByArcs, element: int, motion: Motion) -> tuple[float, float]:
    return 0.0, 0.0


@kernel(inline=True)
def _rates(frame: FlowingByArcs, element: int, motion: Motion) -> tuple[float, float]:
    return flow_at_ends(frame, element, motion.acceleration)


_flow_rates = by_type({StayingByArcs: _no_rates, FlowingByArcs: _rates}, "flow_rates")


@kernel(inline=True)
def _no_end(frame: StayingByArcs, flow: np.record, index: int, value: float) -> None:
    """Shifts do not move in steady running."""


@kernel(inline=True)
def _to_end(frame: FlowingByArcs, flow: np.record, index: int, value: float) -> None:
    flow.by_end[index] += value


@kernel(inline=True)
def _no_force(
    frame: StayingByArcs,
    system: System,
    here: _Point,
    place: float,
    inertia: "_Inertia",
    factors: CarryingFactors,
    work: np.record,
) -> tuple[float, float]:
    return 0.0, 0.0


@kernel(inline=True)
def _force_by_end(
    frame: FlowingByArcs,
    system: System,
    here: _Point,
    place: float,
    inertia: "_Inertia",
    factors: CarryingFactors,
    work: np.record,
) -> tuple[float, float]:
    """Derivative of force and inertia at a point by the shift at the second node."""
    carry, flow, ux, uy = work.carrying, work.flow, inertia.x, inertia.y
    x = y = still = 0.0
    rate_x, rate_y = -place * here.slope_x, -place * here.slope_y  # of the place of the mesh, which grows
    for a in range(len(system.vectors)):
        shape, grown = carry.functions[a], flow.grown[a]
        x += shape * (factors.acceleration * grown[0] + factors.flow * flow.moved_by_end[a, 0])
        y += shape * (factors.acceleration * grown[1] + factors.flow * flow.moved_by_end[a, 1])
        along = grown[0] * ux + grown[1] * uy
        gained = flow.still_by_end[a, 0] * ux + flow.still_by_end[a, 1] * uy
        still += shape * (factors.acceleration * along + factors.flow * gained)
        rate_x, rate_y = rate_x + shape * grown[0], rate_y + shape * grown[1]
    speed = (rate_x + place * here.slope_x) * ux + (rate_y + place * here.slope_y) * uy
    against = inertia.rotating * still + factors.flow * carry.by_speed * speed
    x = factors.flow * (carry.by_rate[0, 0] * rate_x + carry.by_rate[0, 1] * rate_y) - inertia.riding * x
    y = factors.flow * (carry.by_rate[1, 0] * rate_x + carry.by_rate[1, 1] * rate_y) - inertia.riding * y
    return x - against * ux, y - against * uy


_by_end = by_type({StayingByArcs: _no_force, FlowingByArcs: _force_by_end}, "by_end")
_add_to_end = by_type({StayingByArcs: _no_end, FlowingByArcs: _to_end}, "add_to_end")


@kernel(inline=True)
def _covered(
    line: np.record, first: float, last: float, system: System, element: int, work: np.record
) -> tuple[float, float]:
    """Part of an element that lies on a stretch of a span, from 0 to 1; empty where it runs the other way."""
    e, (x, y), (ux, uy) = work.coordinates[0], line.origin, line.direction
    dof = len(system.scale)
    before = (e[0] - x) * ux + (e[1] - y) * uy
    after = (e[dof] - x) * ux + (e[dof + 1] - y) * uy
    if after <= before or last <= first:
        return 0.0, 0.0
    start = (first - before) / (after - before)
    stop = (last - before) / (after - before)
    return min(1.0, max(0.0, start)), min(1.0, max(0.0, stop))


@kernel(inline=True)
def _look(system: System, element: int, xi: float, work: np.record) -> _Point:
    """The belt at a place on an element, 0 to 1; fills the shape functions."""
    carry, derivative, vectors = work.carrying, system.frame.derivative[element], system.vectors
    fill_bernstein(xi, carry.weights)
    fill_shape_functions(system.control[element, 0], carry.weights, carry.functions)
    for b in range(len(vectors)):
        carry.rates[b] = 0.0
        for a in range(len(vectors)):
            carry.rates[b] += carry.functions[a] * derivative[a, b]
    for b in range(len(vectors)):
        carry.bends[b] = 0.0
        for a in range(len(vectors)):
            carry.bends[b] += carry.rates[a] * derivative[a, b]
    place, velocity, flow = work.coordinates[0], work.coordinates[1], work.flow
    x, y = _combined(vectors, carry.functions, place)
    qx, qy = _combined(vectors, carry.rates, place)
    vx, vy = _combined(vectors, carry.functions, velocity)
    tx, ty = _combined(vectors, carry.rates, velocity)
    bx, by = _combined(vectors, carry.bends, place)
    sx = sy = ax = ay = 0.0
    for a in range(len(vectors)):
        sx, sy = sx + carry.functions[a] * flow.still[a, 0], sy + carry.functions[a] * flow.still[a, 1]
        ax, ay = ax + carry.functions[a] * flow.moved[a, 0], ay + carry.functions[a] * flow.moved[a, 1]
    return _Point(x, y, qx, qy, vx, vy, tx, ty, bx, by, sx, sy, ax, ay)


@kernel(inline=True)
def _combined(vectors: tuple[int, ...], functions: FloatArray, values: FloatArray) -> tuple[float, float]:
    x = y = 0.0
    for a in range(len(vectors)):
        x += functions[a] * values[vectors[a]]
        y += functions[a] * values[vectors[a] + 1]
    return x, y


@kernel(inline=True)
def _push(row: np.record, here: _Point, flow: _Flow, carry: np.record) -> None:
    """Force of a support on a meter of span, and its derivatives; without rotating mass.

    The normal force follows the depth at a place of the mesh, resistance the velocity of the material.
    """
    (ux, uy), line = row.line.direction, row.line
    away_x, away_y = here.x - line.origin[0], here.y - line.origin[1]
    along = away_x * ux + away_y * uy
    height = row.raised - 0.5 * row.curvature * (along - line.first) * (line.last - along)
    slope = -0.5 * row.curvature * (line.first + line.last - 2.0 * along)
    nx, ny = row.normal[0] - slope * ux, row.normal[1] - slope * uy
    depth = height - row.normal[0] * away_x - row.normal[1] * away_y
    rate_x, rate_y = here.velocity_x - flow.speed * here.slope_x, here.velocity_y - flow.speed * here.slope_y
    normal = row.stiffness * depth - row.damping * (nx * rate_x + ny * rate_y)
    held = row.both_sides == 1 or (depth > 0.0 and normal > 0.0)
    normal = normal if held else 0.0
    stiffness, damping = (row.stiffness, row.damping) if held else (0.0, 0.0)
    speed = here.velocity_x * ux + here.velocity_y * uy
    given = resistance_of_kind(row, abs(normal), speed)
    drag, by_speed = row.resisting * given.force, row.resisting * given.by_speed
    by_normal = given.by_normal * (row.resisting if normal >= 0.0 else -row.resisting)
    px, py = nx - by_normal * ux, ny - by_normal * uy
    turned = damping * row.curvature * (rate_x * ux + rate_y * uy)
    gx, gy = -stiffness * nx + turned * ux, -stiffness * ny + turned * uy
    carry.force[0], carry.force[1] = normal * nx - drag * ux, normal * ny - drag * uy
    bent = normal * row.curvature
    carry.by_place[0, 0], carry.by_place[0, 1] = px * gx - bent * ux * ux, px * gy - bent * ux * uy
    carry.by_place[1, 0], carry.by_place[1, 1] = py * gx - bent * ux * uy, py * gy - bent * uy * uy
    carry.by_rate[0, 0], carry.by_rate[0, 1] = -damping * px * nx, -damping * px * ny
    carry.by_rate[1, 0], carry.by_rate[1, 1] = -damping * py * nx, -damping * py * ny
    carry.by_speed = by_speed


class _Inertia(NamedTuple):
    """What follows the belt on a meter of span."""

    riding: float
    """Mass with the acceleration of the material, kg/m."""
    rotating: float
    """Mass with the rate of the belt's speed along the span at a place, kg/m."""
    x: float
    """Direction of the span."""
    y: float


@kernel(inline=True)
def _add_point(
    system: System,
    here: _Point,
    flow: _Flow,
    inertia: _Inertia,
    weight: float,
    factors: CarryingFactors,
    work: np.record,
) -> float:
    """Add force and inertia at a point to residual and tangent of an element; gives the power taken, W."""
    carry, riding, rotating, ux, uy = work.carrying, inertia.riding, inertia.rotating, inertia.x, inertia.y
    span = here.slope_x * ux + here.slope_y * uy
    turning = rotating * (here.still_x * ux + here.still_y * uy)
    fx = carry.force[0] - riding * here.moved_x - turning * ux
    fy = carry.force[1] - riding * here.moved_y - turning * uy
    gradient, vectors = work.element.gradient, system.vectors
    for a in range(len(vectors)):
        share = weight * span * carry.functions[a]
        gradient[vectors[a]] -= share * fx
        gradient[vectors[a] + 1] -= share * fy
    if factors.place != 0.0 or factors.rate != 0.0 or factors.acceleration != 0.0:
        _add_tangent(system, flow, inertia, weight * span, factors, work)
        _add_stretching(system, fx, fy, inertia, weight * factors.place, work)
        _add_column(system, here, flow, inertia, weight * span, factors, work)
    return float(-weight * span * (fx * here.velocity_x + fy * here.velocity_y))


@kernel(inline=True)
def _add_tangent(
    system: System, flow: _Flow, inertia: _Inertia, weight: float, factors: CarryingFactors, work: np.record
) -> None:
    """Derivatives by the vectors, their rates and accelerations, a meter of span for a meter of belt."""
    carry, tangent, vectors, speed = work.carrying, work.element.tangent, system.vectors, flow.speed
    ux, uy = inertia.x, inertia.y
    for b in range(len(vectors)):
        shape, rate, bend = carry.functions[b], carry.rates[b], carry.bends[b]
        place, own = factors.place * shape, factors.rate * shape
        drag = carry.by_speed * (own + factors.place * speed * rate)
        still = factors.acceleration * shape + (factors.rate * speed + factors.place * flow.change) * rate
        riding = inertia.riding * (still + factors.rate * speed * rate + factors.place * speed * speed * bend)
        rotating = inertia.rotating * still
        lasting = rotating + drag
        xx = carry.by_place[0, 0] * place + carry.by_rate[0, 0] * own - riding - lasting * ux * ux
        xy = carry.by_place[0, 1] * place + carry.by_rate[0, 1] * own - lasting * ux * uy
        yx = carry.by_place[1, 0] * place + carry.by_rate[1, 0] * own - lasting * ux * uy
        yy = carry.by_place[1, 1] * place + carry.by_rate[1, 1] * own - riding - lasting * uy * uy
        for a in range(len(vectors)):
            _subtract(tangent, vectors[a], vectors[b], weight * carry.functions[a], (xx, xy, yx, yy))


@kernel(inline=True)
def _add_stretching(system: System, fx: float, fy: float, inertia: _Inertia, weight: float, work: np.record) -> None:
    """Derivatives by the length of span on which a meter of belt lies."""
    carry, tangent, vectors = work.carrying, work.element.tangent, system.vectors
    for b in range(len(vectors)):
        by_x, by_y = weight * carry.rates[b] * inertia.x, weight * carry.rates[b] * inertia.y
        block = (fx * by_x, fx * by_y, fy * by_x, fy * by_y)
        for a in range(len(vectors)):
            _subtract(tangent, vectors[a], vectors[b], carry.functions[a], block)


@kernel(inline=True)
def _subtract(
    tangent: FloatArray, row: int, column: int, share: float, block: tuple[float, float, float, float]
) -> None:
    """Subtract a share of a block xx, xy, yx, yy, for two vectors of an element."""
    tangent[row, column] -= share * block[0]
    tangent[row, column + 1] -= share * block[1]
    tangent[row + 1, column] -= share * block[2]
    tangent[row + 1, column + 1] -= share * block[3]


@kernel(inline=True)
def _add_column(
    system: System,
    here: _Point,
    flow: _Flow,
    inertia: _Inertia,
    weight: float,
    factors: CarryingFactors,
    work: np.record,
) -> None:
    """Derivative by the flow, into its column."""
    carry, column, vectors, ux, uy = work.carrying, work.flow.by_speed, system.vectors, inertia.x, inertia.y
    vx, vy = factors.flow * here.slope_x, factors.flow * here.slope_y
    own_x, own_y = factors.acceleration * here.slope_x, factors.acceleration * here.slope_y
    still_x = own_x + factors.flow * (here.turn_x - flow.speed * here.bend_x)
    still_y = own_y + factors.flow * (here.turn_y - flow.speed * here.bend_y)
    against = inertia.rotating * (still_x * ux + still_y * uy) + carry.by_speed * (vx * ux + vy * uy)
    fx = -inertia.riding * (own_x + 2.0 * factors.flow * here.turn_x) - against * ux
    fy = -inertia.riding * (own_y + 2.0 * factors.flow * here.turn_y) - against * uy
    end_x, end_y = _by_end(system.frame, system, here, flow.place, inertia, factors, work)
    for a in range(len(vectors)):
        share = weight * carry.functions[a]
        column[vectors[a]] -= share * fx
        column[vectors[a] + 1] -= share * fy
        _add_to_end(system.frame, work.flow, vectors[a], -share * end_x)
        _add_to_end(system.frame, work.flow, vectors[a] + 1, -share * end_y)


@kernel(inline=True)
def _flow_at(flows: tuple[float, float], rates: tuple[float, float], xi: float) -> _Flow:
    return _Flow(flows[0] + (flows[1] - flows[0]) * xi, rates[0] + (rates[1] - rates[0]) * xi, xi)


@kernel(inline=True)
def has_any(carrying: Any, element: int) -> bool:
    """Whether anything may carry an element, or is carried by it."""
    supports, goods = carrying.first_support, carrying.first_goods
    return bool(supports[element] != supports[element + 1] or goods[element] != goods[element + 1])


@kernel
def add_to_element(
    carrying: Any,
    system: System,
    motion: Motion,
    element: int,
    factors: CarryingFactors,
    work: np.record,
    forces: BodyForces,
) -> None:
    """Add what carries an element, and what it carries.

    `carrying`: that of the system; `system`, `motion`: a belt on a staying mesh, and its state; `element`: which one;
    its coordinates, the velocities of its material points and what `find_accelerations` finds are in the workspace;
    `factors`: of the tangent; `work`: from `element_workspace`; residual, tangent and column of the element are
    changed; `forces`: the power that supports and goods take is added.
    """
    first, last = carrying.first_support[element], carrying.first_support[element + 1]
    first_goods, last_goods = carrying.first_goods[element], carrying.first_goods[element + 1]
    flows, rates = flow_at_ends(system.frame, element, motion.velocity), _flow_rates(system.frame, element, motion)
    rule, length, carry, taken = carrying.rule, system.length[element], work.carrying, 0.0
    for k in range(first, last):
        row = carrying.supports[carrying.support[k]]
        start, stop = _covered(row.line, row.line.first, row.line.last, system, element, work)
        if stop > start:
            inertia = _Inertia(0.0, row.rotating, row.line.direction[0], row.line.direction[1])
            for point in range(rule.points.size):
                xi = start + (stop - start) * rule.points[point]
                here, flow = _look(system, element, xi, work), _flow_at(flows, rates, xi)
                _push(row, here, flow, carry)
                weight = length * (stop - start) * rule.weights[point]
                taken += _add_point(system, here, flow, inertia, weight, factors, work)
    carry.by_place[:], carry.by_rate[:], carry.by_speed = 0.0, 0.0, 0.0
    for k in range(first_goods, last_goods):
        goods = carrying.goods[carrying.on_element[k]]
        passed = goods.stretch * passed_length(system.frame, motion.position)
        rear, front = max(goods.line.first, goods.rear + passed), min(goods.line.last, goods.front + passed)
        start, stop = _covered(goods.line, rear, front, system, element, work)
        mass = goods.mass * schedule_value(system.profiles, goods.schedule, motion.time)
        if stop > start and mass != 0.0:
            inertia = _Inertia(mass, 0.0, goods.line.direction[0], goods.line.direction[1])
            carry.force[0], carry.force[1] = mass * carrying.gravity[0], mass * carrying.gravity[1]
            for point in range(rule.points.size):
                xi = start + (stop - start) * rule.points[point]
                here, flow = _look(system, element, xi, work), _flow_at(flows, rates, xi)
                weight = length * (stop - start) * rule.weights[point]
                taken += _add_point(system, here, flow, inertia, weight, factors, work)
    forces.power[CARRYING_LOSS] += taken


@kernel
def _add(
    carrying: Carrying,
    system: System,
    motion: Motion,
    element: int,
    factors: CarryingFactors,
    work: np.record,
    forces: BodyForces,
) -> None:
    """The same, with its accelerations, where there is anything."""
    if has_any(carrying, element):
        find_accelerations(system.frame, system, motion, element, work)
        add_to_element(carrying, system, motion, element, factors, work, forces)


@kernel(inline=True)
def _add_nothing(
    carrying: Bare,
    system: System,
    motion: Motion,
    element: int,
    factors: CarryingFactors,
    work: np.record,
    forces: BodyForces,
) -> None:
    """Nothing carries the belt."""


add_carrying: Callable[..., None] = by_type({Bare: _add_nothing, Carrying: _add}, "add_carrying")
"""Add supports and goods to residual, tangent and column of an element, and what they take to the powers; the first
argument is that part of the system."""


@kernel(inline=True)
def _add_carried(
    carrying: Carrying,
    system: System,
    motion: Motion,
    element: int,
    factors: CarryingFactors,
    work: np.record,
    forces: BodyForces,
) -> None:
    """The same with accelerations that are found already."""
    if has_any(carrying, element):
        add_to_element(carrying, system, motion, element, factors, work, forces)


add_carried: Callable[..., None] = by_type({Bare: _add_nothing, Carrying: _add_carried}, "add_carried")
"""The same as `add_carrying`, where the accelerations of the element are in the workspace."""

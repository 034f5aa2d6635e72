"""A web line over time: the flows of its ends differ, and lengths of web go over from span to span.

The mesh stays at every roller, as that of a belt that carries, and its last node at the winder.  Both ends are held in
place, and their web moves along it with the flow there.  The virtual work of such motions is that of the tensions,

    t . g_0 + T_0 = 0,        t . g_N - T_N = 0,

with g the residual of the equations of a node and t the unit vector along the web: the equations of the flow at the
unwinder and of the shift at the winder.

A roll turns with its web, w = v/R, and web of the mass m of a meter takes the moment of momentum m v R of a second with
it.  As dJ/dl = m R^2, its moment of momentum balances by

    J dw/dt = +/- (M - T R),        T = M/R -/+ (J/R^2) (dv/dt -/+ v^2 dR/dl / (R g)),

at the winder and, below, at the unwinder, with the stretch g: a roll is a mass J/R^2 at the end of the line.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.profiles.functions import profile_value
from beltdyn.model import Prepared
from beltdyn.stretch import stretching
from beltdyn.system.arc_mesh import Zone, by_arcs, zones_of
from beltdyn.system.arrays import (
    TORQUE_WORK,
    BodyForces,
    Motion,
    RingMatrix,
    System,
    TangentFactors,
)
from beltdyn.system.element_state import gather_motion
from beltdyn.system.frame import node_shift
from beltdyn.system.ring_matrix import hold_at_end
from beltdyn.system.web import RollSize, WebEnds, WebLine, size_of


class RunningWeb(NamedTuple):
    """Both ends of a web that flows in and out at speeds of their own."""

    ends: WebEnds


def running_web(prepared: Prepared, system: System) -> System:
    """The arrays of a web line in steady running or at rest, for equations over time."""
    line = system.carriage
    assert isinstance(line, WebLine)
    zones, length = zones_of(prepared), float(np.sum(system.length))
    end = Zone(length, length, len(zones))
    moved = by_arcs(prepared, system, zones, [Zone(0.0, 0.0, -1), *zones, end, Zone(np.inf, np.inf, -1)])
    arcs = moved.frame.arcs
    last = prepared.path.ends[1] if prepared.path.ends is not None else np.zeros(2)
    arcs = arcs._replace(
        node=np.append(arcs.node, system.nodes - 1),
        direction=np.vstack([arcs.direction, np.zeros(2)]),
        place=np.vstack([arcs.place, last]),
        carrier=np.append(arcs.carrier, -1),
    )
    frame = moved.frame._replace(shift=np.zeros(len(arcs.node)), arcs=arcs)
    free = moved.supports._replace(fixed=np.zeros_like(moved.supports.fixed), any_fixed=False)
    return moved._replace(frame=frame, carriage=RunningWeb(line.ends), supports=free)


@kernel
def push_running(
    line: RunningWeb,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    wanted: bool,
    corner: FloatArray,
    forces: BodyForces,
) -> None:
    """Add the power that comes in and goes out with the web to that of loads."""
    section = system.element.section
    for end in range(2):
        stretch, speed = end_stretch(system, motion.position, end), end_flow(system, motion.velocity, end)
        metric = stretch * stretch
        own = stretching(section.stretch, metric)
        if line.ends.rolls[end].driven:  # kinetic energy goes over to the roll
            torque = profile_value(line.ends.torque, end, motion.time)[0]
            held = torque * stretch / roll_size(line, system, motion.position, end).radius - own.energy
        else:
            held = line.ends.tensions[end] * stretch - own.energy - 0.5 * section.mass * speed * speed * metric
        forces.power[TORQUE_WORK] += speed * (held if end == 1 else -held)


@kernel(inline=True)
def end_flow(system: System, velocity: FloatArray, end: int) -> float:
    """Unstretched length that passes an end in a unit of time, m/s; from positions what has passed, m."""
    return float(velocity[system.frame.place] + node_shift(system.frame, velocity, end * (system.nodes - 1)))


@kernel(inline=True)
def end_stretch(system: System, position: FloatArray, end: int) -> float:
    """Stretch of the web at an end."""
    at = len(system.scale) * end * (system.nodes - 1) + system.turned
    return float((position[at] * position[at] + position[at + 1] * position[at + 1]) ** 0.5)


@kernel(inline=True)
def roll_size(line: RunningWeb, system: System, position: FloatArray, end: int) -> RollSize:
    """A roll with the web that has passed."""
    return size_of(line.ends.rolls[end], (2.0 * end - 1.0) * end_flow(system, position, end))


class _Pull(NamedTuple):
    """Tension of the web at an end, and its derivatives but those by the size of a roll, which changes slowly."""

    tension: float
    """N."""
    inertia: float
    """Of the roll, N, which is taken off the tension."""
    by_slope: tuple[float, float]
    """By the vector dr/dX of the node there."""
    by_slope_rate: tuple[float, float]
    by_flow: float
    by_flow_rate: float


@kernel
def _pull(line: RunningWeb, system: System, motion: Motion, end: int) -> _Pull:
    """Tension as given, or that of a roll by its torque and its inertia."""
    if not line.ends.rolls[end].driven:
        return _Pull(line.ends.tensions[end], 0.0, (0.0, 0.0), (0.0, 0.0), 0.0, 0.0)
    size, sense = roll_size(line, system, motion.position, end), 2.0 * end - 1.0
    at = len(system.scale) * end * (system.nodes - 1) + system.turned
    x, y, vx, vy = motion.position[at], motion.position[at + 1], motion.velocity[at], motion.velocity[at + 1]
    stretch = (x * x + y * y) ** 0.5
    x, y = x / stretch, y / stretch
    rate = x * vx + y * vy
    flow, change = end_flow(system, motion.velocity, end), end_flow(system, motion.acceleration, end)
    mass, grows = sense * size.inertia / size.radius**2, sense * size.growth
    gains = change * stretch + flow * rate - grows * flow * flow * stretch
    along = mass * (change - grows * flow * flow)
    across_x, across_y = mass * flow * (vx - rate * x) / stretch, mass * flow * (vy - rate * y) / stretch
    return _Pull(
        profile_value(line.ends.torque, end, motion.time)[0] / size.radius - mass * gains,
        mass * gains,
        (-along * x - across_x, -along * y - across_y),
        (-mass * flow * x, -mass * flow * y),
        -mass * (rate - 2.0 * grows * flow * stretch),
        -mass * stretch,
    )


@kernel(inline=True)
def rolls_energy_of(line: RunningWeb, system: System, position: FloatArray, velocity: FloatArray) -> float:
    """Kinetic energy of rolls with a torque, J; those that keep a tension are no part of the line."""
    total = 0.0
    for end in range(2):
        if line.ends.rolls[end].driven:
            size, speed = roll_size(line, system, position, end), _web_speed(system, position, velocity, end)
            total += 0.5 * size.inertia * (speed / size.radius) ** 2
    return total


@kernel(inline=True)
def _web_speed(system: System, position: FloatArray, velocity: FloatArray, end: int) -> float:
    """Speed of the web at an end, m/s."""
    return float(end_flow(system, velocity, end) * end_stretch(system, position, end))


@kernel
def gone_with_web(line: RunningWeb, system: System, before: Motion, after: Motion, work: np.record) -> float:
    """Kinetic energy that goes out with the web in a step, less what comes in, beyond that of a line of this content.

    `line`: the ends; `system`: with the lengths of elements after the step; `before`, `after`: both ends of the step;
    `work`: from `element_workspace`.
    """
    total, frame, vectors = 0.0, system.frame, system.vectors
    for element in range(system.length.size):
        began = node_shift(frame, before.position, element + 1) - node_shift(frame, before.position, element)
        ended = node_shift(frame, after.position, element + 1) - node_shift(frame, after.position, element)
        longer = (began - ended) / system.length[element]
        if longer == 0.0:
            continue
        gather_motion(system, element, after.position, after.velocity, work.coordinates)
        mass, speed = system.mass[element], work.coordinates[1]
        for a in range(len(vectors)):
            for b in range(len(vectors)):
                part = 0.5 * longer * (1.0 + a % 3 + b % 3) * mass[vectors[a], vectors[b]]
                for axis in range(2):
                    total += part * speed[vectors[a] + axis] * speed[vectors[b] + axis]
    step = after.time - before.time
    for end in range(2):
        sense, force, stretch = 2.0 * end - 1.0, 0.0, 0.0
        for moment in range(2):
            motion = before if moment == 0 else after
            flow, speed = (
                end_flow(system, motion.velocity, end),
                _web_speed(system, motion.position, motion.velocity, end),
            )
            force += 0.5 * _pull(line, system, motion, end).inertia
            stretch += 0.5 * end_stretch(system, motion.position, end)
            if not line.ends.rolls[end].driven:  # the kinetic energy of the web goes over to rolls
                total += 0.25 * step * sense * system.element.section.mass * flow * speed * speed
        passed = end_flow(system, after.position, end) - end_flow(system, before.position, end)
        total -= sense * force * stretch * passed
    rolls = rolls_energy_of(line, system, after.position, after.velocity)
    return total + rolls - rolls_energy_of(line, system, before.position, before.velocity)


@kernel
def carry_web(
    line: RunningWeb, system: System, motion: Motion, factors: TangentFactors, wanted: bool, matrix: RingMatrix
) -> None:
    """Give the equations along the web at its ends to the flows there, and hold the ends."""
    dof, last = len(system.scale), matrix.corner.shape[0] - 1
    for end in range(2):
        node, own, sense = end * (system.nodes - 1), last - end, 1.0 if end == 0 else -1.0
        at = dof * node + system.turned
        x, y = motion.position[at], motion.position[at + 1]
        size = (x * x + y * y) ** 0.5
        for axis in range(2):
            t = (x if axis == 0 else y) / size
            matrix.border_side[own] += t * matrix.node_side[node, axis]
            if wanted:
                _give_row(node, system.nodes, own, axis, t, matrix)
        pull = _pull(line, system, motion, end)
        matrix.border_side[own] += sense * pull.tension
        if wanted:
            for axis in range(2):
                by_slope = factors.by_position * pull.by_slope[axis] + factors.by_velocity * pull.by_slope_rate[axis]
                matrix.row[node, own, system.turned + axis] += sense * by_slope
            by_flow = factors.by_velocity * pull.by_flow + factors.by_acceleration * pull.by_flow_rate
            for k in range(own, last + 1):  # the flow at the winder is that at the unwinder and a shift
                matrix.corner[own, k] += sense * by_flow
        for axis in range(2):
            matrix.node_side[node, axis] = 0.0
            if wanted:
                hold_at_end(matrix, node, axis)


@kernel(inline=True)
def _give_row(node: int, nodes: int, own: int, axis: int, factor: float, matrix: RingMatrix) -> None:
    """Add a row of a node at an end, times a factor, to that of a body."""
    first = node == 0
    beside = 1 if first else nodes - 2
    for c in range(matrix.diagonal.shape[1]):
        matrix.row[node, own, c] += factor * matrix.diagonal[node, axis, c]
        matrix.row[beside, own, c] += factor * (matrix.upper[node, axis, c] if first else matrix.lower[beside, axis, c])
    for k in range(matrix.corner.shape[0]):
        matrix.corner[own, k] += factor * matrix.column[node, axis, k]

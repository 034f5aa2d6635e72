"""A web line over time: the flows of its ends differ, and lengths of web go over from span to span.

The mesh stays at every roller, as that of a belt that carries, and its last node at the winder.  Both ends are held in
place, and their web moves along it with the flow there.  The virtual work of such motions is that of the tensions,

    t . g_0 + T_0 = 0,        t . g_N - T_N = 0,

with g the residual of the equations of a node and t the unit vector along the web: the equations of the flow at the
unwinder and of the shift at the winder.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.kernel import kernel
from beltdyn.model import Prepared
from beltdyn.stretch import stretching
from beltdyn.system.arc_mesh import Zone, by_arcs, zones_of
from beltdyn.system.arrays import TORQUE_WORK, BodyForces, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.element_state import gather_motion
from beltdyn.system.frame import flow_speed, node_shift
from beltdyn.system.ring_matrix import hold_at_end
from beltdyn.system.web import WebLine


class RunningWeb(NamedTuple):
    """Both ends of a web that flows in and out at speeds of their own."""

    tensions: FloatArray
    """Of the web at the unwinder and at the winder, N, shape (2,)."""


def running_web(prepared: Prepared, system: System) -> System:
    """The arrays of a web line in steady running or at rest, for equations over time."""
    line = system.carriage
    assert isinstance(line, WebLine)
    zones, length = zones_of(prepared), float(np.sum(system.length))
    end = Zone(length, length, len(zones))
    before, after, share = _shares([*zones, end], np.append(0.0, np.cumsum(system.length)))
    moved = by_arcs(prepared, system, zones, before, after, share)
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
    return moved._replace(frame=frame, carriage=RunningWeb(line.tensions), supports=free)


def _shares(zones: list[Zone], nodes: FloatArray) -> tuple[IntArray, IntArray, FloatArray]:
    """Arcs on both sides of each node, -1 before the first, and the share of the second."""
    before, after, share = np.full(nodes.size, -1), np.full(nodes.size, -1), np.zeros(nodes.size)
    for one, other in pairwise([Zone(0.0, 0.0, -1), *zones, Zone(np.inf, np.inf, -1)]):
        between = (nodes >= one.start) & (nodes < other.start)
        way = other.start - one.end
        before[between], after[between] = one.pulley, other.pulley
        share[between] = np.clip((nodes[between] - one.end) / way, 0.0, 1.0) if np.isfinite(way) else 0.0
    return before, after, share


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
    dof, section = len(system.scale), system.element.section
    for end in range(2):
        node = end * (system.nodes - 1)
        at = dof * node + system.turned
        metric = motion.position[at] * motion.position[at] + motion.position[at + 1] * motion.position[at + 1]
        speed = flow_speed(system.frame, motion.velocity) + node_shift(system.frame, motion.velocity, node)
        own = stretching(section.stretch, metric)
        held = line.tensions[end] * metric**0.5 - own.energy - 0.5 * section.mass * speed * speed * metric
        forces.power[TORQUE_WORK] += speed * (held if end == 1 else -held)


@kernel
def gone_with_web(line: RunningWeb, system: System, before: Motion, after: Motion, work: np.record) -> float:
    """Kinetic energy that goes out with the web in a step, less what comes in, beyond that of a line of this content.

    `line`: the ends; `system`: with the lengths of elements after the step; `before`, `after`: both ends of the step;
    `work`: from `element_workspace`.
    """
    total, frame, vectors, dof = 0.0, system.frame, system.vectors, len(system.scale)
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
        node = end * (system.nodes - 1)
        at = dof * node + system.turned
        for moment in range(2):
            motion = before if moment == 0 else after
            flow = flow_speed(frame, motion.velocity) + node_shift(frame, motion.velocity, node)
            x, y = motion.position[at], motion.position[at + 1]
            power = 0.5 * system.element.section.mass * flow * flow * flow * (x * x + y * y)
            total += 0.5 * step * (power if end == 1 else -power)
    return total


@kernel
def carry_web(line: RunningWeb, system: System, motion: Motion, wanted: bool, matrix: RingMatrix) -> None:
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
        matrix.border_side[own] += sense * line.tensions[end]
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

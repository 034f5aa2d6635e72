"""The carriage of a linear axis: a body that slides along a guide and carries both ends of the belt.

With the way s of the carriage along the unit vector u, the ends r_0 and r_N of the belt move as r = p + s u. Their
forces act on the carriage, and their increments are those of s:

    m d2s/dt2 = F(t) + weight - friction - stops - u . (g_0 + g_N),        dr_0 = dr_N = u ds,

with g the residual of the equations of a node. Elimination is exact: the ends stay where the carriage holds them.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, Records, record, records
from beltdyn.kernel import by_type, kernel
from beltdyn.machines.profiles.functions import Profiles, profile_rows, profile_value
from beltdyn.machines.tensioners.tensioner import SPRING, spring_force
from beltdyn.model import Prepared
from beltdyn.system.arc_mesh import arc_count
from beltdyn.system.arrays import (
    BODY,
    SPRING_ENERGY,
    TORQUE_WORK,
    BodyForces,
    Motion,
    NoCarriage,
    RingMatrix,
    Supports,
    System,
    TangentFactors,
)
from beltdyn.system.frame import FlowingByArcs, Travelling
from beltdyn.system.ring_matrix import hold_at_end
from beltdyn.system.running_web import RunningWeb, carry_web, push_running, rolls_energy_of
from beltdyn.system.web import WebLine, push_web

GUIDE = record(
    body="i8",  # its number
    direction="2f8",  # u
    spring=SPRING,  # weight along the guide as preload, friction and stops
)
"""A carriage on its guide."""


class Guided(NamedTuple):
    """A carriage that both ends of the belt are clamped to."""

    table: Records
    """One row of `GUIDE`."""
    push: Profiles
    """The force on it over time, N."""


def with_carriage(prepared: Prepared, system: System) -> System:
    """The arrays of an open belt with fixed ends, whose ends a carriage carries, if the drive has one."""
    carriage = prepared.carriage
    if carriage is None:
        return system
    ends, dof = [0, system.nodes - 1], len(system.scale)
    fixed = system.supports.fixed.copy().reshape(-1, dof)
    fixed[ends, :2] = False
    supports: Supports = system.supports._replace(fixed=fixed.ravel(), any_fixed=bool(fixed.any()))
    body = system.bodies.size
    free = int(np.max(system.bodies.unknown, initial=-1)) + 1
    own = records(BODY, inertia=[carriage.mass], kinetic=carriage.mass, unknown=free, reach=1.0)
    weight = carriage.mass * float(np.dot(prepared.gravity, carriage.direction))
    table = records(GUIDE, body=[body], direction=[carriage.direction])
    for name, value in (carriage.spring | {"preload": weight}).items():
        table["spring"][name] = value
    return system._replace(
        supports=supports,
        bodies=np.concatenate([system.bodies, own]).view(np.recarray),
        carriage=Guided(table, profile_rows([carriage.force], [()])),
    )


def behind_flows(carriage: Any, flows: int) -> Any:
    """The carriage with its body behind those of flows, if there is one."""
    if not isinstance(carriage, Guided):
        return carriage
    table = carriage.table.copy()
    table["body"] += flows
    return carriage._replace(table=table)


@kernel(inline=True)
def _push_nothing(
    carriage: NoCarriage,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    wanted: bool,
    corner: Any,
    forces: BodyForces,
) -> None:
    pass


@kernel
def _push(
    carriage: Guided,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    wanted: bool,
    corner: Any,
    forces: BodyForces,
) -> None:
    """Force, weight, friction and stops; what they do is the work of a load."""
    row = carriage.table[0]
    at = system.first_body + row.body
    own = spring_force(row, motion.position[at], motion.velocity[at])
    push = profile_value(carriage.push, 0, motion.time)[0]
    forces.force[row.body] += own.force + push
    forces.power[TORQUE_WORK] += push * motion.velocity[at] - own.loss
    forces.stored[SPRING_ENERGY] += own.energy
    unknown = system.bodies[row.body].unknown
    if unknown >= 0 and wanted:
        corner[unknown, unknown] -= factors.by_position * own.by_position + factors.by_velocity * own.by_velocity


push_carriage: Callable[..., None] = by_type(
    {NoCarriage: _push_nothing, Guided: _push, WebLine: push_web, RunningWeb: push_running}, "push_carriage"
)
"""Add the forces on a carriage to those on bodies, their power and, if it is wanted, their tangent."""


@kernel(inline=True)
def _carry_nothing(
    carriage: NoCarriage, system: System, motion: Motion, factors: TangentFactors, wanted: bool, matrix: RingMatrix
) -> None:
    pass


@kernel(inline=True)
def _no_flow(frame: Travelling, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    """Nodes travel with the belt."""


@kernel(inline=True)
def _stop_flow(frame: FlowingByArcs, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    last = matrix.corner.shape[0] - 1
    matrix.border_side[last] = motion.acceleration[frame.place]
    matrix.corner[last, last] = factors.by_acceleration if factors.by_acceleration != 0.0 else factors.by_position


_let_none_pass = by_type({Travelling: _no_flow, FlowingByArcs: _stop_flow}, "let_none_pass")
"""Let no belt flow past the ends, which the carriage holds."""


@kernel
def _carry(
    carriage: Guided, system: System, motion: Motion, factors: TangentFactors, wanted: bool, matrix: RingMatrix
) -> None:
    """Give equations and increments of the ends to the carriage; ends of one that is held stay."""
    row = carriage.table[0]
    own = system.bodies[row.body].unknown
    _let_none_pass(system.frame, motion, factors, matrix)
    for end in (0, system.nodes - 1):
        for a in range(2):
            if own >= 0:
                matrix.border_side[own] += row.direction[a] * matrix.node_side[end, a]
            matrix.node_side[end, a] = 0.0
        if wanted:
            if own >= 0:
                _move_columns(system, end, own, row.direction, matrix)
            _clear_end(end, own, row.direction, matrix)


@kernel(inline=True)
def _move_columns(system: System, end: int, own: int, direction: FloatArray, matrix: RingMatrix) -> None:
    """Add rows and columns of the place of an end to those of the carriage."""
    first, dof = end == 0, len(system.scale)
    beside = 1 if first else end - 1
    for a in range(2):
        u = direction[a]
        for c in range(dof):
            out = matrix.upper[end, a, c] if first else matrix.lower[beside, a, c]
            back = matrix.lower[end, c, a] if first else matrix.upper[beside, c, a]
            matrix.row[beside, own, c] += u * out
            matrix.column[beside, c, own] += u * back
            if c >= 2:
                matrix.row[end, own, c] += u * matrix.diagonal[end, a, c]
                matrix.column[end, c, own] += u * matrix.diagonal[end, c, a]
        for b in range(2):
            matrix.corner[own, own] += u * matrix.diagonal[end, a, b] * direction[b]
        for k in range(matrix.corner.shape[0]):
            matrix.corner[own, k] += u * matrix.column[end, a, k]
            matrix.corner[k, own] += u * matrix.row[end, k, a]


@kernel(inline=True)
def _clear_end(end: int, own: int, direction: FloatArray, matrix: RingMatrix) -> None:
    """Let the place of an end follow the carriage: dr = u ds, or zero."""
    for a in range(2):
        hold_at_end(matrix, end, a)
        if own >= 0:
            matrix.column[end, a, own] = -direction[a]


carry_ends: Callable[..., None] = by_type(
    {NoCarriage: _carry_nothing, Guided: _carry, RunningWeb: carry_web}, "carry_ends"
)
"""Let a carriage carry the ends of the belt, when all else is assembled."""


@kernel(inline=True)
def _no_rolls(carriage: Any, system: System, position: FloatArray, velocity: FloatArray) -> float:
    return 0.0


rolls_energy: Callable[[Any, System, FloatArray, FloatArray], float] = by_type(
    {NoCarriage: _no_rolls, Guided: _no_rolls, WebLine: _no_rolls, RunningWeb: rolls_energy_of}, "rolls_energy"
)
"""Kinetic energy of the rolls of a web line at a state, J."""


def rows_of_ties(system: System, size: int) -> IntArray:
    """Rows of equations, of as many as given, that keep a staying mesh in its place, or ends of a web line."""
    last, arcs = size - 1, arc_count(system.frame)
    if not isinstance(system.carriage, RunningWeb):
        return np.arange(last - arcs, size)
    dof = len(system.scale)
    ends = dof * np.array([0, system.nodes - 1])[:, None] + np.arange(2)
    return np.concatenate([ends.ravel(), np.arange(last - arcs, last - 1)])

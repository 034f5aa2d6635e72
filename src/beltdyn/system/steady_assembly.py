"""Equations of steady running in a staying mesh: residual and exact tangent.

dU/de + dR/dv - c^2 C e - Q_c(e, v, omega) - F = 0,   v = c D e     belt
moment + T_a = 0                                             free bodies
t . (r_0 - p) = 0                                            node 0 keeps its place along the belt

Unknowns are e, the speeds of free pulleys, states of controllers, places of tensioners, and c.  What depends on
velocities has the tangent
d/de + c (d/dv) D, and the column (d/dv) D e of c.  At rest a force along t on node 0 is unknown
in the place of c.  A belt with teeth has other unknowns (`beltdyn.system.meshing`).
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.dispatch import elastic_force
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import add_holding_force, fit_mesh, hold_arcs
from beltdyn.system.arc_tangent import add_steady_shifts
from beltdyn.system.arrays import NO_TANGENT, Equations, Motion, NoCarriage, System, TangentFactors
from beltdyn.system.body_forces import clear_body_forces, controls
from beltdyn.system.carrying import CarryingFactors, add_carrying
from beltdyn.system.element_state import gather_motion
from beltdyn.system.flow_tangent import NO_FLOW_TANGENT, FlowFactors, add_flow_forces, find_rate, scatter_column
from beltdyn.system.meshing import add_steady_machines, clear_last_row, flow_unknown
from beltdyn.system.ring_matrix import clear
from beltdyn.system.state import State
from beltdyn.system.supports import add_nodal_loads, hold_fixed, scatter
from beltdyn.system.web import WebLine, hold_web


class Anchor(NamedTuple):
    """What keeps the mesh in its place along the belt."""

    place: FloatArray
    """p, where node 0 is held, m, shape (2,)."""
    direction: FloatArray
    """t, unit vector along the belt there, shape (2,)."""
    at_rest: bool
    """Whether the belt stands still."""


def anchor_at(state: State, at_rest: bool) -> Anchor:
    """Hold node 0 where it is along the belt."""
    slope = state.position[2:4]
    return Anchor(state.position[:2].copy(), slope / np.hypot(*slope), at_rest)


@kernel
def assemble_steady(system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations) -> None:
    """Residual of the equations of steady running, and its tangent.

    Parameters
    ----------
    system
        A closed belt in a staying mesh, or a web line; unknowns of its bodies are the speeds of pulleys, the
        states of controllers, and the places of tensioners.
    motion
        The state; its nodes and tensioners have no velocity.
    anchor
        What keeps the mesh in place.
    wanted
        Whether the tangent is.
    equations
        With one unknown more than the system's bodies have, two of a web line. Residual and body forces are
        overwritten, and the tangent if it is wanted.
    """
    work, matrix, forces = equations.work, equations.matrix, equations.forces
    clear(matrix, wanted)
    clear_body_forces(forces)
    fit_mesh(system.frame, system, motion.position)
    of_flow = FlowFactors(1.0, 0.0, flow_unknown(system.rims), 1.0, False) if wanted else NO_FLOW_TANGENT
    of_carrying = CarryingFactors(of_flow.place, of_flow.rate, of_flow.flow, 0.0)
    for element in range(system.length.size):
        gather_motion(system, element, motion.position, motion.velocity, work.coordinates)
        elastic_force(system.element, work.coordinates[0], system.length[element], wanted, work.element)
        find_rate(system, element, work)
        _add_momentum(system, element, work)
        if wanted:
            add_steady_shifts(system.frame, system, element, equations)
        add_flow_forces(system, motion, element, of_flow, equations)
        add_carrying(system.carrying, system, motion, element, of_carrying, work, forces)
        scatter(system, element, wanted, work, matrix)
        if wanted and not anchor.at_rest and flow_unknown(system.rims) != 0.0:
            scatter_column(system, element, equations)
    factors = TangentFactors(1.0, 1.0, 0.0, False) if wanted else NO_TANGENT
    add_steady_machines(system.rims, system, motion, factors, matrix.corner, forces)
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            matrix.border_side[unknown] -= forces.force[body]
            if wanted and controls(system.bodies[body]):
                matrix.corner[unknown, unknown] -= 1.0  # its value is unknown, not its rate, which is zero
    add_nodal_loads(system, motion.position, factors.by_position, matrix)
    if wanted:
        clear_last_row(system.rims, matrix)
    if system.supports.any_fixed:
        hold_fixed(system, matrix)
    _hold(system.carriage, system, motion, anchor, wanted, equations)
    hold_arcs(system.frame, system, motion, factors, False, matrix)


@kernel(inline=True)
def _add_momentum(system: System, element: int, work: np.record) -> None:
    """Take c^2 C e off the residual of an element, and begin its column of c with -2 c C e."""
    inertia, e, vectors = system.frame.inertia[element], work.coordinates[0], system.vectors
    speed, flow = system.frame.speed[0], work.flow
    flow.by_speed[:] = 0.0
    for a in range(len(vectors)):
        for b in range(len(vectors)):
            row, column, part = vectors[a], vectors[b], inertia[a, b]
            for axis in range(2):
                work.element.gradient[row + axis] -= speed * speed * part * e[column + axis]
                work.element.tangent[row + axis, column + axis] -= speed * speed * part
                flow.by_speed[row + axis] -= 2.0 * speed * part * e[column + axis]


@kernel(inline=True)
def _hold_belt(
    carriage: NoCarriage, system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations
) -> None:
    """The equation that keeps node 0 in its place along the belt."""
    matrix, last = equations.matrix, equations.matrix.corner.shape[0] - 1
    for axis in range(2):
        away = motion.position[axis] - anchor.place[axis]
        matrix.border_side[last] += anchor.direction[axis] * away
        if wanted:
            matrix.row[0, last, axis] = anchor.direction[axis]
    if wanted and anchor.at_rest:
        add_holding_force(system.frame, anchor.direction, matrix)


@kernel(inline=True)
def _hold_line(
    line: WebLine, system: System, motion: Motion, anchor: Anchor, wanted: bool, equations: Equations
) -> None:
    """The equations of the ends of a web line, which keep the mesh in its place."""
    hold_web(line, system, motion, anchor.at_rest, wanted, equations)


_hold = by_type({NoCarriage: _hold_belt, WebLine: _hold_line}, "hold")
"""What keeps the mesh in its place."""

"""Newton's method for steady running, compiled: steps damped by the natural monotonicity test (Deuflhard 2011).

Where a correction shrinks well, the tangent serves again.
"""

from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arc_mesh import arc_count, change_shifts, largest_shift
from beltdyn.system.arrays import Equations, Motion, NoCarriage, System
from beltdyn.system.body_forces import controls
from beltdyn.system.meshing import change_body, change_flow, reach_of
from beltdyn.system.ring_matrix import factorise_ring, ring_matrix, substitute
from beltdyn.system.steady_assembly import Anchor, assemble_steady, new_equations
from beltdyn.system.web import WebLine, change_content, content, set_content, way_of_content

FOUND: Final = 0
"""Status: the last step is within the tolerance."""
NOT_FOUND: Final = 1
"""Status: no part of a step brings the state nearer, or iterations do not suffice."""
SINGULAR: Final = 2
"""Status: the tangent cannot be factorized."""
_MIN_STEP_PART: Final = 1.0 / 64.0
"""Least part of a step that is tried, after six halvings; below, the search fails."""
_CONTRACTION: Final = 0.3
"""Of a correction by a step, up to which the tangent serves once more: a new one costs four times a residual."""


class SteadyWork(NamedTuple):
    """Arrays to work in."""

    equations: Equations
    """With one unknown more than the system's bodies have."""
    ahead_node: FloatArray
    """The correction that the present tangent would make after a step, shape (N, n)."""
    ahead_border: FloatArray
    """Shape (m + 1,)."""


def steady_work(system: System) -> SteadyWork:
    """Make the arrays for a system."""
    given, dof = new_equations(system), len(system.scale)
    border = int(np.max(system.bodies.unknown, initial=-1)) + 2 + arc_count(system.frame) + content(system).size
    equations = given._replace(matrix=ring_matrix(dof, system.nodes, border), border_part=np.zeros(border))
    return SteadyWork(equations, np.zeros((system.nodes, dof)), np.zeros(border))


# The derivative by the content of a web line, by central differences

_PART: Final = 1e-6
"""Change of the content."""


@kernel(inline=True)
def _nothing_more(carriage: NoCarriage, system: System, motion: Motion, anchor: Anchor, work: SteadyWork) -> None:
    """A belt has no content to find."""


@kernel
def _add_content(line: WebLine, system: System, motion: Motion, anchor: Anchor, work: SteadyWork) -> None:
    """Add the column of the content; at rest there is none."""
    if anchor.at_rest:
        return
    equations, matrix, own = work.equations, work.equations.matrix, line.content[0]
    last = matrix.corner.shape[0] - 2
    _copy(matrix.node_side, matrix.border_side, work.ahead_node, work.ahead_border)
    for sense in (1.0, -1.0):
        set_content(line, system, own * (1.0 + sense * _PART))
        assemble_steady(system, motion, anchor, False, equations)
        share = sense / (2.0 * _PART * own)
        for node in range(system.nodes):
            for c in range(len(system.scale)):
                matrix.column[node, c, last] += share * matrix.node_side[node, c]
        for k in range(last + 2):
            matrix.corner[k, last] += share * matrix.border_side[k]
    set_content(line, system, own)
    _copy(work.ahead_node, work.ahead_border, matrix.node_side, matrix.border_side)


_add_column = by_type({NoCarriage: _nothing_more, WebLine: _add_content}, "add_column")


@kernel(inline=True)
def _linearise(system: System, motion: Motion, anchor: Anchor, work: SteadyWork) -> None:
    """Residual and tangent."""
    assemble_steady(system, motion, anchor, True, work.equations)
    _add_column(system.carriage, system, motion, anchor, work)


@kernel
def find_steady(
    system: System, motion: Motion, anchor: Anchor, tolerance: float, most: int, factorised: bool, work: SteadyWork
) -> tuple[int, int]:
    """Find steady running, or equilibrium at rest, from a state nearby.

    `system`: a closed belt in a staying mesh, or a web line; the speed of its frame, and the content, are changed in
    place; `motion`: the state, changed in place; `anchor`: what keeps the mesh in place; `tolerance`: size of the last
    step, m. It is known before it is made, and differences of states are the more exact with it; `most`: iterations, at
    most; with none of them the tangent at the state is factorized; `factorised`: whether the factors in `work` serve
    the first iteration: those of a state nearby, of which the first step is that of the implicit function theorem;
    `work`: from `steady_work`; the body forces in it are those of the state that was found, but for the last step.
    Returns status, iterations: `FOUND`, `NOT_FOUND` or `SINGULAR`.
    """
    equations = work.equations
    node_part, border_part = equations.node_part, equations.border_part
    if factorised:
        assemble_steady(system, motion, anchor, False, equations)
    else:
        _linearise(system, motion, anchor, work)
    if most == 0 and not factorise_ring(equations.matrix, True):
        return SINGULAR, 0
    for iteration in range(1, most + 1):
        known = factorised and iteration == 1
        if not known and not factorise_ring(equations.matrix, True):
            return SINGULAR, iteration
        substitute(equations.matrix, True, node_part, border_part)
        size, length = _size(system, node_part, border_part), 1.0
        while True:
            make_step(system, motion, anchor.at_rest, -length, node_part, border_part)
            assemble_steady(system, motion, anchor, False, equations)
            substitute(equations.matrix, True, work.ahead_node, work.ahead_border)
            ahead = _size(system, work.ahead_node, work.ahead_border)
            if ahead <= max((1.0 - 0.25 * length) * size, tolerance):
                break
            make_step(system, motion, anchor.at_rest, length, node_part, border_part)
            length *= 0.5
            if length < _MIN_STEP_PART or not np.isfinite(size):
                return NOT_FOUND, iteration
        while length == 1.0 and tolerance < ahead <= _CONTRACTION * size:
            size, ahead = ahead, _once_more(system, motion, anchor, work)
        if ahead <= tolerance:
            make_step(system, motion, anchor.at_rest, -1.0, work.ahead_node, work.ahead_border)
            return FOUND, iteration
        _linearise(system, motion, anchor, work)
    return NOT_FOUND, most


@kernel(inline=True)
def _once_more(system: System, motion: Motion, anchor: Anchor, work: SteadyWork) -> float:
    """Make the correction ahead with the same tangent, unless the one after it is larger; gives the size of that."""
    equations = work.equations
    node_part, border_part = equations.node_part, equations.border_part
    size = _size(system, work.ahead_node, work.ahead_border)
    make_step(system, motion, anchor.at_rest, -1.0, work.ahead_node, work.ahead_border)
    assemble_steady(system, motion, anchor, False, equations)
    substitute(equations.matrix, True, node_part, border_part)
    ahead = _size(system, node_part, border_part)
    if not ahead <= size:
        make_step(system, motion, anchor.at_rest, 1.0, work.ahead_node, work.ahead_border)
        return ahead
    _copy(node_part, border_part, work.ahead_node, work.ahead_border)
    return ahead


@kernel(inline=True)
def _copy(nodes: FloatArray, border: FloatArray, to_nodes: FloatArray, to_border: FloatArray) -> None:
    """Copy what belongs to the unknowns of nodes, shape (N, n), and to the others, shape (m,)."""
    for node in range(nodes.shape[0]):
        for c in range(nodes.shape[1]):
            to_nodes[node, c] = nodes[node, c]
    for k in range(border.size):
        to_border[k] = border[k]


@kernel(inline=True)
def make_step(
    system: System, motion: Motion, at_rest: bool, factor: float, node_part: FloatArray, border_part: FloatArray
) -> None:
    """Add factor times a solution to the state.

    `motion`: the state, changed in place; `at_rest`: whether the belt stands still; otherwise the speed of its frame is
    changed too; `factor`: of the solution; `node_part`: change of the coordinates of nodes, shape (N, n);
    `border_part`: change of the other unknowns, shape (m + 1,).
    """
    dof, first = len(system.scale), system.first_body
    for node in range(system.nodes):
        for c in range(dof):
            motion.position[dof * node + c] += factor * node_part[node, c]
    tensioners = system.bodies.size - system.tensioners.size
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            if body < tensioners and not controls(system.bodies[body]):
                change_body(system.rims, motion.velocity, first, body, factor * border_part[unknown])
            else:
                motion.position[first + body] += factor * border_part[unknown]
    change_shifts(system.frame, border_part, factor)
    if not at_rest:
        change_flow(system.rims, system.frame.speed, factor * border_part[border_part.size - 1])
        change_content(system.carriage, system, factor, border_part)


@kernel(inline=True)
def _size(system: System, node_part: FloatArray, border_part: FloatArray) -> float:
    """Root mean square of the ways of nodes in a solution, or the largest way of a body, m.

    A change of speed counts as the part that it is of the belt's speed, times the radius.
    """
    total = 0.0
    for node in range(system.nodes):
        total += node_part[node, 0] * node_part[node, 0] + node_part[node, 1] * node_part[node, 1]
    size = (total / system.nodes) ** 0.5
    size = max(size, largest_shift(system.frame, border_part))
    tensioners, speed = system.bodies.size - system.tensioners.size, abs(system.frame.speed[0])
    for body in range(system.bodies.size):
        unknown, reach = system.bodies[body].unknown, system.bodies[body].reach
        if unknown >= 0:
            turns = body < tensioners and not controls(system.bodies[body])
            scale = reach_of(system.rims, body, reach, speed) if turns else reach
            size = max(size, scale * abs(border_part[unknown]))
    return float(max(size, way_of_content(system.carriage, border_part)))

"""Solutions of the linear system applied to states, and the accelerations of a state (Eqs. 25 and 27)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, Loads, RingMatrix, System
from beltdyn.system.assembly import AssemblyWorkspace, assemble, assembly_workspace, border_size
from beltdyn.system.excitation import prescribe
from beltdyn.system.loads import new_loads
from beltdyn.system.ring_matrix import ring_matrix, solve_ring

FloatArray = NDArray[np.float64]


class Equations(NamedTuple):
    """Linearised equations of motion with their solution, and the loads of the state that they belong to."""

    matrix: RingMatrix
    node_part: FloatArray
    """Solution for the nodes, shape (N, 6)."""
    border_part: FloatArray
    """Solution for the free bodies and the multipliers, shape (m,)."""
    loads: Loads
    work: AssemblyWorkspace


def new_equations(system: System) -> Equations:
    """Make the arrays for a system."""
    border = border_size(system)
    return Equations(
        ring_matrix(system.nodes, border),
        np.zeros((system.nodes, NODE)),
        np.zeros(border),
        new_loads(system),
        assembly_workspace(),
    )


def linearise(
    system: System,
    time: float,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    multipliers: FloatArray,
    by_position: float,
    by_velocity: float,
    by_acceleration: float,
    equations: Equations,
) -> bool:
    """Assemble the equations at a state and solve tangent x = residual; arguments as for `assemble`.

    Returns
    -------
    bool
        False if the tangent is singular.
    """
    assemble(
        system,
        time,
        position,
        velocity,
        acceleration,
        multipliers,
        by_position,
        by_velocity,
        by_acceleration,
        equations.work,
        equations.matrix,
        equations.loads,
    )
    return solve_ring(equations.matrix, system.closed, equations.node_part, equations.border_part)


@kernel
def subtract_solution(system: System, equations: Equations, factor: float, vector: FloatArray) -> None:
    """Take factor times the solution off a state vector.

    Parameters
    ----------
    system
        The system.
    equations
        With a solution.
    factor
        Dimensionless, or the factor between unknown and vector.
    vector : ndarray, shape (6 N + D,)
        Positions, velocities or accelerations, changed in place; prescribed bodies keep theirs.
    """
    for node in range(system.nodes):
        for c in range(NODE):
            vector[NODE * node + c] -= factor * equations.node_part[node, c]
    first = NODE * system.nodes
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            vector[first + body] -= factor * equations.border_part[unknown]


@kernel
def subtract_multipliers(system: System, equations: Equations, factor: float, multipliers: FloatArray) -> None:
    """Take factor times the solution off the multipliers of the joint, if there is one."""
    if system.joint:
        first = equations.border_part.size - NODE
        for c in range(NODE):
            multipliers[c] -= factor * equations.border_part[first + c]


def accelerate(
    system: System,
    time: float,
    position: FloatArray,
    velocity: FloatArray,
    acceleration: FloatArray,
    multipliers: FloatArray,
    equations: Equations,
) -> bool:
    """Accelerations and multipliers that the equations of motion ask for (Eq. 25, and Eq. 27 where nodes are shared).

    Parameters
    ----------
    system
        The system.
    time
        s.
    position, velocity : ndarray, shape (6 N + D,)
        The state; the motion of prescribed bodies is written into it.
    acceleration : ndarray, shape (6 N + D,)
        Overwritten.
    multipliers : ndarray, shape (6,)
        Overwritten.
    equations
        Arrays to work in; afterwards its loads are those of the state.

    Returns
    -------
    bool
        False if the mass matrix is singular.
    """
    acceleration[:] = 0.0
    multipliers[:] = 0.0
    prescribe(system, time, position, velocity, acceleration)
    if not linearise(system, time, position, velocity, acceleration, multipliers, 0.0, 0.0, 1.0, equations):
        return False
    subtract_solution(system, equations, 1.0, acceleration)
    subtract_multipliers(system, equations, 1.0, multipliers)
    return True

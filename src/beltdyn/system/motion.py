"""Linearised equations of motion as arrays, and their solutions applied to states."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import NODE, Loads, RingMatrix, System
from beltdyn.system.assembly import assembly_workspace, border_size
from beltdyn.system.loads import new_loads
from beltdyn.system.ring_matrix import ring_matrix


class Equations(NamedTuple):
    """Linearised equations of motion with their solution, and the loads of the state that they belong to."""

    matrix: RingMatrix
    node_part: FloatArray
    """Solution for the nodes, shape (N, 6)."""
    border_part: FloatArray
    """Solution for the free bodies and the multipliers, shape (m,)."""
    loads: Loads
    work: np.record


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

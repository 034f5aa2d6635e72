"""Linearized equations of motion as arrays, and their solutions applied to states."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import Equations, System
from beltdyn.system.body_forces import new_body_forces
from beltdyn.system.element_state import element_workspace
from beltdyn.system.ring_matrix import ring_matrix
from beltdyn.system.steady_assembly import border_size


def new_equations(system: System) -> Equations:
    """Make the arrays for a system."""
    dof, border = len(system.scale), border_size(system)
    return Equations(
        ring_matrix(dof, system.nodes, border),
        np.zeros((system.nodes, dof)),
        np.zeros(border),
        new_body_forces(system),
        element_workspace(system),
    )


def no_multipliers(system: System) -> FloatArray:
    """Multipliers of a joint that transmits nothing, or where there is none, shape (n,)."""
    return np.zeros(len(system.scale))


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
    vector : ndarray, shape (n N + D,)
        Positions, velocities or accelerations, changed in place; prescribed bodies keep theirs.
    """
    dof = len(system.scale)
    for node in range(system.nodes):
        for c in range(dof):
            vector[dof * node + c] -= factor * equations.node_part[node, c]
    first = system.first_body
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0:
            vector[first + body] -= factor * equations.border_part[unknown]


@kernel
def subtract_multipliers(system: System, equations: Equations, factor: float, multipliers: FloatArray) -> None:
    """Take factor times the solution off the multipliers of the joint, if there is one."""
    if system.joint:
        dof = len(system.scale)
        first = equations.border_part.size - dof
        for c in range(dof):
            multipliers[c] -= factor * equations.border_part[first + c]

"""An element of a staying mesh while the belt flows through it at a speed that changes: its equations of motion.

The material points have the acceleration a = d2e/dt2 + 2 c D de/dt + (dc/dt) D e + c^2 D D e with c = ds/dt, and M a
is the force of inertia: on a closed belt the sum over all elements of M D D is minus that of C, the integral of
rho A S'^T S'.  How much belt has passed, s, is an unknown of the border; what answers for it is

    t . d2r_0/dt2 = 0,

so that node 0 keeps its place along t.  The belt's own equation of s is that of the nodes contracted with D e, and says
nothing new.
"""

import numpy as np

from beltdyn.kernel import kernel
from beltdyn.system.arrays import Equations, Motion, RingMatrix, System, TangentFactors
from beltdyn.system.body_forces import differentiates_forces
from beltdyn.system.flow_tangent import NO_FLOW_TANGENT, FlowFactors, add_flow_forces, find_rate, scatter_column
from beltdyn.system.frame import Flowing, Travelling


@kernel
def flowing_element(
    frame: Flowing, system: System, motion: Motion, factors: TangentFactors, element: int, equations: Equations
) -> None:
    """Inertia, losses and contact of an element through which the belt flows.

    Parameters
    ----------
    frame
        That of the system.
    system, motion, factors
        As for `assembly.assemble`.
    element
        Which one; position, velocity of its material points and second derivative over time of its coordinates are in
        the workspace, and residual and tangent are those of its elasticity.
    equations
        Changed in place.
    """
    work, flow = equations.work, equations.work.flow
    wanted, differentiated = factors.by_acceleration != 0.0 or differentiates_forces(factors), NO_FLOW_TANGENT
    if differentiates_forces(factors):
        place, rate = factors.by_position, factors.by_velocity
        differentiated = FlowFactors(place, rate, rate, rate, factors.secant)
    find_rate(system, element, work)
    flow.by_speed[:] = 0.0
    _add_inertia(frame, system, motion, factors, element, wanted, work)
    add_flow_forces(system, motion, element, differentiated, equations)
    if wanted:
        scatter_column(system, element, equations)


@kernel(inline=True)
def _add_inertia(
    frame: Flowing,
    system: System,
    motion: Motion,
    factors: TangentFactors,
    element: int,
    wanted: bool,
    work: np.record,
) -> None:
    """Add inertia to the residual of an element, make the tangent that of elasticity and inertia, begin the column."""
    flow, vectors = work.flow, system.vectors
    gradient, tangent = work.element.gradient, work.element.tangent
    derivative, second, mass = frame.derivative[element], frame.second[element], frame.mass[element]
    speed, change = motion.velocity[frame.place], motion.acceleration[frame.place]
    place, velocity, acceleration = work.coordinates[0], work.coordinates[1], work.coordinates[2]
    if wanted:
        for row in range(gradient.size):
            for column in range(gradient.size):
                tangent[row, column] *= factors.by_position
    for a in range(len(vectors)):
        for axis in range(2):
            turn, bend = 0.0, 0.0
            for b in range(len(vectors)):
                turn += derivative[a, b] * velocity[vectors[b] + axis]
                bend += second[a, b] * place[vectors[b] + axis]
            moved = acceleration[vectors[a] + axis] + 2.0 * speed * turn + change * flow.rate[a, axis]
            moved -= speed * speed * bend
            by_flow = factors.by_acceleration * flow.rate[a, axis] + 2.0 * factors.by_velocity * turn
            for k in range(len(vectors)):
                gradient[vectors[k] + axis] += mass[k, a] * moved
                flow.by_speed[vectors[k] + axis] += mass[k, a] * by_flow
        for b in range(len(vectors)):
            if wanted:
                part = 2.0 * factors.by_velocity * speed * derivative[a, b]
                part += factors.by_position * (change * derivative[a, b] + speed * speed * second[a, b])
                if a == b:
                    part += factors.by_acceleration
                for k in range(len(vectors)):
                    for axis in range(2):
                        tangent[vectors[k] + axis, vectors[b] + axis] += mass[k, a] * part


@kernel
def hold_mesh(frame: Flowing, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    """Let node 0 keep its place along the belt: of accelerations, or of steps where they do not move these.

    Parameters
    ----------
    frame
        Of the mesh.
    motion
        The state.
    factors
        Of the tangent.
    matrix
        Changed in place.
    """
    last = matrix.corner.shape[0] - 1
    tie = factors.by_acceleration if factors.by_acceleration != 0.0 else factors.by_position
    for axis in range(2):
        matrix.border_side[last] += frame.direction[axis] * motion.acceleration[axis]
        if tie != 0.0:
            matrix.row[0, last, axis] = tie * frame.direction[axis]


@kernel
def hold_nothing(frame: Travelling, motion: Motion, factors: TangentFactors, matrix: RingMatrix) -> None:
    """A travelling mesh is free."""

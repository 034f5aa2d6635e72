"""What the damping of the time integrator takes in a step, for the energy account."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import by_type, kernel
from beltdyn.system.arrays import Motion, System
from beltdyn.system.frame import Flowing, Travelling


@kernel
def _no_flow(frame: Travelling, system: System, element: int, before: Motion, after: Motion, work: np.record) -> None:
    """Nodes move with the belt."""


@kernel
def _flow_of_step(frame: Flowing, system: System, element: int, before: Motion, after: Motion, work: np.record) -> None:
    """Make way, change of velocity, mean acceleration and mean velocity of an element those of material points."""
    passed = 0.5 * (after.position[frame.place] - before.position[frame.place])
    vectors, dof, node_j = system.vectors, len(system.scale), (element + 1) % system.nodes
    derivative, second, speed = frame.derivative[element], frame.second[element], work.element.gradient
    for end in range(2):
        motion, sign = (before, -1.0) if end == 0 else (after, 1.0)
        flow, change = motion.velocity[frame.place], motion.acceleration[frame.place]
        for a in range(len(vectors)):
            for axis in range(2):
                c = vectors[a] + axis
                rate = bend = turn = 0.0
                for b in range(len(vectors)):
                    k = vectors[b] + axis
                    i = dof * element + k if k < dof else dof * node_j + k - dof
                    rate += derivative[a, b] * motion.position[i]
                    bend += second[a, b] * motion.position[i]
                    turn += derivative[a, b] * motion.velocity[i]
                work.coordinates[0, c] += passed * rate
                work.coordinates[1, c] += sign * flow * rate
                work.coordinates[2, c] += 0.5 * (2.0 * flow * turn + change * rate + flow * flow * bend)
                speed[c] += 0.5 * flow * rate


_add_flow_of_step = by_type({Travelling: _no_flow, Flowing: _flow_of_step}, "add_flow_of_step")
"""Make what nodes do in a step what material points do."""


@kernel
def numerical_loss(system: System, before: Motion, after: Motion, impulse: FloatArray, work: np.record) -> float:
    """Energy that the damping of the time integrator takes in a step.

    The change of the kinetic energy should be the work of the forces of inertia M a on the way of the step.  What
    generalised-alpha leaves between them is

        (a0 + a1)/2 . M (q1 - q0) - (v0 + v1)/2 . M (v1 - v0),

    which is exactly its dissipation where forces are linear in the positions: the mean of their values at both ends,
    times the way, is then their work.

    Parameters
    ----------
    system
        Belt and bodies.
    before, after
        Both ends of the step.
    impulse : ndarray, shape (2, n N + D)
        What acts on the bodies beside the forces at the ends, from `missed_impulses`, N m s.
    work
        From `element_workspace`.

    Returns
    -------
    float
        J; of belt and free bodies.
    """
    way, change, mean = work.coordinates[0], work.coordinates[1], work.coordinates[2]
    speed, taken, dof = work.element.gradient, work.element.tangent[0], len(system.scale)
    total = 0.0
    for element in range(system.length.size):
        node_j = (element + 1) % system.nodes
        for c in range(2 * dof):
            i = dof * element + c if c < dof else dof * node_j + c - dof
            way[c], change[c] = after.position[i] - before.position[i], after.velocity[i] - before.velocity[i]
            mean[c] = 0.5 * (after.acceleration[i] + before.acceleration[i])
            speed[c] = 0.5 * (after.velocity[i] + before.velocity[i])
        _add_flow_of_step(system.frame, system, element, before, after, work)
        mass = system.mass[element]
        taken[:] = 0.0
        for row in range(2 * dof):
            for column in range(2 * dof):  # no sum within the inner loop, which can then run on vectors
                taken[column] += mass[row, column] * (mean[row] * way[column] - speed[row] * change[column])
        for column in range(2 * dof):
            total += taken[column]
    first = system.first_body
    for body in range(system.bodies.size):
        if system.bodies[body].unknown >= 0:
            i = first + body
            inertia = 0.5 * (after.acceleration[i] + before.acceleration[i]) * (after.position[i] - before.position[i])
            momentum = 0.5 * (after.velocity[i] ** 2 - before.velocity[i] ** 2)
            given = 0.5 * (impulse[0, i] + impulse[1, i]) * (before.velocity[i] + after.velocity[i])
            total += system.bodies[body].kinetic * (inertia - momentum) + given
    return total

"""What the damping of the time integrator takes in a step, for the energy account."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.system.arrays import Motion, System


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

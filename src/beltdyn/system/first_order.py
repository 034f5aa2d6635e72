"""The equations of motion as a first-order system dy/dt = f(t, y), for standard integrators."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.system.arrays import (
    DRIVER_WORK,
    NO_TANGENT,
    POWERS,
    BodyForces,
    Motion,
    RingMatrix,
    System,
    TangentFactors,
)
from beltdyn.system.body_forces import body_forces_at, prescribe
from beltdyn.system.missed_action import jump_work
from beltdyn.system.ring_matrix import entries, places
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import assemble, new_equations, no_multipliers

# The belt's ends joined by Lagrange multipliers, and the multipliers eliminated (Eqs. 25 and 26)


@dataclass(frozen=True, eq=False)
class JointConstraint:
    """The constant matrices of Eqs. 25 and 26: a belt of N nodes, n coordinates each, the last tied to the first."""

    jacobian: FloatArray
    """C_e: coordinates of the first node minus those of the last, shape (n, n N)."""
    by_force: FloatArray
    """First bracket of Eq. 26, M^-1 - M^-1 C^T (C M^-1 C^T)^-1 C M^-1, shape (n N, n N)."""
    by_constraint: FloatArray
    """Second bracket of Eq. 26, M^-1 C^T (C M^-1 C^T)^-1, shape (n N, n)."""

    def accelerations(self, force: FloatArray, constraint: FloatArray | None = None) -> FloatArray:
        """Accelerations of the nodal coordinates (Eq. 26) by forces Q and Q_d, which is zero for a rigid joint."""
        result = self.by_force @ force
        return result if constraint is None else result + self.by_constraint @ constraint


def joint_constraint(system: System) -> JointConstraint:
    """Compute the matrices in brackets of Eq. 26 once."""
    if not system.joint:
        raise ModelError('the belt has no joint with multipliers. Set simulation.joint = "multipliers".')
    dof = len(system.scale)
    jacobian = np.zeros((dof, system.first_body))
    jacobian[:, :dof] = np.eye(dof)
    jacobian[:, -dof:] = -np.eye(dof)
    inverse: FloatArray = np.linalg.inv(mass_matrix(system)).astype(np.float64)
    flexibility = inverse @ jacobian.T
    by_constraint: FloatArray = flexibility @ np.linalg.inv(jacobian @ flexibility).astype(np.float64)
    return JointConstraint(jacobian, inverse - by_constraint @ flexibility.T, by_constraint)


def mass_matrix(system: System) -> FloatArray:
    """Mass matrix of the belt, dense, shape (n N, n N)."""
    dof, size = len(system.scale), system.first_body
    matrix = np.zeros((size, size))
    for element, mass in enumerate(system.mass):
        nodes = np.array([element, (element + 1) % system.nodes])
        rows = (dof * nodes[:, None] + np.arange(dof)).ravel()
        matrix[np.ix_(rows, rows)] += mass
    return matrix


class FirstOrder:
    """Rates and exact Jacobian of y = (positions, velocities, works), of size 2 (n N + D) + 8."""

    def __init__(self, system: System) -> None:
        self._system = system
        self._half = system.first_body + system.bodies.size
        self._equations = new_equations(system)
        self._no_multipliers = no_multipliers(system)
        self.size = 2 * self._half + len(POWERS)
        self.evaluations = 0

    def pack(self, state: State) -> FloatArray:
        """Unknowns of a state, with no work done yet, shape (size,)."""
        return np.concatenate([state.position, state.velocity, np.zeros(len(POWERS))])

    def unpack(self, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and works from unknowns of shape (..., size)."""
        return y[..., : self._half], y[..., self._half : 2 * self._half], y[..., 2 * self._half :]

    def body_forces_at(self, time: FloatArray, position: FloatArray, velocity: FloatArray) -> BodyForces:
        """Body forces at states; see `system.body_forces.body_forces_at`.

        The prescribed motion is written into the states: a solver's integral of it has its errors.
        """
        return body_forces_at(self._system, time, position, velocity)

    def jump(self, time: float, y: FloatArray) -> None:
        """Bring prescribed bodies to their motion at a time (s) in unknowns, and count the work that it takes."""
        position, velocity, work = self.unpack(y)
        before = velocity.copy()
        prescribe(self._system, Motion(time, position, velocity, np.zeros(self._half)))
        work[DRIVER_WORK] += jump_work(self._system, before, velocity)

    def tolerances(self, velocity: float, time: float) -> FloatArray:
        """Absolute tolerances of the unknowns.

        Parameters
        ----------
        velocity
            Allowed error of the velocities of nodes, rims and other bodies, m/s.
        time
            Positions may err by what the velocity makes in this time, s.

        Returns
        -------
        ndarray, shape (size,)
            The length of an element turns gradients into m, radii angles; works are not controlled.
        """
        nodes = np.tile(self._system.scale, self._system.nodes)
        lengths = np.concatenate([nodes, self._system.bodies.reach])
        return np.concatenate([time * velocity / lengths, velocity / lengths, np.full(len(POWERS), np.inf)])

    def rates(self, time: float, y: FloatArray) -> FloatArray:
        """dy/dt at a time (s): velocities, accelerations (Eq. 27, or Eq. 26 with multipliers) and powers."""
        self.evaluations += 1
        motion = self._assemble(time, y, NO_TANGENT)
        matrix, nodes, free = self._equations.matrix, self._system.first_body, self._free
        acceleration = motion.acceleration
        acceleration[:nodes] = self._flexibility @ -matrix.node_side.ravel()
        acceleration[nodes + free] = -matrix.border_side[: free.size] / self._system.bodies.inertia[free]
        return np.concatenate([motion.velocity, acceleration, self._equations.forces.power])

    def jacobian(self, time: float, y: FloatArray) -> FloatArray:
        """Derivative of `rates` with respect to y; nothing depends on the works, and their rows are left at zero."""
        half = self._half
        result = np.zeros((self.size, self.size))
        result[:half, half : 2 * half] = np.eye(half)
        prescribed = self._system.first_body + np.flatnonzero(self._system.bodies.unknown < 0)
        result[prescribed, half + prescribed] = 0.0
        self._assemble(time, y, TangentFactors(by_position=1.0))
        result[half : 2 * half, :half] = self._by_tangent(self._equations.matrix)
        self._assemble(time, y, TangentFactors(by_velocity=1.0))
        result[half : 2 * half, half : 2 * half] = self._by_tangent(self._equations.matrix)
        return result

    def _assemble(self, time: float, y: FloatArray, factors: TangentFactors) -> Motion:
        """Residual without inertia, and its tangent; gives the motion, with no accelerations but prescribed ones."""
        position, velocity, _ = self.unpack(y)
        motion = Motion(time, position.copy(), velocity.copy(), np.zeros(self._half))
        prescribe(self._system, motion)
        assemble(self._system, motion, self._no_multipliers, factors, self._equations)
        return motion

    @cached_property
    def _flexibility(self) -> FloatArray:
        """Accelerations of the nodes by the forces on them: inverse mass matrix, or first bracket of Eq. 26.

        Fixed coordinates have none.
        """
        if self._system.joint:
            return joint_constraint(self._system).by_force
        moving, mass = np.flatnonzero(~self._system.supports.fixed), mass_matrix(self._system)
        flexibility = np.zeros_like(mass)
        flexibility[np.ix_(moving, moving)] = np.linalg.inv(mass[np.ix_(moving, moving)])
        return flexibility

    @cached_property
    def _free(self) -> IntArray:
        """Numbers of the free bodies."""
        return np.flatnonzero(self._system.bodies.unknown >= 0)

    def _by_tangent(self, matrix: RingMatrix) -> FloatArray:
        """Minus the inverse mass times a tangent, dense, shape (n N + D, n N + D)."""
        free = self._free
        nodes = self._system.first_body
        size = nodes + len(matrix.corner)
        whole, tangent = np.zeros((size, size)), np.zeros((self._half, self._half))
        np.add.at(whole, places(matrix), entries(matrix))
        moving = np.concatenate([np.arange(nodes), nodes + free])
        tangent[np.ix_(moving, moving)] = whole[: moving.size, : moving.size]
        tangent[:nodes] = self._flexibility @ tangent[:nodes]
        tangent[nodes + free] /= self._system.bodies.inertia[free, None]
        return -tangent

"""The equations of motion as a first-order system dy/dt = f(t, y), for standard integrators."""

from functools import cached_property

import numpy as np

from beltdyn.system.arrays import NODE, FloatArray, RingMatrix, System
from beltdyn.system.assembly import assemble
from beltdyn.system.excitation import prescribe
from beltdyn.system.joint_constraint import joint_constraint, mass_matrix
from beltdyn.system.motion import new_equations
from beltdyn.system.state import State

_WORKS = 4


class FirstOrder:
    """Rates and exact Jacobian of y = (positions, velocities, works).

    Parameters
    ----------
    system
        Belt, pulleys, supports.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.evaluations = 0
        self._size = NODE * system.nodes + system.pulleys.radius.size
        self._equations = new_equations(system)
        self._none = np.zeros(NODE)

    def pack(self, state: State) -> FloatArray:
        """Unknowns of a state, with no work done yet, shape (2 (6 N + P) + 4,)."""
        return np.concatenate([state.position, state.velocity, np.zeros(_WORKS)])

    def unpack(self, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Positions, velocities and works from unknowns of shape (..., 2 (6 N + P) + 4)."""
        size = self._size
        return y[..., :size], y[..., size : 2 * size], y[..., 2 * size :]

    def tolerances(self, velocity: float, time: float) -> FloatArray:
        """Absolute tolerances of the unknowns.

        Parameters
        ----------
        velocity
            Of nodes and rims, m/s.
        time
            Positions may err by what the velocity makes in this time, s.

        Returns
        -------
        ndarray, shape (2 (6 N + P) + 4,)
            Gradients and angles are turned into m by the length of an element and by the radius; works are not controlled.
        """
        system = self.system
        element = float(np.max(system.length))
        lengths = np.concatenate(
            [np.tile([1.0, 1.0, *[element] * 4], system.nodes), system.pulleys.radius]
        )
        rates = velocity / lengths
        return np.concatenate([time * rates, rates, np.full(_WORKS, 1e6)])

    def rates(self, time: float, y: FloatArray) -> FloatArray:
        """dy/dt at a time (s): velocities, accelerations (Eq. 27, or Eq. 26 with multipliers) and powers."""
        self.evaluations += 1
        position, velocity, acceleration = self._assemble(time, y, 0.0, 0.0)
        nodes = NODE * self.system.nodes
        matrix = self._equations.matrix
        acceleration[:nodes] = self._nodes_by_force @ -matrix.node_side.ravel()
        free = self._free
        acceleration[nodes + free] = -matrix.border_side[: free.size] / self.system.pulleys.inertia[free]
        return np.concatenate([velocity, acceleration, self._equations.loads.power])

    def jacobian(self, time: float, y: FloatArray) -> FloatArray:
        """Derivative of `rates` with respect to y; the rows of the works, which nothing depends on, are left at zero."""
        size = self._size
        result = np.zeros((y.size, y.size))
        result[:size, size : 2 * size] = np.eye(size)
        prescribed = NODE * self.system.nodes + np.flatnonzero(self.system.pulleys.unknown < 0)
        result[prescribed, size + prescribed] = 0.0
        self._assemble(time, y, 1.0, 0.0)
        result[size : 2 * size, :size] = self._accelerations_of(self._equations.matrix)
        self._assemble(time, y, 0.0, 1.0)
        result[size : 2 * size, size : 2 * size] = self._accelerations_of(self._equations.matrix)
        return result

    def _assemble(
        self, time: float, y: FloatArray, by_position: float, by_velocity: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Residual without inertia of belt and free pulleys, and one part of its tangent."""
        position, velocity = y[: self._size].copy(), y[self._size : 2 * self._size].copy()
        acceleration = np.zeros(self._size)
        prescribe(self.system, time, velocity, acceleration)
        assemble(
            self.system,
            time,
            position,
            velocity,
            acceleration,
            self._none,
            by_position,
            by_velocity,
            0.0,
            self._equations.work,
            self._equations.matrix,
            self._equations.loads,
        )
        return position, velocity, acceleration

    @cached_property
    def _nodes_by_force(self) -> FloatArray:
        """Accelerations of the nodes by the forces on them: inverse mass matrix, or first bracket of Eq. 26."""
        if self.system.joint:
            return joint_constraint(self.system).by_force
        return np.linalg.inv(mass_matrix(self.system))

    @cached_property
    def _free(self) -> FloatArray:
        """Numbers of the free pulleys."""
        return np.flatnonzero(self.system.pulleys.unknown >= 0)

    def _accelerations_of(self, matrix: RingMatrix) -> FloatArray:
        """Minus the inverse mass times a tangent, dense, shape (6 N + P, 6 N + P)."""
        system, free = self.system, self._free
        nodes = NODE * system.nodes
        tangent = np.zeros((self._size, self._size))
        for k in range(system.nodes):
            own, after = np.arange(NODE) + NODE * k, np.arange(NODE) + NODE * ((k + 1) % system.nodes)
            tangent[np.ix_(own, own)] += matrix.diagonal[k]
            tangent[np.ix_(own, after)] += matrix.upper[k]
            tangent[np.ix_(after, own)] += matrix.lower[k]
            tangent[np.ix_(own, nodes + free)] += matrix.column[k, :, : free.size]
            tangent[np.ix_(nodes + free, own)] += matrix.row[k, : free.size]
        tangent[np.ix_(nodes + free, nodes + free)] += matrix.corner[: free.size, : free.size]
        tangent[:nodes] = self._nodes_by_force @ tangent[:nodes]
        tangent[nodes + free] /= system.pulleys.inertia[free, None]
        return -tangent

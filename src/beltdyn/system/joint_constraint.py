"""The belt's ends joined by Lagrange multipliers, and the multipliers eliminated (Eqs. 25 and 26)."""

from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.system.arrays import System


@dataclass(frozen=True, eq=False)
class JointConstraint:
    """The constant matrices of Eqs. 25 and 26, for a belt of N nodes, n coordinates each, the last tied to the first.

    Attributes
    ----------
    jacobian : ndarray, shape (n, n N)
        C_e: coordinates of the first node minus those of the last.
    by_force : ndarray, shape (n N, n N)
        First bracket of Eq. 26, M^-1 - M^-1 C^T (C M^-1 C^T)^-1 C M^-1.
    by_constraint : ndarray, shape (n N, n)
        Second bracket of Eq. 26, M^-1 C^T (C M^-1 C^T)^-1.
    """

    jacobian: FloatArray
    by_force: FloatArray
    by_constraint: FloatArray

    def accelerations(self, force: FloatArray, constraint: FloatArray | None = None) -> FloatArray:
        """Accelerations of the nodal coordinates (Eq. 26).

        Parameters
        ----------
        force : ndarray, shape (n N,)
            Generalised contact and elastic forces Q.
        constraint : ndarray, shape (n,), optional
            Q_d; zero for a rigid joint, whose constraint is linear.

        Returns
        -------
        ndarray, shape (n N,)
        """
        result = self.by_force @ force
        return result if constraint is None else result + self.by_constraint @ constraint


def joint_constraint(system: System) -> JointConstraint:
    """Compute the matrices in brackets of Eq. 26 once.

    Parameters
    ----------
    system
        A belt whose joint is closed by multipliers.

    Returns
    -------
    JointConstraint

    Raises
    ------
    ModelError
        If the belt has no such joint.
    """
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

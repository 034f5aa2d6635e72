"""States of a system: the laid belt (the published start) and the straight one."""

from dataclasses import dataclass

import numpy as np

from beltdyn.model import Path
from beltdyn.system.arrays import NODE, FloatArray, System


@dataclass(frozen=True, eq=False)
class State:
    """Where a system is and how it moves.

    Parameters
    ----------
    position, velocity, acceleration : ndarray, shape (6 N + P,)
        Nodal coordinates (m and 1), then pulley angles (rad), and their rates.
    """

    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray

    def nodes(self, system: System) -> FloatArray:
        """Nodal coordinates as an array of shape (N, 6)."""
        return self.position[: NODE * system.nodes].reshape(system.nodes, NODE)


def at_rest(system: System, coordinates: FloatArray) -> State:
    """A state without motion.

    Parameters
    ----------
    system
        The system.
    coordinates : ndarray, shape (N, 6)
        Nodal coordinates.

    Returns
    -------
    State
        With pulleys at angle zero.
    """
    count = coordinates.size + system.pulleys.radius.size
    position = np.zeros(count)
    position[: coordinates.size] = coordinates.ravel()
    return State(position, np.zeros(count), np.zeros(count))


def laid(system: System, path: Path) -> State:
    """The belt laid on its path at uniform stretch, at rest.

    Node 0 stands where the belt leaves the first pulley; r_x is the stretch times the unit tangent, r_y the unit
    normal.

    Parameters
    ----------
    system
        A closed belt.
    path
        The path around the pulleys.

    Returns
    -------
    State
        Out of balance: the belt is bent and stretched, and does not yet press on the pulleys.
    """
    unstretched = np.concatenate([[0.0], np.cumsum(system.length)])[: system.nodes]
    stretch = path.length / float(np.sum(system.length))
    tangent = path.tangent(stretch * unstretched)
    coordinates = np.hstack([path.position(stretch * unstretched), stretch * tangent, _left(tangent)])
    return at_rest(system, coordinates)


def straight(system: System) -> State:
    """The undeformed belt along the x axis from the origin, at rest."""
    along = np.concatenate([[0.0], np.cumsum(system.length)])[: system.nodes]
    coordinates = np.zeros((system.nodes, NODE))
    coordinates[:, 0] = along
    coordinates[:, 2] = coordinates[:, 5] = 1.0
    return at_rest(system, coordinates)


def coordinate_lengths(system: System) -> FloatArray:
    """Lengths that turn changes of a node's coordinates into m: 1 for r, the longest element for its gradients.

    Parameters
    ----------
    system
        The system.

    Returns
    -------
    ndarray, shape (6,)
    """
    element = float(np.max(system.length))
    return np.array([1.0, 1.0, element, element, element, element])


def _left(vectors: FloatArray) -> FloatArray:
    """Vectors turned by +90 degrees, shape (k, 2)."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)

"""Spring-loaded tensioners with the pulleys that they carry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.path import Path
from beltdyn.model.tensioner import AnyTensioner, MovingTensioner, RotaryTensioner, SlidingTensioner, path_gradient


@dataclass(frozen=True)
class Carrier:
    """A spring-loaded tensioner with the pulley that it carries.

    Attributes
    ----------
    pulley : int
        Number of the pulley.
    tensioner : SlidingTensioner or RotaryTensioner
        The tensioner.
    center : ndarray, shape (2,), m
        Where the pulley stands at q = 0.
    sense : float
        1, or -1 for an arm that lengthens the path by turning clockwise.
    """

    pulley: int
    tensioner: MovingTensioner
    center: FloatArray
    sense: float

    def place(self, position: float) -> tuple[FloatArray, FloatArray]:
        """Center of the pulley at a position q (m, rad), and its derivative with respect to q."""
        if isinstance(self.tensioner, SlidingTensioner):
            direction = np.array(self.tensioner.direction)
            return self.center + position * direction, direction
        assert isinstance(self.tensioner, RotaryTensioner)
        pivot, angle = np.array(self.tensioner.pivot), self.sense * position
        x, y = self.center - pivot
        arm = np.array([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)])
        return pivot + arm, self.sense * np.array([-arm[1], arm[0]])

    def force(self, position: float) -> float:
        """What spring and stops press with at a position (m, rad): N, or N m of an arm."""
        given = self.tensioner
        assert isinstance(given, SlidingTensioner | RotaryTensioner)
        force = given.preload - given.rate * position
        if given.stops is not None and given.stop_stiffness is not None:
            force += given.stop_stiffness * float(np.clip(position, *given.stops) - position)
        return force


def carriers_of(tensioners: Sequence[AnyTensioner], names: Sequence[str], path: Path) -> list[Carrier]:
    """Put spring-loaded tensioners and the pulleys that they carry together.

    Parameters
    ----------
    tensioners : sequence of Tensioner
        Those of a drive; fixed ones are left out.
    names : sequence of str
        Names of the pulleys.
    path : Path
        With all tensioners at zero.

    Raises
    ------
    ValueError
        If one of them cannot tension the belt.
    """
    carriers = []
    for tensioner in tensioners:
        if isinstance(tensioner, MovingTensioner):
            pulley = names.index(tensioner.pulley)
            center, gradient = path_gradient(path, pulley)
            sense = float(np.sign(tensioner.leverage(center, gradient)))
            carriers.append(Carrier(pulley, tensioner, center, sense))
    return carriers


def moved(path: Path, carriers: Sequence[Carrier], positions: FloatArray) -> Path:
    """Path with the tensioners at other positions, shape (K,), m or rad; that at zero is given."""
    if not carriers:
        return path
    centers = path.centers.copy()
    for one, position in zip(carriers, positions, strict=True):
        centers[one.pulley] = one.place(float(position))[0]
    return Path(centers, path.radii)

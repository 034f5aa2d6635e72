"""Spring-loaded tensioners with the pulleys that they carry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import interpreted
from beltdyn.machines.tensioners import fill_forces, tensioner_row
from beltdyn.machines.tensioners.tensioner import (
    TENSIONERS,
    MovingTensioner,
    SpringTensioner,
    Tensioner,
    TensionerForce,
)
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley

_FARTHEST = 1e3
"""Position beyond which no spring is followed, m or rad."""
_SMALLEST = 1e-15
"""Accuracy of positions, m or rad."""


@dataclass(frozen=True)
class Carrier:
    """A spring-loaded tensioner with the pulley that it carries."""

    pulley: int
    """Number of the pulley."""
    tensioner: MovingTensioner
    """The tensioner."""
    row: np.record
    """Its row of `beltdyn.machines.tensioners.TENSIONER_ROWS`, without weight."""
    presses: bool = False
    """Whether it presses the roller of a nip, in place of tensioning the belt; it rests at its place zero."""

    @property
    def constants(self) -> np.record:
        """The constants of its kind."""
        constants: np.record = self.row[TENSIONERS.label(type(self.tensioner))]
        return constants

    def place(self, position: float) -> tuple[FloatArray, FloatArray]:
        """Center of the pulley at a position q (m, rad), and its derivative with respect to q."""
        center = interpreted(type(self.tensioner).center_at)(self.constants, position)
        return np.array([center.x, center.y]), np.array([center.dx, center.dy])

    @property
    def shown_as(self) -> tuple[str, str]:
        """What pages call its place, and their unit."""
        return ("arm angle", "°") if self.tensioner.anchor is not None else ("position", "mm")

    def angle(self, positions: ArrayLike) -> FloatArray:
        """Angles of the arm at its positions, counter-clockwise from the x axis, rad."""
        center, rate = self.place(0.0)
        arm = center - np.array(self.tensioner.anchor)
        sense = np.sign(arm[0] * rate[1] - arm[1] * rate[0])
        return np.asarray(np.arctan2(arm[1], arm[0]) + sense * np.asarray(positions, dtype=float))

    def shown(self, positions: ArrayLike) -> FloatArray:
        """Places as pages show positions (m, rad): angles of the arm, °, or mm."""
        if self.tensioner.anchor is None:
            return np.asarray(1e3 * np.asarray(positions, dtype=float))
        return np.asarray(np.degrees(self.angle(positions)))

    def written(self, position: float) -> str:
        """A place with its unit: the angle of an arm, or the position of a slide."""
        if self.tensioner.anchor is None:
            return self.tensioner.written(position)
        return f"{float(self.shown(position)):.4g}°"

    def force(self, position: float) -> float:
        """Force of spring and stops at a position (m, rad): N, or N m for an arm."""
        return float(self._at(position).force)

    def forces(self, positions: ArrayLike) -> FloatArray:
        """Forces at positions of any shape, compiled."""
        places = np.array(positions, dtype=float, ndmin=1)
        forces = np.empty_like(places)
        fill_forces(self.row, places.ravel(), forces.ravel())
        return forces.reshape(np.shape(positions))

    def stiffness(self, position: float) -> float:
        """Force that spring and stops lose in a unit of the position: N/m, or N m/rad for an arm."""
        return -float(self._at(position).by_position)

    def _at(self, position: float) -> TensionerForce:
        return interpreted(type(self.tensioner).force_at)(self.constants, position, 0.0)

    @property
    def free_position(self) -> float:
        """Where the spring has no force, or the upper stop holds it; inf where it pushes without end."""
        from scipy.optimize import brentq

        lower, upper = self.tensioner.stops or (-_FARTHEST, _FARTHEST)
        if self.force(upper) > 0.0:
            return upper if self.tensioner.stops else np.inf
        pushing = 0.0 if self.force(0.0) > 0.0 else lower
        return float(brentq(self.force, pushing, upper, xtol=_SMALLEST)) if self.force(pushing) > 0.0 else pushing


def carriers_of(tensioners: Sequence[Tensioner], names: Sequence[str], path: Path) -> list[Carrier]:
    """Pair spring-loaded tensioners with the pulleys that they carry."""
    carriers = []
    for tensioner in tensioners:
        if isinstance(tensioner, MovingTensioner):
            pulley = names.index(tensioner.pulley)
            row = tensioner_row(tensioner, pulley, path.centers[pulley], path.yielding(pulley))
            carriers.append(Carrier(pulley, tensioner, row, pulley in path.beside))
    return carriers


def moved(path: Path, carriers: Sequence[Carrier], positions: FloatArray) -> Path:
    """Path with the tensioners at other positions, shape (K,), m or rad, from that at zero."""
    if not carriers:
        return path
    centers = path.centers.copy()
    for one, position in zip(carriers, positions, strict=True):
        centers[one.pulley] = one.place(float(position))[0]
    return Path(centers, path.radii, path.ends, path.nips)


def check_tensioners(tensioners: Sequence[Tensioner], pulleys: Sequence[Pulley], path: Path) -> None:
    """Check that tensioners carry pulleys of the drive and can tension its belt."""
    names, carried = [pulley.name for pulley in pulleys], [item.pulley for item in tensioners]
    for position, (item, name) in enumerate(zip(tensioners, carried, strict=True), 1):
        if name not in names:
            raise ValueError(
                f'tensioner[{position}].pulley = "{name}" is not the name of a pulley. Choose one of {", ".join(names)}'
            )
        if carried.count(name) > 1:
            raise ValueError(
                f'pulley "{name}" is carried by {carried.count(name)} tensioners; only one can carry it. '
                "Remove the others"
            )
        if isinstance(item, MovingTensioner):
            number = names.index(name)
            center = path.centers[number]
            item.leverage(center, path.yielding(number))
            if item.moved_inertia(center, pulleys[number].mass) == 0:
                raise ValueError(
                    f'the tensioner of "{name}" has no moving mass. Give the mass of the pulley, or that of '
                    "the tensioner"
                )


def check_sensors(tensioners: Sequence[Tensioner], pulleys: Sequence[Pulley]) -> None:
    """Check that controllers see moving tensioners, and forces of load cells by springs."""
    moving = {one.pulley: one for one in tensioners if isinstance(one, MovingTensioner)}
    for pulley in pulleys:
        for number, load in enumerate(pulley.load, 1):
            if load.sensed is None:
                continue
            where = f'load[{number}].sensor = "{load.sensed}" of pulley "{pulley.name}"'
            if load.sensed not in moving:
                choice = f"Choose one of {', '.join(moving)}" if moving else 'Add a [[tensioner]] of kind = "sliding"'
                raise ValueError(f"{where} must be a pulley that a moving tensioner carries. {choice}")
            spring = moving[load.sensed]
            if load.senses_force and not (isinstance(spring, SpringTensioner) and spring.rate):
                raise ValueError(
                    f"{where} measures a force by its spring, but its tensioner has no constant rate. Give the "
                    "stiffness of the load cell as rate of a tensioner with such a spring, or control by set_position"
                )

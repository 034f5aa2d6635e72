"""The belt at rest without friction: its stretch, how deep it sinks in, and where springs hold its tensioners."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.path import Path
from beltdyn.model.tensioner import AnyTensioner, MovingTensioner, RotaryTensioner, SlidingTensioner, path_gradient
from beltdyn.theory.stretch import stretch as stretch_under
from beltdyn.theory.stretch import tension as tension_of
from beltdyn.theory.sunk_belt import sunk_stretch

FloatArray = NDArray[np.float64]
_GROWTH = 1.3
_MOST_STEPS = 500
_MOST_ROUNDS = 200
_ACCURACY = 1e-13


@dataclass(frozen=True)
class Rest:
    """A belt at rest.

    Attributes
    ----------
    path : Path
        Its path before it sinks in.
    length : float
        Unstretched length, m.
    stiffness : float
        Of contact, N/m^2.
    tension : float
        N; zero for a slack belt.
    penetrations : ndarray, shape (n,), m
        How deep it sinks into each pulley.
    """

    path: Path
    length: float
    stiffness: float
    tension: float
    penetrations: FloatArray


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


def settle(path: Path, belt: Belt, contact: Contact) -> Rest:
    """Let a belt sink into pulleys that stand still.

    At the stretch g the tension is T = E A alpha1 (g^2 - 1) g / 2 (the axial term of the strain energy). On a
    pulley of radius R it presses with T g / R per unstretched metre, so the belt sinks by d = T g / (R k_p),
    which shortens the path by the wrap angle times d. Of the length and the tension of the belt, and of the
    stiffness of contact and the largest d, one is given and the other found.

    Parameters
    ----------
    path : Path
    belt : Belt
        With its length or its tension; if it has both, its tension counts.
    contact : Contact
        With its stiffness or its penetration.
    """
    radii = np.abs(path.radii)

    def sunk(load: float) -> FloatArray:
        if contact.stiffness is None:
            return np.asarray(contact.allowed_penetration * radii.min() / radii)
        return np.asarray(load / (radii * contact.stiffness))

    if belt.installed_tension is not None:
        tension = belt.installed_tension
        stretch = float(stretch_under(tension, belt.axial_stiffness))
        depths = sunk(tension * stretch)
        length = (path.length - float(path.wrap_angles @ depths)) / stretch
    else:
        length = belt.length
        stretch = _stretch(path, belt, contact, sunk(0.0))
        tension = max(float(tension_of(stretch, belt.axial_stiffness)), 0.0)
        depths = sunk(tension * stretch)
    stiffness = contact.stiffness
    if stiffness is None:
        stiffness = tension * stretch / (float(radii.min()) * float(depths.max()))
    return Rest(path, length, stiffness, tension, depths)


def _stretch(path: Path, belt: Belt, contact: Contact, depths: FloatArray) -> float:
    """Stretch of a belt of given length that sinks in as deep as allowed, or as the stiffness of contact lets it."""
    if contact.stiffness is None:
        return (path.length - float(path.wrap_angles @ depths)) / belt.length
    if path.length <= belt.length:
        return path.length / belt.length
    sinking = float(np.sum(path.wrap_angles / np.abs(path.radii))) / contact.stiffness
    return sunk_stretch(belt.length, path.length, belt.axial_stiffness, sinking)


def come_to_rest(path: Path, belt: Belt, contact: Contact, carriers: Sequence[Carrier]) -> tuple[Rest, FloatArray]:
    """Find where spring-loaded tensioners stand, by virtual work: force of spring and stops = T dL/dq for each.

    Weight and dry friction of a tensioner are left out, and so is what a change of the wrap angles does to the sinking
    in, which is of the order of penetration over radius.

    Parameters
    ----------
    path : Path
        Path with all tensioners at zero.
    belt, contact
        As for `settle`.
    carriers : sequence of Carrier
        The tensioners, shape (K,).

    Returns
    -------
    rest : Rest
    positions : ndarray, shape (K,)
        Positions q of the tensioners, m or rad.

    Raises
    ------
    ValueError
        If a tensioner finds no balance.
    """
    positions = np.zeros(len(carriers))
    for _ in range(_MOST_ROUNDS):
        before = positions.copy()
        for number in range(len(carriers)):
            positions[number] = _balance(path, belt, contact, carriers, positions, number)
        if len(carriers) < 2 or np.all(np.abs(positions - before) <= _ACCURACY * (1 + np.abs(positions))):
            break
    else:
        raise ValueError("the tensioners find no balance together. Make their springs stiffer, or give stops")
    return settle(moved(path, carriers, positions), belt, contact), positions


def moved(path: Path, carriers: Sequence[Carrier], positions: FloatArray) -> Path:
    """Path with the tensioners at other positions, shape (K,), m or rad; that at zero is given."""
    if not carriers:
        return path
    centers = path.centers.copy()
    for one, position in zip(carriers, positions, strict=True):
        centers[one.pulley] = one.place(float(position))[0]
    return Path(centers, path.radii)


def _balance(
    path: Path, belt: Belt, contact: Contact, carriers: Sequence[Carrier], positions: FloatArray, number: int
) -> float:
    """Position of one tensioner, the others held: the first balance on the way on which its forces drive it."""
    from scipy.optimize import brentq

    one = carriers[number]

    def excess(position: float) -> float:
        changed = positions.copy()
        changed[number] = position
        there = moved(path, carriers, changed)
        if abs(there.total_turning - path.total_turning) > 1.0:
            raise ValueError("the belt leaves a pulley")
        if _covers_another(there, one.pulley):
            raise ValueError("the pulley meets another one")
        leverage = path_gradient(there, one.pulley)[1] @ one.place(position)[1]
        return one.force(position) - settle(there, belt, contact).tension * float(leverage)

    start = float(positions[number])
    longest = float(np.abs(path.radii).min() / np.linalg.norm(one.place(start)[1]))
    first = excess(start)
    if first == 0.0:
        return start
    step, here = float(np.copysign(1e-3 * longest, first)), start
    for _ in range(_MOST_STEPS):
        try:
            if excess(here + step) * first <= 0:
                return float(brentq(excess, here, here + step, xtol=1e-15, rtol=4 * np.finfo(float).eps))
        except ValueError:
            break
        here, step = here + step, float(np.clip(_GROWTH * step, -longest, longest))
    raise ValueError(_no_balance(one, first))


def _covers_another(path: Path, pulley: int) -> bool:
    """Tell whether a pulley and another one cover the center of one of them: neither can pass the other."""
    distances = np.linalg.norm(np.delete(path.centers, pulley, axis=0) - path.centers[pulley], axis=1)
    radii = np.abs(path.radii)
    return bool(np.any(distances < np.maximum(np.delete(radii, pulley), radii[pulley])))


def _no_balance(one: Carrier, excess: float) -> str:
    name = one.tensioner.pulley
    if excess > 0:
        return (
            f'the tensioner of "{name}" moves on and on without tensioning the belt enough. '
            "Shorten the belt, lower the preload, or give stops"
        )
    return (
        f'the belt pushes the tensioner of "{name}" away without losing enough tension. '
        "Lengthen the belt, raise the preload, or give stops"
    )

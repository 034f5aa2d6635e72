"""Estimate of the belt at rest without friction: stretch and penetration, equilibrium and stability of tensioners."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import Carrier, moved
from beltdyn.model.contact import Contact
from beltdyn.model.path import Path
from beltdyn.theory.static_tension import stretch_with_penetration


@dataclass(frozen=True)
class StaticEstimate:
    """A belt at rest, without bending stiffness and weight."""

    path: Path
    """Its path, without penetration."""
    length: float
    """Unstretched length, m."""
    stiffness: float
    """Of contact, N/m^2."""
    tension: float
    """N; zero for a slack belt."""
    penetrations: FloatArray
    """Penetration into each pulley, m, shape (n,)."""


def static_estimate(path: Path, belt: Belt, contact: Contact) -> StaticEstimate:
    """Estimate tension and penetration of a belt at rest on its pulleys.

    At the stretch g the tension T is that of the law of stretch. On a pulley of radius R it presses with T g / R per
    unstretched meter, so the belt sinks by d = T g / (R k_p), which shortens the path by the wrap angle times d. Of the
    length and the tension of the belt, and of the stiffness of contact and the largest d, one is given and the other
    found.
    """
    radii, law = np.abs(path.radii), belt.stretch_parameters

    def penetrations(load: float) -> FloatArray:
        if contact.stiffness is None:
            return np.asarray(contact.allowed_penetration * radii.min() / radii)
        return np.asarray(load / (radii * contact.stiffness))

    if belt.installed_tension is not None:
        tension = belt.installed_tension
        stretch = float(law.stretch(tension))
        depths = penetrations(tension * stretch)
        length = (path.length - float(path.wrap_angles @ depths)) / stretch
    else:
        length = belt.given_length
        stretch = _stretch(path, belt, contact, penetrations(0.0))
        tension = max(float(law.tension(stretch)), 0.0)
        depths = penetrations(tension * stretch)
    stiffness = contact.stiffness
    if stiffness is None:
        stiffness = tension * stretch / (float(radii.min()) * float(depths.max()))
    return StaticEstimate(path, length, stiffness, tension, depths)


def _stretch(path: Path, belt: Belt, contact: Contact, depths: FloatArray) -> float:
    """Stretch of a belt of given length that sinks in as deep as allowed, or as the stiffness of contact lets it."""
    length = belt.given_length
    if contact.stiffness is None:
        return (path.length - float(path.wrap_angles @ depths)) / length
    if path.length <= length:
        return path.length / length
    sinking = float(np.sum(path.wrap_angles / np.abs(path.radii))) / contact.stiffness
    return stretch_with_penetration(length, path.length, belt.stretch_parameters, sinking)


_FIRST_STEP, _STEP_GROWTH = 1e-3, 1.3
"""Step of the search along the travel of a tensioner, over the travel that moves its pulley by the smallest radius."""
_LONGEST_STEP = 0.02
"""The same, over the distance of its pulley from the nearest other one, within which the leverage is smooth."""
_ROUNDING = 4 * float(np.finfo(float).eps)
_SEARCH_RANGE = 100.0
"""Search range of a sliding tensioner, in path lengths; an arm is searched over half a turn to both sides."""
_MAX_ROUNDS = 200
"""Rounds in which tensioners are balanced in turn, each with the others held; beyond, there is no common
equilibrium."""
_POSITION_TOLERANCE = 1e-13
"""Change of a position in a round, over 1 (m or rad) plus its magnitude, at which rounds end: close to rounding, so
that the order of tensioners has no influence."""


class TensionerBalance(NamedTuple):
    """An equilibrium position of a tensioner between belt, spring and stops.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> sprung = drive.replace(tensioner=[slide])
    >>> [[one.stable for one in places] for places in bd.model.tensioner_balances(sprung, bd.model.install(sprung))]
    [[True]]
    """

    position: float
    """q, m or rad."""
    stable: bool
    """Whether it returns after a small disturbance, with given belt length and the other tensioners held."""
    here: bool
    """Whether the tensioner rests there, at its nearest equilibrium."""


class _Situation(NamedTuple):
    """A belt around pulleys, one of them on the tensioner that is looked at, the others held."""

    path: Path
    belt: Belt
    contact: Contact
    carriers: Sequence[Carrier]
    positions: FloatArray
    number: int

    @property
    def carrier(self) -> Carrier:
        """The tensioner under consideration."""
        return self.carriers[self.number]

    def at(self, position: float) -> StaticEstimate:
        """The belt with that tensioner at a position."""
        changed = self.positions.copy()
        changed[self.number] = position
        return static_estimate(moved(self.path, self.carriers, changed), self.belt, self.contact)

    def excess(self, position: float) -> float:
        """Excess of the force of spring and stops over that of the belt at a position, F - T dL/dq."""
        one, there = self.carrier, self.at(position)
        if abs(there.path.total_turning - self.path.total_turning) > 1.0:
            raise ValueError("the belt leaves a pulley")
        if _covers_another(there.path, one.pulley):
            raise ValueError("the pulley meets another pulley")
        leverage = float(there.path.gradient(one.pulley) @ one.place(position)[1])
        if self.belt.installed_tension is not None and leverage < 0.0:
            raise ValueError("the tensioner passes its dead centre, beyond which its spring gives the belt no tension")
        return one.force(position) - there.tension * leverage

    @property
    def scale(self) -> float:
        """Travel that moves the pulley by the smallest radius, m or rad."""
        return float(np.abs(self.path.radii).min() / np.linalg.norm(self.carrier.place(0.0)[1]))

    def longest_step(self, position: float) -> float:
        """Search step, short against the distance to the nearest other pulley, m or rad."""
        changed = self.positions.copy()
        changed[self.number] = position
        distances = _distances(moved(self.path, self.carriers, changed), self.carrier.pulley)
        return _LONGEST_STEP * float(distances.min() / np.linalg.norm(self.carrier.place(position)[1]))

    def is_stable(self, position: float) -> bool:
        """Whether an equilibrium is stable: the excess falls along the travel at constant belt length."""
        there, step = self.at(position), 1e-4 * self.scale
        if there.length <= 0.0:  # of a tension that no belt bears, which is refused as such
            return True
        fixed = self._replace(
            belt=self.belt.replace(length=there.length, installed_tension=None),
            contact=self.contact.replace(stiffness=there.stiffness),
        )
        try:
            return fixed.excess(position + step) < fixed.excess(position - step)
        except ValueError:
            return False


def balance_tensioners(
    path: Path, belt: Belt, contact: Contact, carriers: Sequence[Carrier]
) -> tuple[StaticEstimate, FloatArray]:
    """Find rest positions of spring-loaded tensioners by virtual work: force of spring and stops = T dL/dq.

    Of several balances each takes the stable one that is nearest to its nominal place, and an unstable one only where
    none is stable. Weight and dry friction of a tensioner are left out, and so is the effect of wrap angles on
    penetration, which is of the order of penetration over radius. ValueError if there is no balance.
    """
    if not carriers:
        return static_estimate(path, belt, contact), np.zeros(0)
    return _balanced(_Layout(path, belt, contact, tuple(carriers)))


class _Layout(NamedTuple):
    """What places of tensioners depend on, known by its values: drives that differ in loads or speeds have the same."""

    path: Path
    belt: Belt
    contact: Contact
    carriers: tuple[Carrier, ...]

    @property
    def _values(self) -> tuple[object, ...]:
        centers, radii, ends = self.path.centers, self.path.radii, self.path.ends
        parts = self.belt, self.contact, *(one.tensioner for one in self.carriers)
        arrays = centers.tobytes(), radii.tobytes(), b"" if ends is None else ends.tobytes()
        return *arrays, *(repr(part) for part in parts), *(one.pulley for one in self.carriers)

    def __hash__(self) -> int:
        return hash(self._values)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Layout) and self._values == other._values


@lru_cache(maxsize=1024)
def _balanced(layout: _Layout) -> tuple[StaticEstimate, FloatArray]:
    """Places of the tensioners of a layout; see `balance_tensioners`."""
    path, belt, contact, carriers = layout
    positions = np.zeros(len(carriers))
    situations = [
        _Situation(path, belt, contact, carriers, positions, number)
        for number, one in enumerate(carriers)
        if not one.presses
    ]
    for situation in situations:
        positions[situation.number] = _preferred(situation)
    for _ in range(_MAX_ROUNDS if situations[1:] else 0):
        before = positions.copy()
        for situation in situations:
            positions[situation.number] = _nearest(situation)
        if np.all(np.abs(positions - before) <= _POSITION_TOLERANCE * (1 + np.abs(positions))):
            break
    else:
        if situations[1:]:
            raise ValueError("the tensioners have no common equilibrium. Increase their spring rates, or give stops")
    positions.setflags(write=False)
    return static_estimate(moved(path, carriers, positions), belt, contact), positions


def all_balances(
    path: Path, belt: Belt, contact: Contact, carriers: Sequence[Carrier], positions: FloatArray
) -> tuple[tuple[TensionerBalance, ...], ...]:
    """Find all equilibria of each tensioner in ascending order of position, with the others held."""
    situations = (_Situation(path, belt, contact, carriers, positions, number) for number in range(len(carriers)))
    return tuple(_described(situation) for situation in situations)


def held_belt(
    path: Path, belt: Belt, contact: Contact, carriers: Sequence[Carrier], positions: FloatArray, number: int
) -> StaticEstimate:
    """Find the belt that holds a tensioner at a position, by virtual work: T = F / (dL/dq); ValueError if none does."""
    there, one, position = moved(path, carriers, positions), carriers[number], float(positions[number])
    leverage = float(there.gradient(one.pulley) @ one.place(position)[1])
    force = one.force(position)
    if not (force > 0.0 and leverage > 0.0):
        raise ValueError(
            f'no tension holds the tensioner of "{one.tensioner.pulley}" at {one.tensioner.written(position)}: its '
            f"force is {force:.4g}, and a unit of travel lengthens the path by {leverage:.4g}"
        )
    return static_estimate(there, belt.replace(installed_tension=force / leverage), contact)


def _described(situation: _Situation) -> tuple[TensionerBalance, ...]:
    """All balances of a tensioner; none of one that presses the roller of a nip."""
    if situation.carrier.presses:
        return ()
    found = sorted(_balances(situation, 0.0))
    here = min(found, key=lambda q: abs(q - situation.positions[situation.number]), default=None)
    return tuple(TensionerBalance(q, situation.is_stable(q), q == here) for q in found)


def _preferred(situation: _Situation) -> float:
    """The stable balance nearest to the nominal place, or the nearest one of all."""
    nearest = None
    for position in _balances(situation, 0.0):
        if situation.is_stable(position):
            return position
        nearest = position if nearest is None else nearest
    if nearest is None:
        raise ValueError(_no_balance(situation, 0.0))
    if situation.belt.installed_tension is not None:
        raise ValueError(_no_stable_balance(situation.carrier, nearest, situation.belt.installed_tension))
    return nearest


def _nearest(situation: _Situation) -> float:
    """The balance nearest to where a tensioner stands."""
    start = float(situation.positions[situation.number])
    found = next(_balances(situation, start), None)
    if found is None:
        raise ValueError(_no_balance(situation, start))
    return found


def _balances(situation: _Situation, start: float) -> Iterator[float]:
    """Find positions in which the excess changes its sign, on both sides of a start, the nearer ones first."""
    around = situation.carrier.tensioner.turns
    reach = np.pi if around else _SEARCH_RANGE * situation.path.length
    first = situation.excess(start)
    if first == 0.0:
        yield start
    sides = [_Side(situation, start, sign) for sign in (1.0, -1.0)]
    while sides:
        side = min(sides, key=lambda one: abs(one.here - start))
        if abs(side.here - start) > reach or not side.go_on():
            sides.remove(side)
        elif side.found is not None:
            yield side.found


class _Side:
    """The way of a tensioner from a start to one side, searched by growing steps, and up to its end by halved ones."""

    def __init__(self, situation: _Situation, start: float, sign: float) -> None:
        self._situation, self._sign = situation, sign
        self._step = self._shortest = _FIRST_STEP * situation.scale
        self._growth = _STEP_GROWTH
        self.here, self._value = start, situation.excess(start)
        self.found: float | None = None

    def go_on(self) -> bool:
        """Take a step and find an equilibrium on it; False at the end of the travel."""
        from scipy.optimize import brentq

        excess, self.found = self._situation.excess, None
        while True:
            ahead = self.here + self._sign * min(self._step, self._situation.longest_step(self.here))
            try:
                value = excess(ahead)
                if value * self._value < 0.0 or value == 0.0 != self._value:
                    self.found = float(brentq(excess, self.here, ahead, xtol=1e-15, rtol=_ROUNDING))
                break
            except ValueError:
                self._step, self._growth = 0.5 * abs(ahead - self.here), 1.0
                if self._step < self._shortest:
                    return False
        self.here, self._value = ahead, value
        self._step *= self._growth
        return True


def _distances(path: Path, pulley: int) -> FloatArray:
    """Distances of the centers of the other pulleys from one, m."""
    others = np.delete(path.centers, pulley, axis=0)
    return np.asarray(np.linalg.norm(others - path.centers[pulley], axis=1))


def _covers_another(path: Path, pulley: int) -> bool:
    """Tell whether a pulley and another one cover the center of one of them: neither can pass the other."""
    radii = np.abs(path.radii)
    return bool(np.any(_distances(path, pulley) < np.maximum(np.delete(radii, pulley), radii[pulley])))


def _no_balance(situation: _Situation, start: float) -> str:
    one, excess, tension = situation.carrier, situation.excess(start), situation.belt.installed_tension
    name = one.tensioner.pulley
    if tension is not None:
        unit = one.tensioner.force_unit
        return (
            f'belt.installed_tension = {tension:.5g} N does not balance the tensioner of "{name}": its spring gives '
            f"{one.force(start):.5g} {unit}, that tension needs {one.force(start) - excess:.5g} {unit}. Set its "
            "preload to that, or give belt.length instead; the tensioner then sets the tension"
        )
    if excess > 0:
        return (
            f'the tensioner of "{name}" reaches the end of its travel without balancing the belt. '
            "Shorten the belt, reduce the preload, or give stops"
        )
    return (
        f'the belt pushes the tensioner of "{name}" back without losing enough tension. '
        "Lengthen the belt, increase the preload, or give stops"
    )


def _no_stable_balance(one: Carrier, position: float, tension: float) -> str:
    return (
        f"with belt.installed_tension = {tension:.5g} N the equilibrium of the tensioner of "
        f'"{one.tensioner.pulley}" at {one.tensioner.written(position)} is unstable. Change its pivot or direction, '
        "increase its spring rate, or give stops"
    )

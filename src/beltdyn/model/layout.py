"""The layout of a drive: path of the belt, take-up of fixed tensioners, and whether belt and pulleys mesh."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.contact.teeth import CREST
from beltdyn.errors import ModelError
from beltdyn.kernel import interpreted
from beltdyn.machines import FixedTensioner, MovingTensioner, Tensioner
from beltdyn.machines.profiles.functions import profile_integral, profile_rows
from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import carriers_of, check_sensors, check_tensioners
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import Choice, choose_stiffness, stiffness_for_tension
from beltdyn.model.end import PathEnd, pulling
from beltdyn.model.nip import Nip, check_nips, placed, tensioning
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.model.routing import lay_path
from beltdyn.model.static_estimate import StaticEstimate, balance_tensioners
from beltdyn.parts.messages import apart
from beltdyn.parts.quantity import RPM

LARGEST_STRAIN = 0.5
"""Of a belt that is laid on its path."""
MOST_OFF_GROOVE = 0.5 * (1.0 - CREST)
"""Largest misfit of a tooth over the pitch: beyond it the law of teeth holds it less the farther it is off."""
_MAX_TAKE_UP_STEPS = 90
"""Trial steps of the search for a take-up: 30 halvings lead from the longest first step to the shortest, and 60 steps
that grow by 0.3 beyond a million smallest radii. The search fails beyond."""
_FIRST, _LATER, _SHORTEST = 1.0, 0.3, 1e-9
"""Longest first step of a take-up, and the shortest, over the smallest radius; later ones over the way so far."""
_BEYOND = 1.01
"""First step over that of Newton's method, so that the take-up lies within."""
_LOOKED_AT = 10.0
"""Time over which prescribed speeds must agree at least, s; rounded ones do."""
_INSTANTS = 101
"""Instants at which they are compared, besides those at which they change."""


class Given(NamedTuple):
    """Parts of a drive as given."""

    belt: Belt
    pulleys: tuple[Pulley, ...]
    contact: Contact
    tensioners: tuple[Tensioner, ...]
    ends: tuple[PathEnd, ...] = ()
    fineness: float = 0.0
    """Of a staying mesh that is graded towards the ends of arcs; zero of others."""
    nips: tuple[Nip, ...] = ()

    def path_around(self, pulleys: Sequence[Pulley]) -> Path:
        """The checked path of the belt around pulleys."""
        return lay_path(pulleys, self.belt, self.ends, self.nips)

    def estimate(self, path: Path) -> StaticEstimate:
        """The belt at rest, with spring-loaded tensioners in balance."""
        carriers = carriers_of(self.tensioners, self.names, path)
        return balance_tensioners(path, loaded(self.belt, self.ends), self.contact, carriers)[0]

    @property
    def names(self) -> list[str]:
        """Names of the pulleys."""
        return [pulley.name for pulley in self.pulleys]

    @property
    def is_settled(self) -> bool:
        """Whether the belt length and the positions of all pulleys are given."""
        return loaded(self.belt, self.ends).installed_tension is None and not self.has_springs

    @property
    def has_springs(self) -> bool:
        """Whether a spring-loaded tensioner moves a pulley."""
        return bool(self.springs)

    @property
    def springs(self) -> list[MovingTensioner]:
        """The spring-loaded tensioners that tension the belt: those that do not press the rollers of nips."""
        return tensioning(self.tensioners, self.nips)

    @property
    def pulleys_in_place(self) -> tuple[Pulley, ...]:
        """The pulleys, moved by the take-up of fixed tensioners."""
        pulleys = self.pulleys
        for tensioner in self.tensioners:
            if isinstance(tensioner, FixedTensioner) and tensioner.take_up != 0:
                pulleys = _moved(pulleys, tensioner)
        return self.pressed(pulleys, np.inf) if self.nips else pulleys

    def pressed(self, pulleys: tuple[Pulley, ...], stiffness: float) -> tuple[Pulley, ...]:
        """Pulleys with the rollers of nips in place, on contact of a stiffness, N/m^2."""
        check_nips(self.nips, pulleys, self.belt)
        return placed(self.nips, pulleys, self.belt, stiffness, self.tensioners)


class Layout(NamedTuple):
    """A belt on its path, with spring-loaded tensioners at zero."""

    given: Given
    """The parts, with the take-up of their tensioners."""
    pulleys: tuple[Pulley, ...]
    """Where fixed tensioners hold them."""
    path: Path
    """Around these pulleys."""
    choices: tuple[Choice, ...] = ()
    """Numerical parameters chosen for it."""
    nominal: str | None = None
    """Pulley of the tensioner that the belt's length sets to its nominal position; None if the length is given, or is
    that for a given tension."""
    for_loads: bool = False
    """Whether the tension at rest, and so the length of the belt, is that which the loads require."""


def loaded(belt: Belt, ends: tuple[PathEnd, ...]) -> Belt:
    """The belt with the tension that a pulled end gives it at rest, or itself without such an end."""
    tension = pulling(ends)
    return belt if tension is None else belt.replace(length=belt.length, installed_tension=tension)


def lay_out(given: Given) -> Layout:
    """Lay the belt around the pulleys.

    Fixed tensioners move their pulleys; where a length and an installed tension are given, one of them takes up what is
    missing.
    """
    nominal = _require_length(given)
    pulleys = given.pulleys_in_place
    path = given.path_around(pulleys)
    check_tensioners(given.tensioners, pulleys, path)
    check_sensors(given.tensioners, pulleys)
    if nominal is not None:
        tension = _nominal_tension(given, path)
        belt = given.belt.replace(installed_tension=tension)
        return Layout(given._replace(belt=belt), pulleys, path, nominal=nominal)
    if given.is_settled:
        check_length(given.belt, given.belt.given_length, path.length)
    if given.belt.length is None or given.belt.installed_tension is None:
        return Layout(given, pulleys, path)
    given, choices = with_chosen_stiffness(given, path)
    _check_take_up_is_open(given.belt, given.tensioners)
    given = _tightened(given, path)
    pulleys = given.pulleys_in_place
    return Layout(given, pulleys, given.path_around(pulleys), choices)


def _require_length(given: Given) -> str | None:
    """Pulley of the tensioner whose nominal position gives the length of the belt; None if length or tension do."""
    belt = given.belt
    if belt.length is not None or belt.installed_tension is not None:
        return None
    if given.ends or not given.has_springs:
        raise ValueError(
            "belt.length is missing. Give the unstretched length, nominal_length or installed_tension, or a "
            "spring-loaded tensioner of a closed belt, whose nominal position then gives the length; or the loads of a "
            "belt of a rated profile, which then give its tension"
        )
    return given.springs[0].pulley


def _nominal_tension(given: Given, path: Path) -> float:
    """Tension with which the first spring-loaded tensioner stands at its nominal position, N."""
    one = carriers_of(given.tensioners, given.names, path)[0]
    force, lengthens = one.force(0.0), float(path.gradient(one.pulley) @ one.place(0.0)[1])
    if not force > 0.0:
        raise ValueError(
            f'belt.length is missing, and the tensioner of "{one.tensioner.pulley}", whose nominal position would give '
            f"it, has preload = {force:.4g} there. Give its preload at the nominal position, or the length of the belt"
        )
    return force / lengthens


def with_chosen_stiffness(given: Given, path: Path) -> tuple[Given, tuple[Choice, ...]]:
    """The same with a contact stiffness, if neither this nor a penetration is given."""
    belt, contact = loaded(given.belt, given.ends), given.contact
    if contact.stiffness is not None or contact.allowed_penetration is not None:
        return given, ()
    tension = belt.installed_tension
    if tension is None:
        first = with_chosen(contact, belt, {"stiffness": stiffness_for_tension(path, belt)})
        tension = given._replace(contact=first).estimate(path).tension
    choice = choose_stiffness(path, belt, tension)
    return given._replace(contact=with_chosen(contact, belt, {"stiffness": choice.value})), (choice,)


def with_chosen(contact: Contact, belt: Belt, chosen: Mapping[str, Any]) -> Contact:
    """Contact with its open parameters from the belt and its path."""
    try:
        return contact.replace(**chosen)
    except ModelError as error:
        numbers = ", ".join(f"contact.{key} = {value:.4g}" for key, value in chosen.items())
        raise ValueError(
            f"the default {numbers}, from the belt and the pulleys, is not usable. Correct belt.axial_stiffness = "
            f"{belt.axial_stiffness:.4g} N, belt.mass_per_length = {belt.mass_per_length:.4g} kg/m or the radii, or "
            "give the value"
        ) from error


def fixed_tensioner(tensioners: tuple[Tensioner, ...]) -> FixedTensioner:
    """The first fixed tensioner."""
    return next(tensioner for tensioner in tensioners if isinstance(tensioner, FixedTensioner))


def leverage(path: Path, pulley: int, tensioner: Tensioner) -> float:
    """Change of the path length per meter of travel of a tensioner, m."""
    return tensioner.leverage(path.centers[pulley], path.gradient(pulley))


def with_take_up(tensioners: tuple[Tensioner, ...], distance: float) -> tuple[Tensioner, ...]:
    """The same with another take-up of the fixed tensioner, m."""
    fixed = fixed_tensioner(tensioners)
    return tuple(one.replace(take_up=distance) if one is fixed else one for one in tensioners)


def _moved(pulleys: tuple[Pulley, ...], tensioner: FixedTensioner) -> tuple[Pulley, ...]:
    """Pulleys with that of a fixed tensioner moved by its take-up."""
    x, y = (tensioner.take_up * part for part in tensioner.direction)
    return tuple(
        pulley.replace(center=(pulley.center[0] + x, pulley.center[1] + y))
        if pulley.name == tensioner.pulley
        else pulley
        for pulley in pulleys
    )


def _check_take_up_is_open(belt: Belt, tensioners: tuple[Tensioner, ...]) -> None:
    """Refuse a belt of given length and tension without a single fixed tensioner of open take-up."""
    fixed = [tensioner for tensioner in tensioners if isinstance(tensioner, FixedTensioner)]
    key = _sized_by(belt)
    if len(fixed) != 1:
        raise ValueError(
            f"{key} and belt.installed_tension are both given, with {len(fixed)} fixed tensioners; the take-up needs "
            f'exactly one. Give one [[tensioner]] of kind = "fixed", or remove {key.removeprefix("belt.")} or '
            "installed_tension"
        )
    if fixed[0].take_up != 0:
        raise ValueError(
            f'the fixed tensioner of "{fixed[0].pulley}" has take_up = {fixed[0].take_up:g} m, but {key} and '
            "belt.installed_tension determine it. Remove one of the three"
        )


def _tightened(given: Given, path: Path) -> Given:
    """The same with the take-up of the one fixed tensioner that gives a belt of given length its tension."""
    from scipy.optimize import brentq

    fixed, length = fixed_tensioner(given.tensioners), given.belt.given_length

    def taken_up(distance: float) -> Given:
        return given._replace(tensioners=with_take_up(given.tensioners, distance))

    def excess(distance: float) -> float:
        there = taken_up(distance)
        return there.estimate(there.path_around(there.pulleys_in_place)).length - length

    lengthens = leverage(path, given.names.index(fixed.pulley), fixed)
    if abs(lengthens) < LEAST_LEVERAGE:
        raise _no_take_up(given, fixed, "moving it along its direction hardly changes the length of the path")
    here, first, blocked = 0.0, excess(0.0), False
    radius = min(pulley.radius for pulley in given.pulleys)
    step = _BEYOND * float(np.clip(-first / lengthens, -_FIRST * radius, _FIRST * radius))
    least = _SHORTEST * radius
    for _ in range(_MAX_TAKE_UP_STEPS):
        try:
            if excess(here + step) * first <= 0:
                return taken_up(float(brentq(excess, here, here + step, xtol=1e-15)))
        except ValueError as error:  # there is no such layout: the end of the way lies within this step
            blocked, step = True, 0.5 * step
            if abs(step) < least:
                raise _no_take_up(given, fixed, str(error)) from error
            continue
        here += step
        step = step if blocked else _LATER * here
    raise _no_take_up(given, fixed, f"none was found within {abs(here):.3g} m")


def _no_take_up(given: Given, tensioner: FixedTensioner, reason: str) -> ValueError:
    return ValueError(
        f'no take-up of "{tensioner.pulley}" gives a belt of {given.belt.length:.5g} m a tension of '
        f"{given.belt.installed_tension:.5g} N: {reason}. Change {_sized_by(given.belt)}, or the "
        "direction of the tensioner"
    )


def _sized_by(belt: Belt) -> str:
    """The key that gives the length of the belt."""
    return "belt.length" if belt.teeth is None else "belt.teeth"


def check_length(belt: Belt, length: float, path: float, tensioned: bool = False) -> None:
    """Refuse a belt that is too long or too short for its path, with moving tensioners at rest."""
    where = "the path around the pulleys" + ", as placed by the tensioners" * tensioned
    if length >= path:
        exact, room = apart(length, path)
        raise ValueError(
            f"{_length_as_given(belt, exact)} is {'as long as' if length == path else 'longer than'} {where} "
            f"({room} m): the belt would hang slack. Shorten it, or "
            f"{'increase the preload' if tensioned else 'move the pulleys apart'}."
        )
    if path / length - 1 > LARGEST_STRAIN:
        raise ValueError(
            f"{_length_as_given(belt, f'{length:.5g}')} is too short for {where} ({path:.5g} m): "
            f"it would be stretched by {path / length - 1:.0%}; the limit is {LARGEST_STRAIN:.0%}. "
            f"Lengthen it, or {'reduce the preload' if tensioned else 'move the pulleys closer together'}."
        )


def _length_as_given(belt: Belt, unstretched: str) -> str:
    """The length of a belt by the key that gives it, with the unstretched one in m."""
    if belt.nominal_length is not None:
        return f"belt.nominal_length = {1e3 * belt.nominal_length:.6g} mm ({unstretched} m unstretched)"
    if belt.teeth is not None:
        return f"belt.teeth = {belt.teeth} ({unstretched} m unstretched)"
    return f"belt.length = {unstretched} m"


def check_teeth(belt: Belt, pulleys: Sequence[Pulley], path: Path | None) -> None:
    """Refuse teeth that no groove holds, and a belt whose teeth ride on the crests; None of a path that moves."""
    if belt.teeth is None or belt.toothing is None:
        return
    toothed = np.array([pulley.teeth is not None for pulley in pulleys])
    if not toothed.any():
        raise ValueError(
            f"the belt has {belt.teeth} teeth, but no pulley has any. Give pulleys their teeth, or omit belt.teeth and "
            "belt.toothing for a flat belt"
        )
    pitch = belt.toothing.pitch
    if path is None or mesh_misfit(belt, path, toothed) <= MOST_OFF_GROOVE * pitch:
        return
    pitches = path.length / belt.given_pitch
    raise ValueError(
        f"belt.teeth = {belt.teeth} is too short to mesh: the path around the pulleys has {pitches:.2f} pitches of "
        f"{1e3 * pitch:.5g} mm, and a belt stretched to it has its teeth on the crests at the ends of arcs. Give "
        f"{int(pitches)} teeth, or move the pulleys closer together"
    )


def mesh_misfit(belt: Belt, path: Path, toothed: BoolArray) -> float:
    """Largest distance of a tooth from its groove, m, of a belt stretched to its path, without load or play.

    At the end of an arc of length L it is the strain beyond that at which pitches agree, times lambda tanh(L / 2
    lambda) with lambda^2 = p EA / k_t: teeth that share a load hold the belt within lambda of the ends.
    """
    if belt.teeth is None or belt.toothing is None:
        return 0.0
    pitch = belt.toothing.pitch
    strain = path.length / (belt.teeth * pitch) - 1.0
    decay = np.sqrt(pitch * belt.axial_stiffness / belt.toothing.tooth_stiffness)
    arcs = (np.abs(path.radii) * path.wrap_angles)[toothed]
    return float(strain * decay * np.tanh(0.5 * arcs / decay).max(initial=0.0))


def check_speeds(pulleys: Sequence[Pulley], path: Path, duration: float) -> None:
    """Refuse speeds with which a pulley gets half a pitch ahead of another one that the same belt holds by teeth."""
    turning = [
        (one.name, float(np.copysign(one.teeth, radius)), one.speed)
        for one, radius in zip(pulleys, path.radii, strict=True)
        if one.teeth and one.speed is not None and not one.hub
    ]
    if len(turning) < 2:
        return
    end, rows = max(duration, _LOOKED_AT), profile_rows([speed for *_, speed in turning], [()] * len(turning))
    starts = np.concatenate([speed.integrated.start for *_, speed in turning])
    times = np.union1d(np.linspace(0.0, end, _INSTANTS), starts[(starts > 0.0) & (starts < end)])
    passed = [
        count * np.array([interpreted(profile_integral)(rows, number, time) for time in times.tolist()]) / (2.0 * np.pi)
        for number, (_, count, _) in enumerate(turning)
    ]
    first, own_teeth, _ = turning[0]
    for (name, teeth, _), pitches in zip(turning[1:], passed[1:], strict=True):
        off = np.flatnonzero(np.abs(pitches - passed[0]) > 0.5)
        if off.size:
            time = times[off[0]]
            mean, needed = (2.0 * np.pi * RPM / teeth * one[off[0]] / time for one in (pitches, passed[0]))
            raise ValueError(
                f"pulley[{name}] turns at {mean:.6g} rpm in the mean of {time:.3g} s, but the teeth of the belt turn "
                f'its {abs(teeth):.0f} teeth at {needed:.6g} rpm, as "{first}" has {abs(own_teeth):.0f}. Omit one of '
                "both speeds, or make them agree"
            )


def teeth_in_mesh(belt: Belt, path: Path) -> FloatArray:
    """Pitches of the belt on the arc of each pulley, shape (pulleys,)."""
    return np.asarray(np.abs(path.radii) * path.wrap_angles / belt.given_pitch)

"""What follows from a drive as it is given: the length of the belt, the take-up, the numbers of computation."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.machines import FixedTensioner, MovingTensioner, Tensioner
from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import carriers_of, check_tensioners
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import (
    Choice,
    OnPath,
    choose_creep_ratio,
    choose_damping,
    choose_elements,
    choose_graded_elements,
    choose_standstill_creep,
    choose_stiffness,
    stiffness_for_tension,
)
from beltdyn.model.end import PathEnd, pulling
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, fastest_rim, friction_on
from beltdyn.model.routing import lay_path
from beltdyn.model.static_estimate import StaticEstimate
from beltdyn.model.tensioner_balance import balance_tensioners

_LARGEST_STRAIN = 0.5
_SMALLEST_STRAIN = 1e-10
_MOST_STEPS = 60


class Given(NamedTuple):
    """Parts of a drive, as a user gives them."""

    belt: Belt
    pulleys: tuple[Pulley, ...]
    contact: Contact
    tensioners: tuple[Tensioner, ...]
    ends: tuple[PathEnd, ...] = ()
    staying: bool = False
    """Whether the mesh is to stay in place while the belt flows through it."""

    def path_around(self, pulleys: Sequence[Pulley]) -> Path:
        """The path of the belt around pulleys, checked."""
        return lay_path(pulleys, self.belt, self.ends)

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
        """Whether the belt's length and the place of all pulleys are given."""
        return loaded(self.belt, self.ends).installed_tension is None and not self.has_springs

    @property
    def has_springs(self) -> bool:
        """Whether a spring-loaded tensioner moves a pulley."""
        return any(isinstance(tensioner, MovingTensioner) for tensioner in self.tensioners)

    @property
    def pulleys_in_place(self) -> tuple[Pulley, ...]:
        """The pulleys, moved by the take-up of fixed tensioners."""
        pulleys = self.pulleys
        for tensioner in self.tensioners:
            if isinstance(tensioner, FixedTensioner) and tensioner.take_up != 0:
                pulleys = _moved(pulleys, tensioner)
        return pulleys


class Completed(NamedTuple):
    """The same with nothing left open, and what follows."""

    belt: Belt
    """With its length and its number of elements."""
    pulleys: tuple[Pulley, ...]
    """Where fixed tensioners hold them, and spring-loaded ones at zero."""
    contact: Contact
    """With its stiffness, its damping and the parameters of its friction law."""
    tensioners: tuple[Tensioner, ...]
    """With their take-up."""
    path: Path
    """Around these pulleys."""
    choices: tuple[Choice, ...] = ()
    """Numbers of computation that were left open, as they are chosen, with their reasons."""


def loaded(belt: Belt, ends: tuple[PathEnd, ...]) -> Belt:
    """The belt with the tension that a pulled end gives it at rest, or itself without such an end."""
    tension = pulling(ends)
    return belt if tension is None else belt.replace(length=belt.length, installed_tension=tension)


def complete(given: Given) -> Completed:
    """Find what a drive leaves open.

    Fixed tensioners move their pulleys; a belt with an installed tension gets its length, or, if it has one, the
    fixed tensioner its take-up; an allowed penetration becomes a stiffness of contact. The numbers of computation that
    are not given are chosen by `beltdyn.model.defaults`.

    Parameters
    ----------
    given : Given

    Returns
    -------
    Completed

    Raises
    ------
    ValueError
        If a belt cannot run around the pulleys, would be slack or overstretched, a tensioner does not fit the pulleys,
        none can bring the belt to its tension, or they find no balance.
    """
    pulleys = given.pulleys_in_place
    path = given.path_around(pulleys)
    check_tensioners(given.tensioners, pulleys, path)
    if given.is_settled:
        _check_length(given.belt.given_length, path.length)
    given, choices = _with_chosen_stiffness(given, path)
    belt, contact = given.belt, given.contact
    if belt.length is not None and belt.installed_tension is not None:
        _check_take_up_is_open(given.tensioners)
        given = _tightened(given, path)
        pulleys = given.pulleys_in_place
        path = given.path_around(pulleys)
    if given.is_settled and not contact.open_keys and belt.elements is not None:
        return Completed(belt, pulleys, contact, given.tensioners, path)
    estimate = given.estimate(path)
    _check_estimate(given, pulleys, estimate)
    length = estimate.length if belt.length is None else belt.length
    given = given._replace(
        belt=belt.replace(length=length, installed_tension=None), contact=_with_stiffness(contact, estimate.stiffness)
    )
    choices += _choices(given, estimate)
    return Completed(
        belt=given.belt.replace(**_chosen(choices, "belt.")),
        pulleys=pulleys,
        contact=given.contact.replace(**_chosen(choices, "contact.")),
        tensioners=given.tensioners,
        path=path,
        choices=choices,
    )


def _with_chosen_stiffness(given: Given, path: Path) -> tuple[Given, tuple[Choice, ...]]:
    """The same with a stiffness of contact, if neither this nor a penetration is given."""
    belt, contact = loaded(given.belt, given.ends), given.contact
    if contact.stiffness is not None or contact.allowed_penetration is not None:
        return given, ()
    tension = belt.installed_tension
    if tension is None:
        first = given._replace(contact=contact.replace(stiffness=stiffness_for_tension(path, belt)))
        tension = first.estimate(path).tension
    choice = choose_stiffness(path, belt, tension)
    return given._replace(contact=contact.replace(stiffness=choice.value)), (choice,)


def _choices(given: Given, estimate: StaticEstimate) -> tuple[Choice, ...]:
    """Choose the other numbers that are left open, for a belt at rest."""
    path, belt, contact = estimate.path, given.belt, given.contact
    chosen = []
    if contact.damping is None:
        chosen.append(choose_damping(estimate.stiffness, belt))
    strain = estimate.tension / belt.axial_stiffness
    if "creep_ratio" in contact.open_keys:
        grip = np.array([friction_on(pulley, belt, contact) for pulley in given.pulleys])
        chosen.append(choose_creep_ratio(given.pulleys, grip * path.wrap_angles, strain))
    if "standstill_creep" in contact.open_keys:
        ratio = chosen[-1].value if contact.creep_ratio is None else contact.creep_ratio
        chosen.append(choose_standstill_creep(ratio, _largest_speed(given, path, strain)))
    if belt.elements is None:
        on_path = OnPath(belt, estimate.length, np.abs(path.radii), estimate.stiffness)
        graded = given.staying and not given.ends
        chosen.append(
            choose_graded_elements(on_path, path, estimate.tension)
            if graded
            else choose_elements(on_path, estimate.tension)
        )
    return tuple(chosen)


def _largest_speed(given: Given, path: Path, strain: float) -> float:
    """Speed of the fastest driven rim, or where none is known what the strain can cause, m/s."""
    return fastest_rim(given.pulleys, path.radii) or strain * given.belt.wave_speed


def _chosen(choices: Sequence[Choice], group: str) -> dict[str, float]:
    """Values of the choices of a group, by their keys there."""
    return {choice.key.removeprefix(group): choice.value for choice in choices if choice.key.startswith(group)}


def _with_stiffness(contact: Contact, stiffness: float) -> Contact:
    """Contact of a certain stiffness, N/m^2."""
    try:
        return contact.replace(stiffness=stiffness)
    except ModelError as error:
        raise ValueError(
            f"contact.allowed_penetration = {contact.allowed_penetration:g} m takes a stiffness that cannot be given: "
            f"{error} Allow more"
        ) from error


def take_up(completed: Completed, distance: float) -> tuple[Tensioner, ...]:
    """Take up more by the one fixed tensioner, so that the path becomes longer by a small distance.

    Parameters
    ----------
    completed : Completed
    distance : float
        m.

    Returns
    -------
    tuple of Tensioner
    """
    fixed = _fixed(completed.tensioners)
    number = [pulley.name for pulley in completed.pulleys].index(fixed.pulley)
    return _set(completed.tensioners, fixed.take_up + distance / _leverage(completed.path, number, fixed))


def _set(tensioners: tuple[Tensioner, ...], distance: float) -> tuple[Tensioner, ...]:
    """The same with another take-up of the one fixed tensioner, m."""
    fixed = _fixed(tensioners)
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


def _fixed(tensioners: tuple[Tensioner, ...]) -> FixedTensioner:
    """The first fixed tensioner."""
    return next(tensioner for tensioner in tensioners if isinstance(tensioner, FixedTensioner))


def _leverage(path: Path, pulley: int, tensioner: FixedTensioner) -> float:
    """How much longer the path becomes by a metre of take-up, m."""
    return float(path.gradient(pulley) @ np.array(tensioner.direction))


def _check_take_up_is_open(tensioners: tuple[Tensioner, ...]) -> None:
    """Refuse a belt of given length and tension without the one fixed tensioner whose take-up is to be computed."""
    fixed = [tensioner for tensioner in tensioners if isinstance(tensioner, FixedTensioner)]
    if len(fixed) != 1:
        raise ValueError(
            f"belt.length and belt.installed_tension are both given, with {len(fixed)} fixed tensioners: one of them "
            'takes up what is missing. Give one [[tensioner]] of kind = "fixed", or remove length or installed_tension'
        )
    if fixed[0].take_up != 0:
        raise ValueError(
            f'the fixed tensioner of "{fixed[0].pulley}" has take_up = {fixed[0].take_up:g} m, which belt.length and '
            "belt.installed_tension determine. Remove one of the three"
        )


def _tightened(given: Given, path: Path) -> Given:
    """The same with the take-up of the one fixed tensioner that gives a belt of given length its tension."""
    from scipy.optimize import brentq

    fixed, length = _fixed(given.tensioners), given.belt.given_length

    def taken_up(distance: float) -> Given:
        return given._replace(tensioners=_set(given.tensioners, distance))

    def excess(distance: float) -> float:
        there = taken_up(distance)
        return there.estimate(there.path_around(there.pulleys_in_place)).length - length

    leverage = _leverage(path, given.names.index(fixed.pulley), fixed)
    if abs(leverage) < LEAST_LEVERAGE:
        raise _no_take_up(given, fixed, "moving it along its direction hardly changes the length of the path")
    here, first = 0.0, excess(0.0)
    step = -float(np.sign(leverage * first)) * 1e-3 * min(pulley.radius for pulley in given.pulleys)
    for _ in range(_MOST_STEPS):
        try:
            if excess(here + step) * first <= 0:
                return taken_up(float(brentq(excess, here, here + step, xtol=1e-15)))
        except ValueError as error:
            raise _no_take_up(given, fixed, str(error)) from error
        here, step = here + step, 1.3 * step
    raise _no_take_up(given, fixed, f"not within {abs(here):.3g} m")


def _no_take_up(given: Given, tensioner: FixedTensioner, reason: str) -> ValueError:
    return ValueError(
        f'no take-up of "{tensioner.pulley}" brings a belt of {given.belt.length:.5g} m to '
        f"{given.belt.installed_tension:.5g} N: {reason}. Change belt.length, or the direction of the tensioner"
    )


def _check_estimate(given: Given, pulleys: tuple[Pulley, ...], estimate: StaticEstimate) -> None:
    """Refuse a belt at rest that is slack, or stretched beyond what its law describes."""
    wanted, length, path = given.belt.installed_tension, estimate.length, estimate.path.length
    if wanted is not None and not 0 < path <= (1 + _LARGEST_STRAIN) * length:
        raise ValueError(
            f"belt.installed_tension = {wanted:.5g} N would stretch the belt and press it into the pulleys by more "
            f"than {_LARGEST_STRAIN:.0%} of its length. Lower it, or give a belt of more axial stiffness than "
            f"{given.belt.axial_stiffness:.3g} N"
        )
    least = _SMALLEST_STRAIN * given.belt.axial_stiffness
    if wanted is not None and wanted < least:
        raise ValueError(
            f"belt.installed_tension = {wanted:.5g} N would stretch the belt by less than {_SMALLEST_STRAIN:.0e} of "
            f"its length, which is lost in rounding. Give at least {least:.1g} N"
        )
    _check_length(length, path, tensioned=given.has_springs)
    if given.has_springs:
        _check_place(given, pulleys, estimate.path)
    if not estimate.tension > 0:
        raise ValueError(
            f"the belt loses all tension, since it sinks into the pulleys: it is only {1e3 * (path - length):.3g} mm "
            "shorter than its path. Shorten it, or leave out contact.stiffness so that it is chosen"
        )


def _check_place(given: Given, pulleys: tuple[Pulley, ...], path: Path) -> None:
    """Refuse a place to which springs press their pulleys, but at which the belt could not run."""
    moved = [
        pulley.replace(center=tuple(center)) for pulley, center in zip(pulleys, path.centers.tolist(), strict=True)
    ]
    try:
        given.path_around(moved)
    except ValueError as error:
        raise ValueError(
            f"the tensioners balance the belt only where no belt can run: {error}. Change the preload or the belt's "
            "length, or give stops"
        ) from error


def _check_length(length: float, path: float, tensioned: bool = False) -> None:
    """Refuse a belt that is too long or too short for its path, with moving tensioners where they stand."""
    where = "the path around the pulleys" + ", where its tensioners put them" * tensioned
    if length >= path:
        raise ValueError(
            f"belt.length = {length:.5g} m is longer than {where} ({path:.5g} m): the belt would hang slack. "
            f"Shorten it, or {'raise the preload' if tensioned else 'move the pulleys apart'}."
        )
    if path / length - 1 > _LARGEST_STRAIN:
        raise ValueError(
            f"belt.length = {length:.5g} m is too short for {where} ({path:.5g} m): "
            f"it would be stretched by {path / length - 1:.0%}, and {_LARGEST_STRAIN:.0%} is the limit. "
            f"Lengthen it, or {'lower the preload' if tensioned else 'move the pulleys together'}."
        )

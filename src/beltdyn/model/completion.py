"""What a drive file may leave open: the length of the belt, the take-up, the stiffness of contact."""

from typing import Any, NamedTuple

import numpy as np

from beltdyn.machines import FixedTensioner, MovingTensioner, Tensioner
from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import Carrier, carriers_of, check_tensioners
from beltdyn.model.contact import Contact
from beltdyn.model.layout import lay_path
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley
from beltdyn.model.rest import Rest
from beltdyn.model.tensioner_balance import come_to_rest

_LARGEST_STRAIN = 0.5
_SMALLEST_STRAIN = 1e-10
_MOST_STEPS = 60
_ROUNDING = 1e-14
"""Of a length, within which a take-up is not looked for: a drive that has found its own keeps it."""


class _Open(NamedTuple):
    """Parts of a drive, as a user gives them."""

    belt: Belt
    pulleys: tuple[Pulley, ...]
    contact: Contact
    tensioners: tuple[Tensioner, ...]

    def rest(self) -> Rest:
        """The belt at rest, with spring-loaded tensioners in balance."""
        path = lay_path(self.pulleys, self.belt)
        return come_to_rest(path, self.belt, self.contact, self.carriers(path))[0]

    def carriers(self, path: Path) -> list[Carrier]:
        """Its spring-loaded tensioners."""
        return carriers_of(self.tensioners, self.names, path)

    @property
    def names(self) -> list[str]:
        """Names of the pulleys."""
        return [pulley.name for pulley in self.pulleys]


def complete(
    belt: Belt, pulleys: tuple[Pulley, ...], contact: Contact, tensioners: tuple[Tensioner, ...]
) -> dict[str, Any]:
    """Make parts of a drive definite.

    Fixed tensioners move their pulleys; a belt with an installed tension gets its length, or, if it has one, the
    fixed tensioner its take-up; an allowed penetration becomes a stiffness of contact.

    Parameters
    ----------
    belt, pulleys, contact, tensioners
        As a user gives them.

    Returns
    -------
    dict
        The four parts by their names, definite.

    Raises
    ------
    ValueError
        If a belt cannot run around the pulleys, would be slack or overstretched, a tensioner does not fit the pulleys,
        none can bring the belt to its tension, or they find no balance.
    """
    given = _taken_up(_Open(belt, pulleys, contact, tensioners))
    path = lay_path(given.pulleys, belt)
    check_tensioners(tensioners, given.pulleys, path)
    if belt.length is not None and belt.installed_tension is not None:
        _check_take_up_is_open(tensioners)
        given = _tightened(given, path)
        path = lay_path(given.pulleys, belt)
    carriers = given.carriers(path)
    if not carriers and belt.installed_tension is None:
        _check_length(belt.length, path.length)
        if contact.stiffness is not None:
            return given._asdict()
    rest = come_to_rest(path, belt, contact, carriers)[0]
    _check_rest(given, rest)
    length = rest.length if belt.length is None else belt.length
    definite = given._replace(
        belt=belt.definite(length),
        contact=contact.model_copy(update={"stiffness": rest.stiffness, "allowed_penetration": None}),
    )
    return definite._asdict()


def _taken_up(given: _Open) -> _Open:
    """Pulleys moved by the take-up of their fixed tensioners."""
    for tensioner in given.tensioners:
        if isinstance(tensioner, FixedTensioner) and tensioner.take_up != 0:
            given = _shifted(given, tensioner, tensioner.take_up)
    return given


def _shifted(given: _Open, tensioner: FixedTensioner, distance: float) -> _Open:
    """The same with the pulley of a fixed tensioner moved, and its take-up done."""
    done = tensioner.model_copy(update={"take_up": 0.0})
    return given._replace(
        pulleys=_moved(given.pulleys, tensioner, distance),
        tensioners=tuple(done if one is tensioner else one for one in given.tensioners),
    )


def _moved(pulleys: tuple[Pulley, ...], tensioner: FixedTensioner, distance: float) -> tuple[Pulley, ...]:
    """Pulleys with that of a fixed tensioner moved along its direction, m."""
    step = (distance * tensioner.direction[0], distance * tensioner.direction[1])
    return tuple(
        pulley.model_copy(update={"center": (pulley.center[0] + step[0], pulley.center[1] + step[1])})
        if pulley.name == tensioner.pulley
        else pulley
        for pulley in pulleys
    )


def take_up(
    pulleys: tuple[Pulley, ...], tensioners: tuple[Tensioner, ...], path: Path, distance: float
) -> tuple[Pulley, ...]:
    """Move the pulley of the one fixed tensioner, so that the path becomes longer by a small distance, m.

    Parameters
    ----------
    pulleys, tensioners
        Of a drive.
    path : Path
        Around the pulleys.
    distance : float
        m.
    """
    fixed = _fixed(tensioners)
    number = [pulley.name for pulley in pulleys].index(fixed.pulley)
    return _moved(pulleys, fixed, distance / _leverage(path, number, fixed))


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


def _tightened(given: _Open, path: Path) -> _Open:
    """The same with the pulley of the one fixed tensioner where the belt of given length has the given tension."""
    from scipy.optimize import brentq

    fixed = _fixed(given.tensioners)

    def excess(distance: float) -> float:
        return _shifted(given, fixed, distance).rest().length - given.belt.length

    leverage = _leverage(path, given.names.index(fixed.pulley), fixed)
    if abs(leverage) < LEAST_LEVERAGE:
        raise _no_take_up(given, fixed, "moving it along its direction hardly changes the length of the path")
    here, first = 0.0, excess(0.0)
    if abs(first) <= _ROUNDING * given.belt.length:
        return given
    step = -float(np.sign(leverage * first)) * 1e-3 * min(pulley.radius for pulley in given.pulleys)
    for _ in range(_MOST_STEPS):
        try:
            if excess(here + step) * first <= 0:
                found = float(brentq(excess, here, here + step, xtol=1e-15))
                return _shifted(given, fixed, found)
        except ValueError as error:
            raise _no_take_up(given, fixed, str(error)) from error
        here, step = here + step, 1.3 * step
    raise _no_take_up(given, fixed, f"not within {abs(here):.3g} m")


def _no_take_up(given: _Open, tensioner: FixedTensioner, reason: str) -> ValueError:
    return ValueError(
        f'no take-up of "{tensioner.pulley}" brings a belt of {given.belt.length:.5g} m to '
        f"{given.belt.installed_tension:.5g} N: {reason}. Change belt.length, or the direction of the tensioner"
    )


def _check_rest(given: _Open, rest: Rest) -> None:
    """Refuse a belt at rest that is slack, or stretched beyond what its law describes."""
    wanted, length, path = given.belt.installed_tension, rest.length, rest.path.length
    if wanted is not None and not 0 < path <= (1 + _LARGEST_STRAIN) * length:
        raise ValueError(
            f"belt.installed_tension = {wanted:.5g} N would stretch the belt and press it into the pulleys by more "
            f"than {_LARGEST_STRAIN:.0%} of its length. Lower it, or make belt and contact stiffer"
        )
    least = _SMALLEST_STRAIN * given.belt.axial_stiffness
    if wanted is not None and wanted < least:
        raise ValueError(
            f"belt.installed_tension = {wanted:.5g} N would stretch the belt by less than {_SMALLEST_STRAIN:.0e} of "
            f"its length, which is lost in rounding. Give at least {least:.1g} N"
        )
    moving = any(isinstance(tensioner, MovingTensioner) for tensioner in given.tensioners)
    _check_length(length, path, tensioned=moving)
    if moving:
        _check_place(given, rest.path)
    if not rest.tension > 0:
        raise ValueError(
            "the belt loses all tension by sinking into the pulleys: it is only "
            f"{path - length:.3g} m shorter than its path. Shorten it, or let it sink in less"
        )


def _check_place(given: _Open, path: Path) -> None:
    """Refuse a place to which springs press their pulleys, but at which the belt could not run."""
    moved = [
        pulley.model_copy(update={"center": tuple(center)})
        for pulley, center in zip(given.pulleys, path.centers.tolist(), strict=True)
    ]
    try:
        lay_path(moved, given.belt)
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

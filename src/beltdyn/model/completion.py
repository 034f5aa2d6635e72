"""Completion of a laid-out drive: belt length and default numerical parameters."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.machines import Tensioner
from beltdyn.model.belt import Belt
from beltdyn.model.carrier import carriers_of
from beltdyn.model.contact import Contact
from beltdyn.model.defaults import (
    Choice,
    OnPath,
    choose_creep_ratio,
    choose_damping,
    choose_elements,
    choose_graded_elements,
    choose_standstill_creep,
)
from beltdyn.model.layout import (
    LARGEST_STRAIN,
    Given,
    Layout,
    check_length,
    fixed_tensioner,
    leverage,
    with_chosen,
    with_chosen_stiffness,
    with_take_up,
)
from beltdyn.model.path import Path
from beltdyn.model.pulley import Pulley, fastest_rim, friction_on
from beltdyn.model.static_estimate import StaticEstimate
from beltdyn.parts.messages import plain

_SMALLEST_STRAIN = 1e-10
"""Least strain that an installed tension may cause: a smaller one is lost in the rounding of lengths, and refused."""


class Completed(NamedTuple):
    """The parts of a drive with all open values filled in."""

    belt: Belt
    """With its length and number of elements."""
    pulleys: tuple[Pulley, ...]
    """As positioned by fixed tensioners, with spring-loaded tensioners at zero."""
    contact: Contact
    """With stiffness, damping and friction-law parameters."""
    tensioners: tuple[Tensioner, ...]
    """With their take-up."""
    path: Path
    """Around these pulleys."""
    choices: tuple[Choice, ...] = ()
    """Default numerical parameters, with their reasons."""


def complete(layout: Layout) -> Completed:
    """Fill in the open values of a drive.

    A belt with an installed tension gets its length, if its layout has not settled that; an allowed penetration becomes
    a stiffness of contact. The numbers of computation that are not given are chosen by `beltdyn.model.defaults`.
    """
    found = _complete(layout)
    if not layout.given.nips:
        return found
    pulleys = layout.given.pressed(found.pulleys, found.contact.given("stiffness"))
    return found._replace(pulleys=pulleys, path=layout.given.path_around(pulleys))


def _complete(layout: Layout) -> Completed:
    pulleys, path = layout.pulleys, layout.path
    given, choices = with_chosen_stiffness(layout.given, path)
    choices = layout.choices + choices
    belt, contact = given.belt, given.contact
    if given.is_settled and not contact.open_keys and belt.elements is not None:
        return Completed(belt, pulleys, contact, given.tensioners, path)
    estimate = given.estimate(path)
    _check_estimate(given, layout.nominal, pulleys, estimate)
    found = {"length": estimate.length} if belt.length is None else {}
    given = given._replace(
        belt=belt.replace(**found, installed_tension=None), contact=_with_stiffness(contact, estimate.stiffness)
    )
    choices += _choices(given, estimate)
    if layout.nominal is not None:
        reason = f'sets the tensioner of "{layout.nominal}" to its nominal position'
        choices = (Choice("belt.length", estimate.length, "m", reason), *choices)
    if layout.for_loads:
        reason = f"gives {plain(estimate.tension)} N, of a run-in belt, as the loads require"
        choices = (Choice("belt.length", estimate.length, "m", reason), *choices)
    return Completed(
        belt=given.belt.replace(**_chosen(choices, "belt.")),
        pulleys=pulleys,
        contact=with_chosen(given.contact, given.belt, _chosen(choices, "contact.")),
        tensioners=given.tensioners,
        path=path,
        choices=choices,
    )


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
        chosen.append(choose_standstill_creep(ratio, _largest_speed(given, path, strain), given.pulleys))
    if belt.elements is None:
        on_path = OnPath(belt, estimate.length, np.abs(path.radii), estimate.stiffness)
        chosen.append(
            choose_graded_elements(on_path, path, estimate.tension, given.fineness)
            if given.fineness
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
            f"contact.allowed_penetration = {contact.allowed_penetration:g} m needs an invalid contact stiffness: "
            f"{error} Increase it"
        ) from error


def take_up(completed: Completed, distance: float) -> tuple[Tensioner, ...]:
    """Increase the take-up of the fixed tensioner so that the path lengthens by a small distance."""
    fixed = fixed_tensioner(completed.tensioners)
    number = [pulley.name for pulley in completed.pulleys].index(fixed.pulley)
    return with_take_up(completed.tensioners, fixed.take_up + distance / leverage(completed.path, number, fixed))


def _check_estimate(given: Given, nominal: str | None, pulleys: tuple[Pulley, ...], estimate: StaticEstimate) -> None:
    """Refuse a belt at rest that is slack, or stretched beyond what its law describes."""
    wanted, length, path = given.belt.installed_tension, estimate.length, estimate.path.length
    if wanted is not None and not 0 < path <= (1 + LARGEST_STRAIN) * length:
        raise ValueError(
            f"{_asked(given, nominal, estimate.path)} would stretch the belt and press it into the pulleys by more "
            f"than {LARGEST_STRAIN:.0%} of its length. Reduce it, or give the belt an axial stiffness above "
            f"{given.belt.axial_stiffness:.3g} N"
        )
    least = _SMALLEST_STRAIN * given.belt.axial_stiffness
    if wanted is not None and wanted < least:
        raise ValueError(
            f"{_asked(given, nominal, estimate.path)} would stretch the belt by less than "
            f"{_SMALLEST_STRAIN:.0e} of its length, which is below rounding. Give at least {least:.1g} N"
        )
    check_length(given.belt, length, path, tensioned=given.has_springs)
    if given.has_springs:
        _check_place(given, pulleys, estimate.path)
    if not estimate.tension > 0:
        raise ValueError(
            f"the belt sinks into the pulleys and loses all tension: it is only {1e3 * (path - length):.3g} mm "
            "shorter than its path. Shorten it, or omit contact.stiffness to use the default"
        )


def _asked(given: Given, nominal: str | None, path: Path) -> str:
    """The tension at rest with the key that asks for it."""
    tension = f"{given.belt.installed_tension:.5g} N"
    carriers = carriers_of(given.tensioners, given.names, path)
    carrier = next((one for one in carriers if one.tensioner.pulley == nominal), None)
    if carrier is None:
        return f"belt.installed_tension = {tension}"
    unit = carrier.tensioner.force_unit
    return f'preload = {carrier.force(0.0):.4g} {unit} of the tensioner of "{nominal}" is a tension of {tension}, which'


def _check_place(given: Given, pulleys: tuple[Pulley, ...], path: Path) -> None:
    """Refuse a place to which springs press their pulleys, but at which the belt could not run."""
    moved = [
        pulley.replace(center=tuple(center)) for pulley, center in zip(pulleys, path.centers.tolist(), strict=True)
    ]
    try:
        given.path_around(moved)
    except ValueError as error:
        raise ValueError(
            f"springs and belt push the tensioners to where no belt can run: {error}. Change the preload or the belt "
            "length, or give stops"
        ) from error

"""Selection of belt drives: standard pulleys, lengths and V-, V-ribbed or toothed belts that carry a power."""

from collections.abc import Callable, Iterator, Sequence
from math import hypot, pi, sin
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.designs.proposal import Proposal as Proposal
from beltdyn.designs.proposal import Task
from beltdyn.designs.toothed_selection import of_toothed_profile
from beltdyn.errors import ModelError
from beltdyn.model import Entry, read_catalogue
from beltdyn.model.catalogue import find_entry
from beltdyn.model.rating import RatedBelt, Rating, lower_bound
from beltdyn.parts.messages import reason
from beltdyn.parts.quantity import RPM, number_in, numbers_in
from beltdyn.theory.rating import RUN_IN, TENSION_FORMULAS, least_tension
from beltdyn.theory.span import OpenBelt, center_distance, lowest_frequency, open_belt

DIAMETERS = tuple(
    1e-3 * one
    for one in (
        *(20, 22.4, 25, 28, 31.5, 35.5, 40, 45, 50, 53, 56, 60, 63, 67, 71, 75, 80, 85, 90, 95, 100, 106, 112, 118),
        *(125, 132, 140, 150, 160, 170, 180, 190, 200, 212, 224, 236, 250, 265, 280, 315, 355, 375, 400, 425, 450, 475),
        *(500, 530, 560, 630, 710, 800, 900, 1000, 1250, 1600, 2000),
    )
)
"""Preferred diameters of pulleys, m (BS 3790:2006, table 8)."""

_OF_A_PROFILE = 2
"""Most proposals of a profile."""


def select(
    *,
    power: float | str,
    speed: float | str,
    driven_speed: float | str,
    service_factor: float = 1.0,
    distance: str | None = None,
    largest_driver: float | str | None = None,
    largest_driven: float | str | None = None,
    profiles: str | Sequence[str] | None = None,
    ratio_tolerance: float = 0.03,
    most_belts: int = 12,
    toothed: bool = False,
    count: int = 5,
    catalogue: str | Path | None = None,
) -> tuple[Proposal, ...]:
    """Select V-belt, V-ribbed or toothed drives for a power: profile, pulleys, belts or width, length and tension.

    All pairs of standard pulleys and standard lengths of the rated profiles are tried. The best need the least face
    width, ribs times width; of equal ones those with smaller pulleys. Toothed belts have the next standard width in
    which their teeth in mesh and their cords carry the power.

    Parameters
    ----------
    power
        Power to transmit, such as "7.5 kW", or in W.
    speed
        Speed of the driver, such as "1450 rpm", or in rad/s.
    driven_speed
        Speed of the driven pulley.
    service_factor
        Design power over power.
    distance
        Range of the center distance, such as "400..600 mm"; by default 0.7 to 2 times the sum of the diameters.
    largest_driver
        Largest diameter of the driver, such as "200 mm", or in m.
    largest_driven
        Largest diameter of the driven pulley.
    profiles
        Names of profiles, also as text with commas; by default all V- and V-ribbed belts with a rating.
    ratio_tolerance
        Largest deviation of the speed ratio, relative.
    most_belts
        Most V-belts side by side; ribs of a V-ribbed belt are limited to four times as many.
    toothed
        Whether to choose among toothed belts, if no profiles are named.
    count
        Number of proposals, at most two of a profile.
    catalogue
        Your own catalogue, a TOML file that extends that of the package.

    Returns
    -------
    tuple of Proposal
        Best first.

    Raises
    ------
    ModelError
        If a number is not possible, a profile is unknown or has no rating, or no drive is found.

    Examples
    --------
    >>> found = bd.select(power="7.5 kW", speed="1450 rpm", driven_speed="700 rpm", profiles="SPA")
    >>> found[0].profile, found[0].utilization <= 1.0
    ('SPA', True)
    """
    task = Task(
        power=_above_zero("power", power, "W"),
        speed=_above_zero("speed", speed, "rad/s"),
        driven_speed=_above_zero("driven_speed", driven_speed, "rad/s"),
        service_factor=_above_zero("service_factor", service_factor, ""),
        distances=None if distance is None else _range_of(distance),
        largest=(_largest("largest_driver", largest_driver), _largest("largest_driven", largest_driven)),
        tolerance=_above_zero("ratio_tolerance", ratio_tolerance, ""),
        most_belts=most_belts,
    )
    entries = _rated_entries(profiles, catalogue, toothed)
    path = None if catalogue is None else str(catalogue)
    found = sorted(
        (one for name, entry in entries.items() for one in _kind_of(entry)(name, entry, task, path)),
        key=lambda one: (round(one.face_width, 6), one.driver_diameter + one.driven_diameter, one.hub_load),
    )
    if not found:
        raise ModelError(
            f"no drive of {', '.join(entries)} carries {1e-3 * task.design_power:.4g} kW at {RPM * task.speed:.4g} to "
            f"{RPM * task.driven_speed:.4g} rpm within these limits. Widen distance, largest_driver and "
            "largest_driven, raise most_belts or ratio_tolerance, or allow more profiles."
        )
    return tuple(_varied(found, count))


def _above_zero(name: str, value: float | str, unit: str) -> float:
    """A number above zero."""
    number = number_in(name, value, unit)
    if not number > 0.0:
        raise ModelError(f"{name} = {value!r} must be above zero.")
    return number


def _largest(name: str, value: float | str | None) -> float:
    return np.inf if value is None else _above_zero(name, value, "m")


def _range_of(text: str) -> tuple[float, float]:
    """The ends of a range of center distances."""
    least, *_, largest = (
        (float(one) for one in numbers_in("distance", text, "m", 2)) if ".." in str(text) else (0.0, 0.0)
    )
    if not 0.0 < least < largest:
        raise ModelError(f'distance = {text!r} must be a range such as "400..600 mm".')
    return least, largest


def _rated_entries(
    profiles: str | Sequence[str] | None, catalogue: str | Path | None, toothed: bool
) -> dict[str, Entry]:
    """The profiles to choose from."""
    try:
        known = read_catalogue(catalogue)
        wanted = profiles.split(",") if isinstance(profiles, str) else profiles
        if wanted is None:
            wanted = [name for name, one in known.items() if _is_rated(one) and (one.toothing is not None) == toothed]
        chosen = {name.strip(): find_entry(known, name.strip()) for name in wanted}
    except (LookupError, ValueError) as error:
        raise ModelError(f"{reason(error).rstrip('.')}.") from None
    for name, one in chosen.items():
        if not _is_rated(one):
            missing = "standard lengths" if one.rating or one.tooth_rating else "rating"
            raise ModelError(
                f'profile "{name}" has no {missing}. Choose another one, or add them in a catalogue of your own.'
            )
    return chosen


def _is_rated(entry: Entry) -> bool:
    """Whether a profile has a rating and standard lengths."""
    return bool((entry.rating or entry.tooth_rating) and entry.lengths)


def _varied(found: Sequence[Proposal], count: int) -> Iterator[Proposal]:
    """The best ones, not too many of a profile."""
    taken = dict[str, int]()
    for one in found:
        if sum(taken.values()) < count and taken.get(one.profile, 0) < _OF_A_PROFILE:
            taken[one.profile] = taken.get(one.profile, 0) + 1
            yield one


class _Pair(NamedTuple):
    """Two pulleys with a belt of a profile."""

    entry: Entry
    small: float
    """Diameter as sold, m."""
    large: float

    @property
    def radii(self) -> tuple[float, float]:
        """Of the tension line, m."""
        return 0.5 * self.small + self.entry.pitch_offset, 0.5 * self.large + self.entry.pitch_offset

    def at(self, nominal_length: float) -> OpenBelt | None:
        """The path of a belt of a nominal length; None if it is too short."""
        distance = self.distance(nominal_length)
        return None if distance is None else open_belt(distance, self.radii)

    def distance(self, nominal_length: float) -> float | None:
        """Center distance, m."""
        return center_distance(nominal_length + 2.0 * pi * self.entry.pitch_offset, self.radii)


def _kind_of(entry: Entry) -> Callable[[str, Entry, Task, str | None], Iterator[Proposal]]:
    """What proposes drives of a profile."""
    return of_toothed_profile if entry.tooth_rating is not None else _of_profile


def _of_profile(name: str, entry: Entry, task: Task, catalogue: str | None) -> Iterator[Proposal]:
    """The best belt length for each pair of pulleys of a profile."""
    rating = entry.rating
    assert rating is not None
    for pair in _pairs(entry, task):
        speed = pair.radii[0] * max(task.speed, task.driven_speed)
        if speed > rating.largest_speed:
            continue
        known = [one for length in entry.lengths if (one := _fit(pair, rating, length, speed, task)) is not None]
        if known:
            best = min(known, key=lambda one: (one.belts, one.off_middle))
            yield _proposal(name, pair, best, task, catalogue)


def _pairs(entry: Entry, task: Task) -> Iterator[_Pair]:
    """Standard pulleys with the ratio, as far as there is room."""
    room = task.largest if task.slows else task.largest[::-1]
    for small in DIAMETERS:
        if small < (entry.smallest_diameter or 0.0) * (1.0 - 1e-9) or small > room[0]:
            continue
        offset = 2.0 * entry.pitch_offset
        wanted = (small + offset) * task.ratio - offset
        large = min(DIAMETERS, key=lambda one: abs(one - wanted))
        ratio = (large + offset) / (small + offset)
        if large <= room[1] and abs(ratio / task.ratio - 1.0) <= task.tolerance:
            yield _Pair(entry, small, large)


class _Fit(NamedTuple):
    """A belt of a standard length on two pulleys."""

    length: float
    distance: float
    path: OpenBelt
    belts: int
    power: float
    """Rated power of all belts, W."""
    speed: float
    off_middle: float
    """Of the center distance from the middle of its range, m."""


def _fit(pair: _Pair, rating: Rating, length: float, speed: float, task: Task) -> _Fit | None:
    """The belts of a length that carry the power; None where they do not fit."""
    path = pair.at(length)
    total = pair.small + pair.large
    least, largest = task.distances_for(total)
    if path is None:
        return None
    distance = hypot(path.span, pair.radii[1] - pair.radii[0])
    if not least <= distance <= largest:
        return None
    one = RatedBelt(rating, 1, pair.entry.is_v_belt, length)
    diameters, loaded = 2.0 * np.array(pair.radii), np.ones(2, dtype=bool)
    power = float(one.on(diameters, np.array(path.wrap), speed, loaded).power.min())
    most = task.most_belts if one.in_set else 4 * task.most_belts
    if not power > 0.0 or task.design_power > most * power:
        return None
    belts = one.belts_needed(task.design_power / power, 2)
    whole = power * one.factor(belts, 2) / one.factor(1, 2)
    return _Fit(length, distance, path, belts, whole, speed, abs(distance - 0.5 * (least + largest)))


def _proposal(name: str, pair: _Pair, fit: _Fit, task: Task, catalogue: str | None) -> Proposal:
    """A belt on two pulleys as a proposal."""
    entry, belts, rating = pair.entry, fit.belts, pair.entry.rating
    mass, pull = belts * entry.mass_per_length, task.design_power / fit.speed
    wrap = min(fit.path.wrap)
    tensions = {
        name: RUN_IN * least_tension(pull, wrap, mass, fit.speed, grip) for name, grip in TENSION_FORMULAS.items()
    }
    tension = max(tensions.values())
    driver, driven = (pair.small, pair.large) if task.slows else (pair.large, pair.small)
    offset = 2.0 * entry.pitch_offset
    return Proposal(
        profile=name,
        belts=belts,
        driver_diameter=driver,
        driven_diameter=driven,
        nominal_length=fit.length,
        distance=fit.distance,
        driven_speed=task.speed * (driver + offset) / (driven + offset),
        belt_speed=fit.speed,
        rated_power=fit.power,
        utilization=task.design_power / fit.power,
        tension=tension,
        hub_load=2.0 * tension * sin(0.5 * wrap),
        frequency=lowest_frequency(fit.path.span, tension, mass, bending=belts * entry.bending_stiffness),
        face_width=belts * entry.width,
        task=task,
        catalogue=catalogue,
        tensions=tensions,
        doubt="" if rating is None or rating.of_profile is None else lower_bound(rating.of_profile),
    )

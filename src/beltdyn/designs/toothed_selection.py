"""Selection of toothed drives: pulleys, standard belts and the standard width that carry a power."""

from collections.abc import Iterator
from math import hypot, pi, sin
from typing import NamedTuple

import numpy as np

from beltdyn.designs.proposal import Proposal, Task
from beltdyn.model import Entry
from beltdyn.model.belt_loads import OF_TEETH
from beltdyn.model.toothing import RatedTeeth
from beltdyn.theory.rating import least_rest_tension, pull_of_cords
from beltdyn.theory.span import OpenBelt, center_distance, lowest_frequency, open_belt

TEETH = (
    *(10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 32, 34, 36, 38, 40, 42, 44),
    *(45, 46, 48, 50, 52, 54, 56, 60, 64, 68, 72, 76, 80, 84, 90, 96, 100, 108, 112, 120, 144, 168, 192, 216),
)
"""Usual numbers of teeth of pulleys: a choice from what makers stock."""
_WIDEST = 1.0
"""Widest pulley over its diameter, which makers recommend not to exceed."""


class _Meshing(NamedTuple):
    """Two toothed pulleys."""

    entry: Entry
    small: int
    """Teeth."""
    large: int
    pitch: float

    @property
    def radii(self) -> tuple[float, float]:
        """Of the tension line, m."""
        return 0.5 * self.small * self.pitch / pi, 0.5 * self.large * self.pitch / pi


class _Fit(NamedTuple):
    """A belt on two toothed pulleys."""

    teeth: int
    width: float
    """Standard width, m."""
    distance: float
    path: OpenBelt
    speed: float
    power: float
    """Rated, W."""
    off_middle: float
    """Of the center distance from the middle of its range, m."""


def of_toothed_profile(name: str, entry: Entry, task: Task, catalogue: str | None) -> Iterator[Proposal]:
    """The best belt for each pair of pulleys of a toothed profile."""
    for pair in _pairs(entry, task):
        known = [one for teeth in entry.tooth_counts if (one := _fit(pair, teeth, task)) is not None]
        if known:
            best = min(known, key=lambda one: (one.width, one.off_middle))
            yield _proposal(name, pair, best, task, catalogue)


def _pairs(entry: Entry, task: Task) -> Iterator[_Meshing]:
    """Pulleys with the ratio, as far as there is room; the ratio of one size is the closest there is."""
    room = task.largest if task.slows else task.largest[::-1]
    assert entry.toothing is not None
    pitch, least = entry.toothing.pitch, (entry.smallest_diameter or 0.0) * (1.0 - 1e-3)
    for small in TEETH:
        large = min(TEETH, key=lambda one: abs(one - small * task.ratio))
        own, other = (pitch * one / pi - 2.0 * entry.pitch_offset for one in (small, large))
        fits = least <= own <= room[0] and other <= room[1]
        if fits and abs(large / small / task.ratio - 1.0) <= task.tolerance:
            yield _Meshing(entry, small, large, pitch)


def _fit(pair: _Meshing, teeth: int, task: Task) -> _Fit | None:
    """The width of a belt that carries the power; None where it does not fit."""
    entry, radii = pair.entry, pair.radii
    rating, speed = entry.tooth_rating, radii[0] * max(task.speed, task.driven_speed)
    distance = center_distance(teeth * pair.pitch, radii)
    least, largest = task.distances_for(2.0 * sum(radii))
    assert rating is not None
    if distance is None or not least <= distance <= largest or speed > rating.largest_speed:
        return None
    path = open_belt(distance, radii)
    pull = _allowed_pull(entry, radii, path, speed)
    if not pull > 0.0:
        return None
    width = rating.next_width(entry.width * task.design_power / speed / pull)
    if width > _WIDEST * 2.0 * radii[0]:
        return None
    return _Fit(
        teeth, width, distance, path, speed, speed * pull * width / entry.width, abs(distance - 0.5 * (least + largest))
    )


def _allowed_pull(entry: Entry, radii: tuple[float, float], path: OpenBelt, speed: float) -> float:
    """Pull of a belt of the width of the entry, by its teeth in mesh and by its cords, N."""
    assert entry.tooth_rating is not None
    assert entry.toothing is not None
    mass, most = entry.mass_per_length, entry.largest_tension
    belt = RatedTeeth(entry.tooth_rating, entry.toothing, entry.width, mass, most)
    teeth = belt.on(2.0 * np.array(radii), np.array(path.wrap), speed, np.ones(2, dtype=bool)).pull.min()
    return min(float(teeth), np.inf if most is None else pull_of_cords(most, mass, speed))


def _proposal(name: str, pair: _Meshing, fit: _Fit, task: Task, catalogue: str | None) -> Proposal:
    """A belt on two pulleys as a proposal."""
    entry, size = pair.entry, fit.width / pair.entry.width
    mass, pull = size * entry.mass_per_length, task.design_power / fit.speed
    tension = least_rest_tension(pull, mass, fit.speed)
    driver, driven = (pair.small, pair.large) if task.slows else (pair.large, pair.small)
    outside = [pair.pitch * one / pi - 2.0 * entry.pitch_offset for one in (driver, driven)]
    return Proposal(
        profile=name,
        belts=1,
        driver_diameter=outside[0],
        driven_diameter=outside[1],
        nominal_length=fit.teeth * pair.pitch,
        distance=hypot(fit.path.span, pair.radii[1] - pair.radii[0]),
        driven_speed=task.speed * driver / driven,
        belt_speed=fit.speed,
        rated_power=fit.power,
        utilization=task.design_power / fit.power,
        tension=tension,
        hub_load=2.0 * tension * sin(0.5 * min(fit.path.wrap)),
        frequency=lowest_frequency(fit.path.span, tension, mass, bending=size * entry.bending_stiffness),
        face_width=fit.width,
        task=task,
        catalogue=catalogue,
        teeth=(fit.teeth, driver, driven),
        tensions={OF_TEETH: tension},
    )

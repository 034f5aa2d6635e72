"""Rules for the layout of pulleys, so that a belt can run around them."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, pairwise, permutations
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.belt import Belt
from beltdyn.model.end import End, PathEnd, pulling
from beltdyn.model.nip import Nip, check_places, numbered
from beltdyn.model.path import Path, Surroundings, crossings, obstacle
from beltdyn.model.pulley import Pulley

# The path of an open belt

_TRIAL_SPAN = 1.0
"""Length of the span to a pulled end before it is fitted to the belt, m. Its value is arbitrary: the difference to the
length of the belt is added to it."""


def open_path(centers: FloatArray, radii: FloatArray, ends: Sequence[PathEnd], belt: Belt) -> Path:
    """Lay the path of an open belt around pulleys of signed radii.

    The span to a pulled end runs along the force, and is as long as the belt, stretched by that force, leaves it.
    """
    along = [np.zeros(2) if end.pull is None else end.pull / np.linalg.norm(end.pull) for end in ends]
    points = np.array(
        [
            _beyond(centers[pulley], radii[pulley] * sense, way) if end.point is None else end.point
            for end, way, pulley, sense in zip(ends, along, (0, -1), (-1, 1), strict=True)
        ]
    )
    path, tension = Path(centers, radii, points), pulling(tuple(ends))
    if tension is None:
        return path
    if belt.length is None:
        raise ValueError(
            f"belt.installed_tension = {belt.installed_tension:.5g} N contradicts the pulled end, which sets the "
            "tension of the belt. Give belt.length instead"
        )
    missing = belt.length * float(belt.stretch_parameters.stretch(tension)) - path.length
    if missing <= -_TRIAL_SPAN:
        name = next(end.name for end in ends if end.pull is not None)
        raise ValueError(
            f'belt.length = {belt.length:.5g} m is too short: end "{name}" would lie on a pulley. Give the belt more '
            f"than {(path.length - _TRIAL_SPAN) / (path.length + missing) * belt.length:.5g} m"
        )
    return Path(centers, radii, points + missing * np.array(along))


def _beyond(center: FloatArray, radius: float, way: FloatArray) -> FloatArray:
    """A point on the tangent of a circle of signed radius (m) that leaves it in a direction."""
    return np.asarray(center - radius * np.array([-way[1], way[0]]) + _TRIAL_SPAN * way)


_LEAST_WRAP = 1e-6
"""Wrap angle, rad, up to which, or to a full turn less which, the belt counts as missing a pulley: what is left may be
rounding."""
_TURNING_TOLERANCE = 1e-6
"""Deviation of the total turning of a path from a full turn that counts as rounding, rad: closed paths differ by whole
turns."""
_MAX_PULLEYS_TRIED = 16
"""Number of pulleys up to which remedies are searched by trial: the number of lists tried grows with its square. For
more, the message proposes no change of the list."""
_MAX_EXTENT, _MAX_COORDINATE = 1e7, 1e9
"""Largest extent of a drive and largest coordinate, over the smallest radius: 2e5 for a belt conveyor of 20 km."""


class _Fault(NamedTuple):
    rule: str
    remedy: str | None
    """None where a search for it pays."""


def lay_path(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd] = (), nips: Sequence[Nip] = ()) -> Path:
    """Lay a path around pulleys in belt order, and check it, with the rollers of nips (see `check_nips`) beside it."""
    if not nips:
        return _lay(pulleys, belt, ends)
    pairs = numbered(nips, pulleys)
    beside = {roller for roller, _ in pairs}
    alone = _lay([one for number, one in enumerate(pulleys) if number not in beside], belt, ends)
    _check_names([*pulleys, *ends])
    _check_sizes(pulleys, ends)
    _check_distances(pulleys, pairs)
    path = Path(np.array([one.center for one in pulleys]), _signed(pulleys, belt), alone.ends, pairs)
    check_places(nips, path, pulleys, belt)
    return path


def _lay(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd]) -> Path:
    """Lay a path around pulleys that all lie on it."""
    if not ends and len(pulleys) < 2:
        raise ValueError(f"the drive has {len(pulleys)} pulley; a closed belt needs at least two. Add a [[pulley]]")
    if not pulleys:
        raise ValueError("the drive has no pulley; an open belt needs at least one. Add a [[pulley]]")
    _check_names([*pulleys, *ends])
    _check_sizes(pulleys, ends)
    _check_distances(pulleys)
    _check_tangents(pulleys, belt, ends)
    path = trace(pulleys, belt, ends)
    fault = next(_faults(pulleys, belt, path, ends), None)
    if fault:
        raise ValueError(f"{fault.rule}. {fault.remedy or _remedy(pulleys, belt, ends)}")
    return path


def span_names(
    pulleys: Sequence[Pulley], ends: Sequence[PathEnd] | Sequence[End], nips: Sequence[Nip] = ()
) -> list[tuple[str, str]]:
    """Names of the pulleys or ends at both ends of each span, in the order of `Path`."""
    beside = {nip.roller for nip in nips}
    names = [pulley.name for pulley in pulleys if pulley.name not in beside]
    if not ends:
        return list(zip(names, [*names[1:], names[0]], strict=True))
    return [*pairwise([*names, ends[1].name]), (ends[0].name, names[0])]


def radii(pulleys: Sequence[Pulley], belt: Belt) -> FloatArray:
    """Effective radii of the tension line, shape (n,), m."""
    return np.array([pulley.radius + _offset(pulley, belt) for pulley in pulleys])


def _offset(pulley: Pulley, belt: Belt) -> float:
    """Distance from a pulley to the tension line, m."""
    return belt.offset(pulley.side, pulley.teeth is not None)


def trace(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd] = ()) -> Path:
    """Path around pulleys, unchecked."""
    centers, signed = np.array([pulley.center for pulley in pulleys]), _signed(pulleys, belt)
    return open_path(centers, signed, ends, belt) if ends else Path(centers, signed)


def _signed(pulleys: Sequence[Pulley], belt: Belt) -> FloatArray:
    """Effective radii with the signs of `Path`, m."""
    return np.asarray(np.array([pulley.turning for pulley in pulleys]) * radii(pulleys, belt))


def _check_names(parts: Sequence[Pulley | PathEnd]) -> None:
    names = [part.name for part in parts]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(
                f'name = "{name}" is used {names.count(name)} times; pulleys and ends need unique names. Rename one'
            )


def _check_distances(pulleys: Sequence[Pulley], nips: Sequence[tuple[int, int]] = ()) -> None:
    pressed = {frozenset(pair) for pair in nips}
    for (first, one), (second, other) in combinations(enumerate(pulleys), 2):
        if {first, second} in pressed:
            continue
        distance, radii = np.hypot(*np.subtract(one.center, other.center)), one.radius + other.radius
        if not distance > radii:
            raise ValueError(
                f'pulleys "{one.name}" and "{other.name}" overlap: their centers are {distance:.5g} m apart, '
                f"and their radii add up to {radii:.5g} m. Move them apart, or make one smaller"
            )


def _check_sizes(pulleys: Sequence[Pulley], ends: Sequence[PathEnd]) -> None:
    """Refuse pulleys so far apart that positions lose their digits, and that a mesh of the belt has no end."""
    places = np.array([*(one.center for one in pulleys), *(end.point for end in ends if end.point is not None)])
    smallest = min(pulleys, key=lambda one: one.radius)
    extent, largest = float(np.ptp(places, axis=0).max()), float(np.abs(places).max())
    for size, limit, what in (
        (extent, _MAX_EXTENT, "the extent of the drive is"),
        (largest, _MAX_COORDINATE, "the largest coordinate is"),
    ):
        if size > limit * smallest.radius:
            raise ValueError(
                f"{what} {size:.4g} m; the limit is {limit:.0e} times the radius of the smallest pulley, "
                f'{smallest.radius:.4g} m of "{smallest.name}". '
                "Correct the coordinates of pulleys and ends, or their units"
            )


def _check_tangents(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd]) -> None:
    """Where the belt changes sides it runs between two pulleys; elsewhere there always is a tangent but from an end."""
    for end, pulley in zip(ends, (pulleys[0], pulleys[-1]), strict=False):
        needed = pulley.radius + _offset(pulley, belt)
        distance = needed if end.point is None else np.hypot(*np.subtract(end.point, pulley.center))
        if distance < needed:
            raise ValueError(
                f'end "{end.name}" lies inside pulley "{pulley.name}": it is {distance:.5g} m from the center, but the '
                f"belt runs at {needed:.5g} m. Move it away from the pulley"
            )
    for one, other in pairwise([*pulleys, *([] if ends else pulleys[:1])]):
        if one.side == other.side:
            continue
        distance = np.hypot(*np.subtract(one.center, other.center))
        needed = one.radius + other.radius + belt.pitch_offset + belt.back_offset
        if not distance > needed:
            raise ValueError(
                f'the belt cannot pass between "{one.name}" and "{other.name}": this needs a center distance above '
                f"{needed:.5g} m (their radii, belt.pitch_offset and belt.back_offset), but it is {distance:.5g} m. "
                "Move them apart, or make one smaller"
            )


def _faults(pulleys: Sequence[Pulley], belt: Belt, path: Path, ends: Sequence[PathEnd]) -> Iterator[_Fault]:
    """Reasons why a belt cannot run along a path, each computed on demand."""
    names = span_names(pulleys, ends)
    if not ends and not belt.crossed and all(pulley.side == "inside" for pulley in pulleys):
        yield from _disorder(pulleys, path)
    for pulley, wrap in zip(pulleys, path.wrap_angles, strict=True):
        if wrap < _LEAST_WRAP or wrap > 2 * np.pi - _LEAST_WRAP:
            yield _missed(pulley)
    crossing = crossings(path)
    if belt.crossed and not crossing:
        yield _Fault(
            "belt.crossed = true, but no spans cross",
            'Remove it, or set side = "outside" for the pulleys between two crossings, which turn clockwise',
        )
    if crossing and not belt.crossed:
        one, other = ('the span from "{}" to "{}"'.format(*names[span]) for span in crossing[0])
        yield _Fault(f"the belt would cross itself: {one} meets {other}", None)
    if not ends and not belt.crossed and abs(path.total_turning - 2 * np.pi) > _TURNING_TOLERANCE:
        turns = round(path.total_turning / (2 * np.pi))
        yield _Fault(f"the belt would turn {turns} times counter-clockwise in one round, not once", None)
    yield from _collisions(pulleys, belt, path, names)


def _disorder(pulleys: Sequence[Pulley], path: Path) -> Iterator[_Fault]:
    """Faults of a path with all pulleys on its inside that is not a single counter-clockwise loop."""
    if abs(path.total_turning - 2 * np.pi) < _TURNING_TOLERANCE:
        return
    outermost = _outermost(path)
    for index, pulley in enumerate(pulleys):
        if index not in outermost:
            yield _missed(pulley)
    yield _Fault(
        "the pulleys are not listed in the order in which the belt meets them when it runs counter-clockwise",
        f"List them as {_listed(pulleys[index] for index in outermost)}",
    )


def _outermost(path: Path) -> list[int]:
    """Pulleys that a belt around all of them touches, counter-clockwise, from the first one listed if it is one."""
    angles = np.arange(0, 2 * np.pi, 1e-3)
    directions = np.stack([np.cos(angles), np.sin(angles)])
    reached = np.argmax(path.centers @ directions + path.radii[:, None], axis=0)
    found = list(dict.fromkeys(reached.tolist()))
    start = found.index(0) if 0 in found else 0
    return found[start:] + found[:start]


def _missed(pulley: Pulley) -> _Fault:
    where, remedy = ("inside", "outwards") if pulley.side == "inside" else ("outside", "inwards")
    return _Fault(
        f'the belt does not touch pulley "{pulley.name}": it lies {where} the path around the others',
        f"Move it {remedy}, or remove it",
    )


def _collisions(
    pulleys: Sequence[Pulley], belt: Belt, path: Path, spans: Sequence[tuple[str, str]]
) -> Iterator[_Fault]:
    around = Surroundings(np.array([pulley.radius for pulley in pulleys]), belt.pitch_offset, belt.back_offset)
    found = obstacle(path, around)
    if found is None:
        return
    other = pulleys[found.pulley].name
    if found.piece == "arc":
        one = pulleys[found.number].name
        yield _Fault(f'the belt on "{one}" would run through pulley "{other}"', "Move them apart, or make one smaller")
    one, following = spans[found.number]
    yield _Fault(
        f'the belt between "{one}" and "{following}" would run through pulley "{other}"',
        "Move it, or list the pulleys in the order in which the belt meets them",
    )


def _remedy(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd]) -> str:
    """Changes that remove crossings, or that permit them."""
    tried = pulleys if len(pulleys) <= _MAX_PULLEYS_TRIED else ()
    wishes = [
        wish
        for changes in (_other_lists(tried), _fewer(tried))
        if (wish := next((wish for wish, changed in changes if fits(changed, belt, ends)), None))
    ]
    if belt.teeth is None and fits(pulleys, belt.replace(crossed=True), ends):
        wishes.append("set belt.crossed = true if the spans are intended to cross")
    text = ", or ".join(wishes) or "check the order and the sides of the pulleys"
    return text[0].upper() + text[1:]


def _other_lists(pulleys: Sequence[Pulley]) -> Iterator[tuple[str, list[Pulley]]]:
    """Probable intended lists: in reversed order, with another side of one pulley, with one pulley elsewhere."""
    given = list(pulleys)
    turned = [*given[:1], *given[:0:-1]]
    yield f"list the pulleys as {_listed(turned)}", turned
    for index, pulley in enumerate(given):
        if pulley.teeth is not None:
            continue
        side = "outside" if pulley.side == "inside" else "inside"
        changed = pulley.replace(side=side)
        yield f'set side = "{side}" for "{pulley.name}"', [*given[:index], changed, *given[index + 1 :]]
    for index, place in permutations(range(1, len(given)), 2):
        moved = given[:index] + given[index + 1 :]
        moved.insert(place, given[index])
        yield f"list the pulleys as {_listed(moved)}", moved


def _fewer(pulleys: Sequence[Pulley]) -> Iterator[tuple[str, list[Pulley]]]:
    """Lists without one pulley."""
    for index, pulley in enumerate(pulleys):
        surface = "inside" if pulley.side == "inside" else "back"
        wish = f'move "{pulley.name}" against the {surface} of the belt'
        yield wish, [*pulleys[:index], *pulleys[index + 1 :]]


def fits(pulleys: Sequence[Pulley], belt: Belt, ends: Sequence[PathEnd] = ()) -> bool:
    """Tell whether a belt can run around pulleys that do not overlap."""
    if len(pulleys) < (1 if ends else 2):
        return False
    try:
        _check_tangents(pulleys, belt, ends)
        path = trace(pulleys, belt, ends)
    except ValueError:
        return False
    return next(_faults(pulleys, belt, path, ends), None) is None


def _listed(pulleys: Iterable[Pulley]) -> str:
    return ", ".join(f'"{pulley.name}"' for pulley in pulleys)

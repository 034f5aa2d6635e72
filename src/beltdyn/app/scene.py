"""The drawing of the canvas: pulleys, belt path and tensioners, in millimeters with y down."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from beltdyn.app.draft import Draft
from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, Path, prepare
from beltdyn.model.belt import read_side
from beltdyn.model.toothing import FEWEST_TEETH, MOST_TEETH, Toothing
from beltdyn.parts.quantity import to_si
from beltdyn.show.notebook import outline

MILLIMETERS = 1e3
"""Millimeters in a meter: the canvas is drawn in mm, and drives are in m."""
_EMPTY_EXTENT = (-250.0, -150.0, 250.0, 150.0)
"""Extent of an empty canvas, mm: left, top, right and bottom."""
_MIN_PULLEYS = 2
"""Number of pulleys from which on they alone set the extent: the first one stands on an empty canvas."""
_MIN_EXTENT = 60.0
"""Least width and height of the extent, mm: small drives are not magnified without limit."""
_VISIBLE_TRAVEL = 0.004
"""Travel of a tensioner over the size of the drive above which its rest position is drawn separately."""


class Circle(NamedTuple):
    """A pulley as far as its data are valid, m."""

    number: int
    name: str
    x: float
    y: float
    radius: float
    side: str


def length_in(value: object) -> float | None:
    """Parse a length or coordinate, m; None if it is invalid."""
    try:
        number = to_si(value, "m") if isinstance(value, str) else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return None
    return number if math.isfinite(number) and abs(number) < MILLIMETERS**2 else None


def circles(data: Mapping[str, Any]) -> list[Circle]:
    """Parse the pulleys with valid center and size."""
    found, toothed = [], toothing_in(data)
    for number, one in enumerate(groups(data, "pulley")):
        center, radius = one.get("center"), _radius(one, toothed)
        point = (
            [length_in(each) for each in center] if isinstance(center, list | tuple) and len(center) == 2 else [None]
        )
        if radius is None or radius <= 0 or None in point:
            continue
        x, y = (float(each or 0.0) for each in point)
        side = "outside" if read_side(one.get("side")) == "outside" else "inside"
        found.append(Circle(number, str(one.get("name", f"pulley {number + 1}")), x, y, radius, side))
    return found


def circle(data: Mapping[str, Any], number: int) -> Circle | None:
    """A pulley by its number; None if its center or size is invalid."""
    return next((one for one in circles(data) if one.number == number), None)


def toothing_in(data: Mapping[str, Any]) -> tuple[Toothing, float] | None:
    """The toothing of a belt and its pitch offset, m; None if the belt is invalid or has no teeth."""
    try:
        belt = Belt.model_validate(data.get("belt"))
    except (ValueError, ModelError):
        return None
    return None if belt.toothing is None else (belt.toothing, belt.pitch_offset)


def _radius(one: Mapping[str, Any], toothed: tuple[Toothing, float] | None) -> float | None:
    """Radius of a pulley as given, by its diameter, or by its teeth, m; None if it is invalid."""
    radius, diameter, teeth = length_in(one.get("radius")), length_in(one.get("diameter")), one.get("teeth")
    if radius is None and diameter is not None:
        radius = diameter / 2
    if radius is not None or toothed is None or not isinstance(teeth, int):
        return radius
    toothing, offset = toothed
    return toothing.radius(teeth, 0.0, offset) if FEWEST_TEETH <= teeth <= MOST_TEETH else None


def groups(data: Mapping[str, Any], key: str) -> list[Mapping[str, Any]]:
    """The groups of a list in a drive file; entries that are not groups become empty."""
    found = data.get(key)
    return [one if isinstance(one, Mapping) else {} for one in found] if isinstance(found, list) else []


def scene(draft: Draft, *, settled: bool = True) -> dict[str, Any]:
    """The drawing of the canvas."""
    drive, found = draft.drive, circles(draft.data)
    complete = len(found) == len(groups(draft.data, "pulley"))
    path = drive.path if drive is not None else sketched(found) if complete else None
    rest = _rest(drive) if settled and drive is not None else None
    pulleys = [_pulley(one, drive, draft) for one in found]
    thickness = drive.belt.thickness if drive is not None else 0.0
    tensioners = _tensioners(draft.data, found)
    return {
        "pulleys": pulleys,
        "valid": drive is not None,
        "belt": _line(path),
        "thickness": MILLIMETERS * thickness,
        "rest": _line(rest),
        "ghosts": [] if drive is None or rest is None else _ghosts(drive, rest),
        "spans": [] if drive is None else _spans(drive.path),
        "tensioners": tensioners,
        "ends": [] if path is None or path.ends is None else [list(_place(*end)) for end in path.ends.tolist()],
        "extent": _extent(pulleys, tensioners, path),
    }


def sketched(found: Sequence[Circle]) -> Path | None:
    """The path around pulleys if it can be drawn, even if no belt can run there; without belt offsets."""
    if len(found) < 2:
        return None
    radii = np.array([one.radius if one.side == "inside" else -one.radius for one in found])
    try:
        path = Path(np.array([(one.x, one.y) for one in found]), radii)
        return path if np.isfinite(path.span_points).all() else None
    except ValueError:
        return None


def _rest(drive: Drive) -> Path | None:
    """The path with tensioners where their springs hold them, if that is to be told apart from the given one."""
    if not drive.moving_tensioners:
        return None
    path = prepare(drive).installation.path
    way = float(np.abs(path.centers - drive.path.centers).max())
    return path if way > _VISIBLE_TRAVEL * float(np.ptp(path.centers, axis=0).max()) else None


def _ghosts(drive: Drive, rest: Path) -> list[dict[str, float]]:
    """Pulleys of tensioners at rest."""
    places = [(rest.centers[one.pulley].tolist(), drive.pulleys[one.pulley].radius) for one in prepare(drive).carriers]
    return [dict(zip("xyr", (*_place(*center), MILLIMETERS * radius), strict=True)) for center, radius in places]


def _pulley(one: Circle, drive: Drive | None, draft: Draft) -> dict[str, Any]:
    x, y = _place(one.x, one.y)
    drawn = {
        "number": one.number,
        "name": one.name,
        "x": x,
        "y": y,
        "r": MILLIMETERS * one.radius,
        "outside": one.side == "outside",
        "drives": bool(groups(draft.data, "pulley")[one.number].get("speed")),
        "sense": 0,
        "wrap": "",
        "beyond": None,
        "wrong": bool(draft.told_below(("pulley", one.number))),
    }
    if drive is None:
        return drawn
    number = drive.number_of(one.name)  # a drive has its pulleys counter-clockwise, a file in either order
    pulley, center = drive.pulleys[number], drive.centers[number].tolist()
    x, y = _place(center[0], center[1])
    return drawn | {
        "x": x,
        "y": y,
        "drives": pulley.prescribed or pulley.driven_speed() > 0,
        "sense": 0 if drive.guides[number] else drive.running_sense * pulley.turning,
        "wrap": f"{math.degrees(drive.path.wrap_angles[number]):.1f}°",
        "beyond": _beyond(drive.path, number),
    }


def _beyond(path: Path, number: int) -> list[float] | None:
    """The clear way from a pulley, downwards positive."""
    way = path.clear_way(number)
    return None if way is None else [way[0], -way[1]]


def _spans(path: Path) -> list[dict[str, Any]]:
    """Ends and middles of spans, the directions in which there is room for their labels, and their lengths.

    Room is on the right of the belt, which goes around its pulleys counter-clockwise: off the drive.
    """
    middles, along = path.span_points.mean(axis=1), path.span_directions
    outward = np.column_stack([along[:, 1], -along[:, 0]])
    return [
        {
            "x": x,
            "y": y,
            "right": right,
            "down": -up,
            "length": MILLIMETERS * length,
            "ends": [*_place(*start), *_place(*end)],
        }
        for (x, y), (right, up), length, (start, end) in zip(
            (_place(*one) for one in middles.tolist()),
            outward.tolist(),
            path.span_lengths.tolist(),
            path.span_points.tolist(),
            strict=True,
        )
    ]


def _tensioners(data: Mapping[str, Any], found: Sequence[Circle]) -> list[dict[str, Any]]:
    """Arms from a pivot to the pulley, and directions in which pulleys slide."""
    by_name, drawn = {one.name: one for one in found}, []
    for number, one in enumerate(groups(data, "tensioner")):
        carried = by_name.get(str(one.get("pulley")))
        if carried is None:
            continue
        x, y = _place(carried.x, carried.y)
        made: dict[str, Any] = {"number": number, "kind": str(one.get("kind", "")), "x": x, "y": y}
        for key in ("pivot", "direction"):
            point = one.get(key)
            if (
                isinstance(point, list)
                and len(point) == 2
                and None not in (read := [length_in(each) for each in point])
            ):
                made[key] = list(_place(*(float(each or 0.0) for each in read)))
        if "direction" in made:
            size = math.hypot(*made["direction"]) or 1.0
            made["direction"] = [each / size for each in made["direction"]]
        drawn.append(made)
    return drawn


def _extent(pulleys: Sequence[dict[str, Any]], tensioners: Sequence[dict[str, Any]], path: Path | None) -> list[float]:
    """What is to be seen: left, top, right, bottom, mm."""
    points = [(one["x"] + sign * one["r"], one["y"] + sign * one["r"]) for one in pulleys for sign in (-1, 1)]
    points += [tuple(one["pivot"]) for one in tensioners if "pivot" in one]
    if path is not None and path.ends is not None:
        points += [_place(*end) for end in path.ends.tolist()]
    if len(pulleys) < _MIN_PULLEYS:
        points += [_EMPTY_EXTENT[:2], _EMPTY_EXTENT[2:]]
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    middle, half = (low + high) / 2, np.maximum((high - low) / 2, _MIN_EXTENT / 2)
    return [*(middle - half).tolist(), *(middle + half).tolist()]


def _place(x: float, y: float) -> tuple[float, float]:
    return MILLIMETERS * x, -MILLIMETERS * y


def _line(path: Path | None) -> str:
    return "" if path is None else outline(path, _place, MILLIMETERS)

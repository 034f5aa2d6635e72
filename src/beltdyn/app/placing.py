"""Canvas actions as edits of the drive file: place, move, resize, flip, add and remove."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from beltdyn.app.draft import Draft
from beltdyn.app.scene import Circle, circle, circles, groups, length_in, sketched, toothing_in
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.belt import read_side
from beltdyn.model.toothing import FEWEST_TEETH
from beltdyn.parts.quantity import written_like
from beltdyn.parts.toml_edits import Edit, Location

_FIRST_RADIUS = 0.05
"""Radius of the first pulley of a drive, m: its diameter is a fifth of the width of an empty canvas."""
_MIN_RADIUS = 0.005
"""Least radius of a new pulley that has little room, m; a tenth of it limits pulleys that are made smaller by hand."""
_MAX_DISTANCE_SHARE = 0.45
"""Largest radius of a new pulley, over twice the distance of its center from others' surfaces: a gap remains."""
_SURFACE_DENSITY = 0.02 * 2700.0
"""Mass per area of an aluminum disk 20 mm thick, kg/m², assumed for a new pulley."""
_ARM_RATIO = 2.5
"""Length of the arm of a new tensioner, over the radius of its pulley: the pivot lies outside the pulley."""
_DEFAULT_TENSION = 300.0
"""Tension for the spring of a new tensioner, N, where the belt has no installed tension."""
DRIVER = {"kind": "cosine_ramp", "start": 0.02, "end": 0.2, "value": "1500 rpm"}


def move(data: Mapping[str, Any], number: int, x: float, y: float) -> list[Edit]:
    """Set the center of a pulley, m."""
    return _point(data, ("pulley", number, "center"), groups(data, "pulley")[number].get("center"), x, y)


def nudge(data: Mapping[str, Any], number: int, right: float, up: float) -> list[Edit]:
    """Move the center of a pulley by a step, m; nothing if it is invalid."""
    one = circle(data, number)
    return [] if one is None else move(data, number, one.x + right, one.y + up)


def grow(data: Mapping[str, Any], number: int, more: float) -> list[Edit]:
    """Increase the radius of a pulley, m, by at least a tooth if it has teeth; nothing if it is invalid."""
    one = circle(data, number)
    if one is None:
        return []
    teeth = groups(data, "pulley")[number].get("teeth")
    edits = resize(data, number, one.radius + more)
    if isinstance(teeth, int) and edits[0].value == teeth:
        return [Edit("set", ("pulley", number, "teeth"), max(teeth + (1 if more > 0.0 else -1), FEWEST_TEETH))]
    return edits


def nudge_pivot(data: Mapping[str, Any], number: int, right: float, up: float) -> list[Edit]:
    """Move the pivot of a tensioner by a step, m; nothing if it is invalid."""
    given = groups(data, "tensioner")[number].get("pivot")
    point = [length_in(one) for one in given] if isinstance(given, list) and len(given) == 2 else [None, None]
    x, y = point
    return [] if x is None or y is None else move_pivot(data, number, x + right, y + up)


def move_pivot(data: Mapping[str, Any], number: int, x: float, y: float) -> list[Edit]:
    """Set the pivot of a tensioner, m."""
    return _point(data, ("tensioner", number, "pivot"), groups(data, "tensioner")[number].get("pivot"), x, y)


def turn_direction(data: Mapping[str, Any], number: int, x: float, y: float) -> list[Edit]:
    """Point the direction of a sliding tensioner at a position, m."""
    one = groups(data, "tensioner")[number]
    carried = next((each for each in circles(data) if each.name == one.get("pulley")), None)
    if carried is None:
        return []
    away, up = x - carried.x, y - carried.y
    size = math.hypot(away, up)
    return (
        [Edit("set", ("tensioner", number, "direction"), [round(away / size, 4), round(up / size, 4)])] if size else []
    )


def _point(data: Mapping[str, Any], location: tuple[int | str, ...], given: object, x: float, y: float) -> list[Edit]:
    before = given if isinstance(given, list) and len(given) == 2 else [0.0, 0.0]
    return [Edit("set", location, [written_like(new, old, "m") for new, old in zip((x, y), before, strict=True)])]


def resize(data: Mapping[str, Any], number: int, radius: float) -> list[Edit]:
    """Set the radius of a pulley, m, or its diameter or teeth if these are given."""
    one, radius = groups(data, "pulley")[number], max(radius, _MIN_RADIUS / 10)
    if "teeth" in one and (toothed := toothing_in(data)) is not None:
        toothing, offset = toothed
        return [Edit("set", ("pulley", number, "teeth"), toothing.teeth_about(radius, offset))]
    if "diameter" in one and "radius" not in one:
        return [Edit("set", ("pulley", number, "diameter"), written_like(2 * radius, one["diameter"], "m"))]
    return [Edit("set", ("pulley", number, "radius"), written_like(radius, one.get("radius"), "m"))]


def flip(data: Mapping[str, Any], number: int) -> list[Edit]:
    """Move a pulley to the other side of the belt: with teeth on that of the teeth, without on its back."""
    one, own, key = groups(data, "pulley")[number], circle(data, number), ("pulley", number)
    outside, sized = read_side(one.get("side")) == "outside", [name for name in ("radius", "diameter") if name in one]
    edits = [Edit("remove", (*key, "side")) if outside else Edit("set", (*key, "side"), "outside")]
    if own is None or outside == ("teeth" in one):
        return edits
    if not outside:
        edits.append(Edit("remove", (*key, "teeth")))
        return edits if sized else [*edits, Edit("set", (*key, "radius"), f"{1e3 * own.radius:.4g} mm")]
    if (toothed := toothing_in(data)) is None:
        return edits
    toothing, offset = toothed
    edits += [Edit("remove", (*key, name)) for name in sized]
    return [*edits, Edit("set", (*key, "teeth"), toothing.teeth_about(own.radius, offset))]


def remove(data: Mapping[str, Any], number: int) -> list[Edit]:
    """Remove a pulley and its tensioners."""
    name = groups(data, "pulley")[number].get("name")
    carriers = [place for place, one in enumerate(groups(data, "tensioner")) if one.get("pulley") == name]
    return [Edit("remove", ("pulley", number)), *(Edit("remove", ("tensioner", place)) for place in carriers[::-1])]


def rename(data: Mapping[str, Any], number: int, name: str) -> list[Edit]:
    """Rename a pulley, also in its tensioners."""
    before = groups(data, "pulley")[number].get("name")
    carriers = [place for place, one in enumerate(groups(data, "tensioner")) if one.get("pulley") == before]
    edits = [Edit("set", ("pulley", number, "name"), name)]
    return [*edits, *(Edit("set", ("tensioner", place, "pulley"), name) for place in carriers)]


def shift(data: Mapping[str, Any], number: int, places: int) -> list[Edit]:
    """Move a pulley in the belt order, cyclically."""
    pulleys = groups(data, "pulley")
    target = (number + places) % len(pulleys)
    return [Edit("remove", ("pulley", number)), Edit("insert", ("pulley", target), dict(pulleys[number]))]


def new_tensioner(draft: Draft, number: int, kind: str, place: int) -> list[Edit]:
    """Add a tensioner of a kind to a pulley, pressing in the direction that lengthens the path.

    Its spring is such that the belt has the installed tension of the file, or 300 N, with the pulley where it stands.
    """
    path, pulley = sketched(found := circles(draft.data)), groups(draft.data, "pulley")[number]
    one = next((each for each in found if each.number == number), None)
    if one is None:
        return []
    gradient = (0.0, 1.0)
    if path is not None and len(found) == len(groups(draft.data, "pulley")):
        along = path.gradient(number)
        gradient = (float(along[0]), float(along[1]))
    leverage = math.hypot(*gradient) or 1.0
    direction = [round(each / leverage, 4) for each in gradient]
    tension = draft.drive.belt.installed_tension or _DEFAULT_TENSION if draft.drive is not None else _DEFAULT_TENSION
    made: dict[str, Any] = {"kind": kind, "pulley": str(pulley.get("name", ""))}
    if kind == "fixed":
        made |= {"direction": direction}
    elif kind == "sliding":
        made |= {"direction": direction, "preload": f"{tension * leverage:.3g} N"}
    else:
        arm = _ARM_RATIO * one.radius
        pivot = [one.x - arm * direction[1], one.y + arm * direction[0]]
        made |= {"pivot": [float(f"{each:.4g}") for each in pivot], "preload": f"{tension * leverage * arm:.3g} N m"}
    edits = [Edit("insert", ("tensioner", place), made)]
    if kind != "fixed" and not pulley.get("mass"):
        edits.append(
            Edit("set", ("pulley", number, "mass"), float(f"{_SURFACE_DENSITY * math.pi * one.radius**2:.2g}"))
        )
    return edits


def rim(data: Mapping[str, Any], hub: Location) -> list[Edit]:
    """Give a pulley the inertia that its rim needs before a hub, if it has none."""
    pulley = groups(data, "pulley")[int(hub[1])]
    one = circle(data, int(hub[1]))
    if one is None or pulley.get("inertia"):
        return []
    return [Edit("set", (*hub[:-1], "inertia"), inertia_of_disk(one.radius))]


def inertia_of_disk(radius: float) -> float:
    """Inertia of an aluminum disk of the size of a pulley, kg m^2."""
    return float(f"{_SURFACE_DENSITY * math.pi / 2 * radius**4:.2g}")


def add(draft: Draft, x: float, y: float, base: Any = None) -> list[Edit]:
    """Add a pulley at a position, m, in the nearest span and on the possible side.

    The first one is given a speed; the others turn freely, with the inertia of an aluminum disk.
    """
    found, pulleys = circles(draft.data), groups(draft.data, "pulley")
    radius = _radius_at(found, x, y)
    named: dict[str, Any] = {
        "name": _free_name([str(one.get("name")) for one in pulleys]),
        "center": [float(f"{x:.6g}"), float(f"{y:.6g}")],
    }
    turns = {"inertia": inertia_of_disk(radius)} if pulleys else {"speed": dict(DRIVER)}
    smooth = inside = named | {"radius": f"{1e3 * radius:g} mm"} | turns
    if (toothed := toothing_in(draft.data)) is not None:
        toothing, offset = toothed
        inside = named | {"teeth": toothing.teeth_about(radius, offset)} | turns
    for place, side in _places(found, x, y, len(pulleys)):
        tried = smooth | {"side": side} if side == "outside" else inside
        if draft.drive is not None and not _runs(draft.data, place, tried, base):
            continue
        return [Edit("insert", ("pulley", place), tried)]
    return [Edit("insert", ("pulley", len(pulleys)), inside)]


def _runs(data: Mapping[str, Any], place: int, pulley: Mapping[str, Any], base: Any) -> bool:
    """Whether a belt runs around the pulleys with another one in the list."""
    pulleys = list(groups(data, "pulley"))
    pulleys.insert(place, pulley)
    try:
        Drive.model_validate({**data, "pulley": pulleys}, context={"base": base})
    except (ModelError, ValueError):
        return False
    return True


def _places(found: Sequence[Circle], x: float, y: float, count: int) -> Iterator[tuple[int, str]]:
    """Places in the list and sides of the belt to try: those of the nearest spans first."""
    path = sketched(found)
    if path is None or len(found) != count:
        yield count, "inside"
        return
    starts, ends = path.span_points[:, 0], path.span_points[:, 1]
    along = ends - starts
    share = ((x - starts[:, 0]) * along[:, 0] + (y - starts[:, 1]) * along[:, 1]) / (along**2).sum(axis=1).clip(1e-12)
    nearest = starts + share.clip(0.0, 1.0)[:, None] * along
    distance = ((nearest - [x, y]) ** 2).sum(axis=1)
    order = sorted(range(len(distance)), key=lambda span: float(distance[span]))
    for side in ("inside", "outside"):
        for span in order:
            yield span + 1, side


def _radius_at(found: Sequence[Circle], x: float, y: float) -> float:
    """Radius of a new pulley, m: that of the smallest other one, and less where there is no room."""
    if not found:
        return _FIRST_RADIUS
    room = min(math.hypot(x - one.x, y - one.y) - one.radius for one in found)
    radius = min(min(one.radius for one in found), max(_MAX_DISTANCE_SHARE * 2 * room, _MIN_RADIUS))
    return float(f"{radius:.2g}")


def _free_name(names: Sequence[str]) -> str:
    first = ("driver", "driven")
    if len(names) < len(first) and first[len(names)] not in names:
        return first[len(names)]
    return next(name for number in range(len(names) + 1, 10**6) if (name := f"pulley {number}") not in names)

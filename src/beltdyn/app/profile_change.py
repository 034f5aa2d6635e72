"""Another profile of the belt: edits that keep what still fits, and convert or clear the rest.

The tension at rest stays as it is, and so do the sizes of the pulleys, up to whole numbers of teeth.
"""

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from beltdyn.app import placing
from beltdyn.app.draft import Draft, draft
from beltdyn.app.forms import entry_of
from beltdyn.app.scene import Circle, circles, groups, length_in, sketched
from beltdyn.errors import BeltdynError
from beltdyn.model import Belt, Drive, estimate_at_rest, prepare
from beltdyn.model.belt_form import Stiffnesses, without_section
from beltdyn.model.catalogue import Entry
from beltdyn.model.toothing import FEWEST_TEETH
from beltdyn.parts.toml_edits import Edit, Location, changed_data

Data = dict[str, Any]

_LENGTHS = ("length", "nominal_length", "installed_tension", "teeth")
"""Keys that give a belt its length."""
_OF_SECTION = ("ribs", "diameter", "width", "profile", "sold", "poissons_ratio")
"""Keys of the section of a belt beside those that `without_section` knows."""
_PLAIN = (*Stiffnesses.model_fields, "pitch_offset", "back_offset", "wedge_angle", "friction", "contact_stiffness")
"""Values that a belt keeps without its profile."""
_OF_SMOOTH_PULLEYS = ("radius", "diameter", "diameter_kind", "surface")
"""Keys of a pulley that its teeth exclude."""
_NEAR_LENGTH = 1e-3
"""Relative difference of a nominal length from the standard length that it means."""
_SIMILAR_TENSION = 2.0
"""Largest ratio of the tensions at rest before and after: a length that changes it more does not fit."""
_LEAST_SHARE = 0.5
"""Least radius of a pulley that loses its teeth, over that before."""
_USUAL_STRAINS = 0.001, 0.02
"""Limits of the strain at rest of a belt that the present tension would leave slack or stretch too far."""
_UNKNOWN = 1e9
"""Stands for the ratio to an unknown tension."""
_TOOTH_COUNTS = 3
"""Numbers of teeth above and below that of a belt as long as before that are considered."""


def edits_of_profile(current: Draft, profile: str | None, folder: Path) -> list[Edit]:
    """Edits that give the belt another profile of the catalogue, or with None the plain values of the present one.

    Of the lengths that may fit it is the first that leaves about the same tension, or else the one that changes it
    least. Where none gives a valid drive, that of the first has messages.
    """
    belt = current.data.get("belt")
    if not isinstance(belt, Mapping) or belt.get("profile") == profile:
        return [] if isinstance(belt, Mapping) else [Edit("set", ("belt", "profile"), profile)]
    entry = entry_of(profile)
    if entry is None and profile is not None:
        return [Edit("set", ("belt", "profile"), profile)]
    options = list(_without_profile(current) if entry is None else _with_profile(current, str(profile), entry))
    chosen, least = options[0], math.inf
    for option in options:
        drive = draft(option, folder).drive
        change = _change_of_tension(current.drive, drive)
        if change < least:
            chosen, least = option, change
        if change <= _SIMILAR_TENSION:
            break
    return list(_changes(current.data, chosen, ()))


def _changes(before: Mapping[str, Any], after: Mapping[str, Any], location: Location) -> Iterator[Edit]:
    """Edits that turn a group into another one; lists of groups lose none."""
    yield from (Edit("remove", (*location, key)) for key in before if key not in after)
    for key, value in after.items():
        place, old = (*location, key), before.get(key)
        if isinstance(value, Mapping) and isinstance(old, Mapping):
            yield from _changes(old, value, place)
        elif value != old and isinstance(value, list) and all(isinstance(item, Mapping) for item in value):
            entries = old or []
            for number, item in enumerate(value):
                if number < len(entries):
                    yield from _changes(entries[number], item, (*place, number))
                else:
                    yield Edit("insert", (*place, number), item)
        elif value != old:
            yield Edit("set", place, value)


def _tension_at_rest(drive: Drive | None) -> float | None:
    """Tension at rest in closed form, N; None of an invalid drive, and of a slack belt."""
    if drive is None:
        return None
    try:
        tension = float(estimate_at_rest(prepare(drive))[1].tension)
    except BeltdynError:
        return None
    return tension if tension > 0.0 else None


def _change_of_tension(before: Drive | None, after: Drive | None) -> float:
    """Ratio of the tensions at rest, above 1; large where one is unknown, infinite without a valid drive."""
    if after is None:
        return math.inf
    tensions = sorted(_tension_at_rest(drive) or 0.0 for drive in (before, after))
    return tensions[1] / tensions[0] if tensions[0] > 0.0 else _UNKNOWN


def _belt_of(data: Mapping[str, Any]) -> Belt | None:
    """The belt of a drive file; None if it is invalid."""
    try:
        return Belt.model_validate(data.get("belt"))
    except (ValueError, BeltdynError):
        return None


def _without_profile(current: Draft) -> Iterator[Data]:
    """The drive with the values of its belt in place of a profile."""
    belt = current.data["belt"]
    kept = {key: value for key, value in without_section(belt).items() if key not in _OF_SECTION}
    present = _belt_of(current.data)
    if present is not None:
        values = {key: getattr(present, key) for key in _PLAIN}
        kept |= {key: float(f"{value:.5g}") for key, value in values.items() if value}
        if present.toothing is not None:
            kept["toothing"] = present.toothing.arguments
    yield {**current.data, "belt": kept}


def _with_profile(current: Draft, profile: str, entry: Entry) -> Iterator[Data]:
    """The drive with a profile, and each of the lengths that the belt may have."""
    data, belt = current.data, current.data["belt"]
    section = {"profile": profile, **_size(belt, entry, _belt_of(data))}
    kept = {key: value for key, value in without_section(belt).items() if key not in (*_OF_SECTION, *_LENGTHS)}
    pulleys = _toothed_pulleys(data, entry) if entry.toothing is not None else _smooth_pulleys(data, entry)
    changed = {**data, "belt": {**kept, **section}, "pulley": pulleys}
    if entry.toothing is None:
        lengths = _smooth_lengths(current, entry, changed)
    else:  # some number of teeth, by which sizes of pulleys are known
        lengths = _toothed_lengths(current, entry, {**changed, "belt": {**changed["belt"], "teeth": FEWEST_TEETH}})
    for length in lengths:
        option = {**changed, "belt": {**changed["belt"], **length}}
        option = _on_the_line(data, option)
        if entry.toothing is not None and "installed_tension" in length:
            option = _taking_up(current, option)
        yield option


def _size(belt: Mapping[str, Any], entry: Entry, present: Belt | None) -> Data:
    """Ribs, width or diameter: as typed where that is still meant, or else of a belt about as wide as the present."""
    before = entry_of(belt.get("profile"))
    same = before is not None and (before.sold_by, before.is_v_belt) == (entry.sold_by, entry.is_v_belt)
    standard = entry.tooth_rating.widths if entry.tooth_rating is not None else ()
    typed = belt.get(entry.sold_by)
    if typed is None and same and entry.is_v_belt:
        return {}
    if typed is not None and (same or entry.sold_by == "width") and (not standard or length_in(typed) in standard):
        return {entry.sold_by: typed}
    width = entry.width if present is None else present.width
    if entry.sold_by == "ribs":
        return {"ribs": max(1, round(width / entry.width))}
    if entry.sold_by == "diameter":
        return {"diameter": f"{1e3 * entry.width:.5g} mm"}
    return {"width": f"{1e3 * min(standard, key=lambda size: abs(size - width), default=width):.5g} mm"}


# Pulleys


def _smooth_pulleys(data: Mapping[str, Any], entry: Entry) -> list[Any]:
    """Pulleys without teeth, on which the tension line runs as before."""
    belt, sizes = _belt_of(data), {circle.number: circle for circle in circles(data)}
    smooth = []
    for number, pulley in enumerate(groups(data, "pulley")):
        kept = {key: value for key, value in pulley.items() if key not in ("teeth", "pitch_error")}
        if "teeth" in pulley and not {"radius", "diameter"} & kept.keys() and (size := sizes.get(number)) is not None:
            radius = max(_line_radius(size, belt) - entry.pitch_offset, _LEAST_SHARE * size.radius)
            kept["radius"] = f"{1e3 * radius:.5g} mm"
        smooth.append(_as_sold(kept, entry))
    return smooth


def _toothed_pulleys(data: Mapping[str, Any], entry: Entry) -> list[Any]:
    """Pulleys with the whole number of teeth that changes their size least; smooth ones of a toothed belt stay."""
    assert entry.toothing is not None
    radii = {circle.number: _line_radius(circle, _belt_of(data)) for circle in circles(data)}
    was_toothed = "teeth" in data["belt"]
    sides = {circle.number: circle.side for circle in circles(data)}
    toothed = []
    for number, pulley in enumerate(groups(data, "pulley")):
        meshes = "teeth" in pulley if was_toothed else sides.get(number) == "inside"
        kept = dict(pulley)
        if meshes and number in radii and not _has_pitch(data, entry):
            kept = {key: value for key, value in pulley.items() if key not in _OF_SMOOTH_PULLEYS}
            kept["teeth"] = entry.toothing.teeth_about(radii[number], 0.0)
        toothed.append(_as_sold(kept, entry))
    return toothed


def _as_sold(pulley: Data, entry: Entry) -> Data:
    """A pulley whose diameter is of a kind that the profile has."""
    if pulley.get("diameter_kind") in ("datum", "effective") and pulley["diameter_kind"] != entry.pulley_diameter:
        return {key: value for key, value in pulley.items() if key != "diameter_kind"}
    return pulley


def _line_radius(circle: Circle, belt: Belt | None) -> float:
    """Radius of the tension line on a pulley, m."""
    return circle.radius + (0.0 if belt is None else belt.offset("outside" if circle.side == "outside" else "inside"))


def _has_pitch(data: Mapping[str, Any], entry: Entry) -> bool:
    """Whether the belt has teeth of the pitch of a profile already."""
    belt = _belt_of(data)
    if belt is None or belt.toothing is None or entry.toothing is None:
        return False
    return math.isclose(belt.toothing.pitch, entry.toothing.pitch, rel_tol=1e-9)


def _on_the_line(before: Mapping[str, Any], after: Data) -> Data:
    """A linear axis with its carriage on the line of the belt, which another radius of the first pulley shifts."""
    carriage, belts = after.get("carriage"), (_belt_of(before), _belt_of(after))
    first = [next((circle for circle in circles(data) if circle.number == 0), None) for data in (before, after)]
    if not isinstance(carriage, Mapping) or None in first or None in belts:
        return after
    old, new = (_line_radius(circle, belt) for circle, belt in zip(first, belts, strict=True) if circle is not None)
    center = [length_in(value) for value in carriage.get("center") or ()]
    way = [length_in(value) for value in carriage.get("direction") or ()]
    if len(center) != 2 or len(way) != 2 or None in (*center, *way) or first[0] is None:
        return after
    x, y = (float(value or 0.0) for value in center)
    right, up = (float(value or 0.0) for value in way)
    away = (x - first[0].x) * -up + (y - first[0].y) * right
    shift = math.copysign(1.0, away) * (new - old) / (math.hypot(right, up) or 1.0)
    placed = [f"{1e3 * (x - shift * up):.6g} mm", f"{1e3 * (y + shift * right):.6g} mm"]
    return {**after, "carriage": {**carriage, "center": placed}}


# Lengths


def _smooth_lengths(current: Draft, entry: Entry, changed: Data) -> Iterator[Data]:
    """Lengths of a belt without teeth: as given, if such belts are sold; by the tensioner; or by the tension."""
    belt, drive = current.data["belt"], current.drive
    typed = {key: belt[key] for key in _LENGTHS if key in belt and key != "teeth"}
    if not _is_sold(entry, typed.get("nominal_length")):
        del typed["nominal_length"]
    if typed:
        yield typed
    if drive is not None and drive.moving_tensioners:
        yield {}
    yield from ({"installed_tension": tension} for tension in _tensions(current, changed))
    if not typed:
        yield {}


def _tensions(current: Draft, changed: Data) -> Iterator[Any]:
    """Tensions at rest: as before, and the nearest usual one of a belt that this would hardly or too far stretch."""
    tension, belt = _tension_at_rest(current.drive), _belt_of(changed)
    if tension is None:
        return
    yield current.data["belt"].get("installed_tension", f"{tension:.3g} N")
    if belt is not None:
        low, high = (strain * belt.axial_stiffness for strain in _USUAL_STRAINS)
        yield f"{min(max(tension, low), high):.3g} N"


def _is_sold(entry: Entry, nominal_length: Any) -> bool:
    """Whether a profile has a standard length, or none are known, or none is asked for."""
    length = length_in(nominal_length)
    return (
        not entry.lengths
        or length is None
        or any(abs(length / standard - 1.0) < _NEAR_LENGTH for standard in entry.lengths)
    )


def _toothed_lengths(current: Draft, entry: Entry, changed: Data) -> Iterator[Data]:
    """Numbers of teeth, the nearest to the present length first: at the present tension, or as the teeth leave it."""
    belt, drive = current.data["belt"], current.drive
    if drive is None or entry.toothing is None or _has_pitch(current.data, entry):
        yield {key: belt[key] for key in ("teeth", "installed_tension") if key in belt}
    if drive is None or entry.toothing is None:
        return
    before, after = _loop(current.data, drive.belt), _loop(changed, entry)
    pitches = (drive.belt_length + (after - before if before and after else 0.0)) / entry.toothing.pitch
    least = max(round(pitches) - _TOOTH_COUNTS, FEWEST_TEETH)
    counts = sorted(range(least, least + 2 * _TOOTH_COUNTS + 1), key=lambda count: abs(count - pitches))
    if not drive.moving_tensioners:
        for tension in _tensions(current, changed):
            yield from ({"teeth": count, "installed_tension": tension} for count in counts)
    yield from ({"teeth": count} for count in counts)


def _loop(data: Mapping[str, Any], offsets: Belt | Entry) -> float:
    """Length of the tension line of a closed belt around the pulleys, m; zero where there is none."""
    listed = [
        circle._replace(
            radius=circle.radius + (offsets.back_offset if circle.side == "outside" else offsets.pitch_offset)
        )
        for circle in circles(data)
    ]
    path = sketched(listed)
    return 0.0 if path is None else path.length


def _taking_up(current: Draft, option: Data) -> Data:
    """The drive with a fixed tensioner of open take-up, where whole teeth leave no room for the tension."""
    fixed = [number for number, item in enumerate(groups(option, "tensioner")) if item.get("kind") == "fixed"]
    if fixed:
        edits = [Edit("remove", ("tensioner", number, "take_up")) for number in fixed]
        return changed_data(option, edits)
    drive = current.drive
    if drive is None or drive.given_ends:
        return option
    driver = None if drive.driver is None else drive.pulleys[drive.driver].name
    movable = [number for number, item in enumerate(groups(option, "pulley")) if item.get("name") != driver]
    if not movable:
        return option
    return changed_data(option, placing.new_tensioner(current, movable[-1], "fixed", len(groups(option, "tensioner"))))

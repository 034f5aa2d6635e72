"""The parts list of a drive: the belt as it is ordered, and the pulleys with their sizes."""

from collections.abc import Iterator
from math import isclose

from beltdyn.model import Entry, Prepared, Pulley
from beltdyn.parts.messages import aligned, listing
from beltdyn.show.tables import Facts, Pieces, Table

_SAME_LENGTH = 5e-4
"""Difference of a length from a standard one that rounding on a label explains, m."""
_LENGTHS = {"datum": "datum length", "effective": "effective length", "outside": "inside length"}
"""The length by which belts are sold -> that of their pulleys' diameter."""
_OPEN = "–"


def parts_list(prepared: Prepared) -> Pieces:
    """The head of the sheet, the belt to order, and its pulleys."""
    facts = (*((label.lower(), text) for label, text in prepared.drive.sheet.entries), *_belt(prepared))
    return Facts(facts, "Parts"), _pulleys(prepared)


def _belt(prepared: Prepared) -> Iterator[tuple[str, str]]:
    """Profile, number and length of the belt."""
    belt, entry = prepared.belt, prepared.belt.entry
    wide = f"{1e3 * belt.width:.4g} mm wide"
    size = f"{wide}, {1e3 * belt.thickness:.3g} mm thick"
    if prepared.ends:
        yield ("web" if prepared.drive.is_web else "belt"), f"{entry.title}, {size}" if entry else size
        return
    if entry is None:
        yield "belt", f"{size}, {prepared.belt_length:.5g} m long without tension"
        return
    profile, nominal = str(belt.value_of("profile")), 1e3 * belt.nominal_length_of(prepared.belt_length)
    yield "belt", entry.title
    length = f"{_LENGTHS[entry.pulley_diameter]} {nominal:.5g} mm"
    match entry.sold_by:
        case "ribs" if entry.is_v_belt:
            yield "to order", f"{belt.v_belts} × {profile} {nominal:.0f}, {length}"
        case "ribs":
            yield "to order", f"1 × {profile} {nominal:.0f}, {belt.rib_count} ribs, {length}"
        case "width" if belt.teeth is not None:
            yield (
                "to order",
                f"1 × {profile}, {belt.teeth} teeth, {nominal:.5g} mm long, {wide}",
            )
        case _ if entry.strength is not None:
            yield "to order", f"{profile}, {wide}, {1e-3 * nominal:.5g} m long"
        case _:
            yield "to order", f"1 × {profile}, {wide}, {length}"
    if entry.lengths:
        yield "standard length", _standard(entry, belt.nominal_length_of(prepared.belt_length))


def _standard(entry: Entry, nominal: float) -> str:
    """Whether a belt is sold in this length, and otherwise its neighbors."""
    lengths = sorted(entry.lengths)
    if any(isclose(one, nominal, rel_tol=0.0, abs_tol=_SAME_LENGTH) for one in lengths):
        return "yes"
    shorter, longer = [one for one in lengths if one < nominal], [one for one in lengths if one > nominal]
    return f"no; the next ones are {listing([f'{1e3 * one:.5g} mm' for one in (*shorter[-1:], *longer[:1])])}"


def _pulleys(prepared: Prepared) -> Table:
    """Diameters, grooves and face width of each pulley; columns in which nothing is known are left out."""
    belt, entry, pulleys = prepared.belt, prepared.belt.entry, prepared.pulleys
    grooves, width = belt.rib_count or 0, None if entry is None else entry.face_width(belt.rib_count or 1)
    grooved = [one.side == "inside" and bool(grooves) for one in pulleys]
    columns = {
        "diameter\nmm": aligned([2e3 * one.radius for one in pulleys], 5),
        "kind": [_kind(one, entry) for one in pulleys],
        "pitch\ndiameter mm": aligned((2e3 * abs(prepared.radii)).tolist(), 5),
        "outside\ndiameter mm": [_outside(one, entry) for one in pulleys],
        "grooves": [f"{grooves}" if one else _OPEN for one in grooved],
        "teeth": [f"{one.teeth}" if one.teeth else _OPEN for one in pulleys],
        "face width\nmm": [f"{1e3 * width:.4g}" if one and width else _OPEN for one in grooved],
    }
    shown = {heading: cells for heading, cells in columns.items() if set(cells) != {_OPEN}}
    names = [one.name for one in pulleys]
    return Table("Pulleys as supplied", ("", *shown), tuple(zip(names, *shown.values(), strict=True)))


def _kind(pulley: Pulley, entry: Entry | None) -> str:
    """The kind of the diameter by which a pulley is sold."""
    if pulley.side == "outside":
        return "flat"
    return "outside" if entry is None else entry.pulley_diameter


def _outside(pulley: Pulley, entry: Entry | None) -> str:
    """Outside diameter, mm; unknown of V-ribbed pulleys, whose ribs reach about the effective diameter."""
    if pulley.side == "inside" and entry is not None and entry.pulley_diameter == "effective":
        return _OPEN
    above = entry.groove_height if entry is not None and pulley.side == "inside" else 0.0
    return f"{2e3 * (pulley.radius + above):.5g}"

"""The forms beside the canvas: the keys of a group of the drive file, from the JSON schema."""

import math
import re
from collections.abc import Mapping, Set
from functools import cache
from types import MappingProxyType
from typing import Any, Literal, NamedTuple

from beltdyn.app.scene import groups
from beltdyn.machines.loads.load import LOADS
from beltdyn.model import Drive, read_catalogue
from beltdyn.model.belt_form import MATERIAL
from beltdyn.model.catalogue import Entry, find_entry
from beltdyn.parts.quantity import described_unit, printed_unit, to_si
from beltdyn.parts.text_file import ErrorLocation, option_names
from beltdyn.parts.toml_edits import Location

System = Literal["mm", "SI"]

SYSTEMS: Mapping[System, str] = MappingProxyType({"mm": "mm, rpm, N", "SI": "SI units"})
"""Names of the systems."""
_PLAIN = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_NOT_CONVERTED = re.compile(r"±|\+/?-|\b(?:c?cw|(?:counter-)?clockwise)$")
"""Tolerances and senses of rotation are shown as they are given."""
_SIGNIFICANT_DIGITS = 7
"""Significant digits of a value in a field: they hide rounding of the conversion of units. Messages have two fewer."""


class Unit(NamedTuple):
    """A unit of the page."""

    shown: str
    """As a label has it."""
    written: str
    """As a drive file has it; empty for SI units, whose numbers stand alone."""
    size: float
    """Its size in the SI unit."""


_OF_SHOPS: Mapping[str, Unit] = MappingProxyType(
    {
        "m": Unit("mm", "mm", 1e-3),
        "m^2": Unit("mm²", "mm^2", 1e-6),
        "m^3": Unit("cm³", "cm^3", 1e-6),
        "rad": Unit("°", "deg", math.pi / 180.0),
        "rad/s": Unit("rpm", "rpm", math.pi / 30.0),
        "kg*m^2": Unit("kg cm²", "kg cm^2", 1e-4),
        "N/m": Unit("N/mm", "N/mm", 1e3),
        "Pa": Unit("MPa", "MPa", 1e6),
    }
)


def unit_in(system: System, si: str) -> Unit:
    """The unit of a system for an SI unit."""
    other = _OF_SHOPS.get(si) if system == "mm" else None
    return other or Unit(printed_unit(si), "", 1.0)


def shown(value: Any, si: str, system: System) -> str:
    """A value of a drive file as a field shows it; several separated by commas."""
    if isinstance(value, list):
        return ", ".join(shown(one, si, system) for one in value)
    number = _number(value, si)
    if number is None or not si:
        return "" if value is None else repr(value) if isinstance(value, float) else str(value)
    return f"{number / unit_in(system, si).size:.{_SIGNIFICANT_DIGITS}g}"


def _number(value: Any, si: str) -> float | None:
    """A value in SI units; None for one that is shown as it is."""
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        return None
    if not isinstance(value, str):
        return float(value)
    if not si or _NOT_CONVERTED.search(value):
        return None
    try:
        return to_si(value, si)
    except ValueError:
        return None


_NUMBER = r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?"
_MEASURED = re.compile(
    rf"(?<![\w.\[])(?P<numbers>(?:\[{_NUMBER}, {_NUMBER}\])|(?:{_NUMBER} (?:to|or|and) )?{_NUMBER}) "
    r"(?P<unit>m\^2|m\^3|m|rad/s|rad|kg m\^2|N/m|Pa)(?![\w/^²³]| [\w/]*[sm]\b(?=[/^²³]))"
)
"""Numbers with an SI unit in a sentence, neither of a product nor of a quotient: one, a range or a pair."""
_IN_UNIT = re.compile(r"(?P<before>, in|in units of) (?P<unit>m\^2|m\^3|m|rad/s|rad|kg\*m\^2|N/m|Pa)(?=$|[;,.])")
_BOUND = re.compile(
    rf"(?P<value>(?<= = ){_NUMBER} )?(?P<rule>must be (?:greater than|at least|less than|at most)) (?P<bound>{_NUMBER})"
    rf"(?=\. .*?{_IN_UNIT.pattern})"
)
"""A value beside its bound, without a unit, before the hint that has it."""


def in_units(sentence: str, system: System) -> str:
    """A message or a hint with its lengths, speeds and angles in the units of the page."""

    def converted(numbers: str, unit: Unit) -> str:
        return re.sub(_NUMBER, lambda number: f"{float(number[0]) / unit.size:.{_SIGNIFICANT_DIGITS - 2}g}", numbers)

    def measured(match: re.Match[str]) -> str:
        unit = unit_in(system, match["unit"].replace("kg m", "kg*m"))
        return f"{converted(match['numbers'], unit)} {unit.shown}" if unit.written else match[0]

    def bounded(match: re.Match[str]) -> str:
        unit = unit_in(system, match["unit"])
        return f"{converted(match['value'] or '', unit)}{match['rule']} {converted(match['bound'], unit)}"

    if system == "SI":
        return sentence
    sentence = _BOUND.sub(bounded, _MEASURED.sub(measured, sentence))
    return _IN_UNIT.sub(lambda match: f"{match['before']} {unit_in(system, match['unit']).shown}", sentence)


def with_unit(text: str, si: str, system: System) -> str:
    """What was typed as a drive file has it: plain numbers get the unit of the page."""
    unit = unit_in(system, si)
    return f"{text} {unit.written}" if unit.written and _PLAIN.fullmatch(text) else text


Form = Literal["text", "number", "choice", "flag", "point", "numbers", "group", "groups"]

_NOT_IN_FILES = frozenset({"function"})
"""Kinds that a drive file cannot hold."""
_NUMERIC = frozenset({"number", "integer"})
_SHORT_OF: Mapping[str, tuple[str, ...]] = {
    "belt": ("profile", "ribs", "width", "installed_tension", "length", "nominal_length"),
    "pulley": ("name", "center", "radius", "side", "speed", "inertia", "torque", "load"),
    "contact": ("friction",),
    "simulation": ("duration", "output_interval", "start"),
    "limits": ("largest_slip", "largest_hub_load", "largest_tension", "least_slip_safety", "largest_utilization"),
    "tensioner": ("pulley", "direction", "pivot", "preload", "rate", "mass", "inertia", "stops", "take_up"),
}
"""Keys of each group shown by default, in this order; others are shown if given."""
_APART: Mapping[str, tuple[str, ...]] = {"speed": ("torque", "load"), "torque": ("speed",), "load": ("speed",)}
"""Keys of a pulley that exclude others: the torque of a shaft with prescribed speed is a result."""
_OF_TEETH = ("toothing", "pitch_error")
"""Keys that go with a number of teeth of the belt."""


class Field(NamedTuple):
    """A key of a group in a form."""

    location: Location
    """Its location in the drive file."""
    form: Form
    """What is given: a text, a number with or without unit, one of some choices, yes or no, a point, several numbers,
    a group of keys, or a list of groups."""
    unit: str
    """SI unit of bare numbers; empty without one."""
    hint: str
    """What it means."""
    choices: tuple[str, ...]
    """Of a choice; kinds of a group, or of the groups of a list."""
    default: str
    """What holds where it is left open; empty where nothing does, or it is chosen."""
    first: bool
    """Whether it is shown from the start."""
    required: bool
    """Whether it must be given."""
    value: Any
    """What the file gives; None where it is left open."""
    unit_of_values: str = ""
    """SI unit of what a profile gives over time."""
    example: Any = None
    """A usual number of a required key, where its kind names one."""
    label: str = ""
    """The key in words."""

    @property
    def key(self) -> str:
        """Its name in the file."""
        return str(self.location[-1])

    def text(self, system: System) -> str:
        """The value of the file as a field shows it."""
        return shown(self.value, self.unit, system)

    def usual(self, system: System) -> str:
        """The default as a field shows it."""
        plain = as_value(self.form, self.default) if self.unit else None
        return self.default if plain is None else shown(plain, self.unit, system)

    def read(self, text: str, system: System) -> Any:
        """Parse typed text; numbers without a unit are in that of the page."""
        if self.unit and self.form in ("point", "numbers"):
            parts = (with_unit(one.strip(), self.unit, system) for one in text.strip("[] ").split(",") if one.strip())
            return as_value(self.form, ", ".join(parts))
        return as_value(self.form, with_unit(text.strip(), self.unit, system) if self.unit else text)


def as_text(value: Any) -> str:
    """Format a value as typed into a form; several numbers separated by commas."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return ", ".join(as_text(one) for one in value)
    return repr(value) if isinstance(value, float) else str(value)


def as_value(form: Form, text: str) -> Any:
    """Parse typed text: a number if possible, otherwise text for validation; None if empty."""
    text = text.strip()
    if not text:
        return None
    if form in ("point", "numbers"):
        return [_number_or_text(one.strip()) for one in text.strip("[]").split(",") if one.strip()]
    if form == "flag":
        return text == "true"
    return _number_or_text(text) if form == "number" else text


def _number_or_text(text: str) -> int | float | str:
    for read in (int, float):
        try:
            return read(text)
        except ValueError:
            continue
    return text


def fields(data: Mapping[str, Any], location: Location) -> list[Field]:
    """List the keys of a group of the drive file: those shown by default first, and of these the required ones."""
    locations, group = ErrorLocation(Drive, data), value_at(data, location)
    group = group if isinstance(group, Mapping) else {}
    tagged, schema = _tagged(locations, data, location), schema_of(data, location)
    required = schema.get("required") or []
    short = _SHORT_OF.get(_group_name(location), ())
    of_values = described_unit(
        str(locations.locate(_tagged(locations, data, location[:-1]) + location[-1:])[1]["description"])
    )
    found = []
    for key in schema.get("properties", {}):
        own = locations.locate((*tagged, key))[1]
        if key == "kind" or _is_excluded(data, location, key) or (not location and _form(own) in ("group", "groups")):
            continue
        first = key in short or key in required or key in group or not (short or required)
        given_unit = of_values if key in ("value", "values") else ""
        found.append(_field(data, (*location, key), own, first, key in required, given_unit))
    order = {key: place for place, key in enumerate(short or required)}
    return sorted(found, key=lambda one: (not one.first, order.get(one.key, len(order))))


def _is_excluded(data: Mapping[str, Any], location: Location, key: str) -> bool:
    """Whether what a drive has leaves no room for a key of its belt or a pulley."""
    group = value_at(data, location) or {}
    if key in group:
        return False
    if location == ("belt",) and key in _beside_profile(group):
        return True
    if key in _OF_TEETH:
        return not value_at(data, ("belt", "teeth"))
    if _group_name(location) != "pulley":
        return False
    if key == "harmonics":
        return "speed" not in group
    return any(key in _APART[one] for one in _APART if group.get(one))


def _beside_profile(belt: Mapping[str, Any]) -> Set[str]:
    """Keys of a belt that its profile or its teeth exclude; `sold` is of result files."""
    excluded = {"sold"} | ({"length", "nominal_length"} if belt.get("teeth") else set())
    entry = entry_of(belt.get("profile"))
    if entry is None:
        return excluded
    return excluded | {*MATERIAL, "ribs", "diameter", *({"teeth"} if entry.toothing is None else ())} - {entry.sold_by}


def schema_of(data: Mapping[str, Any], location: Location) -> Mapping[str, Any]:
    """The schema of a group, of the kind that it has."""
    locations = ErrorLocation(Drive, data)
    return locations.locate(_tagged(locations, data, location))[1]


def kinds(data: Mapping[str, Any], location: Location) -> tuple[str, ...]:
    """Possible kinds at a location; empty without kinds."""
    locations = ErrorLocation(Drive, data)
    parent = _tagged(locations, data, location[:-1])
    return _kinds(locations.locate((*parent, location[-1]))[1])


def value_at(data: Any, location: Location) -> Any:
    """The value at a location; None without one."""
    for step in location:
        try:
            data = data[step]
        except (LookupError, TypeError):
            return None
    return data


def pulley_at(drive: Drive, data: Mapping[str, Any], location: Location) -> int:
    """Number of the pulley to which a location belongs: a drive counts counter-clockwise, a file in either order."""
    return drive.number_of(value_at(data, (*location[:2], "name")))


def _tagged(locations: ErrorLocation, data: Mapping[str, Any], location: Location) -> Location:
    """The location as errors have it: with the kind behind each group that has one."""
    tagged: Location = ()
    for depth, step in enumerate(location, 1):
        tagged = (*tagged, step)
        known = locations.kinds(tagged)
        group = value_at(data, location[:depth])
        if known and isinstance(group, Mapping) and group.get("kind") in known:
            tagged = (*tagged, str(group["kind"]))
        elif isinstance(group, Mapping):
            tagged = (*tagged, *_parts(locations.locate(tagged)[1]))
    return tagged


def _parts(schema: Mapping[str, Any]) -> tuple[str, ...]:
    """The part that may replace a choice; None if there is none."""
    return tuple(name for name, option in option_names(schema).items() if "$ref" in option)


def _group_name(location: Location) -> str:
    """The name of a group at the top level of the drive."""
    return str(location[0]) if 1 <= len(location) <= 2 and all(isinstance(one, int) for one in location[1:]) else ""


def _field(
    data: Mapping[str, Any], location: Location, schema: Mapping[str, Any], first: bool, required: bool, given_unit: str
) -> Field:
    hint, value = str(schema.get("description", "")), value_at(data, location)
    form: Form = "group" if _parts(schema) and isinstance(value, Mapping) else _form(schema)
    choices = _choices(schema) if form == "choice" else _kinds(schema if form != "groups" else _entries(schema))
    if location == ("belt", "profile"):
        form, choices = "choice", _profiles()
        if isinstance(value, str) and value not in choices:  # of a catalogue of one's own, or a class of conveyor belts
            choices = (value, *choices)
    elif location[-1] == "pulley" and location[0] == "tensioner":
        form, choices = "choice", tuple(str(one.get("name")) for one in groups(data, "pulley"))
    elif location[-1] == "sensor":
        form, choices = "choice", _carried(data)
    elif location[-1] == "load" and not _carried(data):
        choices = tuple(kind for kind in choices if "sensor" not in LOADS[kind].model_fields)
    default = "" if form in ("group", "groups") else as_text(schema.get("default"))
    numeric = form in ("number", "point", "numbers")
    hint = hint if form in ("group", "groups") else hint[:1].upper() + hint[1:]
    return Field(
        location,
        form,
        described_unit(hint) or given_unit if numeric else "",
        hint,
        choices,
        default,
        first,
        required,
        value,
        described_unit(hint) if form == "group" else "",
        next(iter(schema.get("examples", ())), None),
        _label(data, location),
    )


def in_words(key: str) -> str:
    """A key or the name of a kind without underscores."""
    return key.replace("_", " ")


def _label(data: Mapping[str, Any], location: Location) -> str:
    """A key in words; the number of a profile that is sold by ribs counts belts, where these are V-belts."""
    entry = entry_of(value_at(data, ("belt", "profile"))) if location == ("belt", "ribs") else None
    return f"{entry.piece}s" if entry is not None else in_words(str(location[-1]))


def _choices(schema: Mapping[str, Any]) -> tuple[str, ...]:
    """What may be chosen; nothing where there is no choice."""
    options = (schema, *option_names(schema).values())
    return tuple(choice for option in options for choice in option.get("enum", ()))


def _form(schema: Mapping[str, Any]) -> Form:
    if _choices(schema) and not _takes_numbers(schema):
        return "choice"
    if "discriminator" in schema or "properties" in schema:
        return "group"
    if "prefixItems" in schema:
        return "point"
    options = [schema, *schema.get("anyOf", ())]
    for option in options:
        if option.get("type") == "array":
            entries = option.get("items", {})
            return "groups" if {"$ref", "discriminator", "properties"} & set(entries) else "numbers"
    if _takes_numbers(schema):
        return "number"
    return "flag" if any(option.get("type") == "boolean" for option in options) else "text"


def _takes_numbers(schema: Mapping[str, Any]) -> bool:
    """Whether a number is among what may be given, such as beside words for some."""
    return any(option.get("type") in _NUMERIC for option in (schema, *schema.get("anyOf", ())))


def _carried(data: Mapping[str, Any]) -> tuple[str, ...]:
    """Pulleys on moving tensioners: dancers and load cells."""
    return tuple(str(one.get("pulley")) for one in groups(data, "tensioner") if one.get("kind") != "fixed")


def _entries(schema: Mapping[str, Any]) -> Mapping[str, Any]:
    """The schema of the entries of a list."""
    for option in (schema, *schema.get("anyOf", ())):
        if option.get("type") == "array":
            entries: Mapping[str, Any] = option.get("items", {})
            return entries
    return {}


def _kinds(schema: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(kind for kind in schema.get("discriminator", {}).get("mapping", {}) if kind not in _NOT_IN_FILES)


def entry_of(profile: object) -> Entry | None:
    """A profile of the package's catalogue; None of others."""
    try:
        return find_entry(read_catalogue(), str(profile))
    except LookupError:
        return None


@cache
def _profiles() -> tuple[str, ...]:
    return tuple(read_catalogue())

"""A form as a list of rows (keys, groups, list entries), and the edits by rows."""

from collections.abc import Iterator, Mapping, Set
from typing import Any, Literal, NamedTuple

from beltdyn.app import placing
from beltdyn.app.forms import Field, fields, kinds, value_at
from beltdyn.parts.toml_edits import Edit, Location


class Row(NamedTuple):
    """A row of a form.

    Attributes
    ----------
    what : str
        "field", a key; "group", a group by its kind or that is there or not; "entry", one of a list, which can be taken
        away; "add", which adds one; or "more", which shows the other keys of a group.
    depth : int
        How deep it stands.
    location : tuple
        Where it stands in the drive file: of "add" the list, of "more" the group.
    field : Field or None
        The key; none of "more" and "entry".
    kinds : tuple of str
        Kinds to choose out of, of groups and entries; none where there are no kinds.
    """

    what: Literal["field", "group", "entry", "add", "more"]
    depth: int
    location: Location
    field: Field | None = None
    kinds: tuple[str, ...] = ()

    @property
    def shape(self) -> tuple[object, ...]:
        """Properties that need a new row, not only a new value."""
        choices = self.field.choices if self.field is not None else ()
        return self.what, self.depth, self.location, self.kinds, choices


def rows(data: Mapping[str, Any], location: Location, opened: Set[Location], depth: int = 0) -> Iterator[Row]:
    """List the rows of a group.

    Parameters
    ----------
    data : mapping
        The drive file.
    location : tuple
        Where the group stands.
    opened : set
        Groups of which all keys are shown.
    depth : int
        How deep it stands.
    """
    listed = fields(data, location)
    for one in listed:
        if one.first or location in opened:
            yield from _rows_of(data, one, opened, depth)
    if not all(one.first for one in listed):
        yield Row("more", depth, location)


def _rows_of(data: Mapping[str, Any], one: Field, opened: Set[Location], depth: int) -> Iterator[Row]:
    if one.form == "group":
        yield Row("group", depth, one.location, one, one.choices)
        if isinstance(one.value, Mapping):
            yield from rows(data, one.location, opened, depth + 1)
    elif one.form == "groups":
        entries = one.value if isinstance(one.value, list) else []
        for number in range(len(entries)):
            place = (*one.location, number)
            yield Row("entry", depth, place, None, kinds(data, place))
            yield from rows(data, place, opened, depth + 1)
        yield Row("add", depth, one.location, one, one.choices)
    else:
        yield Row("field", depth, one.location, one)


def edits_of_value(data: Mapping[str, Any], location: Location, value: Any) -> list[Edit]:
    """Edits that set a key, or remove it with None; empty if the value is unchanged."""
    if value_at(data, location) == value and type(value_at(data, location)) is type(value):
        return []
    if value is None:
        return [Edit("remove", location)]
    if len(location) == 3 and location[0] == "pulley" and location[2] == "name":
        return placing.rename(data, int(location[1]), str(value))
    return [Edit("set", location, value)]


def edits_of_kind(data: Mapping[str, Any], location: Location, kind: str | None) -> list[Edit]:
    """Edits that change the kind of a group and keep common values, or remove it with None."""
    group = value_at(data, location)
    if kind is None:
        return [] if group is None else [Edit("remove", location)]
    if isinstance(group, Mapping) and group.get("kind") == kind:
        return []
    tried = _with(data, location, {"kind": kind})
    known = {one.key for one in fields(tried, location)}
    kept = {key: value for key, value in group.items() if key in known} if isinstance(group, Mapping) else {}
    return [Edit("set", location, {"kind": kind, **kept})]


def edits_of_entry(data: Mapping[str, Any], location: Location, kind: str | None) -> list[Edit]:
    """Edits that append an entry to a list, with its kind if any."""
    entries = value_at(data, location)
    if entries is not None and not isinstance(entries, list):
        return [Edit("set", location, [{"kind": kind} if kind else {}])]
    return [Edit("insert", (*location, len(entries or [])), {"kind": kind} if kind else {})]


def _with(data: Mapping[str, Any], location: Location, value: Any) -> dict[str, Any]:
    """Data with another value at one place, whose way is there."""
    if len(location) == 1:
        return {**data, str(location[0]): value}
    inner = data.get(str(location[0]))
    return {**data, str(location[0]): _inside(inner, location[1:], value)}


def _inside(data: Any, location: Location, value: Any) -> Any:
    step, rest = location[0], location[1:]
    new = _inside(value_at(data, (step,)), rest, value) if rest else value
    if isinstance(step, int):
        return [*data[:step], new, *data[step + 1 :]]
    return {**(data or {}), step: new}

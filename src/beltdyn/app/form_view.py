"""A form on the page: a widget per row, with values and messages of the drive file."""

import ast
import re
from collections.abc import Callable, Iterator, Mapping, Set
from typing import Any, Literal, NamedTuple

import numpy as np
from nicegui import ui
from nicegui.elements.mixins.validation_element import ValidationElement

from beltdyn.app import placing
from beltdyn.app.forms import Field, fields, in_units, kinds, schema_of, shown, unit_in, value_at
from beltdyn.app.scene import groups
from beltdyn.app.session import Session
from beltdyn.errors import ModelError
from beltdyn.model import Drive, estimate_at_rest, prepare, read_catalogue
from beltdyn.model.catalogue import Entry
from beltdyn.model.pulley import flat_friction_on
from beltdyn.model.toothing import FEWEST_TEETH
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import to_si
from beltdyn.parts.toml_edits import Edit, Location

_EXAMPLE = re.compile(r"^(?:>>>|\.\.\.) (.*)$", re.MULTILINE)
_OF_UNITS = {"rad/s": "1500 rpm", "N*m": "5 N m", "N": "100 N", "Pa": "5 MPa", "W": "1 kW", "": 1.0}
"""What profiles rise to, by their unit."""
_OPPOSING = "-5 N m"
"""Torque on a pulley that turns counter-clockwise."""
_TIMES = {"start": 0.02, "end": 0.2, "time": 0.1, "times": [0.0, 0.2]}


def beginning(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> dict[str, Any]:
    """Valid values of a group of a kind that is put at a location; empty where its kind documents none.

    `data` hold the group already, with its kind alone.
    """
    given = {"kind": kind} if kind else {}
    listed = {one.key: one for one in fields(data, location)}
    example = {key: value for key, value in _example(data, location).items() if key in listed}
    found = {key: example[key] for key in listed if key in example}
    for one in listed.values():
        if one.form == "choice" and one.choices and one.key in found and found[one.key] not in one.choices:
            found[one.key] = one.choices[0]  # a name in the drive of the example
        if one.key not in found and (one.required or one.key in ("times", "values", "angles")):
            value = _usual(one, data, drive)
            if value is not None:
                found[one.key] = value
    acting = {key: _at_once(value) for key, value in found.items()}
    return given | _loading(acting, location, drive)


def _at_once(value: Any) -> Any:
    """A profile that steps or rises at some time as a constant: the drive may have ended before."""
    if isinstance(value, Mapping) and "value" in value and value.get("kind") not in (None, "constant"):
        return {"kind": "constant", "value": value["value"]}
    return value


def _loading(found: dict[str, Any], location: Location, drive: Drive | None) -> dict[str, Any]:
    """A load whose torques oppose the rotation of its pulley on an average, as a driven machine does."""
    if "torques" not in found or location[0] != "pulley" or drive is None:
        return found
    torques, turning = np.asarray(found["torques"], dtype=float), _turning(drive, int(location[1]))
    if float(torques.mean()) * turning > 0.0:
        torques = -torques
    if turning < 0.0 and "speeds" in found:  # the same machine, seen from its other end
        speeds = [to_si(one, "rad/s") if isinstance(one, str) else float(one) for one in found["speeds"]]
        return found | {"speeds": [-one for one in reversed(speeds)], "torques": torques[..., ::-1].tolist()}
    return found | {"torques": torques.tolist()}


def _turning(drive: Drive, number: int) -> float:
    """Sense in which a pulley turns, positive counter-clockwise."""
    return float(drive.running_sense * drive.pulleys[number].turning * drive.positive_sense)


def _example(data: Mapping[str, Any], location: Location) -> dict[str, Any]:
    """Arguments of the class in the example of its description, where they are plain data."""
    code = "\n".join(_EXAMPLE.findall(str(schema_of(data, location).get("description", ""))))
    try:
        statements = ast.parse(code)
    except SyntaxError:
        return {}
    for call in (node for node in ast.walk(statements) if isinstance(node, ast.Call)):
        if call.keywords and not call.args:
            try:
                return {str(one.arg): ast.literal_eval(one.value) for one in call.keywords if one.arg != "kind"}
            except ValueError:
                return {}
    return {}


def _usual(one: Field, data: Mapping[str, Any], drive: Drive | None) -> Any:
    """A usual value of a required key."""
    if one.key in _TIMES:
        return _TIMES[one.key]
    if one.key in ("value", "values"):
        rises_to = _level(one, data, drive)
        return rises_to if one.key == "value" else [0.0, rises_to]
    if one.form == "group" and one.choices:
        return {"kind": "constant", "value": _OF_UNITS.get(one.unit_of_values, 1.0)}
    return one.example


def _level(one: Field, data: Mapping[str, Any], drive: Drive | None) -> Any:
    """What a profile rises to: the torque on a pulley opposes its rotation."""
    level = _OF_UNITS.get(one.unit, 1.0)
    if one.location[0] == "pulley" and one.location[2] == "torque" and drive is not None:
        return level if _turning(drive, int(one.location[1])) < 0.0 else _OPPOSING
    return level


# A form as a list of rows (keys, groups, list entries), and the edits by rows


class Row(NamedTuple):
    """A row of a form."""

    what: Literal["field", "group", "entry", "add", "more"]
    """"field", a key; "group", a group by its kind or that is there or not; "entry", one of a list, which can be
    taken away; "add", which adds one; or "more", which shows the other keys of a group."""
    depth: int
    """How deep it stands."""
    location: Location
    """Its location in the drive file: for "add" the list, for "more" the group."""
    field: Field | None = None
    """The key; none of "more" and "entry"."""
    kinds: tuple[str, ...] = ()
    """Kinds to choose out of, of groups and entries; none where there are no kinds."""

    @property
    def shape(self) -> tuple[object, ...]:
        """Properties that need a new row, not only a new value."""
        choices = self.field.choices if self.field is not None else ()
        return self.what, self.depth, self.location, self.kinds, choices


def rows(data: Mapping[str, Any], location: Location, opened: Set[Location], depth: int = 0) -> Iterator[Row]:
    """List the rows of a group."""
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


_NEAR_LENGTH = 1e-3
"""Difference from a standard length within which a nominal length is kept, relative."""


def edits_of_profile(data: Mapping[str, Any], profile: str | None, drive: Drive | None) -> list[Edit]:
    """Edits that set the profile of the belt, and clear what does not fit it: measures by which it is not sold, teeth.

    The new belt is about as wide as the one before, and pulleys without teeth as large.
    """
    edits = edits_of_value(data, ("belt", "profile"), profile)
    belt, entry = value_at(data, ("belt",)), read_catalogue().get(profile or "")
    if entry is None or not isinstance(belt, Mapping):
        return edits
    refused = {"ribs", "width", "diameter"} - {entry.sold_by}
    if entry.toothing is None:
        refused.add("teeth")
        edits += _without_teeth(data, drive)
    elif drive is not None and drive.belt.teeth is None:
        edits += _with_teeth(data, drive, entry.toothing.pitch)
        refused |= {"length"} if _takes_up(data) else {"length", "installed_tension"}
    if not _is_sold(entry, belt.get("nominal_length")):
        refused.add("nominal_length")
    edits += [Edit("remove", ("belt", key)) for key in sorted(refused & belt.keys())]
    lengths = {"length", "nominal_length", "installed_tension"} & (belt.keys() - refused)
    if entry.toothing is None and not lengths and "teeth" in belt and drive is not None:
        edits.append(Edit("set", ("belt", "installed_tension"), f"{estimate_at_rest(prepare(drive))[1].tension:.3g} N"))
    before = None if drive is None else drive.belt.entry
    counted = before is not None and before.is_v_belt == entry.is_v_belt
    if drive is not None and not (entry.sold_by in belt and counted):
        edits.append(Edit("set", ("belt", entry.sold_by), _size(entry, drive.belt.width)))
    return edits


def _takes_up(data: Mapping[str, Any]) -> bool:
    """Whether a fixed tensioner takes up the length of the belt."""
    return any(one.get("kind") == "fixed" for one in groups(data, "tensioner"))


def _without_teeth(data: Mapping[str, Any], drive: Drive | None) -> list[Edit]:
    """Edits that make pulleys with teeth smooth, as large as they are."""
    edits = list[Edit]()
    for number, pulley in enumerate(groups(data, "pulley")):
        if "teeth" in pulley:
            edits.append(Edit("remove", ("pulley", number, "teeth")))
            if drive is not None and not {"radius", "diameter"} & pulley.keys():
                edits.append(Edit("set", ("pulley", number, "radius"), f"{1e3 * drive.pulleys[number].radius:.5g} mm"))
    return edits


def _with_teeth(data: Mapping[str, Any], drive: Drive, pitch: float) -> list[Edit]:
    """Edits that give teeth to pulleys inside the belt, about as many as have room, and to the belt."""
    edits = [Edit("set", ("belt", "teeth"), max(FEWEST_TEETH, int(drive.path.length / pitch)))]
    for number, pulley in enumerate(groups(data, "pulley")):
        if drive.pulleys[number].side == "inside":
            edits += [Edit("remove", ("pulley", number, key)) for key in ("radius", "diameter") if key in pulley]
            around = 2.0 * np.pi * float(drive.pulleys[number].radius) / pitch
            edits.append(Edit("set", ("pulley", number, "teeth"), max(FEWEST_TEETH, round(around))))
    return edits


def _is_sold(entry: Entry, nominal_length: Any) -> bool:
    """Whether a profile has a standard length, or none are known."""
    try:
        length = to_si(nominal_length, "m") if isinstance(nominal_length, str) else nominal_length
    except ValueError:
        return True
    return not entry.lengths or length is None or any(abs(length / one - 1.0) < _NEAR_LENGTH for one in entry.lengths)


def _size(entry: Entry, width: float) -> int | str:
    """Ribs, width or diameter of a belt that is about as wide as another one, m."""
    if entry.sold_by == "ribs":
        return max(1, round(width / entry.width))
    sold = entry.tooth_rating.widths if entry.tooth_rating is not None else ()
    near = min(sold, key=lambda one: abs(one - width), default=width if entry.sold_by == "width" else entry.width)
    return f"{1e3 * near:.5g} mm"


def in_use(drive: Drive | None, location: Location) -> Any:
    """The value of a drive at a place of its file, with what its profile supplies and what is chosen; None if none."""
    if drive is None or len(location) < 2:
        return None
    completed = drive.completed
    part: Any = {"belt": completed.belt, "contact": completed.contact, "simulation": drive.simulation}.get(
        str(location[0]), drive
    )
    try:
        if location == ("contact", "friction"):
            return drive.belt.friction
        if location[0] == "pulley" and location[-1] == "friction":
            return flat_friction_on(drive.pulleys[int(location[1])], drive.belt, drive.contact)
        steps = location[1:] if part is not drive else location
        for step in steps:
            part = part[step] if isinstance(step, int) else part.value_of(step) if isinstance(part, Part) else None
    except (LookupError, AttributeError, ModelError, ValueError):
        return None
    return part


def edits_of_kind(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> list[Edit]:
    """Edits that change the kind of a group and keep common values, or remove it with None; others begin as usual."""
    group = value_at(data, location)
    if kind is None:
        return [] if group is None else [Edit("remove", location)]
    if isinstance(group, Mapping) and group.get("kind") == kind:
        return []
    tried = _with(data, location, {"kind": kind})
    known = {one.key for one in fields(tried, location)}
    kept = {key: value for key, value in group.items() if key in known} if isinstance(group, Mapping) else {}
    begun = beginning(tried, location, kind, drive)
    points = {key for key, value in begun.items() if isinstance(value, list)}
    if not points <= kept.keys():  # columns of points belong together
        kept = {key: value for key, value in kept.items() if key not in points}
    return [Edit("set", location, {**begun, **kept, "kind": kind})]


def edits_of_entry(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> list[Edit]:
    """Edits that append an entry to a list, with its kind if any, which begins with usual numbers."""
    entries = value_at(data, location)
    listed = entries if isinstance(entries, list) else []
    first = {"kind": kind} if kind else {}
    place = (*location, len(listed))
    made = beginning(_with(data, location, [*listed, first]), place, kind, drive)
    if entries is not None and not isinstance(entries, list):
        return [Edit("set", location, [made])]
    return [Edit("insert", place, made), *(placing.rim(data, location) if location[-1] == "hub" else [])]


def edits_of_group(data: Mapping[str, Any], location: Location) -> list[Edit]:
    """Edits that give a group without kinds, which begins with usual numbers."""
    return [Edit("set", location, beginning(_with(data, location, {}), location, None))]


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


_TYPED = ("number", "text", "point", "numbers")


class FormView:
    """The form of a group of the drive file; `apply` is called with the edits of a user."""

    def __init__(self, session: Session, apply: Callable[[list[Edit]], None]) -> None:
        self._session, self._apply = session, apply
        self._opened: set[Location] = set()
        self._rows: list[Row] = []
        self._widgets: dict[Location, Any] = {}
        self._location: Location | None = None
        self._filling = False
        self._messages = ui.column().classes("w-full gap-0")
        self._box = ui.element("div").classes("bd-fields")

    def show(self, location: Location | None) -> None:
        """Show the group at a location with its present values and messages; nothing for None."""
        data = self._session.document.data
        found = [] if location is None else list(rows(data, location, self._opened))
        same = location == self._location and [one.shape for one in found] == [one.shape for one in self._rows]
        self._location, self._rows, self._filling = location, found, True
        try:
            if not same:
                self._build()
            self._fill()
        finally:
            self._filling = False

    def rebuild(self) -> None:
        """Show the same group anew, as in other units."""
        self._rows = []
        self.show(self._location)

    def _build(self) -> None:
        self._box.clear()
        self._widgets = {}
        with self._box:
            for row in self._rows:
                half = row.field is not None and row.what == "field" and row.field.form in ("number", "flag", "point")
                holder = ui.element("div").classes("bd-field" if half else "bd-field bd-whole")
                if row.depth:
                    holder.classes("bd-inner-field").style(f"--bd-depth: {row.depth}")
                with holder:
                    getattr(self, f"_build_{row.what}")(row)

    def _fill(self) -> None:
        """Update values and messages but keep the widgets, so that typing is not interrupted."""
        draft = self._session.draft
        for row in self._rows:
            widget = self._widgets.get(row.location)
            if widget is None or row.what in ("add", "more"):
                continue
            if row.what == "field":
                assert row.field is not None
                widget.value = self._shown(row.field)
                if isinstance(widget, ui.input):
                    widget.props["placeholder"] = self._in_use(row.field)
                told = draft.told_below(row.location)
            else:
                group = value_at(draft.data, row.location)
                widget.value = _kind_of(group) if row.kinds else group is not None
                told = draft.told_at(row.location)
            if isinstance(widget, ValidationElement):
                widget.error = in_units("\n".join(told), self._session.units) or None
        self._messages.clear()
        if self._location is not None:
            with self._messages:
                for sentence in draft.told_at(self._location):
                    ui.label(in_units(sentence, self._session.units)).classes("bd-message")

    def _shown(self, field: Field) -> Any:
        if field.form == "flag":
            return field.value if isinstance(field.value, bool) else field.default == "true"
        if field.form == "choice":
            return field.value if field.value in field.choices else None
        return field.text(self._session.units)

    def _in_use(self, field: Field) -> str:
        """What holds where a field is left open: the value of the drive, or else the default."""
        units = self._session.units
        value = in_use(self._session.draft.drive, field.location)
        if isinstance(value, bool) or not isinstance(value, int | float):
            return field.usual(units)
        return shown(value if isinstance(value, int) else float(f"{value:.5g}"), field.unit, units)

    def _build_field(self, row: Row) -> None:
        field = row.field
        assert field is not None
        label, units = field.key.replace("_", " "), self._session.units
        usual = field.usual(units)
        if field.form == "flag":
            widget: Any = ui.checkbox(label, on_change=lambda event: self._enter(field, event.value))
        elif field.form == "choice":
            shown = self._shown(field)
            widget = ui.select(
                list(field.choices),
                label=f"{label} (default: {usual})" if usual and shown is None else label,
                value=shown,
                clearable=not field.required,
                with_input=len(field.choices) > 8,
                on_change=lambda event: self._enter(field, event.value),
            )
            widget.props("dense outlined options-dense hide-bottom-space").classes("w-full")
        else:
            suffix = unit_in(units, field.unit).shown if field.unit else ""
            widget = ui.input(label=label, value=self._shown(field), placeholder=self._in_use(field))
            widget.props(f'dense outlined stack-label hide-bottom-space autocomplete="off" suffix="{suffix}"')
            widget.classes("w-full").on("change", lambda: self._type(field, widget.value or ""))
        widget.mark(".".join(map(str, field.location)))
        with widget:
            default = f" Default: {usual} {unit_in(units, field.unit).shown if field.unit else ''}".rstrip() + "."
            ui.tooltip(in_units(field.hint, units) + default * bool(usual)).props("max-width=320px delay=600")
        self._widgets[row.location] = widget

    def _build_group(self, row: Row) -> None:
        assert row.field is not None
        if not row.kinds:
            widget: Any = ui.checkbox(
                _in_words(row.field.key), on_change=lambda event: self._give(row.location, event.value)
            )
        else:
            widget = self._kinds(row, _in_words(row.field.key), clearable=True)
        with widget:
            ui.tooltip(row.field.hint).props("max-width=320px delay=600")
        self._widgets[row.location] = widget.mark(".".join(map(str, row.location)))

    def _build_entry(self, row: Row) -> None:
        *_, key, number = row.location
        with ui.row().classes("w-full no-wrap items-center gap-1"):
            if row.kinds:
                self._widgets[row.location] = self._kinds(row, f"{key} {int(number) + 1}", clearable=False)
            else:
                ui.label(f"{key} {int(number) + 1}").classes("grow")
            button = ui.button(icon="delete_outline", on_click=lambda: self._apply([Edit("remove", row.location)]))
            button.props(f'flat dense round aria-label="remove {key} {int(number) + 1}"').tooltip("Remove")

    def _kinds(self, row: Row, label: str, clearable: bool) -> Any:
        def choose(kind: str | None) -> None:
            if not self._filling:
                self._apply(edits_of_kind(self._session.document.data, row.location, kind, self._session.draft.drive))

        group = value_at(self._session.document.data, row.location)
        widget = ui.select(
            {kind: _in_words(kind) for kind in row.kinds},
            label=label,
            value=_kind_of(group) if _kind_of(group) in row.kinds else None,
            clearable=clearable,
            on_change=lambda event: choose(event.value),
        )
        return widget.props("dense outlined options-dense hide-bottom-space").classes("w-full grow")

    def _build_add(self, row: Row) -> None:
        def add(kind: str | None = None) -> None:
            self._apply(edits_of_entry(self._session.document.data, row.location, kind, self._session.draft.drive))

        key = str(row.location[-1])
        button = ui.button(f"add {key}", icon="add").props("flat dense no-caps size=sm").mark(f"add:{key}")
        if not row.kinds:
            button.on_click(lambda: add())
            return
        with button, ui.menu():
            for kind in row.kinds:
                item = ui.menu_item(_in_words(kind), on_click=lambda kind=kind: add(kind))
                item.mark(f"add:{key}:{kind}")

    def _build_more(self, row: Row) -> None:
        def toggle() -> None:
            self._opened ^= {row.location}
            self.show(self._location)

        opened = row.location in self._opened
        button = ui.button(
            "fewer keys" if opened else "more keys", icon="expand_less" if opened else "expand_more", on_click=toggle
        )
        button.props("flat dense no-caps size=sm")

    def _type(self, field: Field, text: str) -> None:
        """Take what was typed; what stands in the file as it is shown stays."""
        present = value_at(self._session.document.data, field.location)
        if text.strip() != field._replace(value=present).text(self._session.units):
            self._enter(field, field.read(text, self._session.units))

    def _enter(self, field: Field, value: Any) -> None:
        if self._filling:
            return
        if field.location == ("belt", "profile"):
            self._apply(edits_of_profile(self._session.document.data, value, self._session.draft.drive))
        else:
            self._apply(edits_of_value(self._session.document.data, field.location, value))

    def _give(self, location: Location, given: bool) -> None:
        if not self._filling and given != (value_at(self._session.document.data, location) is not None):
            self._apply(edits_of_group(self._session.document.data, location) if given else [Edit("remove", location)])


def _in_words(kind: str) -> str:
    """The name of a kind without underscores."""
    return kind.replace("_", " ")


def _kind_of(group: Any) -> str | None:
    kind = group.get("kind") if isinstance(group, Mapping) else None
    return kind if isinstance(kind, str) else None

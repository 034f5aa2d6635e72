"""A form on the page: a widget per row, with values and messages of the drive file."""

from collections.abc import Callable, Iterator, Mapping, Set
from typing import Any, Literal, NamedTuple

from nicegui import ui
from nicegui.elements.mixins.validation_element import ValidationElement

from beltdyn.app import placing
from beltdyn.app.beginnings import edits_of_entry, edits_of_group, edits_of_kind
from beltdyn.app.forms import Field, fields, in_units, in_words, kinds, shown, unit_in, value_at
from beltdyn.app.profile_change import edits_of_profile
from beltdyn.app.session import Session
from beltdyn.app.values_in_use import in_use
from beltdyn.parts.toml_edits import Edit, Location

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
                if isinstance(widget, ui.select):
                    widget.props["label"] = self._label(row.field)
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
        draft = self._session.draft
        value = in_use(draft.drive, draft.data, field.location)
        if field.form == "choice" and isinstance(value, str):
            return value
        if isinstance(value, bool) or not isinstance(value, int | float):
            return field.usual(units)
        size = unit_in(units, field.unit).size
        return shown(value if isinstance(value, int) else size * float(f"{value / size:.5g}"), field.unit, units)

    def _label(self, field: Field) -> str:
        """The name of a choice, with what holds where it is left open."""
        name, value = field.label, self._in_use(field)
        if not value or self._shown(field) is not None:
            return name
        return f"{name} ({'default' if value == field.default else 'in use'}: {value})"

    def _build_field(self, row: Row) -> None:
        field = row.field
        assert field is not None
        label, units = field.label, self._session.units
        usual = field.usual(units)
        if field.form == "flag":
            widget: Any = ui.checkbox(label, on_change=lambda event: self._enter(field, event.value))
        elif field.form == "choice":
            widget = ui.select(
                list(field.choices),
                label=self._label(field),
                value=self._shown(field),
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
            widget: Any = ui.checkbox(row.field.label, on_change=lambda event: self._give(row.location, event.value))
        else:
            widget = self._kinds(row, row.field.label, clearable=True)
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
            {kind: in_words(kind) for kind in row.kinds},
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
                item = ui.menu_item(in_words(kind), on_click=lambda kind=kind: add(kind))
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
            self._apply(edits_of_profile(self._session.draft, value, self._session.workspace.folder.root))
        else:
            self._apply(edits_of_value(self._session.document.data, field.location, value))

    def _give(self, location: Location, given: bool) -> None:
        if not self._filling and given != (value_at(self._session.document.data, location) is not None):
            self._apply(edits_of_group(self._session.document.data, location) if given else [Edit("remove", location)])


def _kind_of(group: Any) -> str | None:
    kind = group.get("kind") if isinstance(group, Mapping) else None
    return kind if isinstance(kind, str) else None

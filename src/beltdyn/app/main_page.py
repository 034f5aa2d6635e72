"""The page: canvas, forms, messages and numbers of one tab."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.resources import files
from typing import TYPE_CHECKING, Any

from nicegui import app, ui
from nicegui.element import Element
from nicegui.events import GenericEventArguments, KeyEventArguments

from beltdyn.app.form_view import FormView
from beltdyn.app.forms import SYSTEMS, Unit, in_units, in_words, unit_in
from beltdyn.app.pulley_table import TableDialog
from beltdyn.app.results_view import ResultsView
from beltdyn.app.scene import MILLIMETERS, groups, scene
from beltdyn.app.session import Session
from beltdyn.app.workspace import EMPTY, STARTS, Example, Workspace, examples, thumbnail
from beltdyn.errors import BeltdynError
from beltdyn.parts.toml_edits import Edit

if TYPE_CHECKING:
    from beltdyn.app.watching import Glimpse


# The canvas in the browser: shows a scene and reports actions on it


class Canvas(Element, component="canvas.js"):
    """An SVG on which pulleys are placed, dragged and sized.

    `on_act` is called with the action, the number of the pulley or tensioner, numbers in m, and whether it is done;
    `on_choose` with the number of the pulley chosen, or None.
    """

    def __init__(self, on_act: Callable[[Mapping[str, Any]], None], on_choose: Callable[[object], None]) -> None:
        super().__init__()
        self.props["scene"] = {}
        self.props["selected"] = -1
        self.props["live"] = None
        self.props["tensions"], self.props["unit"] = [], None
        self.on("act", lambda event: on_act(_told(event)))
        self.on("choose", lambda event: on_choose(_told(event).get("number")))

    def keep(self, text: str, name: str) -> None:
        """Pass the drive file to the browser, which offers it for download if the server ends."""
        self.props["text"], self.props["name"] = text, name

    def show(self, scene: Mapping[str, Any], selected: int | None) -> None:
        """Show a scene with a highlighted pulley."""
        self.props["scene"] = dict(scene)
        self.props["selected"] = -1 if selected is None else selected
        self.update()
        self.run_method("follow", None)

    def follow(self, scene: Mapping[str, Any]) -> None:
        """Show a scene during dragging, until the next call of `show`."""
        self.run_method("follow", scene)

    def watch(self, seen: "Glimpse | None") -> None:
        """Show a snapshot of a run instead of the belt at rest, or the drive again with None."""
        self.props["live"] = None if seen is None else seen.drawn
        self.update()

    def pull(self, tensions: Sequence[float]) -> None:
        """Show tensions of the spans, N, as many as there are spans; none with an empty list."""
        self.props["tensions"] = [float(one) for one in tensions]
        self.update()

    def measure(self, unit: Unit) -> None:
        """Show lengths in a unit."""
        self.props["unit"] = {"name": unit.shown, "size": MILLIMETERS * unit.size}
        self.update()

    def fit(self) -> None:
        """Show the whole drive."""
        self.run_method("fit")


def _told(event: GenericEventArguments) -> Mapping[str, Any]:
    """What the browser sent, if it is a mapping."""
    return event.args if isinstance(event.args, Mapping) else {}


# Open, save and download the drive file, and start from an example


class FileMenu:
    """The menu of the drive file; `update` is called after another drive is loaded."""

    def __init__(self, session: Session, update: Callable[[], None]) -> None:
        self._session, self._update = session, update
        for text, icon, action in (
            ("New", "note_add", self.show_gallery),
            ("Open", "folder_open", self.show_files),
            ("Save", "save", self.save),
            ("Download", "download", self.download),
        ):
            button = ui.button(text, icon=icon, on_click=action).props("flat dense no-caps")
            button.props(f'aria-label="{text}"').mark(text)

    def show_gallery(self) -> None:
        """Offer an empty drive file and the examples."""
        with self._dialog("New drive") as dialog:
            self._offer(dialog, Example("empty_canvas", "A belt without pulleys, to start from scratch.", EMPTY))
            with ui.item(on_click=lambda: self._turn_to_table(dialog)).props("clickable"), ui.item_section():
                ui.item_label("table of pulleys")
                ui.item_label("Centers and diameters from a CSV file or a spreadsheet.").props("caption")
            for one in examples():
                self._offer(dialog, one)

    def _turn_to_table(self, gallery: ui.dialog) -> None:
        gallery.close()
        self.ask_table()

    def ask_table(self) -> None:
        """Ask for a table of pulleys, in a dialog that outlives what was clicked."""
        with ui.context.client:
            TableDialog(lambda text: self._begin(lambda: self._session.start(text)))

    def _offer(self, dialog: ui.dialog, one: Example) -> None:
        def begin() -> None:
            dialog.close()
            self._begin(lambda: self._session.start(one.text))

        with ui.item(on_click=begin).props("clickable").mark(f"example:{one.name}"), ui.item_section():
            ui.item_label(in_words(one.name))
            ui.item_label(one.about).props("caption")

    def show_files(self) -> None:
        """Offer the drive files of the folder."""
        with self._dialog(f"Open a drive file in {self._session.workspace.folder.root}") as dialog:
            names = self._session.workspace.folder.files()
            if not names:
                ui.label("This folder has no drive files.")
            for name in names:
                self._offer_file(dialog, name)

    def _offer_file(self, dialog: ui.dialog, name: str) -> None:
        def begin() -> None:
            dialog.close()
            self._begin(lambda: self._session.open(name))

        with ui.item(on_click=begin).props("clickable").mark(f"file:{name}"), ui.item_section():
            ui.item_label(name)

    @contextmanager
    def _dialog(self, title: str) -> Iterator[ui.dialog]:
        """A dialog with a list, deleted when it is closed."""
        with ui.dialog(value=True) as dialog, ui.card().classes("w-full"):
            ui.label(title).classes("text-subtitle1")
            if self._session.document.changed:
                ui.label("Unsaved changes will be lost.").classes("bd-message bd-warning")
            with ui.list().classes("w-full").props("dense separator"):
                yield dialog
        dialog.on("hide", dialog.delete)

    def _begin(self, start: Callable[[], None]) -> None:
        if self._tried(start):
            self._update()

    def save(self) -> None:
        """Save under the name of the file, or ask for one."""
        if self._session.name is None or not self._tried(self._save):
            self.ask_name()

    def _save(self, name: str | None = None) -> None:
        ui.notify(f"Saved: {self._session.save(name)}", type="positive")
        self._update()

    def ask_name(self) -> None:
        """Ask for a name, and save."""
        with ui.dialog(value=True) as dialog, ui.card():
            ui.label(f"Save in {self._session.workspace.folder.root}")
            name = ui.input("file name", value=self._session.name or "drive.toml").props("autofocus").mark("file name")

            def save() -> None:
                if self._tried(lambda: self._save(name.value or "")):
                    dialog.close()

            name.on("keydown.enter", save)
            with ui.row():
                ui.button("Save", on_click=save).props("no-caps").mark("save under name")
                ui.button("Cancel", on_click=dialog.close).props("flat no-caps")
        dialog.on("hide", dialog.delete)

    def download(self) -> None:
        """Download the drive file in the browser."""
        ui.download.content(
            self._session.document.text.encode(), (self._session.name or "drive.toml").rpartition("/")[2], "text/plain"
        )

    def _tried(self, action: Callable[[], None]) -> bool:
        try:
            action()
        except BeltdynError as error:
            ui.notify(str(error), type="negative", multi_line=True, timeout=10_000, close_button="Close")
            return False
        return True


_TABS = {
    "belt": "all_inclusive",
    "pulley": "radio_button_checked",
    "tensioner": "swap_vert",
    "contact": "compress",
    "simulation": "timer",
    "limits": "speed",
    "drive": "description",
}
"""Groups of the drive file, with their icons."""
_LISTS = ("pulley", "tensioner")
_BLUE = "#1d5f9e"
"""Contrast with white 6.6."""
_TENSIONER_KINDS = ("rotary", "sliding", "fixed")


class Page:
    """The page of one tab, by default with a new session."""

    def __init__(self, workspace: Workspace) -> None:
        self.session = Session(workspace)
        self._tab = "belt"
        self._tensioner = 0

    async def build(self) -> None:
        """Build the page, with the drive of the tab before a reload."""
        ui.add_css(files("beltdyn.app").joinpath("page.css").read_text(encoding="utf-8"))
        await ui.context.client.connected()
        kept = app.storage.tab.get("session")
        if isinstance(kept, Session):
            self.session = kept
        else:
            self._begin()
        app.storage.tab["session"] = self.session
        self._build()
        self.update()

    def _begin(self) -> None:
        first = self.session.workspace.first
        if first is not None:
            try:
                self.session.open(first)
            except BeltdynError as error:
                ui.notify(str(error), type="negative", multi_line=True, timeout=0, close_button="Close")

    def _build(self) -> None:
        self._dark = ui.dark_mode(None)
        ui.colors(primary=_BLUE)
        with ui.header().classes("items-center q-py-xs gap-1 no-wrap bd-header").props("elevated=false"):
            ui.label("beltdyn").classes("bd-brand")
            self._title = ui.label().classes("ellipsis grow").mark("title")
            self._undo = self._icon("undo", "Undo (Ctrl+Z)", self.undo)
            self._redo = self._icon("redo", "Redo (Ctrl+Y)", self.redo)
            self._files = FileMenu(self.session, self.update)
            units = ui.select(dict(SYSTEMS), value=self.session.units)
            units.on_value_change(lambda event: self._measure(event.value))
            units.props('dense borderless options-dense aria-label="units"').classes("bd-units").mark("units")
            self._icon("contrast", "Light or dark", self._turn_dark)
        with ui.element("main").classes("bd-main"):
            with ui.element("div").classes("bd-forms"):
                self._build_forms()
            with ui.element("div").classes("bd-stage"):
                self._build_toolbar()
                self._canvas = Canvas(self.act, self.choose)
                self._messages = ui.column().classes("w-full gap-2 bd-messages")
                self._messages.props('role="status" aria-live="polite"')
            with ui.element("div").classes("bd-results"):
                self._results = ResultsView(self.session, self._canvas.watch, self._canvas.pull)
        self._canvas.measure(unit_in(self.session.units, "m"))
        ui.keyboard(on_key=self._key, ignore=[])

    def _icon(self, icon: str, says: str, on_click: Callable[[], None]) -> Any:
        button = ui.button(icon=icon, on_click=on_click).props(f'flat dense round aria-label="{says}"')
        return button.tooltip(says).mark(icon)

    def _build_toolbar(self) -> None:
        def tool(text: str, icon: str, on_click: Callable[[], None]) -> Any:
            return ui.button(text, icon=icon, on_click=on_click).props("flat dense no-caps size=sm").mark(text)

        with ui.row().classes("w-full items-center gap-1"):
            tool("Add pulley", "add_circle_outline", self.add_pulley)
            self._of_pulley = [
                tool("Other side", "flip", lambda: self._on_chosen("flip")),
                tool("Earlier", "arrow_back", lambda: self._on_chosen("earlier")),
                tool("Later", "arrow_forward", lambda: self._on_chosen("later")),
                tool("Remove", "delete_outline", lambda: self._on_chosen("remove")),
            ]
            tool("Fit", "fit_screen", lambda: self._canvas.fit())

    def _build_forms(self) -> None:
        with ui.tabs(on_change=lambda event: self._open_tab(event.value)) as self._tabs:
            self._tabs.props("vertical no-caps").classes("bd-tabs")
            for name, icon in _TABS.items():
                ui.tab(name, icon=icon).mark(f"tab:{name}")
        with ui.element("div").classes("bd-form"):
            self._heading = ui.label().classes("bd-heading")
            self._lists = ui.row().classes("w-full gap-1")
            self._form = FormView(self.session, self.apply)
        self._tabs.value = self._tab

    def update(self) -> None:
        """Update everything to the present drive."""
        session = self.session
        self._title.text = session.title
        self._undo.set_enabled(session.document.can_undo)
        self._redo.set_enabled(session.document.can_redo)
        for button in self._of_pulley:
            button.set_enabled(session.selected is not None)
        self._canvas.keep(session.document.text, session.name or "drive.toml")
        self._canvas.show(scene(session.draft), session.selected)
        self._update_messages()
        self._update_forms()
        self._results.update()

    def _update_messages(self) -> None:
        self._messages.clear()
        with self._messages:
            if not groups(self.session.document.data, "pulley"):
                self._invite()
                return
            if self._begins():
                ui.label("Place the next pulley: a belt runs around two or more.").classes("bd-heading-plain")
                return
            for one in self.session.draft.told:
                label = ui.label(in_units(one.sentence, self.session.units)).classes("bd-message cursor-pointer")
                label.on("click", lambda one=one: self._go_to(one.location))
        if self.session.document.lost_comments:
            self.session.document.lost_comments = False
            ui.notify("The file was rewritten without its comments. Undo restores them.", type="warning")

    def _begins(self) -> bool:
        """Whether the first pulley stands alone, and nothing is wrong but that."""
        data, told = self.session.document.data, self.session.draft.told
        alone = len(groups(data, "pulley")) == 1 and not data.get("end")
        return alone and all(len(one.location) < 2 for one in told)

    def _invite(self) -> None:
        """Say how to begin on an empty canvas."""
        with ui.row().classes("w-full items-center gap-2"):
            ui.label("Start with a drive like yours, or place the first pulley.").classes("bd-heading-plain grow")
            ui.button("Table of pulleys …", on_click=self._files.ask_table).props("flat dense no-caps")
            ui.button("Open a file …", on_click=self._files.show_files).props("flat dense no-caps")
        offered = {one.name: one for one in examples()}
        with ui.element("div").classes("bd-starts"):
            for name, title in STARTS.items():
                card = ui.element("button").props('type="button"').classes("bd-start").mark(f"start:{name}")
                card.on("click", lambda name=name: self._start(offered[name]))
                with card:
                    ui.html(thumbnail(offered[name].text), sanitize=False)
                    ui.label(title)
                    ui.tooltip(offered[name].about).classes("bd-about")

    def _start(self, one: Example) -> None:
        self.session.start(one.text)
        self.update()
        self._canvas.fit()

    def _go_to(self, location: tuple[int | str, ...]) -> None:
        """Open the form of an error."""
        if not location or location[0] not in _TABS:
            return
        if location[0] == "pulley" and len(location) > 1:
            self.session.choose(location[1])
        if location[0] == "tensioner" and len(location) > 1:
            self._tensioner = int(location[1])
        self._tabs.value = str(location[0])
        self.update()

    def _update_forms(self) -> None:
        self._heading.text = self._tab
        self._lists.clear()
        if self._tab in _LISTS:
            with self._lists:
                (self._list_pulleys if self._tab == "pulley" else self._list_tensioners)()
        self._form.show(self._location())

    def _location(self) -> tuple[int | str, ...] | None:
        """Location of the group of the form."""
        if self._tab == "drive":
            return ()
        if self._tab == "pulley":
            return None if self.session.selected is None else ("pulley", self.session.selected)
        if self._tab == "tensioner":
            count = len(groups(self.session.document.data, "tensioner"))
            self._tensioner = min(self._tensioner, count - 1) if count else 0
            return ("tensioner", self._tensioner) if count else None
        return (self._tab,)

    def _list_pulleys(self) -> None:
        for number, one in enumerate(groups(self.session.document.data, "pulley")):
            chosen = number == self.session.selected
            button = ui.button(str(one.get("name", number + 1)), on_click=lambda number=number: self.choose(number))
            button.props(f"dense no-caps unelevated size=sm {'' if chosen else 'flat'}")
        if self.session.selected is None:
            ui.label("Select a pulley here or on the canvas.").classes("text-caption")

    def _list_tensioners(self) -> None:
        listed = groups(self.session.document.data, "tensioner")
        for number, one in enumerate(listed):
            name = f"{one.get('kind', '?')}: {one.get('pulley', '?')}"
            button = ui.button(name, on_click=lambda number=number: self._choose_tensioner(number))
            button.props(f"dense no-caps unelevated size=sm {'' if number == self._tensioner else 'flat'}")
        with ui.button("add tensioner", icon="add").props("flat dense no-caps size=sm"), ui.menu():
            for kind in _TENSIONER_KINDS:
                ui.menu_item(kind, on_click=lambda kind=kind: self.add_tensioner(kind)).mark(f"add:tensioner:{kind}")
        if listed:
            button = ui.button("remove", icon="delete_outline", on_click=self._remove_tensioner)
            button.props("flat dense no-caps size=sm").mark("remove:tensioner")

    def _choose_tensioner(self, number: int) -> None:
        self._tensioner = number
        self.update()

    def add_tensioner(self, kind: str) -> None:
        """Add a tensioner that carries the chosen pulley."""
        self._tensioner = len(groups(self.session.document.data, "tensioner"))
        self.apply(self.session.new_tensioner(kind))

    def _remove_tensioner(self) -> None:
        self.apply([Edit("remove", ("tensioner", self._tensioner))])

    def _measure(self, system: Any) -> None:
        """Show lengths, speeds and forces in other units."""
        self.session.units = system
        self._canvas.measure(unit_in(system, "m"))
        self._update_messages()
        self._form.rebuild()
        self._results.redraw()

    def _open_tab(self, name: str) -> None:
        self._tab = name
        self._update_forms()

    def apply(self, edits: list[Edit]) -> None:
        """Change the drive file, and update the page."""
        self.session.apply(edits)
        self.update()

    def act(self, told: Mapping[str, Any]) -> None:
        """Apply an action on the canvas; during a drag only preview it."""
        edits = self.session.edits_of(told.get("action"), told)
        if told.get("done"):
            self.session.apply(edits)
            if told.get("action") == "add":
                self._tabs.value = "pulley"
            self.update()
        else:
            self._canvas.follow(scene(self.session.preview(edits), settled=False))

    def choose(self, number: object) -> None:
        """Select a pulley, and open its form."""
        self.session.choose(number)
        if self.session.selected is not None:
            self._tabs.value = "pulley"
        self.update()

    def add_pulley(self) -> None:
        """Add a pulley beside the existing ones."""
        left, _, right, bottom = scene(self.session.draft)["extent"]
        count = len(groups(self.session.document.data, "pulley"))
        x = (right + 0.35 * (right - left) if count else (left + right) / 2) / 1e3
        middle = 0.0 if not count else -bottom / 1e3 + 0.1
        self.act({"action": "add", "x": round(x, 3), "y": round(middle, 3), "done": True})

    def _on_chosen(self, action: str) -> None:
        self.act({"action": action, "number": self.session.selected, "done": True})

    def undo(self) -> None:
        """Undo the last change."""
        self.session.undo()
        self.update()

    def redo(self) -> None:
        """Redo the undone change."""
        self.session.redo()
        self.update()

    def _key(self, event: KeyEventArguments) -> None:
        if not event.action.keydown or not (event.modifiers.ctrl or event.modifiers.meta):
            return
        if event.key == "z" and not event.modifiers.shift:
            self.undo()
        elif event.key in ("y", "Z", "z"):
            self.redo()

    def _turn_dark(self) -> None:
        self._dark.value = not self._dark.value

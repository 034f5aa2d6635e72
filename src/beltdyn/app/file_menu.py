"""Open, save and download the drive file, and start from an example."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from nicegui import ui

from beltdyn.app.session import Session
from beltdyn.app.workspace import EMPTY, Example, examples
from beltdyn.errors import BeltdynError


class FileMenu:
    """The menu of the drive file.

    Parameters
    ----------
    session : Session
        The drive.
    update : callable
        Called after another drive is loaded.
    """

    def __init__(self, session: Session, update: Callable[[], None]) -> None:
        self._session, self._update = session, update
        for text, icon, action in (
            ("New", "note_add", self.show_gallery),
            ("Open", "folder_open", self.show_files),
            ("Save", "save", self.save),
            ("Download", "download", self.download),
        ):
            button = ui.button(text, icon=icon, on_click=action).props("flat dense no-caps color=white")
            button.props(f'aria-label="{text}"').mark(text)

    def show_gallery(self) -> None:
        """Offer an empty drive file and the examples."""
        with self._dialog("New drive") as dialog:
            self._offer(dialog, Example("empty_canvas", "A belt without pulleys, to start from scratch.", EMPTY))
            for one in examples():
                self._offer(dialog, one)

    def _offer(self, dialog: ui.dialog, one: Example) -> None:
        def begin() -> None:
            dialog.close()
            self._begin(lambda: self._session.start(one.text))

        with ui.item(on_click=begin).props("clickable").mark(f"example:{one.name}"), ui.item_section():
            ui.item_label(one.name.replace("_", " "))
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

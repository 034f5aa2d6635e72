"""The dialog in which a table of pulleys is pasted, or read out of a CSV file."""

from collections.abc import Callable

from nicegui import ui
from nicegui.events import UploadEventArguments

from beltdyn.app.pulley_table import EXAMPLE, drive_from_table
from beltdyn.errors import ModelError
from beltdyn.parts.table_file import decoded
from beltdyn.parts.text_file import LONGEST_TABLE

_ABOUT = (
    "Paste cells of a spreadsheet, or choose a CSV file: a line for each pulley, in the order in which the belt meets "
    "them. Lengths are in mm unless a heading or a row of units says otherwise; further columns are inertia, speed and "
    "torque."
)


class TableDialog:
    """Opens at once; `begin` is called with the text of the drive file."""

    def __init__(self, begin: Callable[[str], None]) -> None:
        self._begin = begin
        with ui.dialog(value=True) as self._dialog, ui.card().classes("bd-dialog"):
            ui.label("Drive from a table of pulleys").classes("bd-heading-plain")
            ui.label(_ABOUT).classes("bd-state")
            self._table = ui.textarea(placeholder=EXAMPLE).classes("w-full bd-code").mark("pasted")
            self._table.props('outlined autofocus rows=9 aria-label="table of pulleys"')
            self._told = ui.label().classes("bd-message").mark("wrong-table")
            self._told.set_visibility(False)
            with ui.row().classes("w-full items-center gap-2"):
                ui.button("Use", on_click=self._use).props("no-caps unelevated").mark("use-table")
                ui.button("Cancel", on_click=self._dialog.close).props("flat no-caps")
                ui.space()
                file = ui.upload(on_upload=self._read, auto_upload=True, max_file_size=LONGEST_TABLE)
                file.props('accept=".csv,.txt,.tsv"').classes("hidden").mark("table-file")
                pick = ui.button("CSV file …", icon="upload_file", on_click=lambda: file.run_method("pickFiles"))
                pick.props("flat no-caps")
        self._dialog.on("hide", self._dialog.delete)

    async def _read(self, event: UploadEventArguments) -> None:
        try:
            self._table.value = decoded(await event.file.read())
            self._told.set_visibility(False)
        except UnicodeDecodeError:
            self._say(f"{event.file.name} is not a text file. Save it as CSV in UTF-8.")

    def _use(self) -> None:
        try:
            text = drive_from_table(self._table.value or "")
        except ModelError as error:
            self._say(str(error))
            return
        self._dialog.close()
        self._begin(text)

    def _say(self, wrong: str) -> None:
        self._told.text = wrong
        self._told.set_visibility(True)

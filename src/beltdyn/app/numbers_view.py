"""Numbers of the drive at rest, below the canvas: the tables of `beltdyn check`."""

from nicegui import ui

from beltdyn.app.session import Session
from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, install
from beltdyn.results.rest_sheet import rest_sheet
from beltdyn.results.sheet_parts import Facts, Table


class NumbersView:
    """The tables below the canvas.

    Parameters
    ----------
    session : Session
        The drive.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._box = ui.column().classes("w-full gap-2 bd-tables").mark("numbers")

    def update(self) -> None:
        """Show the numbers of the drive as it stands; nothing where it is wrong."""
        self._box.clear()
        drive = self._session.draft.drive
        if drive is None:
            return
        with self._box:
            try:
                self._show(drive)
            except BeltdynError as error:
                ui.label(str(error)).classes("bd-message")

    def _show(self, drive: Drive) -> None:
        for part in rest_sheet(drive, drive, install(drive)).parts:
            show_part(part)


def show_part(part: Table | Facts) -> None:
    """Show a part of a sheet."""
    if part.title:
        ui.label(part.title).classes("text-weight-medium q-mt-sm")
    with ui.element("table").classes("bd-table" if isinstance(part, Table) else "bd-table bd-facts"):
        if isinstance(part, Table):
            _row("th", part.headings)
        for row in part.rows if isinstance(part, Table) else part.facts:
            _row("td", row)


def _row(tag: str, cells: tuple[str, ...]) -> None:
    with ui.element("tr"):
        for cell in cells:
            with ui.element(tag):
                ui.label(cell)

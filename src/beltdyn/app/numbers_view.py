"""Numbers below the canvas, updated with each change: rest, steady running and modes."""

import time
from collections.abc import Iterable, Sequence
from html import escape
from uuid import uuid4

from nicegui import background_tasks, ui

from beltdyn.app.computing import PREPARING, Answer, Asked, Calculator
from beltdyn.app.session import Session
from beltdyn.errors import BeltdynError
from beltdyn.model import estimate_at_rest, prepare
from beltdyn.show.rest_sheet import rest_sheet
from beltdyn.show.sheet import Facts, Table

# Tables and facts of a sheet on the page


def show_parts(parts: Iterable[Table | Facts]) -> None:
    """Show the parts of a sheet one below the other."""
    for part in parts:
        if part.title:
            ui.label(part.title).classes("text-weight-medium q-mt-sm")
        ui.html(table_html(part), sanitize=False).classes("bd-tables")


def table_html(part: Table | Facts) -> str:
    """A table or facts as HTML; all text is escaped."""
    if isinstance(part, Table):
        head, rows, kind = f"<thead>{_row('th', part.headings)}</thead>", part.rows, "bd-table"
    else:
        head, rows, kind = "", part.facts, "bd-table bd-facts"
    return f'<table class="{kind}">{head}<tbody>{"".join(_row("td", row) for row in rows)}</tbody></table>'


def _row(tag: str, cells: Sequence[str]) -> str:
    return f"<tr>{''.join(f'<{tag}>{escape(cell)}</{tag}>' for cell in cells)}</tr>"


_TITLES = {"rest": "At rest", "running": "Running", "modes": "Modes"}
_PERCENT, _MINUTE = 0.01, 60.0
_OFTEN, _SOON = 0.5, 2.0
"""Polling interval of a pending answer, and delay before its state is shown, s."""


class Slider(ui.slider):
    """A slider moved by the browser at once; that of the library waits for the server and loses keys."""

    LOOPBACK = False


class NumbersView:
    """The tables below the canvas; without a calculator, estimates at rest alone."""

    def __init__(self, session: Session, calculator: Calculator | None) -> None:
        self._session, self._calculator = session, calculator
        self._tab = uuid4().hex
        self._wanted: Asked | None = None
        self._busy = False
        self._shown: Asked | None = None
        if calculator is not None:
            with ui.row().classes("w-full items-center gap-3"):
                self._what = ui.toggle(dict(_TITLES), value="rest", on_change=self.update).props("dense no-caps flat")
                self._what.mark("what")
                self._sliders = ui.row().classes("items-center gap-2 grow")
                with self._sliders:
                    self._speed = self._slider("speed", 10, 200)
                    self._load = self._slider("load", 0, 200)
                self._state = ui.label().classes("text-caption").props('role="status"').mark("state")
        self._box = ui.column().classes("w-full gap-2 bd-tables").mark("numbers")
        self._begun = 0.0
        self._timer = ui.timer(_OFTEN, self._say_why, active=False)

    def _slider(self, name: str, low: int, high: int) -> Slider:
        with ui.row().classes("items-center gap-2 no-wrap"):
            label = ui.label().classes("text-caption").style("min-width: 7em")
            slider = Slider(min=low, max=high, value=100, step=5, on_change=self.update)
        slider.props(f'dense aria-label="{name} in percent of the drive file"').style("width: 130px").mark(name)
        label.bind_text_from(slider, "value", lambda value: f"{name} {value:g} %")
        return slider

    def update(self) -> None:
        """Show the numbers of the present drive; nothing for an invalid one."""
        session = self._session
        what = "rest" if self._calculator is None else str(self._what.value)
        if self._calculator is not None:
            self._sliders.set_visibility(what != "rest")
        if session.draft.drive is None:
            self._wanted = self._shown = None
            self._box.clear()
            self._say("")
            return
        factors = (1.0, 1.0)
        if self._calculator is not None and what != "rest":
            factors = (_PERCENT * float(self._speed.value), _PERCENT * float(self._load.value))
        asked = Asked(what, self._tab, session.document.text, session.workspace.folder.root, *factors)
        if asked == self._shown:
            return
        self._shown = asked
        if what == "rest":
            self._estimate()
        if self._calculator is not None:
            self._wanted = asked
            self._say("computing …")
            if not self._busy:
                self._busy = self._timer.active = True
                background_tasks.create(self._work(self._calculator))

    def _estimate(self) -> None:
        """Show at once what is known by hand."""
        drive = self._session.draft.drive
        assert drive is not None
        try:
            prepared, found = estimate_at_rest(prepare(drive))
            parts, told = rest_sheet(drive, prepared.drive, found, computed=False).parts, ""
        except BeltdynError as error:
            parts, told = (), str(error)
        self._show(Answer(parts, (), told, 0.0))

    async def _work(self, calculator: Calculator) -> None:
        """Answer the latest question, until there is none."""
        try:
            while (asked := self._wanted) is not None:
                self._wanted, self._begun = None, time.perf_counter()
                answer = await calculator.ask(asked)
                if asked == self._shown and not self._box.is_deleted:
                    self._show(answer)
                    seconds = f"{answer.seconds:.2g}" if answer.seconds < _MINUTE else f"{answer.seconds:.0f}"
                    self._say(f"{_TITLES[asked.what].lower()}, computed in {seconds} s")
        finally:
            self._busy = self._timer.active = False

    def _say_why(self) -> None:
        """Say what an answer waits for that is not there soon."""
        waited = time.perf_counter() - self._begun
        if self._busy and self._calculator is not None and self._shown is not None and waited > _SOON:
            what = PREPARING if self._calculator.preparing else "computing …"
            self._say(f"{what}: {waited:.0f} s")

    def _say(self, text: str) -> None:
        if self._calculator is not None:
            self._state.text = text

    def _show(self, answer: Answer) -> None:
        self._box.clear()
        with self._box:
            if answer.error:
                ui.label(answer.error).classes("bd-message")
            show_parts(answer.parts)
            for warning in answer.warnings:
                ui.label(warning).classes("bd-message bd-warning")

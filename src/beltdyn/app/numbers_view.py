"""Numbers beside the canvas, updated with each change: rest, steady running and modes."""

import time
from collections.abc import Callable, Iterable, Sequence
from html import escape
from typing import Any
from uuid import uuid4

from nicegui import background_tasks, ui
from nicegui.events import ValueChangeEventArguments

from beltdyn.app.charts import charts
from beltdyn.app.computing import Answer, Asked, Calculator, in_words
from beltdyn.app.findings import Findings, at_rest
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


TITLES = {"rest": "At rest", "running": "Running", "modes": "Modes"}
_PERCENT, _MINUTE = 0.01, 60.0
_OFTEN, _SOON = 0.5, 2.0
"""Polling interval of a pending answer, and delay before its state is shown, s."""


class Slider(ui.slider):
    """A slider moved by the browser at once; that of the library waits for the server and loses keys."""

    LOOPBACK = False


def show_findings(found: Findings, session: Session) -> None:
    """Show figures and charts in the units of the page."""
    drawn = charts(found, session.units)
    if drawn:
        ui.html(drawn, sanitize=False).classes("w-full bd-findings")


class NumbersView:
    """Numbers of rest, running or modes; without a calculator, estimates at rest alone.

    `tell` is called with the tensions of the spans, which the canvas shows; with none where they are not known.
    """

    def __init__(
        self, session: Session, calculator: Calculator | None, tell: Callable[[tuple[float, ...]], None]
    ) -> None:
        self._session, self._calculator, self._tell = session, calculator, tell
        self._tab = uuid4().hex
        self._what = "rest"
        self._wanted: Asked | None = None
        self._busy = False
        self._shown: Asked | None = None
        self._answer: Answer | None = None
        self._all_open = False
        if calculator is not None:
            self._sliders = ui.row().classes("w-full items-center no-wrap gap-4")
            with self._sliders:
                self._speed = self._slider("speed", 10, 200)
                self._load = self._slider("load", 0, 200)
            self._bar = ui.linear_progress(value=0.0, show_value=False).props('instant-feedback aria-label="progress"')
            self._state = ui.label().classes("bd-state").props('role="status"').mark("state")
        self._box = ui.column().classes("w-full gap-2").mark("numbers")
        self._begun = 0.0
        self._timer = ui.timer(_OFTEN, self._say_why, active=False)

    def _slider(self, name: str, low: int, high: int) -> Slider:
        with ui.column().classes("gap-0 grow"):
            label = ui.label().classes("bd-state")
            slider = Slider(min=low, max=high, value=100, step=5, on_change=self.update)
        slider.props(f'dense aria-label="{name} in percent of the drive file"').classes("w-full").mark(name)
        label.bind_text_from(slider, "value", lambda value: f"{name} {value:g} %")
        return slider

    def choose(self, what: str) -> None:
        """Show rest, running or modes."""
        self._what = what
        self.update()

    def update(self) -> None:
        """Show the numbers of the present drive; nothing for an invalid one."""
        session, what = self._session, self._what
        if self._calculator is not None:
            self._sliders.set_visibility(what != "rest" and session.draft.drive is not None)
        if session.draft.drive is None:
            self._wanted = self._shown = self._answer = None
            self._box.clear()
            self._tell(())
            self._say("")
            if not session.document.data.get("pulley"):
                with self._box:
                    ui.label("Tensions, hub loads and frequencies appear here with the first belt.").classes("bd-state")
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

    def redraw(self) -> None:
        """Show the present answer anew, as in other units."""
        if self._answer is not None:
            self._show(self._answer)

    def _estimate(self) -> None:
        """Show at once what is known by hand."""
        drive = self._session.draft.drive
        assert drive is not None
        parts: tuple[Table | Facts, ...] = ()
        told, shown = "", Findings()
        try:
            prepared, found = estimate_at_rest(prepare(drive))
            parts = rest_sheet(drive, prepared.drive, found, computed=False).parts
            shown = at_rest(prepared.drive, found)
        except BeltdynError as error:
            told = str(error)
        self._show(Answer(parts, (), told, 0.0, shown))

    async def _work(self, calculator: Calculator) -> None:
        """Answer the latest question, until there is none."""
        try:
            while (asked := self._wanted) is not None:
                self._wanted, self._begun = None, time.perf_counter()
                answer = await calculator.ask(asked)
                if asked == self._shown and not self._box.is_deleted:
                    self._show(answer)
                    seconds = f"{answer.seconds:.2g}" if answer.seconds < _MINUTE else f"{answer.seconds:.0f}"
                    self._say(f"{TITLES[asked.what].lower()}, computed in {seconds} s")
        finally:
            self._busy = self._timer.active = False
            if not self._bar.is_deleted:
                self._bar.set_visibility(False)

    def _say_why(self) -> None:
        """Say what an answer waits for that is not there soon."""
        waited = time.perf_counter() - self._begun
        if not (self._busy and self._calculator is not None and self._shown is not None):
            return
        counted = self._calculator.compiling
        self._bar.props(remove="indeterminate") if counted else self._bar.props("indeterminate")
        self._bar.set_visibility(counted is not None or waited > _SOON)
        if counted:
            self._bar.value = counted[0] / counted[1]
            self._say(in_words(counted))
        elif waited > _SOON:
            self._say(f"computing …: {waited:.0f} s")

    def _say(self, text: str) -> None:
        if self._calculator is not None:
            self._state.text = text
            if not self._busy:
                self._bar.set_visibility(False)

    def _show(self, answer: Answer) -> None:
        self._answer = answer
        self._tell(answer.findings.tensions)
        self._box.clear()
        with self._box:
            if answer.error:
                ui.label(answer.error).classes("bd-message")
            for warning in answer.warnings:
                ui.label(warning).classes("bd-message bd-warning")
            show_findings(answer.findings, self._session)
            if answer.parts:
                with ui.expansion("All numbers", value=self._all_open).classes("w-full bd-all") as all_numbers:
                    show_parts(answer.parts)
                all_numbers.props("dense").mark("all numbers").on_value_change(self._keep_open)

    def _keep_open(self, event: ValueChangeEventArguments[Any]) -> None:
        self._all_open = bool(event.value)

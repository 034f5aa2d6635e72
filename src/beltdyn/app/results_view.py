"""Results beside the canvas: numbers that follow each change, and analyses."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from nicegui import ui

from beltdyn.app.analysis_view import AnalysisView
from beltdyn.app.numbers_view import TITLES, NumbersView
from beltdyn.app.session import Session

if TYPE_CHECKING:
    from beltdyn.app.watching import Glimpse

_ANALYSES = "analyses"


class ResultsView:
    """The panel of results; `watch` is called with snapshots of a run, `tell` with tensions of the spans at rest."""

    def __init__(
        self,
        session: Session,
        watch: Callable[["Glimpse | None"], None],
        tell: Callable[[tuple[float, ...]], None],
    ) -> None:
        self._session = session
        calculator = session.workspace.calculator
        titles = TITLES if calculator is not None else {"rest": TITLES["rest"]}
        first = _ANALYSES if session.job is not None else "rest"
        self._what = ui.toggle(titles | {_ANALYSES: "Analyses"}, value=first).props("no-caps unelevated spread")
        self._what.classes("w-full bd-switch").mark("what").on_value_change(lambda event: self._choose(event.value))
        with ui.column().classes("w-full gap-2") as self._first:
            self._numbers = NumbersView(session, calculator, tell)
        with ui.column().classes("w-full gap-2") as self._second:
            self._analyses = AnalysisView(session, watch)
        self._choose(first)

    def update(self) -> None:
        """Update everything to the present drive."""
        self._numbers.update()
        self._analyses.update()

    def redraw(self) -> None:
        """Show what is there in other units."""
        self._numbers.redraw()
        self._analyses.redraw()

    def _choose(self, what: str) -> None:
        self._first.set_visibility(what != _ANALYSES)
        self._second.set_visibility(what == _ANALYSES)
        if what != _ANALYSES:
            self._numbers.choose(what)

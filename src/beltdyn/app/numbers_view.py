"""Numbers beside the canvas, updated with each change: rest, steady running and modes."""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from html import escape
from typing import Any
from uuid import uuid4

from nicegui import background_tasks, ui
from nicegui.events import ValueChangeEventArguments

from beltdyn.app.computing import Answer, Asked, Calculator, in_words
from beltdyn.app.findings import Around, Column, Figure, Findings, Rows, Shape, at_rest
from beltdyn.app.forms import System, in_units, unit_in
from beltdyn.app.session import Session
from beltdyn.errors import BeltdynError
from beltdyn.model import estimate_at_rest, prepare
from beltdyn.parts.text_file import shorten
from beltdyn.show.rest_sheet import limitations, rest_sheet
from beltdyn.show.tables import Facts, Table

_WIDTH, _HEIGHT = 400.0, 165.0
"""Size of the chart of tensions, in its own units."""
_LEFT, _RIGHT, _TOP, _BASE = 40.0, 394.0, 28.0, 143.0
"""Edges of the area of the curve, in units of the chart: names stand above it, numbers to its left, and words below."""
_NAME_LINES = (11.0, 22.0)
"""Heights of the two lines of pulley names, in units of the chart: names close together alternate between them."""
_MAX_NAME_LENGTH = 14
"""Letters of the name of a pulley at most: longer names are shortened, as the chart is narrow."""
_TICK_INTERVALS = 4
"""Intervals between the rules of the tension axis, at most before it is extended to whole steps."""
_LETTER_WIDTH = 5.6
"""Mean width of a letter, in units of the chart, by which the room for a name is estimated."""
_MAX_PLAIN_THOUSANDS = 1e4
"""Size of a number from which on it is written as a power of ten, in thousands: below, it has at most seven digits."""


def charts(found: Findings, system: System) -> str:
    """All that is shown of some findings, one below the other."""
    parts = [_figures(found.figures, system)]
    if found.around is not None:
        parts.append(_section("Tension around the belt, N", tension_chart(found.around, system)))
    if found.shapes:
        shapes = "".join(map(_shape, found.shapes))
        parts.append(_section("Mode shapes, at their largest displacement", f'<div class="bd-shapes">{shapes}</div>'))
    parts += [_section(one.title, _table(one, system)) for one in found.rows]
    return "".join(parts)


def number_in(value: float, unit: str, system: System) -> tuple[str, str]:
    """A number and its unit as they are shown."""
    if not math.isfinite(value):
        return "–", ""
    if unit == "%":
        return f"{100.0 * value:.3g}", "%"
    if unit == "W":
        return (_digits(value / 1e3), "kW") if abs(value) >= 1e3 else (_digits(value), "W")
    shown = unit_in(system, unit)
    return _digits(value / shown.size), shown.shown


def _digits(value: float) -> str:
    """A number with three or four digits, and never as a power of ten where it is a usual one."""
    if abs(value) >= 1e3:
        return f"{value:.0f}" if abs(value) < _MAX_PLAIN_THOUSANDS * 1e3 else f"{value:.3g}"
    return f"{value:.3g}"


def _section(title: str, content: str) -> str:
    return f'<section><h3 class="bd-title">{escape(title)}</h3>{content}</section>'


def _figures(figures: Iterable[Figure], system: System) -> str:
    """The numbers that count, side by side."""
    cards = []
    for one in figures:
        number, unit = number_in(one.value, one.unit, system)
        of = f'<div class="bd-of">{escape(one.of)}</div>' if one.of else ""
        cards.append(
            f'<div class="bd-figure"><div class="bd-name">{escape(one.name)}</div>'
            f'<div class="bd-number">{number}<span> {unit}</span></div>{of}</div>'
        )
    return f'<div class="bd-figures">{"".join(cards)}</div>' if cards else ""


class _Axes:
    """Where places along the belt and tensions are drawn."""

    def __init__(self, around: Around) -> None:
        self.end = around.places[-1] or 1.0
        self.low, self.high, self.step = _nice(min(around.tensions), max(around.tensions))
        self.base = self.y(self.low)

    def x(self, place: float) -> float:
        return _LEFT + (_RIGHT - _LEFT) * min(place / self.end, 1.0)

    def y(self, tension: float) -> float:
        return _BASE - (_BASE - _TOP) * (tension - self.low) / (self.high - self.low)


def tension_chart(around: Around, system: System) -> str:
    """The tension around the belt, with the arcs on pulleys shaded."""
    axes = _Axes(around)
    points = zip(around.places, around.tensions, strict=True)
    curve = "L".join(f"{axes.x(place):.1f} {axes.y(tension):.1f}" for place, tension in points)
    ends = [f"{axes.x(place):.1f} {axes.base:.1f}" for place in (around.places[0], axes.end)]
    length = " ".join(number_in(axes.end, "m", system))
    parts = [
        *_arcs(around, axes),
        *_rules(axes),
        f'<path class="bd-under" d="M{ends[0]}L{curve}L{ends[1]}Z"/>',
        f'<path class="bd-line" d="M{curve}"/>',
        f'<text class="bd-tick" x="{_LEFT}" y="{_HEIGHT - 6}">along the belt</text>',
        f'<text class="bd-tick" x="{_RIGHT}" y="{_HEIGHT - 6}" text-anchor="end">{length}</text>',
    ]
    told = f"Tension around the belt, from {min(around.tensions):.0f} to {max(around.tensions):.0f} N"
    return _svg(f"0 0 {_WIDTH:g} {_HEIGHT:g}", "bd-chart", told, parts)


def _arcs(around: Around, axes: _Axes) -> Iterator[str]:
    """The arcs on pulleys, and the names that have room."""
    taken = [-math.inf] * len(_NAME_LINES)
    for name, begin, stop in around.arcs:
        left, right = axes.x(begin), axes.x(stop)
        size = f'width="{right - left:.1f}" height="{axes.base - _TOP}"'
        yield f'<rect class="bd-arc" x="{left:.1f}" y="{_TOP}" {size}/>'
        label = shorten(name, _MAX_NAME_LENGTH)
        half = 0.5 * _LETTER_WIDTH * len(label)
        middle = min(max(0.5 * (left + right), _LEFT + half), _RIGHT - half)
        line = next((number for number, end in enumerate(taken) if middle - half > end), None)
        if line is not None:
            taken[line] = middle + half
            at = f'x="{middle:.1f}" y="{_NAME_LINES[line]}"'
            yield f'<text class="bd-tick" {at} text-anchor="middle">{escape(label)}</text>'


def _rules(axes: _Axes) -> Iterator[str]:
    """Lines of equal tension, with their numbers."""
    for count in range(round((axes.high - axes.low) / axes.step) + 1):
        tension = axes.low + count * axes.step
        yield f'<path class="bd-rule" d="M{_LEFT} {axes.y(tension):.1f}H{_RIGHT}"/>'
        at = f'x="{_LEFT - 5}" y="{axes.y(tension) + 3.5:.1f}"'
        yield f'<text class="bd-tick" {at} text-anchor="end">{tension:g}</text>'


def _svg(box: str, kind: str, told: str, parts: Sequence[str]) -> str:
    return f'<svg class="{kind}" viewBox="{box}" role="img" aria-label="{escape(told)}">{"".join(parts)}</svg>'


def _nice(least: float, largest: float) -> tuple[float, float, float]:
    """Limits of an axis from zero, or from below where there is less, and the step of its numbers."""
    low, high = min(least, 0.0), max(largest, 1e-9)
    rough = (high - low) / _TICK_INTERVALS
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(one * power for one in (1.0, 2.0, 2.5, 5.0, 10.0) if one * power >= rough * 0.999)
    return math.floor(low / step) * step, math.ceil(1.02 * high / step) * step, step


def _table(rows: Rows, system: System) -> str:
    """Numbers with a bar below each."""
    heads = "".join(f"<th>{escape(one.name)}{_in(one, system)}</th>" for one in rows.columns)
    largest = [max((abs(value) for value in one.values if math.isfinite(value)), default=0.0) for one in rows.columns]
    lines = []
    for place, name in enumerate(rows.names):
        cells = "".join(
            _cell(one, one.values[place], most, system) for one, most in zip(rows.columns, largest, strict=True)
        )
        lines.append(f"<tr><td>{escape(name)}</td>{cells}</tr>")
    return f'<table class="bd-bars"><thead><tr><th></th>{heads}</tr></thead><tbody>{"".join(lines)}</tbody></table>'


def _in(column: Column, system: System) -> str:
    """The unit of a column, in its heading."""
    if not column.unit:
        return ""
    return f"<span>{'%' if column.unit == '%' else unit_in(system, column.unit).shown}</span>"


def _cell(column: Column, value: float, most: float, system: System) -> str:
    if not math.isfinite(value):
        return '<td class="bd-none">–</td>'
    number = number_in(value, column.unit, system)[0]
    share = abs(value) / most if most else 0.0
    kind = "bd-bar bd-low" if value < column.least else "bd-bar"
    return f'<td>{number}<div class="{kind}" style="width:{100.0 * share:.0f}%"></div></td>'


def _shape(one: Shape) -> str:
    """A mode: the drive at rest, pale, and displaced."""
    left, top, width, height = one.extent
    parts = [f'<path class="bd-rest" d="{one.rest}"/>']
    for x, y, radius, angle in one.pulleys:
        turned = f"rotate({angle:.2f} {x:.1f} {y:.1f})"
        parts.append(f'<circle class="bd-hubs" cx="{x:.1f}" cy="{y:.1f}" r="{radius:.1f}"/>')
        parts.append(
            f'<path class="bd-hubs" transform="{turned}" d="M{x - radius:.1f} {y:.1f}h{2 * radius:.1f}'
            f'M{x:.1f} {y - radius:.1f}v{2 * radius:.1f}"/>'
        )
    parts.append(f'<path class="bd-line" d="{one.belt}"/>')
    told = f"Mode at {one.frequency:.4g} Hz, {one.about}"
    picture = _svg(f"{left:.1f} {top:.1f} {width:.1f} {height:.1f}", "bd-mode", told, parts)
    return (
        f'<div class="bd-shape">{picture}<div class="bd-number">{one.frequency:.4g}<span> Hz</span></div>'
        f'<div class="bd-of">damping ratio {one.damping:.2%}</div><div class="bd-of">{escape(one.about)}</div></div>'
    )


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
_PERCENT = 0.01
"""One percent: the sliders of speed and load are in %, their factors are not."""
_MINUTE = 60.0
"""One minute, s: computing times from it on are shown in whole seconds."""
_POLLING_INTERVAL, _BUSY_DELAY = 0.5, 2.0
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
        self._timer = ui.timer(_POLLING_INTERVAL, self._say_why, active=False)

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
            self._box.classes(remove="bd-old").clear()
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
        if self._shown is not None and asked.text != self._shown.text:
            self._box.classes(add="bd-old")
            self._tell(())
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
        told, warnings, shown = "", tuple[str, ...](), Findings()
        try:
            prepared, found = estimate_at_rest(prepare(drive))
            parts = rest_sheet(drive, prepared.drive, found, computed=False).parts
            warnings, shown = tuple(limitations(found)), at_rest(prepared.drive, found)
        except BeltdynError as error:
            told = str(error)
        self._show(Answer(parts, warnings, told, 0.0, shown))

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
        self._bar.set_visibility(counted is not None or waited > _BUSY_DELAY)
        if counted:
            self._bar.value = counted[0] / counted[1]
            self._say(in_words(counted))
        elif waited > _BUSY_DELAY:
            self._say(f"computing …: {waited:.0f} s")

    def _say(self, text: str) -> None:
        if self._calculator is not None:
            self._state.text = text
            if not self._busy:
                self._bar.set_visibility(False)

    def _show(self, answer: Answer) -> None:
        self._answer = answer
        self._tell(answer.findings.tensions)
        self._box.classes(remove="bd-old").clear()
        with self._box:
            if answer.error:
                ui.label(in_units(answer.error, self._session.units)).classes("bd-message")
            for warning in answer.warnings:
                ui.label(in_units(warning, self._session.units)).classes("bd-message bd-warning")
            show_findings(answer.findings, self._session)
            if answer.parts:
                with ui.expansion("All numbers", value=self._all_open).classes("w-full bd-all") as all_numbers:
                    show_parts(answer.parts)
                all_numbers.props("dense").mark("all numbers").on_value_change(self._keep_open)

    def _keep_open(self, event: ValueChangeEventArguments[Any]) -> None:
        self._all_open = bool(event.value)

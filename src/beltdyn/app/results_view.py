"""Results beside the canvas: numbers that follow each change, and analyses."""

import json
import math
import re
from collections.abc import Callable
from functools import cache, partial
from inspect import Parameter
from pathlib import Path
from tempfile import mkdtemp
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import quote

from docstring_parser import parse
from nicegui import app, ui

from beltdyn.analyses import ANALYSES, SIMULATE
from beltdyn.app.computing import COMPILING
from beltdyn.app.forms import in_units, in_words
from beltdyn.app.jobs import Job, Outcome
from beltdyn.app.numbers_view import TITLES, NumbersView, show_findings, show_parts
from beltdyn.app.scene import groups
from beltdyn.app.session import Session
from beltdyn.errors import BeltdynError, ModelError
from beltdyn.model import Drive
from beltdyn.parts import options
from beltdyn.parts.quantity import RPM
from beltdyn.parts.text_file import shorten
from beltdyn.show.tables import Facts

if TYPE_CHECKING:
    from beltdyn.app.watching import Glimpse


# Analyses offered by the page, with the options of their functions

_CHECKPOINT = "checkpoint"
"""An option that is not needed: runs of the page are not resumed."""
_SUFFIXES = {"table": (".csv",), "measured": (".csv",), "study": (".toml",), "compare": (".nc",)}
"""File option -> suffixes of its files; other file options offer all of these."""


_RARE = ("at", "force_tolerance", "elements", "sobol", "settling", "friction", "tolerance", "wear", "light_load")
"""Options shown on request."""
_QUOTED = re.compile(r'"([^"]+)"')
_MIN_SPEED_RATIO, _MAX_SPEED_RATIO = 0.3, 1.2
"""Limits of the range of speeds that is proposed, over the speed of the drive."""


class Option(NamedTuple):
    """An option of an analysis."""

    name: str
    """As its function has it."""
    kind: type
    """str, int or float: what is given; Path of a file in the folder of the page."""
    default: str
    """What holds where it is left open; empty where it must be given, or is chosen."""
    required: bool
    """Whether it must be given."""
    about: str
    """What it means."""
    takes_unit: bool = False
    """Whether a number may have a unit."""

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files of a file option; empty for others."""
        every = tuple(dict.fromkeys(one for suffixes in _SUFFIXES.values() for one in suffixes))
        return _SUFFIXES.get(self.name, every) if self.kind is Path else ()

    @property
    def example(self) -> str:
        """What may be typed, out of its description; empty where that quotes nothing with a number."""
        quoted = _QUOTED.findall(self.about)
        return next((one for one in quoted if any(letter.isdigit() for letter in one)), "")

    @property
    def rare(self) -> bool:
        """Whether it is shown on request."""
        return self.name in _RARE and not self.required

    def read(self, text: str) -> str | int | float:
        """Parse typed text, or the name of a chosen file."""
        if self.kind in (str, Path):
            return text
        try:
            number: int | float = self.kind(text)
        except ValueError:
            if self.takes_unit:
                return text
            whole = "a whole number" if self.kind is int else "a number"
            raise ModelError(f"{self.name} = {shorten(text)} must be {whole}.") from None
        return number


@cache
def offered() -> dict[str, str]:
    """Analyses of a drive file with plain options and files, with their purposes."""
    return {
        name: one.purpose
        for name, one in ANALYSES.items()
        if all(_kind(each.annotation) or each.default is not Parameter.empty for each in _own(name))
    }


@cache
def options_of(name: str) -> tuple[Option, ...]:
    """Options of an analysis that are texts, numbers or files, required ones first."""
    found = []
    told = {one.arg_name: one.description or "" for one in parse(ANALYSES[name].function.__doc__ or "").params}
    for one in _own(name):
        if kind := _kind(one.annotation):
            required = one.default is Parameter.empty
            default = "" if required or one.default is None else str(one.default)
            about = " ".join(told[one.name].replace("`", "").split())
            found.append(Option(one.name, kind, default, required, about, _takes_unit(one.annotation)))
    return tuple(sorted(found, key=lambda option: not option.required))


def proposal(option: Option, drive: Drive | None) -> str:
    """What a required option begins with: the driver, and a range about its speed; empty where there is none."""
    from beltdyn.app.computing import given_speed
    from beltdyn.points.changed_drive import driver_of

    if not option.required or drive is None or option.name not in ("pulley", "speed", "from_", "to"):
        return ""
    try:
        number = driver_of(drive)
    except BeltdynError:
        return ""
    if option.name == "pulley":
        return drive.pulleys[number].name
    speed = RPM * abs(given_speed(drive, number))
    low, high = (f"{factor * speed:.2g}" for factor in (_MIN_SPEED_RATIO, _MAX_SPEED_RATIO))
    low, high = (f"{float(one):.0f}" for one in (low, high))
    return {"speed": f"{low}..{high} rpm", "from_": f"{low} rpm", "to": f"{high} rpm"}[option.name]


def _own(name: str) -> list[Parameter]:
    return [one for one in options.options_of(ANALYSES[name].function).values() if one.name != _CHECKPOINT]


def _kind(annotation: Any) -> type | None:
    """What an option takes as it is typed or chosen; None where it is neither file, text nor number."""
    if _takes_unit(annotation):
        return float
    kinds = options.option_types(annotation)
    return next((kind for kind in (Path, str, float, int) if kind in kinds), None)


def _takes_unit(annotation: Any) -> bool:
    """Whether an option is a number that may have a unit."""
    return {float, str} <= set(options.option_types(annotation))


_POLLING_INTERVAL = 0.25
"""Polling interval of an analysis, s."""


class AnalysisView:
    """The part of the page that runs analyses; `watch` is called with snapshots of a run, and with None at its end."""

    def __init__(self, session: Session, watch: Callable[["Glimpse | None"], None]) -> None:
        self._session, self._watch = session, watch
        self._cards: list[tuple[str, Outcome, ui.expansion]] = []
        self._seen: Glimpse | None = None
        names = offered()
        with ui.row().classes("w-full items-center no-wrap gap-2"):
            self._name = ui.select(
                {name: f"{name}: {about}" for name, about in names.items()}, value=SIMULATE, label="analysis"
            )
            self._name.props("dense outlined options-dense").classes("grow").style("min-width: 0").mark("analysis")
            self._name.on_value_change(self._ask_options)
            self._start = (
                ui.button("Run", icon="play_arrow", on_click=self.start).props("no-caps unelevated").mark("run")
            )
            self._cancel = (
                ui.button("Cancel", icon="stop", on_click=self.cancel).props("no-caps outline").mark("cancel")
            )
        self._options = ui.column().classes("w-full gap-1")
        self._inputs: dict[Option, ui.input | ui.select] = {}
        self._bar = ui.linear_progress(value=0.0, show_value=False).props('instant-feedback aria-label="progress"')
        self._state = ui.label().classes("bd-state").props('role="status"').mark("progress")
        self._box = ui.column().classes("w-full gap-1 bd-tables").mark("watched")
        self._results = ui.column().classes("w-full gap-1")
        self._timer = ui.timer(_POLLING_INTERVAL, self._look, active=session.job is not None)
        self._show_outcomes()
        self._ask_options()
        self.update()

    def update(self) -> None:
        """Enable or disable buttons according to the drive."""
        running = self._session.job is not None
        if self._proposed != self._proposals():
            self._ask_options()
        self._start.set_enabled(self._session.draft.drive is not None and not running)
        for name, outcome, card in self._cards:
            card.text = self._title(name, outcome)
            old = self._is_old(outcome)
            card.classes(add="bd-old" if old else "", remove="" if old else "bd-old")
        self._cancel.set_visibility(running)
        self._bar.set_visibility(running)

    def _is_old(self, outcome: Outcome) -> bool:
        """Whether the drive was edited since."""
        return bool(outcome.text) and outcome.text != self._session.document.text

    def _title(self, name: str, outcome: Outcome) -> str:
        return f"{name}: {outcome.status}{', before the last edits' * self._is_old(outcome)}"

    def redraw(self) -> None:
        """Show the outcomes anew, as in other units."""
        for *_, card in self._cards:
            card.delete()
        self._cards.clear()
        self._show_outcomes()

    def _proposals(self) -> list[str]:
        """What options offer of the present drive."""
        named = [str(one.get("name", "")) for one in groups(self._session.document.data, "pulley")]
        drive = self._session.draft.drive
        return named + [proposal(one, drive) for one in options_of(str(self._name.value))]

    def _ask_options(self) -> None:
        """Show the options of the chosen analysis, and rare ones on request."""
        self._options.clear()
        self._proposed = self._proposals()
        listed = options_of(str(self._name.value))
        with self._options:
            with ui.element("div").classes("bd-fields"):
                self._inputs = {one: self._input(one) for one in listed if not one.rare}
            if any(one.rare for one in listed):
                with (
                    ui.expansion("More options").classes("w-full bd-all").props("dense"),
                    ui.element("div").classes("bd-fields"),
                ):
                    self._inputs |= {one: self._input(one) for one in listed if one.rare}

    def _input(self, one: Option) -> ui.input | ui.select:
        """A field of an option; for a file a list of files in the folder, for a pulley one of pulleys."""
        name, drive = in_words(one.name.strip("_")), self._session.draft.drive
        box: ui.input | ui.select
        if one.suffixes:
            there = self._session.workspace.folder.files(*one.suffixes)
            words = name if there else f"{name}: no {' or '.join(one.suffixes)} file in the folder"
            box = ui.select(there, label=words, clearable=True)
            box.props("dense outlined options-dense stack-label").classes("bd-whole")
        elif one.name == "pulley":
            pulleys = [str(each.get("name", "")) for each in groups(self._session.document.data, "pulley")]
            box = ui.select(pulleys, label=name, value=proposal(one, drive) or None, clearable=not one.required)
            box.props("dense outlined options-dense stack-label")
        else:
            usual = one.default or (f"such as {one.example}" if one.example else "")
            box = ui.input(label=name, placeholder=usual, value=proposal(one, drive))
            box.props('dense outlined stack-label autocomplete="off"')
        with box:
            ui.tooltip(one.about).classes("bd-about")
        return box.mark(f"option:{one.name}")

    def start(self) -> None:
        """Start the chosen analysis."""
        name, session = str(self._name.value), self._session
        if session.job is not None or session.draft.drive is None:
            return
        try:
            options = {
                one.name: self._session.workspace.folder.root / typed if one.suffixes else one.read(typed)
                for one, box in self._inputs.items()
                if (typed := (box.value or "").strip())
            }
        except ModelError as error:
            self._state.text = str(error)
            return
        missing = [one.name for one in self._inputs if one.required and one.name not in options]
        if missing:
            self._state.text = f"{name} needs {' and '.join(missing)}. Give a value."
            return
        folder = Path(mkdtemp(dir=session.workspace.results))
        result = ANALYSES[name].result_file(folder / Path(session.name or "drive.toml").name)
        session.job = Job(name, session.document.text, session.workspace.folder.root, result, options)
        session.workspace.jobs.add(session.job)
        self._timer.active = True
        self.update()

    def cancel(self) -> None:
        """Stop the analysis, and keep the results computed so far."""
        if self._session.job is not None:
            self._session.job.cancel()
            self._state.text = "stopping …"

    def _look(self) -> None:
        job = self._session.follow_job()
        if job is not None:
            part, phase, remaining, glimpse = job.step
            self._bar.value = part
            self._bar.props(remove="indeterminate") if part else self._bar.props("indeterminate")
            left = "" if math.isnan(remaining) else f", about {remaining:.0f} s left"
            done = f", {part:.0%}" if part and not phase.startswith(COMPILING) else ""
            self._state.text = f"{job.name}: {phase}{done}{left}"
            self._show_glimpse(glimpse)
            return
        self._timer.active, self._state.text = False, ""
        self._show_glimpse(None)
        self._show_outcomes()
        self.update()

    def _show_glimpse(self, glimpse: "Glimpse | None") -> None:
        """Show a run as it stands: the belt on the canvas, numbers here."""
        if glimpse is self._seen:
            return
        self._seen = glimpse
        self._watch(glimpse)
        self._box.clear()
        if glimpse is not None:
            with self._box:
                low, high = glimpse.tension
                ui.label(f"at {glimpse.time:.4g} s; belt tension {low:.1f} N (dark) to {high:.1f} N (bright)").classes(
                    "text-caption"
                )
                show_parts((glimpse.pulleys,))

    def _show_outcomes(self) -> None:
        """Show new outcomes, and remove those that the session has dropped."""
        there = self._session.outcomes
        for old in [one for one in self._cards if all(one[1] is not outcome for _, outcome in there)]:
            old[2].delete()
            self._cards.remove(old)
        for name, outcome in reversed(there):
            if all(shown is not outcome for _, shown, _ in self._cards):
                self._show(name, outcome)

    def _show(self, name: str, outcome: Outcome) -> None:
        for *_, other in self._cards:
            other.value = False
        with self._results:
            card = ui.expansion(self._title(name, outcome), value=True).classes("w-full")
            card.props("dense header-class=text-weight-medium")
            card.move(target_index=0)
            with card:
                self._fill(name, outcome)
        self._cards.append((name, outcome, card))

    def _fill(self, name: str, outcome: Outcome) -> None:
        units = self._session.units
        if outcome.error:
            ui.label(in_units(outcome.error, units)).classes("bd-message")
        if outcome.answer:
            ui.label(in_units(outcome.answer, units)).classes("bd-answer")
        mark, why = outcome.verdict
        if why:
            ui.label(f"{_MARKS[mark]} {in_units(why, units)}").classes(f"bd-verdict bd-{mark}")
        with ui.row().classes("w-full items-center gap-x-2 gap-y-0"):
            if (report := outcome.report) is not None:
                address = app.add_static_file(local_file=report)
                _button("Show report", "article", lambda: _open(address)).mark("look")
                _button("Print or PDF", "print", lambda: _print(address)).mark("print")
                _button("Mail", "mail", lambda: self._mail(name, outcome)).mark("mail")
                _button("Download report", "download", partial(ui.download.file, report)).mark("report")
            for text, file in (("Result file", outcome.result), ("Resulting drive file", outcome.best)):
                if file is not None:
                    _button(text, "download", partial(ui.download.file, file)).mark(text)
        for warning in outcome.warnings:
            ui.label(in_units(warning, units)).classes("bd-message bd-warning")
        show_findings(outcome.findings, self._session)
        for picture in outcome.pictures:
            ui.image(picture).props("no-spinner no-transition").classes("bd-picture")
        if outcome.parts:
            shown = bool(outcome.findings.figures or outcome.pictures)
            with ui.expansion("All numbers", value=not shown).classes("w-full bd-all").props("dense"):
                show_parts(outcome.parts)

    def _mail(self, name: str, outcome: Outcome) -> None:
        """Begin a mail with the answer, and download the report to attach it."""
        assert outcome.report is not None
        ui.download.file(outcome.report)
        facts = [f"{fact}: {value}" for part in outcome.parts if isinstance(part, Facts) for fact, value in part.facts]
        answer = [in_units(words, self._session.units) for words in (outcome.answer, outcome.verdict[1])]
        body = "\n".join([*answer, *facts[:_MAX_FACTS], "", f"Report attached: {outcome.report.name}"])
        subject = f"{(self._session.name or 'drive').removesuffix('.toml')}: {name.replace('_', ' ')}"
        ui.run_javascript(f"window.location.href = {json.dumps(mail_address(subject, body))}")


_MARKS = {"pass": "✓", "fail": "✗", "open": "·"}
_MAX_FACTS = 8
"""Number of key numbers in a mail at most: all are in the report."""


def mail_address(subject: str, body: str) -> str:
    """The address at which a browser begins a mail (RFC 6068)."""
    return f"mailto:?subject={quote(subject)}&body={quote(body.strip().replace(chr(10), chr(13) + chr(10)))}"


_PRINT = """
const frame = document.createElement("iframe");
frame.style = "position: fixed; left: -200vw; width: 210mm; height: 297mm; border: 0";
frame.title = "report to print";
frame.onload = () => setTimeout(() => { frame.contentWindow.print(); }, 1000);  // charts are drawn by then
frame.src = ADDRESS;
document.querySelectorAll('iframe[title="report to print"]').forEach((one) => one.remove());
document.body.append(frame);
"""


def _print(address: str) -> None:
    """Let the browser print a report, which it also does to a PDF file."""
    prefix = str(ui.context.client.request.scope.get("root_path", ""))
    ui.run_javascript(_PRINT.replace("ADDRESS", json.dumps(f"{prefix}{address}")))


def _button(text: str, icon: str, on_click: Callable[[], None]) -> ui.button:
    return ui.button(text, icon=icon, on_click=on_click).props("dense flat no-caps")


def _open(address: str) -> None:
    """Show a report over the page."""
    prefix = str(ui.context.client.request.scope.get("root_path", ""))
    with ui.dialog(value=True) as dialog, ui.card().classes("bd-paper"):
        with ui.row().classes("w-full items-center no-wrap gap-3"):
            ui.label("Report").classes("bd-heading-plain grow")
            ui.link("open in new tab", address, new_tab=True)
            ui.button("Close", on_click=dialog.close).props("no-caps flat dense").mark("close report")
        ui.element("iframe").props(f'src="{prefix}{address}" title="report"').classes("bd-report")
    dialog.on("hide", dialog.delete)


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

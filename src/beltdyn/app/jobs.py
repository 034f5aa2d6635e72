"""Long analyses, each in a separate process with progress and cancellation."""

import math
import threading
import time
from collections.abc import Mapping, Sequence
from multiprocessing.connection import Connection
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from beltdyn.analyses import ANALYSES
from beltdyn.app.computing import Counted, in_words, tell_of_compilation
from beltdyn.app.findings import Findings, findings_of
from beltdyn.designs.processes import SPAWN, heeding, new_event, start_process, start_worker, working
from beltdyn.errors import Parts, cause_of
from beltdyn.model import loads
from beltdyn.show.tables import Facts, Table

if TYPE_CHECKING:
    from beltdyn.app.watching import Glimpse

_GRACE_PERIOD = 5.0
"""Time for a cancelled analysis to close its file, s."""
_PROGRESS_INTERVAL = 0.1
"""Interval of progress reports, s."""


class Step(NamedTuple):
    """The progress of an analysis."""

    part: float
    """The part that is done, 0 to 1."""
    phase: str
    """What it is at."""
    remaining: float
    """Seconds left, or NaN."""
    glimpse: "Glimpse | None" = None
    """A run as it stood when it was looked at last."""


_DRAWN = ("configuration", "slip", "mode_shapes", "mode_shape")
"""Figures whose contents the page shows as charts."""
_MAX_PICTURES = 2
"""Figures of a result on the page at most, beside those that it draws as charts: the report has all."""
_OF_COMPUTATION = ("mesh", "computing")
"""Beginnings of names of facts about the computation."""
_STARTING = Step(0.0, "starting", math.nan)


class Outcome(NamedTuple):
    """The outcome of an analysis."""

    status: str
    """"completed", "interrupted" or "failed"."""
    error: str = ""
    """Why it failed; empty otherwise."""
    parts: tuple[Table | Facts, ...] = ()
    """What is shown of it."""
    warnings: tuple[str, ...] = ()
    """What to know of it."""
    result: Path | None = None
    """The result file, if there is one."""
    report: Path | None = None
    """The report, if there is one."""
    best: Path | None = None
    """The drive file that the analysis found, as an optimization does."""
    findings: Findings = Findings()
    """What is shown as figures and charts."""
    pictures: tuple[str, ...] = ()
    """Its first figures, as addresses of pictures."""
    answer: str = ""
    """The answer in a sentence, such as the operating point."""
    verdict: tuple[str, str] = ("open", "")
    """"pass", "fail" or "open" by the limits of the drive file, and why."""
    text: str = ""
    """The drive file that was analyzed."""


class Job:
    """An analysis of a drive file in a separate process; the report is written beside the result."""

    def __init__(self, name: str, text: str, folder: Path, result: Path, options: Mapping[str, Any]) -> None:
        self._heard, told = SPAWN.Pipe(duplex=False)
        self._stop = new_event()
        self._process = start_process(_analyse, name, text, folder, result, dict(options), told, self._stop)
        self.name, self._text = name, text
        self.step = _STARTING
        self.outcome: Outcome | None = None
        self._ending: Outcome | None = None
        told.close()
        self._listener = threading.Thread(target=self._listen, daemon=True)
        self._listener.start()

    def poll(self) -> None:
        """Receive messages of the process."""
        if self.outcome is None and self._ending is not None:
            self.outcome = self._ending._replace(text=self._text)
            self.close()

    def _listen(self) -> None:
        """Hear what the process tells, at once, so that it never waits for the page."""
        try:
            while isinstance(said := self._heard.recv(), Step):
                self.step = said
            self._ending = said
        except (EOFError, OSError):
            self._ending = Outcome("failed", "the computing process ended unexpectedly, possibly for lack of memory.")

    def cancel(self) -> None:
        """Stop it, and keep the results computed so far."""
        self._stop.set()

    def close(self) -> None:
        """End the process at once."""
        self._stop.set()
        self._process.join(_GRACE_PERIOD if self.outcome is not None else 0.0)
        if self._process.is_alive():
            self._process.kill()
            self._process.join()
        self._listener.join(_GRACE_PERIOD)
        self._heard.close()
        if self.outcome is None:
            self.outcome = Outcome("interrupted")


def _analyse(
    name: str, text: str, folder: Path, result: Path, options: dict[str, Any], told: Connection, stop: SharedEvent
) -> None:
    """Analyze a drive into a file, write its report, and tell how it goes."""
    start_worker(stop)
    teller = _Teller(told, result)
    tell_of_compilation(teller.tell_of_compilation)

    try:
        with working():
            found = ANALYSES[name].write(loads(text, folder), result, heeding(teller.tell), True, **options)
        told.send(_outcome(found, result))
    except KeyboardInterrupt:
        told.send(Outcome("interrupted"))
    except Exception as error:
        told.send(Outcome("failed", cause_of(error)))
    told.close()


class _Teller:
    """Tells how far an analysis is, now and then, with a glimpse of what grows over time."""

    def __init__(self, told: Connection, result: Path) -> None:
        self._told, self._result = told, result
        self._watcher: Any = None
        self._glimpse: Glimpse | None = None
        self._step = _STARTING
        self._last = -math.inf
        self._begun: dict[str, tuple[float, float]] = {}
        self._sending = threading.Lock()

    def tell(self, progress: Any) -> None:
        """Report progress, and take snapshots of a run."""
        now = time.perf_counter()
        if now - self._last < _PROGRESS_INTERVAL:
            return
        self._last = now
        if progress.phase == "integrating":
            self._look()
        part = progress.time / progress.duration
        phase = "loading kernels" if progress.phase == "compiling" else progress.phase
        self._step = Step(part, phase, self._remaining(progress, part, now), self._glimpse)
        self._send(self._step)

    def _send(self, step: Step) -> None:
        """Send a step; kernels that another process compiles are told of in a thread of their own."""
        with self._sending:
            self._told.send(step)

    def tell_of_compilation(self, counted: Counted) -> None:
        """Report the kernels that the analysis waits for, and when it continues."""
        done, total = counted
        waits = Step(done / max(total, 1), in_words(counted), math.nan, self._glimpse)
        self._send(waits if done < total else self._step)

    def _remaining(self, progress: Any, part: float, now: float) -> float:
        """Time that is left, s, by the pace that the analysis tells, or else by that of this phase until now."""
        from beltdyn.solvers.run_progress import FORECAST

        begun, first = self._begun.setdefault(progress.phase, (now, part))
        if not math.isnan(progress.remaining):
            return float(progress.remaining)
        known = part > first and part >= FORECAST
        return (1.0 - part) * (now - begun) / (part - first) if known else math.nan

    def _look(self) -> None:
        from beltdyn.app.watching import Watcher  # loads the library of figures

        self._watcher = self._watcher or Watcher(self._result)
        self._glimpse = self._watcher.look() or self._glimpse


def _outcome(found: Any, result: Path) -> Outcome:
    """What is shown of a result, with its report."""
    from beltdyn.results import Run, key_numbers
    from beltdyn.show.report import write_report
    from beltdyn.show.report.report import lead
    from beltdyn.show.sheet import sheet
    from beltdyn.show.verdict import verdict

    if isinstance(found, Run) and not found.outputs:
        return Outcome(found.status)
    parts = Parts()
    with parts.part():
        parts.completed.append(write_report(found, result.with_suffix(".html"), overwrite=True))
    report = next(iter(parts.completed), None)
    best = result.with_suffix(".toml")
    written = best if best.is_file() else None
    findings, pictures = parts.done(lambda: findings_of(found), Findings()), _pictures(found, parts)
    shown = sheet(found)
    faults = dict.fromkeys(map(str, (*shown.errors, *parts.errors)))
    warnings = (*found.warnings, *(line for fault in faults for line in fault.splitlines()))
    answer = parts.done(lambda: lead(found), "") or _first_fact(shown.parts)
    judged = parts.done(lambda: verdict([found]) if key_numbers(found) else ("open", ""), ("open", ""))
    return Outcome(found.status, "", shown.parts, warnings, result, report, written, findings, pictures, answer, judged)


def _first_fact(parts: Sequence[Table | Facts]) -> str:
    """What a sheet says first of the drive, not of its computation."""
    facts = [fact for part in parts if isinstance(part, Facts) for fact in part.facts]
    return next((f"{name}: {value}" for name, value in facts if not name.startswith(_OF_COMPUTATION)), "")


def _pictures(found: Any, parts: Parts) -> tuple[str, ...]:
    """The first figures of a result as a report has them, but for those that the page draws itself."""
    from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default, data_uri, repeated

    names = [name for name in chosen_by_default([found]) if name not in _DRAWN][:_MAX_PICTURES]
    drawn = (
        parts.done(lambda name=name: data_uri(FIGURES[name].arrange(found, Choice())), "", repeated([found], name))  # type: ignore[misc]
        for name in names
    )
    return tuple(picture for picture in drawn if picture)

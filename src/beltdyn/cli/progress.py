"""The progress bars of a simulation and of many."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, Task, TaskID, TextColumn, TimeRemainingColumn
from rich.text import Text

if TYPE_CHECKING:
    from beltdyn.solvers.run_progress import BatchProgress
    from beltdyn.solvers.run_progress import Progress as SolverProgress

_EARLY = 5.0
"""Computing time after which a long run is announced, s."""
_LONG = 60.0
"""Remaining computing time of a long run, s."""

_LINE_INTERVAL = 60.0
"""Time between lines of progress where there is no terminal for a bar, s."""

_SLOW_RUNS = "Fine meshes, steep friction and small tolerances make runs long; `beltdyn check` names the cause."

_PHASES = {
    "compiling": "loading kernels",
    "equilibrium": "finding static equilibrium",
    "settling": "settling at the first speed",
    "integrating": "simulating",
    "operating points": "computing operating points",
    "designs": "evaluating designs",
    "points": "computing points",
    "no workers": "waiting for workers: the cluster has none",
}
_COMPILING = "compiling kernels, once on this machine"
_COUNTED = "integrating", "operating points", "designs", "points", "no workers"
"""Phases with a known total."""


@contextmanager
def progress_bar() -> Iterator[Callable[["SolverProgress"], None]]:
    """Show simulated time, step size and remaining time on standard error; announce a long run early."""
    with _bar() as bar:
        task = bar.add_task("preparing", total=None, state="")
        told, log = False, _lines(bar.console)

        def report(progress: "SolverProgress") -> None:
            nonlocal told
            if not told and progress.elapsed > _EARLY and progress.remaining > _LONG:
                bar.console.print(_long("This run", progress.remaining, progress.bound), highlight=False)
                told = True
            counted = progress.phase in _COUNTED
            log(f"{_PHASES[progress.phase]}{f', {_state(progress)}' if counted else ''}", progress.remaining)
            bar.update(
                task,
                description=_PHASES[progress.phase],
                completed=progress.time,
                total=progress.duration if counted else None,
                state=_state(progress) if counted else "",
            )

        yield report


def _long(what: str, remaining: float, bound: str) -> str:
    """The remaining computing time (s), and its cause."""
    return f"{what} will take {_in_minutes(remaining)} more at the present rate. {bound}"


def _in_minutes(remaining: float) -> str:
    """A remaining computing time (s) in words."""
    minutes = remaining / 60.0
    left = f"{minutes:.0f} minutes" if minutes < 120.0 else f"{minutes / 60.0:.0f} hours"
    return "a minute or two" if minutes < 1.5 else f"about {left}"


def _lines(console: Console) -> Callable[[str, float], None]:
    """What prints the state of a work, and its remaining time (s), now and then where a bar would not be seen."""
    last = perf_counter()

    def log(state: str, remaining: float) -> None:
        nonlocal last
        if console.is_terminal or perf_counter() - last < _LINE_INTERVAL:
            return
        last = perf_counter()
        console.print(f"{state}{f'; {_in_minutes(remaining)} more' if remaining > 0.0 else ''}", highlight=False)

    return log


def _state(progress: "SolverProgress") -> str:
    if progress.phase != "integrating":
        return f"{progress.time:.0f} of {'at most ' * (progress.phase == 'designs')}{progress.duration:.0f}"
    return f"{progress.time:.4g} of {progress.duration:.4g} s, step {progress.step_size:.1e} s"


@contextmanager
def runs_bar(at_end: str = "done") -> Iterator[Callable[["BatchProgress"], None]]:
    """Show the number of completed runs, and a line for each active run, on standard error."""
    from beltdyn.solvers.run_progress import FORECAST

    with _bar() as bar:
        whole = bar.add_task("", total=None, state="", visible=False)
        lines: dict[Path, TaskID] = {}
        begin: float | None = None
        told, log = False, _lines(bar.console)

        def report(progress: "BatchProgress") -> None:
            nonlocal begin, told
            if begin is None and (progress.running or progress.done):
                begin = perf_counter()
            part = (progress.done + sum(progress.running.values())) / max(progress.total, 1)
            part = part if progress.share is None else progress.share
            state = f"{progress.done} of {progress.total} {progress.kind}"
            elapsed = perf_counter() - begin if begin is not None else 0.0
            remaining = elapsed * (1.0 - part) / part if part >= FORECAST else 0.0
            if not told and elapsed > _EARLY and remaining > _LONG:
                told = True
                bar.console.print(_long("These runs", remaining, _SLOW_RUNS), highlight=False)
            log(state, remaining)
            for file in lines.keys() - progress.running.keys():
                bar.remove_task(lines.pop(file))
            for file, done in progress.running.items():
                line = lines.get(file) or bar.add_task(f"  {file.stem}", total=1.0, state="")
                lines[file] = line
                bar.update(line, completed=done)
            begun = bool(progress.running or progress.done)
            phase = _PHASES["integrating"] if begun else "preparing (kernels are compiled once on this machine)"
            bar.update(
                whole,
                description=at_end if progress.done == progress.total else phase,
                completed=part,
                total=1.0 if begun else None,
                state=state,
                visible=True,
            )

        yield report


class _Remaining(TimeRemainingColumn):
    """The remaining time, once it can be forecast."""

    def render(self, task: Task) -> Text:
        """The time, or dashes."""
        from beltdyn.solvers.run_progress import FORECAST

        early = not task.finished and task.percentage < 100.0 * FORECAST
        return Text("-:--:--", style="progress.remaining") if early else super().render(task)


@contextmanager
def compilation_bar() -> Iterator[None]:
    """Show the progress of compilation on standard error."""
    with _bar() as bar:
        bar.add_task("loading kernels", total=None, state="")
        yield


@contextmanager
def _bar() -> Iterator[Progress]:
    """A bar with a description, a state in words and the remaining time; one more while kernels are compiled."""
    from beltdyn.kernel import watch_compilation

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[state]}"),
        _Remaining(elapsed_when_finished=True),
    )
    with Progress(*columns, console=Console(stderr=True)) as bar:
        line = bar.add_task(_COMPILING, total=None, state="", visible=False)

        def show(done: int, total: int) -> None:
            bar.update(line, completed=done, total=total, state=f"{done} of {total}", visible=done < total)

        with watch_compilation(show):
            yield bar

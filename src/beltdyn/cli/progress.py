"""The progress bars of a simulation and of many."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from beltdyn.solve.progress import BatchProgress
    from beltdyn.solve.progress import Progress as SolverProgress

_EARLY = 5.0
"""Computing time, s, after which a run that takes long is told of."""
_LONG = 60.0
"""Remaining computing time, s, that is long."""

_PHASES = {
    "compiling": "preparing kernels (the first run compiles them: about 20 s)",
    "equilibrium": "finding equilibrium",
    "integrating": "simulating",
}


@contextmanager
def progress_bar() -> Iterator[Callable[["SolverProgress"], None]]:
    """Show simulated time, step size and remaining time on standard error; say early that a run takes long, and why.

    Yields
    ------
    callable
        What the solver calls with its progress.
    """
    with _bar() as bar:
        task = bar.add_task("preparing", total=None, state="")
        told = False

        def report(progress: "SolverProgress") -> None:
            nonlocal told
            if not told and progress.elapsed > _EARLY and progress.remaining > _LONG:
                bar.console.print(_long(progress), highlight=False)
                told = True
            integrating = progress.phase == "integrating"
            bar.update(
                task,
                description=_PHASES[progress.phase],
                completed=progress.time,
                total=progress.duration if integrating else None,
                state=_state(progress) if integrating else "",
            )

        yield report


def _long(progress: "SolverProgress") -> str:
    """How long a run takes, and what makes it so."""
    minutes = progress.remaining / 60.0
    left = f"{minutes:.0f} minutes" if minutes < 120.0 else f"{minutes / 60.0:.0f} hours"
    return f"This run will take about {left} more, if it goes on like this. {progress.bound}"


def _state(progress: "SolverProgress") -> str:
    return f"{progress.time:.4g} of {progress.duration:.4g} s, step {progress.step_size:.1e} s"


@contextmanager
def runs_bar(at_end: str = "done") -> Iterator[Callable[["BatchProgress"], None]]:
    """Show how many runs have ended, and a line for each that is on its way, on standard error.

    Parameters
    ----------
    at_end
        What is being done when all have ended.

    Yields
    ------
    callable
        What is told of the runs.
    """
    with _bar() as bar:
        whole = bar.add_task("", total=None, state="", visible=False)
        lines: dict[Path, TaskID] = {}

        def report(progress: "BatchProgress") -> None:
            for file in lines.keys() - progress.running.keys():
                bar.remove_task(lines.pop(file))
            for file, part in progress.running.items():
                line = lines.get(file) or bar.add_task(f"  {file.stem}", total=1.0, state="")
                lines[file] = line
                bar.update(line, completed=part)
            begun = bool(progress.running or progress.done)
            phase = _PHASES["integrating" if begun else "compiling"]
            bar.update(
                whole,
                description=at_end if progress.done == progress.total else phase,
                completed=progress.done + sum(progress.running.values()),
                total=progress.total if begun else None,
                state=f"{progress.done} of {progress.total} runs",
                visible=True,
            )

        yield report


def _bar() -> Progress:
    """A bar with a description, a state in words and the remaining time."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[state]}"),
        TimeRemainingColumn(elapsed_when_finished=True),
    )
    return Progress(*columns, console=Console(stderr=True))

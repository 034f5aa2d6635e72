"""The progress bars of a simulation and of many."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from beltdyn.report.runs import Stage
    from beltdyn.solve.progress import Progress as SolverProgress

_PHASES = {
    "compiling": "compiling (once on a machine: about 20 s)",
    "equilibrium": "finding equilibrium",
    "integrating": "simulating",
}


@contextmanager
def progress_bar() -> Iterator[Callable[["SolverProgress"], None]]:
    """Show simulated time, step size and remaining time on standard error.

    Yields
    ------
    callable
        What the solver calls with its progress.
    """
    with _bar() as bar:
        task = bar.add_task("preparing", total=None, state="")

        def report(progress: "SolverProgress") -> None:
            integrating = progress.phase == "integrating"
            bar.update(
                task,
                description=_PHASES[progress.phase],
                completed=progress.time,
                total=progress.duration if integrating else None,
                state=_state(progress) if integrating else "",
            )

        yield report


def _state(progress: "SolverProgress") -> str:
    return f"{progress.time:.4g} of {progress.duration:.4g} s, step {progress.step_size:.1e} s"


@contextmanager
def runs_bar() -> Iterator[Callable[["Stage"], None]]:
    """Show how many runs have ended, and which are on their way, on standard error.

    Yields
    ------
    callable
        What is told of the runs.
    """
    with _bar() as bar:
        task = bar.add_task("", total=None, state="", visible=False)

        def report(stage: "Stage") -> None:
            names = f": {', '.join(stage.running)}" if stage.running else ""
            at_end = "writing the page" if stage.done == stage.total else _PHASES["compiling"]
            bar.update(
                task,
                description="simulating" if stage.running else at_end,
                completed=stage.done,
                total=stage.total,
                state=f"{stage.done} of {stage.total} runs{names}",
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

"""The progress bar of a simulation."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

if TYPE_CHECKING:
    from beltdyn.solve.progress import Progress as SolverProgress

_PHASES = {
    "compiling": "preparing kernels (once on a machine: about a minute)",
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
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[state]}"),
        TimeRemainingColumn(elapsed_when_finished=True),
    )
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task("preparing", total=None, state="")

        def report(progress: "SolverProgress") -> None:
            bar.update(
                task,
                description=_PHASES[progress.phase],
                completed=progress.time,
                total=progress.duration,
                state=_state(progress) if progress.phase == "integrating" else "",
            )

        yield report


def _state(progress: "SolverProgress") -> str:
    return f"{progress.time:.4g} of {progress.duration:.4g} s, step {progress.step_size:.1e} s"

"""Summary of a run."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.results.balance import Balance, power_balance
from beltdyn.results.closure import largest_closure
from beltdyn.results.cycles import mean_window
from beltdyn.results.means import (
    PulleySummary,
    SpanSummary,
    TensionerSummary,
    pulley_means,
    span_means,
    tensioner_means,
)
from beltdyn.results.recorded import Recorded, attribute
from beltdyn.results.resolution import Resolution
from beltdyn.results.run import Run
from beltdyn.results.window import Window


class Means(NamedTuple):
    """Means over the end of a run."""

    pulleys: tuple[PulleySummary, ...]
    """Means of the pulleys."""
    spans: tuple[SpanSummary, ...]
    """Means of the spans."""
    tensioners: tuple[TensionerSummary, ...]
    """Means of the moving tensioners."""
    balance: Balance
    """Mean powers of shafts and losses by cause."""


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary of a run.

    Means are taken over whole turns of the belt and whole periods of what repeats; see `cycles.mean_window`.

    Attributes
    ----------
    status : str
        How the run ended.
    start, end : float
        First and last instant of what means are taken over, s.
    turns : int
        Number of turns of the belt that means are taken over; zero where not even one was taken.
    outputs : int
        Number of recorded outputs.
    pulleys : tuple of PulleySummary
        One for each pulley.
    spans : tuple of SpanSummary
        One for each span.
    tensioners : tuple of TensionerSummary
        One for each tensioner that moves.
    balance : Balance
        Mean powers of shafts and losses by cause, and with them the efficiency.
    resolution : Resolution
        How well the mesh resolves tension and contact.
    energy_closure : float
        Largest closure error of the energy account at any time, relative to the energy put in by then.
    integrator : str
        The time integrator; empty when the run's end was not recorded.
    steps, rejected_steps, newton_iterations : int
        The solver's counts; zero when the run's end was not recorded.
    wall_time : float
        Time taken, s, without `compile_time`; NaN when the run's end was not recorded.
    compile_time : float
        Time taken by compilation, s; NaN when the run's end was not recorded.
    warnings : tuple of str
        What a reader of the results has to know.

    Examples
    --------
    >>> [pulley.name for pulley in bd.summarize(run).pulleys]
    ['driver', 'driven']
    """

    status: str
    start: float
    end: float
    turns: int
    outputs: int
    pulleys: tuple[PulleySummary, ...]
    spans: tuple[SpanSummary, ...]
    tensioners: tuple[TensionerSummary, ...]
    balance: Balance
    resolution: Resolution
    energy_closure: float
    integrator: str
    steps: int
    rejected_steps: int
    newton_iterations: int
    wall_time: float
    compile_time: float
    warnings: tuple[str, ...]

    @property
    def computing_time_per_second(self) -> float:
        """Computing time per simulated second, s; NaN at rest, or if the end of the run was not recorded."""
        return self.wall_time / self.end if self.end > 0.0 else np.nan


def summarize(run: Run) -> Summary:
    """Summarise a run.

    Parameters
    ----------
    run : Run
        The run, with at least one output.

    Returns
    -------
    Summary
        Its numbers.

    Raises
    ------
    ModelError
        If the run holds no output, or the result is not a run.

    Examples
    --------
    >>> bd.summarize(run).pulleys[1].name
    'driven'
    """
    if not isinstance(run, Run):
        raise ModelError(f"a summary needs results over time; these are of {run.kind}. Use result.dataset.")
    run.require_output()
    with run.recorded() as recorded:
        return _summarize(run, recorded)


def means_of(run: Run) -> Means:
    """Means over the averaging window of a run, without findings.

    Parameters
    ----------
    run : Run
        The run, with at least one output.
    """
    with run.recorded() as recorded:
        return _means(run, recorded, mean_window(recorded, run.drive))


def _means(run: Run, recorded: Recorded, window: Window) -> Means:
    return Means(
        pulleys=pulley_means(recorded, run.drive, window),
        spans=span_means(recorded, run.drive, window),
        tensioners=tensioner_means(recorded, run.drive, window),
        balance=power_balance(recorded, window),
    )


def _summarize(run: Run, recorded: Recorded) -> Summary:
    window = mean_window(recorded, run.drive)
    return Summary(
        status=run.status,
        start=window.start,
        end=window.end,
        turns=window.turns,
        outputs=len(window.time),
        **_means(run, recorded, window)._asdict(),
        resolution=run.resolution,
        energy_closure=largest_closure(recorded).error,
        integrator=str(recorded.attrs.get("integrator", "")),
        steps=int(attribute(recorded, "steps", 0)),
        rejected_steps=int(attribute(recorded, "rejected_steps", 0)),
        newton_iterations=int(attribute(recorded, "newton_iterations", 0)),
        wall_time=attribute(recorded, "wall_time", np.nan),
        compile_time=attribute(recorded, "compile_time", np.nan),
        warnings=tuple(run.warnings),
    )

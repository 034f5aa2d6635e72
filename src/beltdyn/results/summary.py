"""Summary of a run."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from beltdyn.model import Drive
from beltdyn.model.simulation import Simulation
from beltdyn.results.checks.mesh import STEADY_LOSSES, STEADY_SLIPS
from beltdyn.results.cycles import Window, mean_window
from beltdyn.results.energy_balance import Balance, causes_of, largest_closure, lifting_power, power_balance
from beltdyn.results.means import (
    PulleySummary,
    SpanSummary,
    TensionerSummary,
    span_means,
    tensioner_means,
)
from beltdyn.results.provenance import Resolution
from beltdyn.results.run import Run
from beltdyn.results.schema import Recorded, attribute


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

    Examples
    --------
    >>> [pulley.name for pulley in bd.summarize(run).pulleys]
    ['driver', 'driven']
    """

    status: str
    """How the run ended."""
    start: float
    """First instant of the averaging window, s."""
    end: float
    """Last instant of the averaging window, s."""
    turns: int
    """Number of turns of the belt that means are taken over; zero where not even one was taken."""
    outputs: int
    """Number of recorded outputs."""
    pulleys: tuple[PulleySummary, ...]
    """One for each pulley."""
    spans: tuple[SpanSummary, ...]
    """One for each span."""
    tensioners: tuple[TensionerSummary, ...]
    """One for each tensioner that moves."""
    balance: Balance
    """Mean powers of shafts and losses by cause, and with them the efficiency."""
    resolution: Resolution
    """How well the mesh resolves tension and contact."""
    energy_closure: float
    """Largest closure error of the energy account at any time, relative to the energy put in by then."""
    integrator: str
    """The time integrator; empty when the run's end was not recorded."""
    steps: int
    """Steps; zero when the run's end was not recorded."""
    rejected_steps: int
    """Rejected steps."""
    newton_iterations: int
    """Iterations of Newton's method."""
    wall_time: float
    """Time taken, s, without `compile_time`; NaN when the run's end was not recorded."""
    compile_time: float
    """Time taken by compilation, s; NaN when the run's end was not recorded."""
    warnings: tuple[str, ...]
    """What a reader of the results has to know."""

    @property
    def computing_time_per_second(self) -> float:
        """Computing time per simulated second, s; NaN at rest, or if the end of the run was not recorded."""
        return self.wall_time / self.end if self.end > 0.0 else np.nan


def summarize(run: Run) -> Summary:
    """Summarize a run.

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
    run.require_output()
    with run.recorded() as recorded:
        return _summarize(run, recorded)


def means_of(run: Run) -> Means:
    """Means over the averaging window of a run, without findings."""
    with run.recorded() as recorded:
        return _means(run, recorded, mean_window(recorded, run.prepared))


def _means(run: Run, recorded: Recorded, window: Window) -> Means:
    return Means(
        pulleys=run.pulley_means,
        spans=span_means(recorded, run.prepared, window),
        tensioners=tensioner_means(recorded, run.prepared, window),
        balance=power_balance(recorded, window, lifting_power(recorded, run.prepared, window)),
    )


def _summarize(run: Run, recorded: Recorded) -> Summary:
    window = mean_window(recorded, run.prepared)
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


# Comparison of the end of a run with steady running under the same speeds and loads

VALUES, FAILURE = "steady_values", "steady_failure"
"""Attributes of a run: the values in steady running in their order, or why there are none."""

_CHANGING = 0.3
"""Rate of the stored energy over the losses from which on a run has not settled: losses then differ by 2 % for that."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A value at the end of a run and in steady running.

    Examples
    --------
    >>> slip = bd.results.Compared("slip", "driven", "%", run=0.21, steady=0.2)
    >>> print(f"{slip.quantity} of {slip.name}: {slip.run - slip.steady:+.2f} {slip.unit}")
    slip of driven: +0.01 %
    """

    quantity: str
    """"speed", "slip", "hub load", "contact force" (the largest normal force per meter of belt), "tension" or
    "position" of a tensioner."""
    name: str
    """Name of the pulley, of the span, or of the tensioner's pulley."""
    unit: str
    """SI unit."""
    run: float
    """Mean over the end of the run."""
    steady: float
    """In steady running."""


def steady_comparison(run: Run) -> tuple[Compared, ...]:
    """Compare the end of a run with the steady running under the same speeds and loads.

    Parameters
    ----------
    run : Run
        Of ``simulate(drive, compare_steady=True)``.

    Returns
    -------
    tuple of Compared
        Empty without a comparison, or if no steady running was found.

    Examples
    --------
    >>> bd.steady_comparison(run)  # of bd.simulate(drive) alone
    ()
    """
    with run.recorded() as recorded:
        steady = np.atleast_1d(np.asarray(recorded.attrs.get(VALUES, []), dtype=float)).tolist()
    return tuple(replace(one, steady=value) for one, value in zip(_ending(run), steady, strict=True)) if steady else ()


def steady_values(run: Run) -> list[float]:
    """The values in steady running that `steady_comparison` reads from the attribute `VALUES` of another run."""
    return [one.run for one in _ending(run)]


def coarse_settings(drive: Drive) -> list[str]:
    """Settings of a run by which losses and slip may differ from those with the chosen mesh and tolerance."""
    settings, default = drive.simulation, Simulation.model_fields["rtol"].default
    found = []
    if not drive.frame.stays:
        given = settings.frame is not None
        found.append('simulation.frame = "travelling"' if given else drive.frame.reason.removeprefix("since "))
    if settings.mesh == "uniform":
        found.append('simulation.mesh = "uniform"')
    if drive.belt.elements is not None:
        found.append(f"belt.elements = {drive.belt.elements}")
    if settings.rtol > default:
        found.append(f"simulation.rtol = {settings.rtol:g}")
    return found


def ends_steadily(run: Run) -> bool:
    """Whether a run ends in what steady running may be compared with: a turn of the belt in which nothing changes."""
    pulleys = run.drive.pulleys
    if run.outputs == 0 or any(one.harmonics or any(load.orders for load in one.load) for one in pulleys):
        return False
    with run.recorded() as recorded:
        window = mean_window(recorded, run.prepared)
        balance = power_balance(recorded, window)
    return bool(window.turns and balance.power_in > 0.0 and abs(balance.stored) < _CHANGING * balance.lost)


def steady_losses(run: Run) -> dict[str, list[float]]:
    """Attributes of another run by which `off_steady_running` finds its errors."""
    means = means_of(run)
    return {
        STEADY_LOSSES: [
            means.balance.losses[cause] for cause in causes_of(toothed=run.drive.belt.teeth is not None).values()
        ],
        STEADY_SLIPS: [one.slip for one in means.pulleys],
    }


def _ending(run: Run) -> Iterator[Compared]:
    """The compared values at the end of a run."""
    summary = summarize(run)
    with run.recorded() as recorded:
        forces = _largest_contact_forces(recorded, summary)
    of_pulleys = (("speed", "rad/s", "speed"), ("slip", "1", "slip"), ("hub load", "N", "hub_load"))
    for quantity, unit, field in of_pulleys:
        for pulley in summary.pulleys:
            yield Compared(quantity, pulley.name, unit, getattr(pulley, field), np.nan)
    for pulley, force in zip(summary.pulleys, forces, strict=True):
        yield Compared("contact force", pulley.name, "N/m", force, np.nan)
    for span in summary.spans:
        yield Compared("tension", span.name, "N", span.tension, np.nan)
    for one in summary.tensioners:
        yield Compared("position", one.name, "rad" if one.rotary else "m", one.position, np.nan)


def _largest_contact_forces(recorded: Recorded, summary: Summary) -> list[float]:
    """Largest normal force per meter of belt on each pulley, averaged over time, N/m."""
    times = np.asarray(recorded["field_time"])
    rows = slice(int(np.searchsorted(times, min(summary.start, times[-1]))), None)
    force, touched = np.asarray(recorded["normal_force"])[rows], np.asarray(recorded["contact_pulley"])[rows]
    numbers = range(len(summary.pulleys))
    return [float(np.mean(np.max(np.where(touched == number, force, 0.0), axis=1))) for number in numbers]

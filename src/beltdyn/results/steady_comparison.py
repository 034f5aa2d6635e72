"""What a run ended in, beside the steady running under the same speeds and loads."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from beltdyn.results.recorded import Recorded
from beltdyn.results.run import Run
from beltdyn.results.summary import Summary, summarize

VALUES, FAILURE = "steady_values", "steady_failure"
"""Attributes of a run: the numbers of steady running in their order, or why there is none."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A number of a run and of steady running.

    Attributes
    ----------
    quantity : str
        "speed", "slip", "hub load", "contact force" (the largest normal force on a metre of belt), "tension" or
        "position" of a tensioner.
    name : str
        Name of the pulley, of the span, or of the tensioner's pulley.
    unit : str
        SI unit.
    run : float
        Mean over the end of the run.
    steady : float
        In steady running.

    Examples
    --------
    >>> slip = bd.Compared("slip", "driven", "%", run=0.21, steady=0.2)
    >>> print(f"{slip.quantity} of {slip.name}: {slip.run - slip.steady:+.2f} {slip.unit}")
    slip of driven: +0.01 %
    """

    quantity: str
    name: str
    unit: str
    run: float
    steady: float


def steady_comparison(run: Run) -> tuple[Compared, ...]:
    """Compare the end of a run with the steady running under the same speeds and loads.

    Parameters
    ----------
    run : Run
        Of ``simulate(drive, compare_steady=True)``.

    Returns
    -------
    tuple of Compared
        Nothing where the run was not to be compared, or there is no steady running.

    Examples
    --------
    >>> bd.steady_comparison(run)  # of bd.simulate(drive) alone
    ()
    """
    with run.recorded() as recorded:
        steady = np.atleast_1d(np.asarray(recorded.attrs.get(VALUES, []), dtype=float)).tolist()
    return tuple(replace(one, steady=value) for one, value in zip(_ending(run), steady, strict=True)) if steady else ()


def steady_values(run: Run) -> list[float]:
    """The numbers of steady running that `steady_comparison` finds in the attribute `VALUES` of another run.

    Parameters
    ----------
    run : Run
        Of `steady_state`, of the same pulleys, spans and tensioners.
    """
    return [one.run for one in _ending(run)]


def _ending(run: Run) -> Iterator[Compared]:
    """Numbers of the end of a run."""
    summary = summarize(run)
    with run.recorded() as recorded:
        forces = _largest_contact_forces(recorded, summary)
    of_pulleys = (("speed", "rad/s", "speed"), ("slip", "1", "slip"), ("hub load", "N", "hub_load"))
    for quantity, unit, attribute in of_pulleys:
        for pulley in summary.pulleys:
            yield Compared(quantity, pulley.name, unit, getattr(pulley, attribute), np.nan)
    for pulley, force in zip(summary.pulleys, forces, strict=True):
        yield Compared("contact force", pulley.name, "N/m", force, np.nan)
    for span in summary.spans:
        yield Compared("tension", span.name, "N", span.tension, np.nan)
    for one in summary.tensioners:
        yield Compared("position", one.name, "rad" if one.rotary else "m", one.position, np.nan)


def _largest_contact_forces(recorded: Recorded, summary: Summary) -> list[float]:
    """Largest normal force on a metre of belt on each pulley, N/m: a mean as the others."""
    times = np.asarray(recorded["field_time"])
    rows = slice(int(np.searchsorted(times, min(summary.start, times[-1]))), None)
    force, touched = np.asarray(recorded["normal_force"])[rows], np.asarray(recorded["contact_pulley"])[rows]
    numbers = range(len(summary.pulleys))
    return [float(np.mean(np.max(np.where(touched == number, force, 0.0), axis=1))) for number in numbers]

"""Comparison of the end of a run with steady running under the same speeds and loads."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from beltdyn.model import Drive
from beltdyn.model.simulation import Simulation
from beltdyn.results.balance import LOSSES, power_balance
from beltdyn.results.checks.steady import STEADY_LOSSES, STEADY_SLIPS
from beltdyn.results.cycles import mean_window
from beltdyn.results.recorded import Recorded
from beltdyn.results.run import Run
from beltdyn.results.summary import Summary, means_of, summarize

VALUES, FAILURE = "steady_values", "steady_failure"
"""Attributes of a run: the values in steady running in their order, or why there are none."""

_CHANGING = 0.3
"""Rate of the stored energy over the losses from which on a run has not settled: losses then differ by 2 % for that."""


@dataclass(frozen=True, slots=True)
class Compared:
    """A value at the end of a run and in steady running.

    Attributes
    ----------
    quantity : str
        "speed", "slip", "hub load", "contact force" (the largest normal force per metre of belt), "tension" or
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
        Empty if no comparison was asked for, or no steady running was found.

    Examples
    --------
    >>> bd.steady_comparison(run)  # of bd.simulate(drive) alone
    ()
    """
    with run.recorded() as recorded:
        steady = np.atleast_1d(np.asarray(recorded.attrs.get(VALUES, []), dtype=float)).tolist()
    return tuple(replace(one, steady=value) for one, value in zip(_ending(run), steady, strict=True)) if steady else ()


def steady_values(run: Run) -> list[float]:
    """The values in steady running that `steady_comparison` reads from the attribute `VALUES` of another run.

    Parameters
    ----------
    run : Run
        The result of `steady_state`, with the same pulleys, spans and tensioners.
    """
    return [one.run for one in _ending(run)]


def coarse_settings(drive: Drive) -> list[str]:
    """Settings of a run by which its losses and slip may differ from those on the mesh, and with the tolerance, chosen.

    Parameters
    ----------
    drive : Drive
        The drive as it is given.
    """
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
    """Whether a run ends in what steady running may be compared with: a turn of the belt in which nothing changes.

    Parameters
    ----------
    run : Run
        The run, not of steady running itself.
    """
    pulleys = run.drive.pulleys
    if run.outputs == 0 or any(one.harmonics or any(load.orders for load in one.load) for one in pulleys):
        return False
    with run.recorded() as recorded:
        window = mean_window(recorded, run.drive)
        balance = power_balance(recorded, window)
    return bool(window.turns and balance.power_in > 0.0 and abs(balance.stored) < _CHANGING * balance.lost)


def steady_losses(run: Run) -> dict[str, list[float]]:
    """Attributes of another run by which `off_steady_running` finds its errors.

    Parameters
    ----------
    run : Run
        Of `steady_state`, of the same pulleys.
    """
    means = means_of(run)
    return {
        STEADY_LOSSES: [means.balance.losses[cause] for cause in LOSSES.values()],
        STEADY_SLIPS: [one.slip for one in means.pulleys],
    }


def _ending(run: Run) -> Iterator[Compared]:
    """The compared values at the end of a run."""
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
    """Largest normal force per metre of belt on each pulley, averaged over time, N/m."""
    times = np.asarray(recorded["field_time"])
    rows = slice(int(np.searchsorted(times, min(summary.start, times[-1]))), None)
    force, touched = np.asarray(recorded["normal_force"])[rows], np.asarray(recorded["contact_pulley"])[rows]
    numbers = range(len(summary.pulleys))
    return [float(np.mean(np.max(np.where(touched == number, force, 0.0), axis=1))) for number in numbers]

"""An analysis: a run-up, in which the speed of a pulley rises linearly."""

from math import isfinite
from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.quantity import to_si
from beltdyn.results import Run
from beltdyn.solve.progress import Report
from beltdyn.solve.simulate import record_run

_LEAD = 0.1
"""Part of the run-up's duration in which the drive first reaches the speed that it starts from."""


def sweep(
    drive: Drive,
    *,
    pulley: str,
    from_: float | str,
    to: float | str,
    duration: float | str = 5.0,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Run:
    """Run a drive up through a range of speeds, for waterfall and order plots.

    The speed of one pulley rises linearly in place of what the drive says; its harmonics, loads and all else stay.
    Before, the drive runs up from rest to the first speed in a tenth of the duration. Spectra reach 0.375 over
    simulation.output_interval; `beltdyn plot FILE --figures waterfall,orders` draws them.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The name of the pulley, whose speed is prescribed.
    from_
        The speed at the beginning, with a unit, such as "700 rpm", or in rad/s.
    to
        The speed at the end, such as "6000 rpm".
    duration
        How long the run-up takes, with a unit, such as "5 s", or in s.
    output
        Result file (NetCDF4), written as the simulation goes; without one the results stay in memory.
    progress
        Called now and then with a `Progress`.
    overwrite
        Replace any regular file by the results, and not only earlier results.

    Returns
    -------
    Run
        As `simulate` gives it. Its attribute ``swept_pulley`` has the name of the pulley.

    Raises
    ------
    ModelError
        If there is no such pulley, its speed is not prescribed, or the numbers make no run-up; and as `simulate`.
    SimulationError
        As `simulate`.

    Examples
    --------
    >>> run = bd.sweep(drive, pulley="driver", from_="10 rpm", to="20 rpm", duration="10 ms")
    >>> run.dataset.pulley_speed.sel(pulley="driver")[-1].round(4).item()  # rad/s
    2.0944
    """
    start, end = _number("from", from_, "rad/s"), _number("to", to, "rad/s")
    raised = run_up(drive, pulley, start, end, _number("duration", duration, "s"))
    return record_run(raised, output, progress, overwrite, swept_pulley=pulley)


def run_up(drive: Drive, pulley: str, start: float, end: float, duration: float) -> Drive:
    """Let the speed of a pulley rise linearly.

    Parameters
    ----------
    drive
        The drive.
    pulley
        Name of the pulley.
    start, end
        Speeds, rad/s.
    duration
        How long the rise takes, s; a tenth of it is put before, to reach the first speed.

    Raises
    ------
    ModelError
        If there is no such pulley, its speed is not prescribed, or the numbers make no run-up.
    """
    names = [one.name for one in drive.pulleys]
    if pulley not in names:
        raise ModelError(f"pulley = {pulley!r} is not in this drive. Its pulleys are: {', '.join(names)}.")
    number = names.index(pulley)
    if not drive.pulleys[number].prescribed:
        driven = [one.name for one in drive.pulleys if one.prescribed]
        choice = f"Choose one of {', '.join(driven)}." if driven else "Give it a speed in the drive file."
        raise ModelError(f"pulley = {pulley!r} turns freely: a sweep prescribes its speed. {choice}")
    if not duration > 0.0:
        raise ModelError(f"duration = {duration:g} s must be above zero. Raise it.")
    if start * end < 0.0 or start == end:
        raise ModelError(
            f"from {start:g} to {end:g} rad/s is no run-up: the speeds must differ and have one sign. Change one."
        )
    lead = _LEAD * duration
    speed = {"kind": "table", "times": [0.0, lead, lead + duration], "values": [0.0, start, end]}
    pulleys = list(drive.pulleys)
    pulleys[number] = pulleys[number].replace(speed=speed)
    return drive.replace(pulley=pulleys, simulation=drive.simulation.replace(duration=lead + duration))


def _number(name: str, value: float | str, unit: str) -> float:
    """A quantity in SI units, with or without its unit."""
    try:
        number = to_si(value, unit) if isinstance(value, str) else float(value)
        if not isfinite(number):
            raise ValueError("must be a finite number")
    except ValueError as error:
        raise ModelError(f"{name} = {value!r} {error}.") from error
    return number

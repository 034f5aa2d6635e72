"""`beltdyn sweep`."""

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.cli.output import ended, require_output, simulate_to
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.model import Drive

_LEAD = 0.1
"""Part of the run-up's duration in which the drive first reaches the speed that it starts from."""


def sweep(
    file: Path,
    /,
    *,
    pulley: str,
    start: Annotated[str, Parameter(name="--from")],
    end: Annotated[str, Parameter(name="--to")],
    duration: str = "5 s",
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Run a drive up through a range of speeds, for waterfall and order plots.

    The speed of one pulley rises linearly in place of what the drive file says; its harmonics, loads and all else stay.
    Before, the drive runs up from rest to the first speed in a tenth of the duration.

    Parameters
    ----------
    file
        The drive file, TOML.
    pulley
        The name of the pulley, whose speed is prescribed.
    start
        The speed at the beginning, with a unit, such as "700 rpm".
    end
        The speed at the end, such as "6000 rpm".
    duration
        How long the run-up takes, such as "5 s".
    output
        The result file; by default the drive file's name with -sweep.nc.
    force
        Replace that file even if it is no result of an earlier run.
    """
    from beltdyn.model import load
    from beltdyn.results.schema import PASS_BAND

    path = output or file.with_name(f"{file.stem}-sweep.nc")
    require_output(path, (file,), csv=False, force=force)
    drive = run_up(load(file), pulley, *_numbers(start, end, duration))
    finished = simulate_to(drive, path, force)
    if finished.outputs:
        highest = PASS_BAND / drive.simulation.output_interval
        show(f"Spectra reach {highest:.4g} Hz; shorten simulation.output_interval for more. Draw them with:")
        show(f'  beltdyn plot {path} --figures waterfall,orders --pulley "{pulley}"')
    return ended(finished)


def run_up(drive: "Drive", pulley: str, start: float, end: float, duration: float) -> "Drive":
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
        raise ModelError(f"from {start:g} to {end:g} rad/s is no run-up: the speeds must differ and have one sign.")
    lead = _LEAD * duration
    speed = {"kind": "table", "times": [0.0, lead, lead + duration], "values": [0.0, start, end]}
    pulleys = list(drive.pulleys)
    pulleys[number] = pulleys[number].replace(speed=speed)
    return drive.replace(pulley=pulleys, simulation=drive.simulation.replace(duration=lead + duration))


def _numbers(start: str, end: str, duration: str) -> tuple[float, float, float]:
    """Read the quantities of the command line, or say which one is wrong."""
    from beltdyn.parts.quantity import to_si

    numbers = []
    for option, text, unit in (("--from", start, "rad/s"), ("--to", end, "rad/s"), ("--duration", duration, "s")):
        try:
            plain = _plain(text)
            numbers.append(to_si(text, unit) if plain is None else plain)
            if not isfinite(numbers[-1]):
                raise ValueError("must be a finite number")
        except ValueError as error:
            raise ModelError(f'{option} "{text}" {error}.') from error
    return numbers[0], numbers[1], numbers[2]


def _plain(text: str) -> float | None:
    """A number without a unit, which is in SI units; None if it has one."""
    try:
        return float(text)
    except ValueError:
        return None

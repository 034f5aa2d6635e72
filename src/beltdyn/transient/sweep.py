"""Run-up: a simulation in which the speed of a pulley rises linearly."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from beltdyn.errors import ModelError
from beltdyn.machines import Constant, FunctionLoad, Load, Profile
from beltdyn.model import Drive, prepare
from beltdyn.observation.observer import SlipThrough
from beltdyn.parts.options import takes_options
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import number_in, with_other_sense
from beltdyn.results import Run
from beltdyn.solvers.run_progress import Report
from beltdyn.state.settling import Settling
from beltdyn.transient.simulate import record_run

_Part = TypeVar("_Part", bound=Part)
_LEAD = 0.1
"""Part of the run-up's duration in which the drive reaches the speed that it starts from, before the recording."""
_LATE = 1e9
"""An instant when nothing changes any more, s."""


@takes_options
def sweep(
    drive: Drive,
    *,
    pulley: str,
    from_: float | str,
    to: float | str,
    duration: float | str = 5.0,
    settling: float | str | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Run:
    """Simulate a run-up through a range of speeds, for waterfall and order plots.

    The speed of one pulley rises linearly instead of its profile; its harmonics are kept. Other time-dependent
    quantities, such as load schedules, keep their final values, and motors run in delta; Python functions get the time
    of the run-up, and before it that of settling. The recording starts at the first speed once the starting transients
    have decayed. The run ends early at gross slip. Spectra reach 0.375 over simulation.output_interval; `beltdyn plot
    FILE --figures waterfall,orders` draws them.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The name of the pulley, whose speed is prescribed.
    from_
        Initial speed with a unit, such as "700 rpm", or in rad/s.
    to
        Final speed, such as "6000 rpm".
    duration
        Duration of the run-up with a unit, such as "5 s", or in s.
    settling
        Longest settling time at the first speed, such as "2 s"; by default the duration of the run-up. It is shorter if
        transients decay sooner.
    output
        Result file (NetCDF4), written during the simulation; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Run
        As `simulate` gives it. Attributes of its dataset are ``swept_pulley``, the name of the pulley;
        ``settling_time``, the time before the recording, s; ``settling_left``, the transient left in the span tensions,
        over the largest mean span tension; and ``held``, the quantities held constant.

    Raises
    ------
    ModelError
        If there is no such pulley, its speed is not prescribed, or the speeds make no run-up; and as `simulate`.
    SimulationError
        As `simulate`; a `SlipError` at gross slip.

    Examples
    --------
    >>> run = bd.sweep(drive, pulley="driver", from_="10 rpm", to="20 rpm", duration="10 ms")
    >>> run.dataset.pulley_speed.sel(pulley="driver")[-1].round(4).item()  # rad/s
    2.0944
    """
    if drive.is_web:
        raise ModelError(
            "a run-up needs a closed belt, and this is a web line, whose rollers keep their draws. Give them speeds "
            "over time, and use `beltdyn simulate`."
        )
    start, end = _speed_in(drive, "from", from_), _speed_in(drive, "to", to)
    length = number_in("duration", duration, "s")
    longest = length if settling is None else number_in("settling", settling, "s")
    steady, held = without_schedules(drive)
    raised = run_up(steady, pulley, start, end, length)
    if not longest > 0.0:
        raise ModelError(f"settling = {longest:g} s must be above zero. Increase it, or omit it.")
    number = drive.number_of(pulley)
    return record_run(
        raised,
        output,
        progress,
        overwrite,
        begin=Settling(number, start, _LEAD * length, longest) if start != 0.0 else None,
        watch=None if drive.ends else SlipThrough(prepare(raised), number),
        drive_as_given=drive.text,
        swept_pulley=pulley,
        held=", ".join(one for one in held if not one.startswith(f"{pulley}.speed = ")),
    )


def _speed_in(drive: Drive, name: str, given: float | str) -> float:
    """A speed, positive in the sense in which speeds of the drive are so."""
    if isinstance(given, str) and drive.positive_sense < 0:
        given = with_other_sense(given)
    return number_in(name, given, "rad/s")


def without_schedules(drive: Drive, at: float = _LATE) -> tuple[Drive, list[str]]:
    """Let all that changes over time keep its value at an instant."""
    held = list[str]()

    def constant(part: _Part, name: str, **others: Any) -> _Part:
        profiles = {key: value for key in type(part).model_fields if isinstance(value := getattr(part, key), Profile)}
        final = {key: float(profile.at([at])[0]) for key, profile in profiles.items()}
        held.extend(f"{name}.{key} = {final[key]:.4g}" for key in final if not isinstance(profiles[key], Constant))
        values = {key: Constant(value=value) for key, value in final.items()}
        return part.replace(**values, **others) if values or others else part

    def all_constant(parts: Sequence[_Part], name: str) -> list[_Part]:
        return [constant(part, f"{name}[{number}]", **_held(part, at)) for number, part in enumerate(parts, 1)]

    for one in drive.pulleys:
        for number, load in enumerate(one.load, 1):
            for key, value in load.held_at(at).items():
                name = f"{one.name}.load[{number}]"
                held.append(f"{name} without {key}" if value is None else f"{name}.{key} = {value.value:.4g}")
            if isinstance(load, FunctionLoad):
                held.append(f"{one.name}.load[{number}] not held (a function of time)")
    pulleys = [
        constant(
            one,
            one.name,
            load=all_constant(one.load, f"{one.name}.load"),
            hub=all_constant(one.hub, f"{one.name}.hub"),
        )
        for one in drive.pulleys
    ]
    goods = [constant(one, f"goods[{number}]") for number, one in enumerate(drive.goods, 1)]
    return drive.replace(pulley=pulleys, goods=goods), held


def _held(part: Part, at: float) -> Mapping[str, Any]:
    """What a load has that stays as it is at an instant (s)."""
    return part.held_at(at) if isinstance(part, Load) else {}


def run_up(drive: Drive, pulley: str, start: float, end: float, duration: float) -> Drive:
    """Let the speed of a pulley rise linearly."""
    number = drive.number_of(pulley)
    if not drive.pulleys[number].prescribed:
        driven = [one.name for one in drive.pulleys if one.prescribed]
        choice = f"Choose one of {', '.join(driven)}." if driven else "Give it a speed in the drive file."
        raise ModelError(f"pulley = {pulley!r} turns freely, but a sweep needs a prescribed speed. {choice}")
    if not duration > 0.0:
        raise ModelError(f"duration = {duration:g} s must be above zero. Increase it.")
    if start * end < 0.0 or start == end:
        raise ModelError(
            f"from {start:g} to {end:g} rad/s is not a run-up: the speeds must differ and have the same sign."
        )
    speed = {"kind": "table", "times": [0.0, duration], "values": [start, end]}
    pulleys = list(drive.pulleys)
    pulleys[number] = pulleys[number].replace(speed=speed)
    settings = drive.simulation
    begun = "laid" if settings.start == "laid" else "equilibrium"
    return drive.replace(pulley=pulleys, simulation=settings.replace(duration=duration, start=begun, start_at=None))

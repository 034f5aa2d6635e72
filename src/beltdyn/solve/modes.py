"""Modes of a drive about rest, steady running or a state of a run: frequency, damping and shape."""

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.number_range import numbers_in
from beltdyn.parts.quantity import RPM
from beltdyn.results import Result, Run
from beltdyn.results.recorded import runs_steadily
from beltdyn.solve.earlier_run import instant_of
from beltdyn.solve.progress import Report
from beltdyn.solve.steady import steady_state
from beltdyn.solve.steady_running.changed_drive import at_speed, driver_of, held_at, sense_of
from beltdyn.solve.vibration.eigenvalues import MOST_SWINGING
from beltdyn.solve.vibration.mode_table import modes_about
from beltdyn.solve.vibration.run_state import require_mesh_that_stays
from beltdyn.solve.vibration.small_motions import about_instant, about_rest, about_steady

REST: str = "rest"
STEADY: str = "steady"


def modes(
    drive: Drive | Run,
    *,
    about: str | Run = STEADY,
    speed: str | None = None,
    pulley: str | None = None,
    at: float | str | None = None,
    count: int = 12,
    force_tolerance: float | None = None,
    progress: Report | None = None,
) -> Result:
    """Compute the modes of a drive: frequency, damping ratio and shape.

    Small vibrations about a steady state: at rest with a belt that sticks to its pulleys, or in steady running with its
    creep and sliding. Pulleys of prescribed speed do not vibrate. For tensioners with dry friction modes are given
    twice: with tensioners sliding without friction, and with stuck tensioners.

    Modes are numbered by frequency, those with stuck tensioners from 101. Modes with a damping ratio below 0.5 come
    first, then those that barely resonate, such as tensioner motions damped by belt creep.

    Parameters
    ----------
    drive
        The drive, or a run, which gives the drive and `about`.
    about
        "steady" or "rest"; or the result of `steady_state`, or of a run over time on a staying mesh, whose drive is
        then used. The state of a run at an instant is treated as a steady state.
    speed
        Speed of the driver, such as "800 rpm", in place of its motor; by default that of the drive file.
    pulley
        The pulley whose speed is prescribed by `speed`; by default the driver.
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation. For a run over time an instant of its outputs along the belt, by default the last.
    count
        Number of lightly damped modes, from the lowest frequency, up to 99. Heavily damped modes in between are
        included, up to 99 modes in total.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh of steady running is
        refined; by default that of the drive, 0.01.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Result
        Variables along ``mode``.

    Raises
    ------
    ModelError
        If the belt is open, the drive cannot run steadily, or options are incompatible.
    ConvergenceError
        If there is no such state, or no oscillating mode.

    Examples
    --------
    >>> found = bd.modes(drive, about="rest", count=3)
    >>> found.dataset.frequency.values.round(1).tolist()  # Hz
    [9.2, 21.0, 21.0]
    >>> found.dataset.kind.values.tolist()
    ['rotational', 'span', 'span']
    """
    given = drive.drive_as_given if isinstance(drive, Run) else drive.text
    if isinstance(drive, Run):
        if about != STEADY:
            raise ModelError("about cannot be given with a run, which is itself the state. Omit about.")
        about, drive = drive, drive.drive
    _require_sense(about, speed, pulley, at, count)
    if isinstance(about, Run) and not runs_steadily(about.dataset):
        require_mesh_that_stays(about)
        drive, instant = about.drive, instant_of(about, at)
        motions, state = about_instant(about, instant), f"in its run at t = {instant:.6g} s"
    elif isinstance(about, Run):
        motions, state = about_steady(about), _running(about)
    elif about == REST:
        motions, state = about_rest(drive), "at rest"
    else:
        held = drive if speed is None else _at_speed(drive, speed, pulley, at)
        run = steady_state(held, at=at, force_tolerance=force_tolerance, progress=progress)
        motions, state = about_steady(run), _running(run)
    result = modes_about(motions, count)
    told = {"title": f"Modes of {drive.title}, {state}", "drive_as_given": given}
    return Result(result.dataset.assign_attrs(told), result.drive)


def _require_sense(about: str | Run, speed: str | None, pulley: str | None, at: float | str | None, count: int) -> None:
    """Make sure that the options make sense."""
    if count < 1:
        raise ModelError(f"count = {count} must be 1 or more.")
    if count > MOST_SWINGING:
        raise ModelError(f"count = {count} exceeds the limit of {MOST_SWINGING} modes. Give fewer.")
    if not isinstance(about, Run) and about not in (REST, STEADY):
        raise ModelError(
            f'about = {about!r} is not a state. Give "{REST}", "{STEADY}", or a result of `steady_state` or `simulate`.'
        )
    if isinstance(about, Run) and not runs_steadily(about.dataset):
        if speed is not None or pulley is not None:
            raise ModelError(
                "speed and pulley cannot be given with a run over time, which has its own speeds. Omit them."
            )
    elif about != STEADY and any(one is not None for one in (speed, pulley, at)):
        raise ModelError(f'speed, pulley and at require about = "{STEADY}". Omit them.')
    if pulley is not None and speed is None:
        raise ModelError(f"pulley = {pulley!r} needs a speed to prescribe. Give speed.")


def _at_speed(drive: Drive, speed: str, pulley: str | None, at: float | str | None) -> Drive:
    """The drive with a pulley at a speed."""
    values = numbers_in("speed", speed, "rad/s", 2)
    if values.size > 1:
        raise ModelError(f'speed = {speed!r} must be a single speed, such as "800 rpm".')
    held = held_at(drive, at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    return at_speed(held, number, sense_of(held, number) * float(values[0]))


def _running(run: Run) -> str:
    """The state of steady running in words."""
    driver = run.drive.reference
    name, speed = run.drive.pulleys[driver].name, float(run.dataset["pulley_speed"][-1, driver])
    return f"in steady running with {name} at {RPM * speed:.4g} rpm"

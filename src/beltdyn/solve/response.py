"""Forced response: linear response of steady running to harmonics of speeds and loads, over speed."""

from pathlib import Path
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.number_range import numbers_in
from beltdyn.results import Result, Run, Variable
from beltdyn.solve.progress import Report
from beltdyn.solve.steady_running.changed_drive import at_instant, at_speed, driver_of, held_at, sense_of
from beltdyn.solve.steady_running.operating_points import Axes, OperatingPoints
from beltdyn.solve.steady_running.point_values import labels_of
from beltdyn.solve.vibration.forced_motion import ForcedMotion
from beltdyn.solve.vibration.mode_table import SLIDING, STUCK
from beltdyn.solve.vibration.response_answers import Answers
from beltdyn.solve.vibration.response_comparison import Place, measured_amplitudes, run_up_amplitudes
from beltdyn.solve.vibration.waves import averaged

_KEPT = (
    *("belt_speed", "largest_tension", "least_slip_safety"),
    *("pulley_speed", "span_tension", "hub_load", "tensioner_position", "failure"),
)
"""Variables of operating points that are kept: what responses swing about."""


def response(
    drive: Drive,
    *,
    speed: str,
    pulley: str | None = None,
    points: int = 40,
    dry_tensioners: str = SLIDING,
    compare: Path | str | Run | None = None,
    measured: Path | str | None = None,
    at: float | str | None = None,
    force_tolerance: float | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute the forced response to harmonics of speeds and loads over speed (order cuts) by linear analysis.

    Small vibrations about steady running at each speed, at the frequencies of the orders. Loads are those of the drive
    file at one instant; speed-dependent loads follow the speed. Speeds without steady running are marked as failed.

    Parameters
    ----------
    drive
        The drive, with harmonics of a prescribed speed or of loads, or with torques over the shaft angle.
    speed
        Speeds of the pulley: a range such as "700..6000 rpm", or a list "700, 1500, 3000 rpm"; positive in its sense of
        rotation.
    pulley
        The pulley whose speed is prescribed; by default the driver.
    points
        Number of speeds of a range.
    dry_tensioners
        "sliding" for tensioners without dry friction, as in large vibrations, or "stuck" for tensioners held by it, as
        in small ones.
    compare
        A result file of `sweep`, or its result: adds the amplitudes of the same orders in the run-up.
    measured
        A CSV file of measured amplitudes to add: a column "speed [rpm]", and columns such as "span_tension crank-idler
        order 2 [N]".
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), updated point by point; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Along ``speed`` (rad/s, of the pulley in the attribute ``pulley``), ``excitation`` and pulley, span or tensioner
        amplitudes ``NAME_amplitude`` and phases ``NAME_phase``: NAME is its mean, and amplitude times
        cos(order times the angle of the exciting shaft + phase) beside.

    Raises
    ------
    ModelError
        If nothing excites the drive, options are invalid, or the drive cannot run steadily.
    ConvergenceError
        If no speed has steady running.

    Examples
    --------
    >>> waves = [{"order": 2, "amplitude": 0.02}]
    >>> shaking = drive.replace(pulley=[drive.pulleys[0].replace(harmonics=waves), drive.pulleys[1]])
    >>> found = bd.response(shaking, speed="80, 120 rpm")
    >>> found.dataset.span_tension_amplitude.dims
    ('speed', 'excitation', 'span')
    """
    if dry_tensioners not in (SLIDING, STUCK):
        raise ModelError(f'dry_tensioners = {dry_tensioners!r} must be "{SLIDING}" or "{STUCK}".')
    given, exciting = held_at(averaged(drive), at), at_instant(drive, at)
    number = driver_of(given) if pulley is None else given.number_of(pulley)
    name, sense = given.pulleys[number].name, sense_of(given, number)
    speeds = numbers_in("speed", speed, "rad/s", points)
    if speeds[0] < 0.0:
        raise ModelError(
            f"speed = {speed!r} must not be negative: speeds are positive in the pulley's sense of rotation."
        )
    answers = Answers(exciting, number, speeds)
    place, beside = Place(speeds, number, answers.excitations, labels_of(given)), dict[str, Any]()
    if compare is not None:
        beside |= run_up_amplitudes(compare, place)
    if measured is not None:
        beside |= measured_amplitudes(Path(measured), place)
    axes: Axes = {"speed": (Variable(("speed",), "rad/s", f"Speed of {name}"), speeds)}
    with OperatingPoints("response", given, axes, output, progress, overwrite, names=_KEPT) as table:
        title = f"Response of {drive.title} over the speed of {name}"
        table.attributes = {"title": title, "drive_as_given": drive.text, "pulley": name}
        table.attributes["dry_tensioners"] = dry_tensioners
        table.more, table.derive = answers.coordinates, lambda arrays: {**answers.variables(), **beside}

        def take(index: tuple[int, ...], run: Run | None) -> None:
            if run is not None:
                answers.take(index[0], run, ForcedMotion(run, dry_tensioners == STUCK))
                table.notes = answers.warnings(table.arrays)

        def drive_at(value: float) -> Drive:
            return at_speed(given, number, sense * value)

        table.each(drive_at, force_tolerance, then=take, found_then="response")
    return table.result()

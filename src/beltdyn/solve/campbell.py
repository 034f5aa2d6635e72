"""Campbell diagram: modes about steady running over speed, and critical speeds."""

from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.number_range import numbers_in
from beltdyn.results import Result, Run, Variable
from beltdyn.solve.progress import Report
from beltdyn.solve.steady_running.changed_drive import at_instant, at_speed, driver_of, held_at, sense_of
from beltdyn.solve.steady_running.operating_points import Axes, OperatingPoints
from beltdyn.solve.vibration.campbell_diagram import CampbellDiagram
from beltdyn.solve.vibration.excitation import given_excitations, own_excitations
from beltdyn.solve.vibration.mode_table import SLIDING, STUCK
from beltdyn.solve.vibration.waves import averaged

_KEPT = (
    *("belt_speed", "largest_tension", "least_slip_safety"),
    *("pulley_speed", "span_tension", "tensioner_position", "failure"),
)
"""Variables of operating points that are kept."""


def campbell(
    drive: Drive,
    *,
    speed: str,
    pulley: str | None = None,
    points: int = 40,
    count: int = 8,
    orders: str | None = None,
    dry_tensioners: str = SLIDING,
    at: float | str | None = None,
    force_tolerance: float | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute a Campbell diagram: the modes of a drive over speed, and the critical speeds at which orders excite them.

    Modes are those of `modes`, about steady running, and are tracked over speed by their shapes. Loads are those of the
    drive file at one instant; speed-dependent loads follow the speed. Speeds without steady running are marked as
    failed.

    Parameters
    ----------
    drive
        The drive.
    speed
        Speeds of the pulley: a range such as "700..6000 rpm", or a list "700, 1500, 3000 rpm"; positive in its sense of
        rotation.
    pulley
        The pulley whose speed is prescribed, in place of its motor; by default the driver.
    points
        Number of speeds of a range.
    count
        Number of modes at each speed, from the lowest frequency.
    orders
        Exciting orders of the pulley's rotation, such as "1, 2, 4". By default the harmonics of speeds and loads in the
        drive file, and the rotation of all pulleys and of the belt.
    dry_tensioners
        "sliding" for tensioners without dry friction, as in large vibrations, or "stuck" for tensioners held by it, as
        in small ones.
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
        Variables along ``speed`` (rad/s, of the pulley in the attribute ``pulley``) and ``mode``; ``critical`` speeds,
        and the frequencies of each ``excitation``.

    Raises
    ------
    ModelError
        If options are invalid, or the drive cannot run steadily.
    ConvergenceError
        If no speed has steady running.

    Examples
    --------
    >>> found = bd.campbell(drive, speed="80, 120 rpm", count=2)
    >>> found.dataset.frequency.dims
    ('speed', 'mode')
    """
    if count < 1:
        raise ModelError(f"count = {count} must be 1 or more.")
    if dry_tensioners not in (SLIDING, STUCK):
        raise ModelError(f'dry_tensioners = {dry_tensioners!r} must be "{SLIDING}" or "{STUCK}".')
    held = held_at(averaged(drive), at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    name, sense = held.pulleys[number].name, sense_of(held, number)
    excitations = own_excitations(at_instant(drive, at)) if orders is None else given_excitations(orders, held, number)
    speeds = numbers_in("speed", speed, "rad/s", points)
    if speeds[0] < 0.0:
        raise ModelError(
            f"speed = {speed!r} must not be negative: speeds are positive in the pulley's sense of rotation."
        )
    axes: Axes = {"speed": (Variable(("speed",), "rad/s", f"Speed of {name}"), speeds)}
    with OperatingPoints("campbell", held, axes, output, progress, overwrite, names=_KEPT) as table:
        title = f"Campbell diagram of {drive.title} over the speed of {name}"
        table.attributes = {
            "title": title,
            "drive_as_given": drive.text,
            "pulley": name,
            "dry_tensioners": dry_tensioners,
        }
        diagram = CampbellDiagram(held, speeds, excitations, count, dry_tensioners == STUCK)

        def take(_: tuple[int, ...], run: Run | None) -> None:
            diagram.take(run)
            if diagram.found:
                table.more, table.derive, table.notes = diagram.coordinates, diagram.variables, diagram.warnings

        def drive_at(value: float) -> Drive:
            return at_speed(held, number, sense * value)

        table.each(drive_at, force_tolerance, then=take, found_then="modes")
    return table.result()

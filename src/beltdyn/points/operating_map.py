"""Operating map: operating points over speed, load, or both."""

from collections.abc import Mapping
from pathlib import Path

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.points.changed_drive import at_speed_under, driver_of, held_at, sense_of, with_load
from beltdyn.points.operating_points import OperatingPoints, serpentine
from beltdyn.results import Result, Variable
from beltdyn.solvers.progress import Report


def operating_map(
    drive: Drive,
    *,
    pulley: str | None = None,
    speed: Numbers | None = None,
    load: Numbers | None = None,
    points: int = 40,
    load_points: int = 10,
    at: float | str | None = None,
    force_tolerance: float | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute operating points over speed, load, or both: tensions, slip, hub loads, efficiency.

    Each point is steady running as of `steady_state`, found from the previous point. Loads are those of the drive file
    at one instant; speed-dependent loads follow the speed. Points without steady running are marked as failed.

    Parameters
    ----------
    drive
        The drive.
    pulley
        The pulley whose speed is prescribed, in place of its motor; by default the driver.
    speed
        Its speeds: a range such as "700..6000 rpm", a list "700, 1500, 3000 rpm", or an array in rad/s; positive in
        its sense of rotation. By default those of the drive file.
    load
        Factors on all torques and loads except motors: a range such as "0.2..1.2", a list, or an array.
    points
        Number of speeds of a range.
    load_points
        Number of factors of a range.
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
        Variables along ``speed`` (rad/s, of the pulley in the attribute ``pulley``), ``load``, or both.

    Raises
    ------
    ModelError
        If neither speed nor load is given, a range is invalid, or the drive cannot run steadily.
    ConvergenceError
        If no point has steady running.

    Examples
    --------
    >>> found = bd.operating_map(drive, speed="60..120 rpm", points=3)
    >>> found.dataset.efficiency.dims
    ('speed',)
    """
    if speed is None and load is None:
        raise ModelError('a map needs speed, load or both. Give speed = "700..6000 rpm", or load = "0.2..1.2".')
    held = held_at(drive, at)
    number = driver_of(held) if pulley is None else held.number_of(pulley)
    name = held.pulleys[number].name
    axes = dict[str, tuple[Variable, FloatArray]]()
    if speed is not None:
        axes["speed"] = Variable(("speed",), "rad/s", f"Speed of {name}"), numbers_in("speed", speed, "rad/s", points)
    if load is not None:
        axes["load"] = Variable(("load",), "1", "Load"), load_factors(load, load_points)
    with OperatingPoints("operating_map", held, axes, output, progress, overwrite) as table:
        table.attributes = {"drive_as_given": drive.text, "pulley": name}

        def drive_at(*values: float) -> Drive:
            return at_point(held, number, dict(zip(axes, values, strict=True)))

        table.each(drive_at, force_tolerance, order=serpentine(table.shape))
    return table.result()


def at_point(held: Drive, pulley: int, there: Mapping[str, float]) -> Drive:
    """The drive at an operating point of a map."""
    factor = there.get("load", 1.0)
    if "speed" not in there:
        return with_load(held, factor)
    return at_speed_under(held, pulley, sense_of(held, pulley) * there["speed"], factor)


def load_factors(load: Numbers, count: int) -> FloatArray:
    """Factors on loads."""
    factors = numbers_in("load", load, "", count)
    if factors[0] < 0.0:
        raise ModelError(
            f"load = {load!r} contains a negative factor, with which loads would drive. Start at zero or above."
        )
    return factors

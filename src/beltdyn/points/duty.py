"""Duty cycle: operating points of a duty table, and means weighted by duration."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Pulley
from beltdyn.model.parameter_study import PASS, columns_of
from beltdyn.parts.change import Steps, meaning_of
from beltdyn.parts.messages import suggest
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.table_file import HeadedColumn, read_headed
from beltdyn.points.changed_drive import (
    driver_of,
    held_at,
    sense_of,
    turned,
    turned_at,
    under_power,
    under_torque,
    with_load,
)
from beltdyn.points.operating_points import VARIABLES, Axes, OperatingPoints
from beltdyn.results import Result, Variable
from beltdyn.solvers.run_progress import Report

UNITS = {
    "duration": "s",
    "share": "",
    "load": "",
    "temperature": "degC",
    "speed": "rad/s",
    "torque": "N m",
    "power": "W",
}
"""What columns hold, and their SI units."""
_OF_PULLEYS = ("speed", "torque", "power")
_HEADINGS = (
    '"duration [s]" or "share [%]", "load", "temperature [°C]", "speed [rpm]" of the driver, or "NAME speed '
    '[rpm]", "NAME '
    'torque [N m]" or "NAME power [kW]"'
)
_MEANS = ("pulley_slip", "power", "hub_load", "span_tension", "loss")
_EXPONENT = 3.0
"""Of the load in the life of ball bearings (ISO 281)."""


class Column(NamedTuple):
    """A column of a duty table."""

    what: str
    """"duration", "load", "temperature", "speed", "torque" or "power"."""
    pulley: str
    """Of a speed, torque or power; empty of others, and of the driver's speed in its sense of rotation."""
    values: Sequence[Any]
    """In SI units; None where a row leaves it open."""

    @property
    def heading(self) -> str:
        """The heading without its unit."""
        return f"{self.pulley} {self.what}".strip()


@takes_options
def duty(
    drive: Drive,
    *,
    table: Path | str | None = None,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    r"""Compute the operating points of a duty table, with means weighted by duration.

    The table is that of the drive file, its groups ``[[duty]]``, or a CSV file with a line of headings: "duration [s]"
    or "share [%]" of time, "speed [rpm]" of the driver in its sense of rotation, "NAME power [kW]", the power that a
    pulley takes, or "NAME torque [N m]" and "NAME speed [rpm]", counter-clockwise positive, "load", the factor on all
    torques and loads of the drive file but those of motors, and on goods, and "temperature [°C]" of the belt, on which
    its life depends. Each line is an operating point. Quantities without a column are those of the drive file.

    Parameters
    ----------
    drive
        The drive.
    table
        The CSV file; by default the groups ``[[duty]]`` of the drive file.
    at
        Instant at which the rest of the drive is evaluated, such as "0.5 s", or in s; by default the end of the
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
        Variables along ``row``, and their means over all rows that have an operating point: ``mean_power_in``,
        ``mean_efficiency`` and others; ``equivalent_hub_load`` is the cubic mean over the turns of each pulley, which
        gives the same life of ball bearings.

    Raises
    ------
    ModelError
        If there is no duty table, or the drive cannot run steadily.
    ConvergenceError
        If no row has steady running.

    Examples
    --------
    >>> from pathlib import Path
    >>> _ = Path("duty.csv").write_text("duration [s], driver speed [rpm]\n60, 90\n30, 120\n")
    >>> bd.duty(drive, table="duty.csv").dataset.efficiency.dims
    ('row',)
    """
    columns = duty_of(drive, table)
    if columns is None:
        raise ModelError("the drive has no duty. Give groups [[duty]] in the drive file, or a CSV file with table.")
    held = held_at(drive, at)
    durations = durations_of(columns)
    axes = {"row": (Variable(("row",), "1", "Row", "int64"), np.arange(1, durations.size + 1))}
    with OperatingPoints("duty", held, axes, output, progress, overwrite) as points:
        points.more = {"duration": (Variable(("row",), "s", "Duration"), durations)}
        points.derive = partial(_means, durations=durations)
        points.attributes = {"drive_as_given": drive.text}
        points.each(lambda row: at_row(held, columns, row - 1), force_tolerance)
    return points.result()


def duty_of(drive: Drive, table: Path | str | None) -> list[Column] | None:
    """The duty of a table, or else of the drive file; None without either."""
    if table is not None:
        columns, names = read_duty(Path(table)), [one.name for one in drive.pulleys]
        for one in columns:
            if one.pulley and one.pulley not in names:
                raise ModelError(
                    f'{table}: the heading "{one.pulley} {one.what}" names no pulley of the drive. '
                    f"{suggest(one.pulley, names)}"
                )
        require_distinct_columns(drive, columns, table)
        return columns
    return [Column(*key, values) for key, values in columns_of(drive.duty).items()] if drive.duty else None


def require_distinct_columns(
    drive: Drive, columns: Sequence[Column], source: object, numbers: Sequence[str] = ()
) -> None:
    """Make sure that columns, and numbers of the drive that vary besides, set different values.

    Parameters
    ----------
    drive
        The drive.
    columns
        What differs from row to row.
    source
        What has the columns, such as the path of a table.
    numbers
        Paths of numbers, as `Drive.with_` takes them.
    """
    known = [(one, _meaning(drive, one)) for one in columns if one.what not in ("duration", "load")]
    for place, (one, meaning) in enumerate(known):
        for other, same in known[:place]:
            if meaning == same:
                which = "the torque" if meaning[-1] == "torque" else "the same value"
                raise ModelError(f'{source}: "{other.heading}" and "{one.heading}" both give {which}. Remove one.')
        for path in numbers:
            if meaning_of(drive, path)[: len(meaning)] == meaning:
                raise ModelError(
                    f'{source}: the column "{one.heading}" gives the number "{path}", which varies besides. Remove one.'
                )


def _meaning(drive: Drive, column: Column) -> Steps:
    """The value of a drive that a column gives, as from `meaning_of`; a power is given by a torque."""
    if column.what == "temperature":
        return ("belt", "temperature")
    number = drive.number_of(column.pulley) if column.pulley else driver_of(drive)
    return ("pulley", f"{number + 1}", "speed" if column.what == "speed" else "torque")


def read_duty(path: Path) -> list[Column]:
    """Read a duty table; shares of time are those of an hour."""
    columns = [_column(one) for one in read_headed("table", path)]
    times = [(place, one) for place, one in enumerate(columns) if one.what in ("duration", "share")]
    numbers = [value for _, one in times for value in one.values if value is not None]
    if len(times) != 1 or min(numbers) < 0.0 or not sum(numbers) > 0.0:
        raise ModelError(
            f'{path} needs one column "duration [s]" or "share [%]" of non-negative numbers, not all zero.'
        )
    place, time = times[0]
    scale = PASS if time.what == "share" else 1.0
    columns[place] = Column("duration", "", [scale * value for value in numbers])
    return columns


def _column(given: HeadedColumn) -> Column:
    """A column in SI units."""
    pulley, _, what = given.what.rpartition(" ")
    if what not in UNITS or (bool(pulley) != (what in _OF_PULLEYS) and given.what != "speed"):
        raise ModelError(f'{given.path}: the heading "{given.what}" must be {_HEADINGS}.')
    return Column(what, pulley.strip(), given.values(UNITS[what]))


def durations_of(columns: list[Column]) -> FloatArray:
    """Durations of the rows of a table, s."""
    return np.array(next(one.values for one in columns if one.what == "duration"), dtype=float)


def at_row(held: Drive, columns: list[Column], row: int) -> Drive:
    """The drive at the operating point of a row of a table: speeds first, from which powers give torques."""
    given = [(one, value) for one in columns if (value := one.values[row]) is not None]
    load = next((value for one, value in given if one.what == "load"), 1.0)
    if load < 0.0:
        raise ModelError(f"row {row + 1}: load = {load:g} is negative, with which loads would drive.")
    held = with_load(held, load)
    pulleys, belt = list(held.pulleys), held.belt
    for one, value in sorted(given, key=lambda column: column[0].what != "speed"):
        if one.what == "speed" and not one.pulley:
            driver = driver_of(held)
            pulleys = turned(held, pulleys, driver, sense_of(held, driver) * value)
        elif one.what in _OF_PULLEYS:
            number = held.number_of(one.pulley)
            pulleys[number] = _CHANGES[one.what](held, number, value, pulleys)
        elif one.what == "temperature":
            belt = belt.replace(temperature=value)
    return held.replace(pulley=pulleys, belt=belt)


_CHANGES: dict[str, Callable[[Drive, int, float, list[Pulley]], Pulley]] = {
    "speed": lambda drive, number, speed, pulleys: turned_at(pulleys[number], speed),
    "torque": lambda drive, number, torque, pulleys: under_torque(pulleys[number], torque),
    "power": under_power,
}


def _means(arrays: Mapping[str, NDArray[np.float64]], durations: NDArray[np.float64]) -> Axes:
    """Means over the rows that were found, weighted by their durations."""
    found = np.isfinite(arrays["power_in"])
    weights = durations[found]
    if not weights.sum() > 0.0:
        return {}
    return dict(_mean_of(arrays, found, weights))


def _mean_of(
    arrays: Mapping[str, NDArray[np.float64]], found: NDArray[np.bool_], weights: NDArray[np.float64]
) -> Iterator[tuple[str, tuple[Variable, ArrayLike]]]:
    """Name and values of each mean."""
    put_in, taken = (np.average(arrays[name][found], axis=0, weights=weights) for name in ("power_in", "power_out"))
    yield "mean_power_in", (Variable((), "W", "Mean power input"), put_in)
    yield "mean_power_out", (Variable((), "W", "Mean power output"), taken)
    yield "mean_efficiency", (Variable((), "1", "Energy efficiency"), taken / put_in if put_in and taken else np.nan)
    for name in _MEANS:
        if name in arrays:
            one = VARIABLES[name]
            mean = np.average(arrays[name][found], axis=0, weights=weights)
            yield f"mean_{name}", (Variable(one.dims, one.units, f"Mean of {one.long_name.lower()}"), mean)
    turns = weights[:, None] * np.abs(arrays["pulley_speed"][found])
    power = np.sum(turns * arrays["hub_load"][found] ** _EXPONENT, axis=0)
    cubic = np.divide(power, turns.sum(axis=0), out=np.zeros_like(power), where=turns.sum(axis=0) > 0.0)
    yield "equivalent_hub_load", (Variable(("pulley",), "N", "Equivalent hub load"), cubic ** (1.0 / _EXPONENT))

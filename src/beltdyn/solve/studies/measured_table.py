"""Tables of measured results: a row for each state in which something was measured."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.change import unit_at
from beltdyn.parts.messages import suggest
from beltdyn.solve.duty import UNITS, Column
from beltdyn.solve.studies.headed_table import HeadedColumn, read_headed
from beltdyn.solve.studies.named_results import names_of, unit_of

_DEVIATION = "±"


class Condition(NamedTuple):
    """A number of the drive that differs from row to row."""

    path: str
    values: list[float]


class MeasuredTable(NamedTuple):
    """What was measured, in SI units."""

    points: list[Column]
    """Speeds, torques and loads of the rows, as of a duty table."""
    conditions: list[Condition]
    results: dict[str, FloatArray]
    """Name -> measured values, shape (rows,); NaN where none was measured."""
    deviations: dict[str, FloatArray]
    """Name -> their standard deviations."""

    @property
    def rows(self) -> int:
        """How many there are."""
        return len(next(iter(self.results.values())))

    def changes(self, row: int) -> Mapping[str, float]:
        """What differs in the drive of a row."""
        return {one.path: one.values[row] for one in self.conditions}


def read_measured(path: Path, drive: Drive) -> MeasuredTable:
    """Read a table of measured results.

    Headings are those of a duty table, paths of numbers, names of results, and results with ± before for standard
    deviations, each with a unit in brackets where it has one.

    Parameters
    ----------
    path
        The CSV file.
    drive
        The drive, whose pulleys, numbers and results headings name.

    Raises
    ------
    ModelError
        If it cannot be read, or a heading or number is wrong.
    """
    table = MeasuredTable([], [], {}, {})
    for column in read_headed("table", path):
        _take(table, column, drive)
    if not table.results:
        raise ModelError(
            f'{path} has no column of results. Add a column such as "pulley_slip[{drive.pulleys[-1].name}]".'
        )
    for name, values in table.results.items():
        if not np.isfinite(values).any():
            raise ModelError(f"{path}: {name} was not measured in any row. Fill in the column, or remove it.")
    for name, sizes in table.deviations.items():
        if name not in table.results or np.any(sizes[np.isfinite(table.results[name])] <= 0.0):
            raise ModelError(f'{path}: "± {name}" needs a column "{name}" beside it, and deviations above zero.')
    return table


def _take(table: MeasuredTable, column: HeadedColumn, drive: Drive) -> None:
    """Take a column into a table."""
    known, path = names_of(drive), column.path
    of_deviations, given = (
        column.what.startswith(_DEVIATION),
        column._replace(what=column.what.lstrip(f"{_DEVIATION} ")),
    )
    whole = f"{given.what}[{given.unit}]"
    if whole in known:  # the brackets name a part, and no unit
        given = given._replace(what=whole, unit="")
    if given.what in known:
        unit = unit_of(given.what, drive)
        cells = [given._replace(cells=[cell]).values(unit) if cell[1].strip() else [np.nan] for cell in given.cells]
        (table.deviations if of_deviations else table.results)[given.what] = np.concatenate(cells)
        return
    pulley, _, kind = given.what.rpartition(" ")
    if kind in UNITS and bool(pulley) == (kind in ("speed", "torque")):
        if pulley:
            drive.number_of(pulley)
        table.points.append(Column(kind, pulley, given.values(UNITS[kind])))
        return
    number = next((one for one in (whole, given.what) if _is_number(one, drive)), None)
    if number is None:
        raise ModelError(
            f'{path}: the heading "{given.what}" is not a result, "load", "NAME speed [rpm]", "NAME torque [N '
            f'm]" or the path of a parameter. {suggest(given.what, known)}'
        )
    own = given._replace(unit="") if number == whole else given
    table.conditions.append(Condition(number, own.values(unit_at(drive, number))))


def _is_number(path: str, drive: Drive) -> bool:
    """Whether a path leads to a number of the drive."""
    try:
        unit_at(drive, path)
    except ModelError:
        return False
    return True

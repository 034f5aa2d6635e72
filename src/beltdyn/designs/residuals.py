"""Residuals of a calibration: results of drives less measured ones, over their deviations, and their derivatives."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import OperatingPoint, named
from beltdyn.designs.designs import Design, Designs, Free
from beltdyn.designs.named_results import names_of, unit_of
from beltdyn.errors import ConvergenceError, InternalError, ModelError, is_internal
from beltdyn.model import Drive
from beltdyn.model.parameter_study import CalibrationStudy, Measurement, Points
from beltdyn.parts.change import meaning_of, require_distinct, unit_at
from beltdyn.parts.messages import suggest
from beltdyn.parts.table_file import HeadedColumn, read_headed
from beltdyn.points.duty import UNITS, Column, at_row, require_distinct_columns
from beltdyn.solvers.run_progress import Progress, Report

# Tables of measured results: a row for each state in which something was measured

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


def read_measured(path: Path, drive: Drive, *, at_rest: bool = False) -> MeasuredTable:
    """Read a table of measured results.

    Headings are those of a duty table, paths of numbers, names of results, and results with ± before for standard
    deviations, each with a unit in brackets where it has one.
    """
    table = MeasuredTable([], [], {}, {})
    for column in read_headed("table", path):
        _take(table, column, drive, names_of(drive, at_rest=at_rest))
    conditions = [one.path for one in table.conditions]
    require_distinct(drive, conditions, f"{path}: the heading")
    require_distinct_columns(drive, table.points, path, conditions)
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


def _take(table: MeasuredTable, column: HeadedColumn, drive: Drive, known: list[str]) -> None:
    """Take a column into a table."""
    path = column.path
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
            f'm]" or the path of a parameter. {suggest(whole.removesuffix("[]"), known)}'
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


MOST = 60
"""Designs that are tried, at most."""
_FAR = 1e3
"""Residual of what does not run, over its deviation."""


class Series(NamedTuple):
    """Measurements in states of one drive."""

    designs: Designs
    labels: list[str]
    """Of the rows."""
    measured: FloatArray
    """Shape (rows, results); NaN where none."""
    deviations: FloatArray
    """Shape (rows, results)."""

    @property
    def names(self) -> list[str]:
        """The results of the rows, in the order of their values."""
        return [f"{one.name} ({label})" for label in self.labels for one in self.designs.watched]


class Residuals:
    """Residuals of designs, and their derivatives with respect to numbers scaled to 0 to 1 between bounds."""

    def __init__(
        self,
        drive: Drive,
        numbers: Sequence[Free],
        study: CalibrationStudy,
        base: Path,
        force_tolerance: float | None,
        progress: Report | None,
    ) -> None:
        self._numbers, self._progress, self._count = numbers, progress, 0
        tables = [
            (one, read_measured(base / one.table, drive, at_rest=one.state == "rest")) for one in study.measurements
        ]
        self.known = _deviations_are_known(study.measurements, [table for _, table in tables])
        self.series = [
            series
            for one, table in tables
            for series in _series(drive, numbers, one, table, force_tolerance, self._tell)
        ]
        self.measured = np.concatenate([one.measured.ravel() for one in self.series])
        self._deviations = np.concatenate([one.deviations.ravel() for one in self.series])
        self.on = np.isfinite(self.measured)
        if np.sum(self.on) < len(numbers):
            raise ModelError(
                f"{np.sum(self.on)} measured values cannot identify {len(numbers)} parameters. Measure more, or fit "
                "fewer."
            )
        self._near: list[Design] | None = None
        self._found: dict[bytes, list[Design]] = {}

    def start(self) -> FloatArray:
        """Where the search begins."""
        first = np.array([(one.start - one.least) / (one.largest - one.least) for one in self._numbers])
        failures = [one.failure for one in self._at(first) if one.failure]
        if failures:
            kind = InternalError if is_internal(failures[0]) else ConvergenceError
            raise kind(f"the search starts from the given drive, which does not run. {failures[0]}")
        self.first = self.values(first)
        names = [name for one in self.series for name in one.names]
        absent = [
            name for name, value, on in zip(names, self.first, self.on, strict=True) if on and not np.isfinite(value)
        ]
        if absent:
            raise ModelError(
                f"{absent[0]} was measured, but cannot be computed for this drive. Leave such cells empty, or "
                "remove the column."
            )
        return first

    def values(self, parts: FloatArray) -> FloatArray:
        """Results of a design, in the order of the measurements."""
        return np.concatenate([one.values.ravel() for one in self._at(parts)])

    def residuals(self, parts: FloatArray) -> FloatArray:
        """Results less measurements, over deviations; far off where the design does not run."""
        away = ((self.values(parts) - self.measured) / self._deviations)[self.on]
        return np.asarray(np.nan_to_num(away, nan=_FAR))

    def jacobian(self, parts: FloatArray) -> FloatArray:
        """Derivatives of the residuals."""
        designs = self._near = self._at(parts)
        ranges = np.array([one.largest - one.least for one in self._numbers])
        slopes = [
            series.designs.derivatives(design).reshape(-1, ranges.size)
            for series, design in zip(self.series, designs, strict=True)
        ]
        return np.asarray((np.concatenate(slopes) * ranges / self._deviations[:, None])[self.on])

    def _at(self, parts: FloatArray) -> list[Design]:
        key = parts.tobytes()
        if key not in self._found:
            changes = {
                one.path: one.least + float(part) * (one.largest - one.least)
                for one, part in zip(self._numbers, parts, strict=True)
            }
            near: Sequence[Design | None] = self._near or [None] * len(self.series)
            self._found[key] = [
                series.designs.find(changes, last) for series, last in zip(self.series, near, strict=True)
            ]
            self._count += 1
            self._tell(0.0)
        return self._found[key]

    def _tell(self, part: float) -> None:
        if self._progress is not None:
            self._progress(Progress(self._count + part, float(MOST), 0.0, self._count, "designs"))


def _deviations_are_known(measurements: Sequence[Measurement], tables: Sequence[MeasuredTable]) -> bool:
    """Whether tables give standard deviations: for all results, or for none."""
    named = [(one.table, name) for one, table in zip(measurements, tables, strict=True) for name in table.results]
    given = [name in table.deviations for table in tables for name in table.results]
    if any(given) and not all(given):
        where, name = named[given.index(False)]
        raise ModelError(
            f'{where} has no standard deviation of {name}, while other results have one. Add a column "± '
            f'{name}", or remove the others.'
        )
    return all(given)


def _series(
    drive: Drive,
    numbers: Sequence[Free],
    one: Measurement,
    table: MeasuredTable,
    force_tolerance: float | None,
    tell: Callable[[float], None],
) -> Iterator[Series]:
    """The rows of a table, those of one drive together."""
    names, groups = list(table.results), dict[tuple[float, ...], list[int]]()
    for row in range(table.rows):
        groups.setdefault(tuple(table.changes(row).values()), []).append(row)
    require_distinct_columns(drive, table.points, one.table, [number.path for number in numbers])
    free = {meaning_of(drive, number.path): number.path for number in numbers}
    for rows in groups.values():
        changes = table.changes(rows[0])
        fitted = [path for path in changes if meaning_of(drive, path) in free]
        if fitted:
            raise ModelError(f"{one.table} has a column {fitted[0]}, which is to be fitted. Remove one of them.")
        labels = [f"{Path(one.table).stem}, row {row + 1}" for row in rows]
        points = [
            OperatingPoint(label, 1.0 / len(rows), partial(at_row, columns=table.points, row=row))
            for label, row in zip(labels, rows, strict=True)
        ]
        watched = [named(name, drive, len(rows)) for name in names]
        designs = Designs(
            drive.with_(changes) if changes else drive,
            numbers,
            points,
            Points(at=one.at),
            watched,
            force_tolerance,
            tell,
            at_rest=one.state == "rest",
        )
        measured = np.array([table.results[name][rows] for name in names]).T
        yield Series(designs, labels, measured, np.array([_deviation(table, name)[rows] for name in names]).T)


def _deviation(table: MeasuredTable, name: str) -> FloatArray:
    """Standard deviations of a result, or its size where none are given."""
    values = table.results[name]
    size = float(np.sqrt(np.nanmean(values**2))) or 1.0
    return table.deviations.get(name, np.full(values.size, size))

"""Residuals of a calibration: results of drives less measured ones, over their deviations, and their derivatives."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.study import CalibrationStudy, Measurement, Points
from beltdyn.solve.duty import at_row
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.studies.designs import Design, Designs, Free
from beltdyn.solve.studies.measured_table import MeasuredTable, read_measured
from beltdyn.solve.studies.study_points import OperatingPoint
from beltdyn.solve.studies.watched import named

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


class Residuals:
    """Residuals of designs, and their derivatives by parts of the ways between bounds.

    Parameters
    ----------
    drive
        The drive at the start.
    numbers
        Those that are fitted.
    study
        What was measured.
    base
        Folder from which paths of tables start.
    force_tolerance
        As for `steady_state`.
    progress
        Called now and then with a `Progress`.

    Raises
    ------
    ModelError
        If a table is none, or there are fewer measured values than numbers.
    """

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
        tables = [(one, read_measured(base / one.table, drive)) for one in study.measurements]
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
        """Where the search begins.

        Raises
        ------
        ConvergenceError
            If a state of the drive that is given is not found.
        """
        first = np.array([(one.start - one.least) / (one.largest - one.least) for one in self._numbers])
        failures = [one.failure for one in self._at(first) if one.failure]
        if failures:
            raise ConvergenceError(f"the search starts from the given drive, which does not run. {failures[0]}")
        self.first = self.values(first)
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
    free = {number.path for number in numbers}
    for rows in groups.values():
        changes = table.changes(rows[0])
        if free & changes.keys():
            raise ModelError(f"{one.table} has a column {next(iter(free & changes.keys()))}, which is to be fitted.")
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

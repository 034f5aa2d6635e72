"""The rows of a study in a CSV file: added to as points finish, and read again when the study goes on.

A row has the number of its point, the values of the numbers that vary, results in SI units, the time that it took,
warnings, why it failed, and a checksum of all that.  Values have all digits, so that a point is found by them.
"""

import csv
import hashlib
import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError, OutputError
from beltdyn.parts.text_file import LONGEST_TABLE, read_text
from beltdyn.results.atomic import atomic_path, unwritable
from beltdyn.solve.studies.point_work import Outcome
from beltdyn.solve.studies.study_plan import Plan

_FIRST, _LAST = "point", ("seconds [s]", "warnings", "failure", "checksum")


class Row(NamedTuple):
    """A row as it was written."""

    key: tuple[str, ...]
    """Values of the numbers that vary, as text."""
    outcome: Outcome
    """With the number of the point in the file."""


class StudyRows:
    """The CSV file of a study.

    Parameters
    ----------
    path
        The file.
    plan
        The points.
    """

    def __init__(self, path: Path, plan: Plan) -> None:
        self.path, self._plan = path, plan
        self.columns: dict[str, str] = {}
        """Names of results, and their units."""

    def key(self, point: int) -> tuple[str, ...]:
        """Values of the numbers at a point as text."""
        return tuple(map(_written, self._plan.values[point]))

    def begin(self, columns: Mapping[str, str], outcomes: Sequence[Outcome]) -> None:
        """Write the file anew, with the results that are known.

        Raises
        ------
        ModelError
            If it cannot be written.
        """
        self.columns = dict(columns)
        with (
            atomic_path(self.path, lambda _: True) as temporary,
            temporary.open("w", encoding="utf-8", newline="") as file,
        ):
            file.write(_as_lines([self._headings()]) + self._lines(outcomes))

    def append(self, outcomes: Sequence[Outcome]) -> None:
        """Add rows.

        Raises
        ------
        OutputError
            If the file cannot be written; what it holds stays.
        """
        try:
            with self.path.open("a", encoding="utf-8", newline="") as file:
                file.write(self._lines(outcomes))
        except OSError as error:
            raise OutputError(unwritable(self.path, error)) from error

    def _headings(self) -> list[str]:
        numbers = zip(self._plan.paths, self._plan.units, strict=True)
        units = [(*numbers,), (*self.columns.items(),)]
        return [_FIRST, *(f"{name} [{unit or '1'}]" for part in units for name, unit in part), *_LAST]

    def _lines(self, outcomes: Sequence[Outcome]) -> str:
        headings = self._headings()
        rows = [self._cells(one) for one in outcomes]
        return _as_lines([[*cells, _checksum(headings, cells)] for cells in rows])

    def _cells(self, outcome: Outcome) -> list[str]:
        """All but the checksum."""
        values = [_written(outcome.values.get(name, np.nan)) for name in self.columns]
        last = f"{outcome.seconds:.4g}", outcome.warnings, outcome.failure
        return [str(outcome.point + 1), *self.key(outcome.point), *values, *last]

    def read(self) -> list[Row]:
        """The intact rows of the file, and with them the columns; none where there is no file.

        A row that is damaged, or that a killed process left unfinished, is left out: its point is computed again.

        Raises
        ------
        ModelError
            If the file is none of a study of these numbers, or no row is intact.
        """
        if not self.path.exists():
            return []
        try:
            text = read_text(self.path, LONGEST_TABLE)
            headings, *rows = csv.reader(io.StringIO(text[: text.rfind("\n") + 1])) if "\n" in text else [[]]
        except (OSError, ValueError, csv.Error) as error:
            raise ModelError(f"{self.path} cannot be read ({error}). Move it away, or choose another name.") from error
        numbers = 1 + len(self._plan.paths)
        if tuple(headings[-len(_LAST) :]) != _LAST or headings[:numbers] != self._headings()[:numbers]:
            raise ModelError(f"{self.path} holds no points of this study. Move it away, or choose another name.")
        self.columns = dict(map(_name_and_unit, headings[numbers : -len(_LAST)]))
        intact = list(self._rows(headings, rows))
        if rows and not intact:
            raise ModelError(f"{self.path} is damaged: no row has its checksum. Move it away, or choose another name.")
        return intact

    def _rows(self, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[Row]:
        numbers = 1 + len(self._plan.paths)
        for cells in rows:
            if cells[-1:] != [_checksum(headings, cells[:-1])]:
                continue
            texts = cells[numbers : -len(_LAST)]
            values = {name: float(text) for name, text in zip(self.columns, texts, strict=True) if text}
            seconds, warnings, failure, _ = cells[-len(_LAST) :]
            outcome = Outcome(int(cells[0]) - 1, values, failure, warnings, float(seconds))
            yield Row(tuple(cells[1:numbers]), outcome)


def is_study_table(path: Path) -> bool:
    """Tell whether a file has the headings of a study."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            headings = next(csv.reader(file), [])
    except (OSError, UnicodeDecodeError, csv.Error):
        return False
    return headings[:1] == [_FIRST] and tuple(headings[-len(_LAST) :]) == _LAST


def _checksum(headings: Sequence[str], cells: Sequence[str]) -> str:
    """Of a row under its headings, so that a damaged head is noticed, too."""
    return hashlib.sha256("\0".join([*headings, *cells]).encode()).hexdigest()[:16]


def _name_and_unit(heading: str) -> tuple[str, str]:
    name, _, unit = heading.rpartition(" [")
    return name, unit.removesuffix("]")


def _written(value: object) -> str:
    """A value as text that gives it back; nothing for what is not known."""
    if isinstance(value, float):
        return "" if np.isnan(value) else repr(float(value))
    return str(value)


def _as_lines(rows: Sequence[Sequence[str]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()

"""What is known of the points of a study: a dataset, in a file if one is named, and rows in a CSV file beside it."""

import csv
import hashlib
import io
import json
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltdyn.analyses import STUDY
from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.designs.point_work import Outcome
from beltdyn.designs.study_plan import Plan
from beltdyn.errors import ModelError, OutputError, is_internal
from beltdyn.model import Drive, ParameterStudy, dumps
from beltdyn.parts.messages import listing
from beltdyn.parts.text_file import LONGEST_TABLE, read_text
from beltdyn.results import Result, Variable, build_result
from beltdyn.results.atomic import OutputLock, atomic_path, require_replaceable, target_of, unwritable
from beltdyn.results.dataset import is_result, read_dataset
from beltdyn.results.recorder import status_after
from beltdyn.signals import closing, uninterrupted

# The rows of a study in a CSV file: added to as points finish, and read again when the study goes on

_FIRST, _LAST = "point", ("seconds [s]", "warnings", "failure", "checksum")


class Row(NamedTuple):
    """A row as it was written."""

    key: tuple[str, ...]
    """Values of the numbers that vary, as text."""
    outcome: Outcome
    """With the number of the point in the file."""


class StudyRows:
    """The CSV file of a study."""

    def __init__(self, path: Path, plan: Plan) -> None:
        self.path, self._plan = path, plan
        self.columns: dict[str, str] = {}
        """Names of results, and their units."""

    def key(self, point: int) -> tuple[str, ...]:
        """Values of the numbers at a point as text."""
        return tuple(map(_written, self._plan.values[point]))

    def begin(self, columns: Mapping[str, str], outcomes: Sequence[Outcome]) -> None:
        """Write the file anew, with the results that are known."""
        self.columns = dict(columns)
        with (
            atomic_path(self.path, lambda _: True) as temporary,
            temporary.open("w", encoding="utf-8", newline="") as file,
        ):
            file.write(_as_lines([self._headings()]) + self._lines(outcomes))

    def append(self, outcomes: Sequence[Outcome]) -> None:
        """Add rows."""
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


def rows_file(output: Path) -> Path:
    """The CSV file of a study beside its result file."""
    return output.with_suffix(".csv")


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


_POINT = ("point",)
_OFTEN, _SHARE = 2.0, 20.0
"""Least time between two writings of the result file, s, and times that a writing takes."""
_MOST_NAMES = 6
"""Results without a value that are named."""
_STRING = re.compile(r"""["']([^"'\n]+)["']""")
"""A text in a TOML file, which may be the path of another file."""
_COMPUTING = "computing"
"""Attribute: what tells apart what is computed at a point."""


def _fingerprints(study: ParameterStudy, drive: Drive, plan: Plan, inputs: Mapping[str, Path]) -> dict[str, str]:
    """What tells apart what is computed at a point, by what it is: drive, analysis, its options, files and results."""
    parts: dict[str, object] = {
        "drive": dumps(drive),
        "analysis": study.analysis,
        **{f"option {name}": value for name, value in study.options.items()},
        "list of results": study.results,
        "list of numbers": plan.paths,
    }
    found = {name: _fingerprint(json.dumps(part, default=str).encode()) for name, part in parts.items()}
    for name, file in inputs.items():
        found |= {f"content of {one.name} (option {name})": _fingerprint(_content(one)) for one in _files_of(file)}
    return found


def _fingerprint(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def _files_of(file: Path) -> list[Path]:
    """A file, and those that a study file among them names."""
    if file.suffix.lower() != ".toml":
        return [file]
    named = [file.parent / text for text in _STRING.findall(_content(file).decode("utf-8", "replace"))]
    return [file, *(one for one in dict.fromkeys(named) if one.is_file())]


def _content(file: Path) -> bytes:
    """What a file holds; nothing of one that is missing, which the analysis tells of."""
    try:
        return file.read_bytes() if file.is_file() else b""
    except OSError:
        return b""


class StudyTable:
    """The points of a study, a context that closes its files whatever happens; an interruption keeps what was found.

    The rows are in a CSV file beside `output`; points of another study there are an error, as they would be lost.
    """

    def __init__(
        self,
        study: ParameterStudy,
        drive: Drive,
        plan: Plan,
        output: Path | None,
        overwrite: bool = False,
        retry: bool = False,
        inputs: Mapping[str, Path] = MappingProxyType({}),
    ) -> None:
        self._study, self._drive, self._plan, self._path = study, drive, plan, output
        self._computing = _fingerprints(study, drive, plan, inputs)
        count = len(plan.values)
        self.done: BoolArray = np.zeros(count, dtype=bool)
        self._columns: dict[str, str] = {}
        self._values: dict[str, FloatArray] = {}
        self._seconds = np.full(count, np.nan)
        self._texts: dict[str, NDArray[np.object_]] = {
            name: np.full(count, "", dtype=object) for name in ("failure", "warnings")
        }
        self._status, self._written, self._pause = "running", time.perf_counter(), _OFTEN
        self._rows = None if output is None else StudyRows(rows_file(output), plan)
        self._lock: OutputLock | None = None
        self._begun = False
        self._has_head = False
        """Whether the result file tells whose rows there are, so that a study that is killed can go on."""
        if output is not None:
            self._claim(output, overwrite, retry)

    def _claim(self, output: Path, overwrite: bool, retry: bool) -> None:
        """Take the rows that are there; files stay as they are until there is something to write."""
        assert self._rows is not None
        require_replaceable(output, is_result, overwrite)
        require_replaceable(self._rows.path, is_study_table, overwrite)
        try:
            self._lock = OutputLock(target_of(output))
        except OSError as error:
            raise ModelError(unwritable(output, error)) from error
        try:
            if not overwrite:
                self._go_on(output, retry)
        except BaseException:
            self._lock.release()
            raise

    def _go_on(self, output: Path, retry: bool) -> None:
        """Take over points that were computed before."""
        assert self._rows is not None
        rows = self._rows.read()
        if not rows:
            return
        remedy = "Choose another --output, or recompute all with --force (in Python: overwrite=True)."
        if of := self._difference(output):
            raise ModelError(f"{self._rows.path} holds {len(rows)} points of {of}. {remedy}")
        self._has_head = True
        keys = [self._rows.key(point) for point in range(len(self._plan.values))]
        places = {key: point for point, key in enumerate(keys)}
        lost = sum(row.key not in places for row in rows)
        if lost:
            raise ModelError(f"{self._rows.path} holds {lost} points that are no longer in the study. {remedy}")
        self._columns = dict(self._rows.columns)
        self._values = {name: np.full(len(self.done), np.nan) for name in self._columns}
        for row in rows:
            if not (row.outcome.failure and (retry or is_internal(row.outcome.failure))):
                point = row.outcome.point
                is_same = 0 <= point < len(keys) and keys[point] == row.key
                self._note(row.outcome, point if is_same else places[row.key])

    def _difference(self, output: Path) -> str:
        """What tells the study of a result file from this one, in words; empty if nothing does."""
        try:
            dataset = read_dataset(output)
        except ModelError:
            return f"a study whose head {output} is missing or damaged"
        with dataset:
            text = str(dataset.attrs.get(_COMPUTING, ""))
        try:
            known = dict(json.loads(text))
        except ValueError:
            return f"a study whose head {output} is of another version"
        own = self._computing
        differing = [name for name in {**own, **known} if own.get(name) != known.get(name)]
        return f"a study with another {listing(differing)}" if differing else ""

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> bool:
        """Close the files with a status."""
        self._status = status_after(kind)
        try:
            with closing():
                if self.done.any():
                    self._save()
        finally:
            if self._lock is not None:
                self._lock.release()
        return self._status == "interrupted"

    def take(self, outcomes: list[Outcome], units: Mapping[str, str]) -> None:
        """Take what became of points, and write it."""
        fresh = [one for one in outcomes if not self.done[one.point]]
        if missing := next((one.missing for one in fresh if one.missing), ""):
            raise ModelError(missing)
        added = {name: unit for name, unit in units.items() if name not in self._columns}
        self._columns |= added
        self._values |= {name: np.full(len(self.done), np.nan) for name in added}
        for one in fresh:
            self._note(one, one.point)
        self._begun = self._begun and not added
        self._append(fresh)
        if time.perf_counter() - self._written > self._pause:
            self._save()

    def _append(self, outcomes: Sequence[Outcome]) -> None:
        """Write rows of points that are noted: all that are known where the file begins, or has other columns now."""
        if self._rows is None or not outcomes:
            return
        if self._begun:
            self._rows.append(outcomes)
            return
        if not self._has_head:
            self._rows.path.unlink(missing_ok=True)  # rows of another study must not come under this head
            self._save()
        self._rows.begin(self._columns, [self._outcome(int(one)) for one in np.flatnonzero(self.done)])
        self._begun = True

    def _note(self, outcome: Outcome, point: int) -> None:
        for name, value in outcome.values.items():
            self._values[name][point] = value
        self._texts["failure"][point], self._texts["warnings"][point] = outcome.failure, outcome.warnings
        self._seconds[point] = outcome.seconds
        self.done[point] = True

    def _outcome(self, point: int) -> Outcome:
        values = {name: float(one[point]) for name, one in self._values.items()}
        failure, warnings = self._texts["failure"][point], self._texts["warnings"][point]
        return Outcome(point, values, failure, warnings, float(self._seconds[point]))

    def result(self) -> Result:
        """What is known until now."""
        plan, points = self._plan, np.arange(1, len(self.done) + 1)
        coordinates: dict[str, tuple[Variable, ArrayLike]] = {
            "point": (Variable(_POINT, "1", "Point", "int64"), points)
        }
        for path, unit, values in zip(plan.paths, plan.units, plan.values.T, strict=True):
            coordinates[path] = Variable(_POINT, unit or "1", path), np.array(values.tolist())
        variables: dict[str, tuple[Variable, ArrayLike]] = {
            name: (Variable(_POINT, unit, name), self._values[name]) for name, unit in self._columns.items()
        }
        variables["seconds"] = Variable(_POINT, "s", "Computing time of the point"), self._seconds
        variables["failure"] = Variable(_POINT, "1", "Why the point failed", "str"), self._texts["failure"]
        variables["point_warnings"] = Variable(_POINT, "1", "Warnings of the point", "str"), self._texts["warnings"]
        result = build_result(STUDY, self._drive, variables, coordinates, self._warnings())
        result.dataset.attrs |= self._about()
        for path, base in zip(plan.paths, plan.base, strict=True):
            result.dataset[path].attrs["base"] = json.dumps(base, default=str)
        return result

    def _about(self) -> dict[str, Any]:
        """Global attributes."""
        title = f"{self._drive.title}: {self._study.analysis} at {len(self.done)} points"
        return {
            "title": title,
            "status": self._status,
            "analysis": self._study.analysis,
            "sampling": "table" if self._study.table is not None else self._study.sampling,
            "numbers": "\n".join(self._plan.paths),
            "results": "\n".join(self._columns),
            "done": int(self.done.sum()),
            _COMPUTING: json.dumps(self._computing),
        }

    def _warnings(self) -> list[str]:
        """Failures, and warnings of points, each but once, whatever its numbers."""
        failed = np.flatnonzero(self._texts["failure"] != "")
        said = _grouped(failed, lambda point: [str(self._texts["failure"][point]).splitlines()[0]])
        found = [f"{len(failed)} of {int(self.done.sum())} points failed."] if len(failed) else []
        found += [f"failed at {where}: {text}" for where, text in said]
        found += self._unknown(len(failed))
        warned = np.flatnonzero(self._texts["warnings"] != "")
        return found + [
            f"at {where}: {text}"
            for where, text in _grouped(warned, lambda point: str(self._texts["warnings"][point]).splitlines())
        ]

    def _unknown(self, failed: int) -> list[str]:
        """Results without a value at any of the points that did not fail."""
        names = [name for name, values in self._values.items() if np.isnan(values).all()]
        if not names or failed == self.done.sum():
            return []
        more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
        return [f"no value at any point: {', '.join(names[:_MOST_NAMES])}{more}."]

    def _save(self) -> None:
        """Write the result file, if one is named."""
        begun = time.perf_counter()
        if self._path is not None and self._lock is not None:
            with uninterrupted(), self._lock.used():
                self.result().save(self._path, overwrite=True)
            self._has_head = True
        self._written = time.perf_counter()
        self._pause = max(_OFTEN, _SHARE * (self._written - begun))


def _grouped(points: NDArray[np.intp], texts: Callable[[int], list[str]]) -> list[tuple[str, str]]:
    """Texts that differ in numbers alone, once, with where they are said."""
    groups: dict[str, tuple[str, list[int]]] = {}
    for point in points.tolist():
        for text in texts(point):
            groups.setdefault(re.sub(r"[\d.,e+\-−–%]+", "#", text), (text, []))[1].append(point + 1)
    return [
        (f"point {places[0]}" + (f" and {len(places) - 1} more" if places[1:] else ""), text)
        for text, places in groups.values()
    ]

"""The plan of a study: which numbers of a drive take which values at which points."""

import warnings
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.model.parameter_study import SAMPLED, VariedNumber
from beltdyn.parts.change import converted, number_path, require_distinct, unit_at, value_at
from beltdyn.parts.quantity import numbers_in
from beltdyn.parts.table_file import HeadedColumn, read_headed

# Points of a study in the unit cube: Latin hypercube, Sobol's sequence, and Saltelli's design for Sobol indices


def unit_points(sampling: str, dimensions: int, count: int, seed: int) -> FloatArray:
    """Take points in the unit cube."""
    from scipy.stats import qmc

    if sampling == "latin_hypercube":
        return np.asarray(qmc.LatinHypercube(dimensions, rng=np.random.default_rng(seed)).random(count))
    wide = 2 * dimensions if sampling == "saltelli" else dimensions
    engine = qmc.Sobol(wide, scramble=True, rng=np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "The balance properties of Sobol' points")  # the user chose their number
        found = np.asarray(engine.random(count))
    return found if sampling == "sobol" else _saltelli(found[:, :dimensions], found[:, dimensions:])


def _saltelli(first: FloatArray, second: FloatArray) -> FloatArray:
    """The design of two samples of shape (n, d), shape (n (d + 2), d)."""
    mixed = [first.copy() for _ in range(first.shape[1])]
    for column, one in enumerate(mixed):
        one[:, column] = second[:, column]
    return np.concatenate([first, second, *mixed])


def combinations(values: Sequence[NDArray[np.object_]]) -> NDArray[np.object_]:
    """All combinations of values, the last number changing first, shape (points, numbers)."""
    grid = np.meshgrid(*(np.arange(len(one)) for one in values), indexing="ij")
    return np.stack([one[place.ravel()] for one, place in zip(values, grid, strict=True)], axis=1)


def one_at_a_time(values: Sequence[NDArray[np.object_]], base: Sequence[object]) -> NDArray[np.object_]:
    """The base, and points at which one number takes another of its values, shape (points, numbers)."""
    found = [np.array(base, dtype=object)]
    for column, some in enumerate(values):
        for value in some:
            if value != base[column]:
                found.append(found[0].copy())
                found[-1][column] = value
    return np.stack(found)


MOST_POINTS = 10_000_000
"""Largest number of points of a study; more are refused. Memory holds all of them, at 80 MB or more per varied
number."""
_DIGITS = 12
"""Of numbers between bounds."""

Values = NDArray[np.object_]


@dataclass(frozen=True)
class Plan:
    """Points of a study."""

    paths: tuple[str, ...]
    """Of the numbers that vary."""
    units: tuple[str, ...]
    """SI units of the numbers; empty for pure numbers and texts."""
    values: Values
    """Values of the numbers in SI units, shape (points, numbers)."""
    base: tuple[Any, ...]
    """Values that the drive file has; None where a number is not given there."""

    def changes(self, point: int) -> Mapping[str, Any]:
        """What differs from the drive at a point: path -> value."""
        return dict(zip(self.paths, self.values[point].tolist(), strict=True))


def plan_of(study: ParameterStudy, drive: Drive, base: Path) -> Plan:
    """Lay out the points of a study."""
    table = read_headed("table", base / study.table) if study.table is not None else []
    columns = [column._replace(what=number_path(drive, column.what)) for column in table]
    if study.numbers:
        study = study.replace(number=[one.replace(path=number_path(drive, one.path)) for one in study.numbers])
    paths = tuple(column.what for column in columns) or tuple(one.path for one in study.numbers)
    require_distinct(drive, paths)
    units, given = tuple(_unit(drive, path) for path in paths), tuple(value_at(drive, path) for path in paths)
    if columns:
        values = _together([_column(column, drive, unit) for column, unit in zip(columns, units, strict=True)])
    elif study.sampling in SAMPLED:
        values = _sampled(study, drive, units)
    else:
        several = [_values(one, drive, unit) for one, unit in zip(study.numbers, units, strict=True)]
        values = _combined(study.sampling, several, given)
    return Plan(paths, units, values, given)


def _combined(sampling: str, several: Sequence[Values], given: Sequence[Any]) -> Values:
    """Points of a sampling that takes the values as they are listed."""
    if sampling == "together":
        return _together(several)
    if sampling == "one_at_a_time":
        return one_at_a_time(several, given)
    count = prod(map(len, several))
    if count > MOST_POINTS:
        raise ModelError(
            f"the study has {count:,} points, more than the limit of {MOST_POINTS:,}. Give fewer values, or "
            'sample between bounds with sampling = "sobol".'
        )
    return combinations(several)


def _together(several: Sequence[Values]) -> Values:
    """Points at which the n-th values of all numbers stand together."""
    if len({len(one) for one in several}) > 1:
        raise ModelError(
            'sampling = "together" needs the same number of values for each [[number]]. Add or remove values.'
        )
    return np.stack(several, axis=1)


def _sampled(study: ParameterStudy, drive: Drive, units: Sequence[str]) -> Values:
    """Points between bounds; whole numbers are rounded."""
    bounds = [_bounds(one, drive, unit) for one, unit in zip(study.numbers, units, strict=True)]
    count = study.points * (len(bounds) + 2) if study.sampling == "saltelli" else study.points
    if count > MOST_POINTS:
        raise ModelError(f"the study has {count:,} points, more than the limit of {MOST_POINTS:,}. Reduce points.")
    unit = unit_points(study.sampling, len(bounds), study.points, study.seed)
    low, high = np.array([[float(one) for one in pair] for pair in bounds]).T
    placed = low + unit * (high - low)
    found = np.empty(placed.shape, dtype=object)
    for column, pair in enumerate(bounds):
        whole = all(isinstance(one, int) for one in pair)
        numbers = placed[:, column]
        found[:, column] = [round(one) for one in numbers] if whole else _rounded(numbers)
    return found


def _rounded(numbers: Iterable[float]) -> list[float]:
    """Numbers with so many digits, which text gives back."""
    return [float(f"{one:.{_DIGITS}g}") for one in numbers]


def _bounds(number: VariedNumber, drive: Drive, unit: str) -> tuple[float | int, float | int]:
    """The least and the largest value of a number."""
    values = _values(number.replace(steps=2), drive, unit)
    if len(values) != 2 or any(isinstance(one, str | bool) for one in values):
        raise ModelError(
            f"number {number.path}: values = {number.values!r} are not bounds. Write a range such as "
            f'"0.2..1.2 {unit}".'.replace(' ".', '".')
        )
    low, high = sorted(values.tolist())
    return low, high


def _values(number: VariedNumber, drive: Drive, unit: str) -> Values:
    """The values of a number, in SI units; the drive must take each of them."""
    if isinstance(number.values, str):
        numbers = numbers_in(f"number {number.path}: values", number.values, unit, number.steps)
        return _taken(drive, number.path, _rounded(numbers))
    return _taken(drive, number.path, number.values)


def _column(column: HeadedColumn, drive: Drive, unit: str) -> Values:
    """The values of a number in a table: numbers, or texts where one is no number."""
    texts = [cell.strip() for _, cell in column.cells]
    if column.unit or unit or all(map(_is_number, texts)):
        return _taken(drive, column.what, _rounded(column.values(unit)))
    return _taken(drive, column.what, texts)


def _is_number(text: str) -> bool:
    with suppress(ValueError):
        float(text)
        return True
    return False


def _taken(drive: Drive, path: str, values: Sequence[Any]) -> Values:
    """Values as the drive takes them; each is tried at its place, where nothing else differs."""
    found = np.empty(len(values), dtype=object)
    for place, value in enumerate(values):
        whole = isinstance(value, float) and value.is_integer() and isinstance(value_at(drive, path), int)
        try:
            one = converted(drive, path, int(value) if whole else value)
        except ModelError as error:
            raise ModelError(f"number {path}: {error}") from error
        if not isinstance(one, bool | int | float | str):
            raise ModelError(f"number {path}: {value!r} is neither a number nor a word. Give the path of one in it.")
        found[place] = one
    return found


def _unit(drive: Drive, path: str) -> str:
    """SI unit of a number; empty where it has none."""
    value_at(drive, path)
    with suppress(ModelError):
        return unit_at(drive, path)
    return ""

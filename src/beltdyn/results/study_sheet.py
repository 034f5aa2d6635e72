"""The sheet of a study: number of points, and range of each input and result."""

from typing import TYPE_CHECKING

import numpy as np

from beltdyn.parts.columns import aligned
from beltdyn.results.result import Result
from beltdyn.results.sheet_parts import Facts, Sheet, Table
from beltdyn.results.shown import shown_unit

if TYPE_CHECKING:
    import xarray as xr

_DIGITS = 5
_MOST = 40
"""Results in the table."""


def study_sheet(result: Result) -> Sheet:
    """Give the sheet of a study.

    Parameters
    ----------
    result : Result
        The result of `study`.

    Returns
    -------
    Sheet
        Without its warnings.
    """
    dataset = result.dataset
    names = str(dataset.attrs["results"]).splitlines()
    numbers = [_row(dataset[path]) for path in str(dataset.attrs["numbers"]).splitlines()]
    tables = [Table("", ("number", "", "min", "max"), tuple(numbers))]
    if names:
        rows = tuple(_result_row(dataset[name]) for name in names[:_MOST])
        tables.append(Table("", ("result", "", "min", "at point", "mean", "max", "at point"), rows))
    return Sheet(str(dataset.attrs["title"]), (Facts(tuple(_facts(dataset, names))), *tables))


def _facts(dataset: "xr.Dataset", names: list[str]) -> list[tuple[str, str]]:
    seconds = dataset["seconds"].values
    done, failed = int(dataset.attrs["done"]), int((dataset["failure"] != "").sum())
    facts = [("points", f"{done} of {dataset.sizes['point']}, {failed} failed" if failed else f"{done}")]
    if done < dataset.sizes["point"] and not failed:
        facts = [("points", f"{done} of {dataset.sizes['point']}")]
    if done:
        facts.append(("computing time", f"{np.nansum(seconds):.3g} s, {np.nanmean(seconds):.3g} s per point"))
    if len(names) > _MOST:
        facts.append(("results", f"{len(names)}, {_MOST} shown"))
    return facts


def _row(values: "xr.DataArray") -> tuple[str, ...]:
    """An input and its range."""
    if values.dtype.kind not in "fi":
        words = list(dict.fromkeys(map(str, values.values)))
        return str(values.name), "", ", ".join(words[:3]), f"{len(words)} values" if len(words) > 3 else ""
    unit, factor = shown_unit(values)
    return str(values.name), unit, *(f"{factor * float(one):z.{_DIGITS}g}" for one in (values.min(), values.max()))


def _result_row(values: "xr.DataArray") -> tuple[str, ...]:
    """A result: its mean, and its extremes with their points."""
    known = np.flatnonzero(np.isfinite(values.values))
    if not known.size:
        return str(values.name), "", "", "", "", "", ""
    unit, factor = shown_unit(values)
    numbers = factor * values.values[known]
    least, largest = int(np.argmin(numbers)), int(np.argmax(numbers))
    low, mean, high = aligned([float(numbers[least]), float(numbers.mean()), float(numbers[largest])], _DIGITS)
    point = values["point"].values[known]
    return str(values.name), unit, low, str(point[least]), mean, high, str(point[largest])

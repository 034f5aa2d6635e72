"""Sheets of results: the tables and facts that the screen, notebooks and reports show."""

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

from beltdyn.analyses import STUDY
from beltdyn.parts.columns import aligned
from beltdyn.results.provenance import mesh_facts
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.run_sheet import run_sheet
from beltdyn.results.sheet_parts import Facts, Sheet, Table
from beltdyn.results.shown import VARIOUS, in_words, shown_unit
from beltdyn.results.study_sheet import study_sheet

if TYPE_CHECKING:
    import xarray as xr

_DIGITS = 5
_FIRST_PART = re.compile("[,:]")
_AMONG_WARNINGS = frozenset({"failure"})
"""Variables of long texts, which warnings quote."""


def sheet(result: Result) -> Sheet:
    """Give the sheet of a result: the summary of a run, or the values and tables of another analysis.

    Parameters
    ----------
    result : Result
        The result of any analysis.

    Returns
    -------
    Sheet
        Without its warnings.
    """
    if isinstance(result, Run):
        return run_sheet(result)
    if result.kind == STUDY:
        return study_sheet(result)
    dataset = result.dataset
    variables = dataset.data_vars.values()
    numbers = [(str(one.attrs["long_name"]), _single(one)) for one in variables if not one.dims]
    numbers += mesh_facts(dataset.attrs)
    axes = tuple(str(dataset.attrs.get("axes", "")).split())
    tables, left_out = list[Table](), _AMONG_WARNINGS | {dataset.attrs.get("tables_by")}
    for dims in dict.fromkeys([axes, *((str(dimension),) for dimension in dataset.dims)]):
        columns = [one for one in variables if dims and one.dims == dims and one.name not in left_out]
        if columns and all(dimension in dataset.coords for dimension in dims):
            labels = [one for one in dataset.coords.values() if one.dims and set(one.dims) <= set(dims)]
            shown = [*(one.broadcast_like(columns[0]) for one in labels), *columns]
            tables += _tables(shown, dataset.get(dataset.attrs.get("tables_by")))
    return Sheet(str(dataset.attrs["title"]), (*([Facts(tuple(numbers))] if numbers else []), *tables))


def _tables(shown: "Sequence[xr.DataArray]", group: "xr.DataArray | None") -> list[Table]:
    """A table of columns; or one for each word of a variable along their rows, below that word."""
    headings, rows = tuple(map(_heading, shown)), list(zip(*map(_column, shown), strict=True))
    if group is None or group.dims != shown[0].dims:
        return [Table("", headings, tuple(rows))]
    words = [str(one) for one in group.values]
    return [
        Table(
            word[:1].upper() + word[1:],
            headings,
            tuple(row for row, own in zip(rows, words, strict=True) if own == word),
        )
        for word in dict.fromkeys(words)
    ]


def _single(variable: "xr.DataArray") -> str:
    """A number with its unit, with five digits."""
    return f"{_column(variable)[0]} {shown_unit(variable)[0]}" if variable.dtype.kind == "f" else in_words(variable)


def _heading(variable: "xr.DataArray") -> str:
    """The first part of its name up to a comma or a colon, and its unit."""
    name = str(variable.attrs.get("long_name", variable.name))
    return f"{_FIRST_PART.split(name)[0]}\n{shown_unit(variable)[0]}".rstrip()


def _column(variable: "xr.DataArray") -> list[str]:
    """The numbers of a variable, with as many decimals each where they have one unit, or its words."""
    if variable.dtype.kind != "f":
        return [str(one) for one in variable.values.ravel()]
    if variable.attrs.get("units") == VARIOUS:
        return [f"{one:z.{_DIGITS}g}" for one in variable.values.ravel()]
    return aligned((shown_unit(variable)[1] * variable.values.ravel()).tolist(), _DIGITS)

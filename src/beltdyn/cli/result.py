"""A result on the screen: the summary of a run, and tables of results with dimensions of their own."""

import math
from typing import TYPE_CHECKING

from beltdyn.cli.console import show, show_facts, show_table, show_warnings
from beltdyn.cli.summary import show_summary

if TYPE_CHECKING:
    import xarray as xr

    from beltdyn.results import Result

_SHOWN_UNITS = {"rad": ("°", math.degrees(1.0)), "1": ("", 1.0)}
"""Unit of a variable -> how it is written, and the factor on its numbers."""


def show_result(result: "Result") -> None:
    """Write the summary of a run; of other results single numbers, a table for each dimension with names, and warnings.

    Parameters
    ----------
    result
        The result.
    """
    from beltdyn.results import Run

    if isinstance(result, Run):
        show_summary(result)
        return
    dataset = result.dataset
    variables = dataset.data_vars.values()
    show(str(dataset.attrs["title"]))
    numbers = [one for one in variables if not one.dims]
    show_facts((str(one.attrs["long_name"]), f"{_written(one)[0]} {_unit(one)}") for one in numbers)
    for dimension in dataset.dims:
        columns = [one for one in variables if one.dims == (dimension,)]
        if columns and dimension in dataset.coords:
            labels = dataset[dimension]
            rows = zip(map(str, labels.values), *map(_written, columns), strict=True)
            headings = (f"{one.attrs['long_name']}\n{_unit(one)}" for one in columns)
            show()
            show_table("", (str(labels.attrs.get("long_name", dimension)), *headings), rows)
    show()
    show_warnings(result.warnings)


def _unit(variable: "xr.DataArray") -> str:
    unit = str(variable.attrs["units"])
    return _SHOWN_UNITS.get(unit, (unit, 1.0))[0]


def _written(variable: "xr.DataArray") -> list[str]:
    """The numbers of a variable."""
    _, factor = _SHOWN_UNITS.get(str(variable.attrs["units"]), ("", 1.0))
    return [f"{factor * value:.5g}" for value in variable.values.ravel()]

"""A result on the screen: the summary of a run, and tables of results with dimensions of their own."""

import math
from typing import TYPE_CHECKING

from beltdyn.cli.console import aligned, show, show_facts, show_table, show_warnings
from beltdyn.cli.summary import show_summary

if TYPE_CHECKING:
    import xarray as xr

    from beltdyn.results import Result

_SHOWN_UNITS = {"rad": ("°", math.degrees(1.0)), "1": ("", 1.0)}
"""Unit of a variable -> how it is written, and the factor on its numbers."""
_MILLIMETRES = 0.1
"""Size of lengths, m, below which they are written in mm."""
_DIGITS = 5


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
            name = str(labels.attrs.get("long_name", dimension)).partition(",")[0]
            show_table("", (name, *headings), rows)
    show()
    show_warnings(result.warnings)


def _shown(variable: "xr.DataArray") -> tuple[str, float]:
    """The unit in which a variable is written, and the factor on its numbers."""
    unit = str(variable.attrs["units"])
    if unit == "m" and not (abs(variable) >= _MILLIMETRES).any():
        return "mm", 1e3
    return _SHOWN_UNITS.get(unit, (unit, 1.0))


def _unit(variable: "xr.DataArray") -> str:
    return _shown(variable)[0]


def _written(variable: "xr.DataArray") -> list[str]:
    """The numbers of a variable, with as many decimals each."""
    return aligned((_shown(variable)[1] * variable.values.ravel()).tolist(), _DIGITS)

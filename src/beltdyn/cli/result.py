"""A result on the screen: the summary of a run, and tables of results with dimensions of their own."""

import math
import re
from typing import TYPE_CHECKING

from beltdyn.cli.console import aligned, show, show_facts, show_table, show_warnings
from beltdyn.cli.summary import show_summary

if TYPE_CHECKING:
    import xarray as xr

    from beltdyn.results import Result

_MILLIMETRES = 0.1
"""Size of lengths, m, below which they are written in mm."""
_DIGITS = 5
_FIRST_PART = re.compile("[,:]")
_AMONG_WARNINGS = frozenset({"failure"})
"""Variables of long texts, of which warnings tell."""


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
    axes = tuple(str(dataset.attrs.get("axes", "")).split())
    for dims in dict.fromkeys([axes, *((str(dimension),) for dimension in dataset.dims)]):
        columns = [one for one in variables if dims and one.dims == dims and one.name not in _AMONG_WARNINGS]
        if columns and all(dimension in dataset.coords for dimension in dims):
            labels = [one for one in dataset.coords.values() if one.dims and set(one.dims) <= set(dims)]
            shown = [*(one.broadcast_like(columns[0]) for one in labels), *columns]
            show()
            show_table("", map(_heading, shown), zip(*map(_written, shown), strict=True))
    show()
    show_warnings(result.warnings)


def _heading(variable: "xr.DataArray") -> str:
    """The first part of its name up to a comma or a colon, and its unit."""
    name = str(variable.attrs.get("long_name", variable.name))
    return f"{_FIRST_PART.split(name)[0]}\n{_unit(variable)}".rstrip()


def _shown(variable: "xr.DataArray") -> tuple[str, float]:
    """The unit in which a variable is written, and the factor on its numbers."""
    from beltdyn.parts.quantity import RPM

    unit = str(variable.attrs.get("units", ""))
    if unit == "m" and not (abs(variable) >= _MILLIMETRES).any():
        return "mm", 1e3
    shown = {"rad": ("°", math.degrees(1.0)), "rad/s": ("rpm", RPM), "1": ("", 1.0)}
    return shown.get(unit, (unit, 1.0))


def _unit(variable: "xr.DataArray") -> str:
    return _shown(variable)[0]


def _written(variable: "xr.DataArray") -> list[str]:
    """The numbers of a variable, with as many decimals each, or its words."""
    if variable.dtype.kind != "f":
        return [str(one) for one in variable.values.ravel()]
    return aligned((_shown(variable)[1] * variable.values.ravel()).tolist(), _DIGITS)

"""The tables of a rating: verdict and checks, parts, loads of the shafts, and factors."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from beltdyn.parts.messages import aligned
from beltdyn.results import Result
from beltdyn.results.provenance import mesh_facts
from beltdyn.results.schema import shown_unit
from beltdyn.show.parts_list import parts_list
from beltdyn.show.tables import Facts, Sheet, Table

if TYPE_CHECKING:
    import xarray as xr

_DEGREES = 180.0 / np.pi
"""Degrees in a radian: angles are shown in degrees."""
_PERCENT = "utilization of the rated power"
_SHOWN = {"m": ("mm", 1e3)}
_UNITS = {"diameter": ("mm", 1e3), "wrap_angle": ("°", _DEGREES), "width_needed": ("mm", 1e3)}
"""Units of variables of pulleys that differ from those of all; powers are in kW."""


def rating_sheet(result: Result) -> Sheet:
    """Give the sheet of a rating."""
    dataset = result.dataset
    verdict = str(dataset.attrs.get("verdict", ""))  # none in files of earlier versions
    judged = (Facts((("verdict", verdict),), "Verdict"), _checks(dataset)) if verdict else ()
    pulleys = (_pulleys(dataset),) if "pulley" in dataset.dims else ()
    numbers = Facts((*_scalars(dataset), *mesh_facts(dataset.attrs)))
    parts = (*judged, *parts_list(result.prepared), *pulleys, numbers)
    return Sheet(str(dataset.attrs["title"]), parts)


def _checks(dataset: "xr.Dataset") -> Table:
    """Value and limit of each check."""
    rows = []
    for number, name in enumerate(map(str, dataset["check"].values)):
        at = dataset.isel(check=number)
        unit, factor = str(at["check_unit"].item()), 1.0
        unit, factor = ("%", 100.0) if name == _PERCENT else _SHOWN.get(unit, ("" if unit == "1" else unit, factor))
        bound = "at most" if at["check_at_most"].item() else "at least"
        value, limit = (f"{factor * float(at[key]):.4g}" for key in ("check_value", "check_limit"))
        rows.append((name, value, bound, limit, unit, "met" if at["check_met"].item() else "not met"))
    return Table("Checks", ("", "value", "", "limit", "", ""), tuple(rows))


def _pulleys(dataset: "xr.Dataset") -> Table:
    """All variables of pulleys."""
    headings, columns = [""], [list(map(str, dataset["pulley"].values))]
    for name, variable in dataset.data_vars.items():
        if variable.dims != ("pulley",):
            continue
        unit, factor = _UNITS.get(str(name), ("kW", 1e-3) if variable.attrs["units"] == "W" else shown_unit(variable))
        label = str(variable.attrs["long_name"]).partition(",")[0].partition(":")[0]
        headings.append(f"{_in_two_lines(label)} {unit}".rstrip())
        columns.append(aligned((factor * variable.values).tolist()))
    return Table("Pulleys", tuple(headings), tuple(zip(*columns, strict=True)))


def _in_two_lines(label: str) -> str:
    """A heading divided near its middle."""
    spaces = [place for place, letter in enumerate(label) if letter == " "]
    if not spaces:
        return label
    middle = min(spaces, key=lambda place: abs(place - len(label) / 2.0))
    return f"{label[:middle]}\n{label[middle + 1 :]}"


def _scalars(dataset: "xr.Dataset") -> Iterator[tuple[str, str]]:
    for variable in dataset.data_vars.values():
        if not variable.dims and variable.dtype.kind == "f":
            unit, factor = shown_unit(variable)
            yield str(variable.attrs["long_name"]), f"{factor * float(variable):.4g} {unit}".rstrip()

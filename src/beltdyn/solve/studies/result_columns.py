"""Results of any analysis as named numbers, such as "hub_load[driven]" and "largest(span_tension[a-b])"."""

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.results import Result, Run
from beltdyn.solve.studies.named_results import unit_of, values_of

if TYPE_CHECKING:
    import xarray as xr

ALL = "all"
_CALL = re.compile(r"(?P<reduction>\w+)\((?P<name>[^()]+)\)")
_NUMBERS = "fiu"
"""Kinds of arrays that hold numbers."""

_REDUCTIONS: dict[str, Callable[["xr.DataArray", list[str]], "xr.DataArray"]] = {
    "largest": lambda values, dims: values.max(dims),
    "least": lambda values, dims: values.min(dims),
    "mean": lambda values, dims: values.mean(dims),
    "deviation": lambda values, dims: values.std(dims),
    "swing": lambda values, dims: values.max(dims) - values.min(dims),
    "last": lambda values, dims: values.isel(dict.fromkeys(dims, -1)),
}
"""What makes one number of those over time, or along elements and nodes."""


class Columns(NamedTuple):
    """Numbers of a result."""

    values: dict[str, float]
    units: dict[str, str]
    missing: str
    """Which results that are asked for there are not, as a sentence; empty where all are there."""


def columns_of(result: Result, wanted: Sequence[str]) -> Columns:
    """Read numbers of a result by their names.

    A variable along names, as of pulleys or modes, gives a number for each of them.  Of a run over time a plain name
    is that of a mean over the last turns of the belt, as its summary has it, and ``largest(...)``, ``least(...)``,
    ``mean(...)``, ``deviation(...)``, ``swing(...)`` and ``last(...)`` are taken of a variable over all outputs.

    Parameters
    ----------
    result
        The result of any analysis.
    wanted
        Names, or "all" for all single numbers.
    """
    plain = _plain(result)
    values, units, missing = dict[str, float](), dict[str, str](), list[str]()
    for text in wanted:
        call = _CALL.fullmatch(text.strip())
        name = text.strip() if call is None else call["name"].strip()
        known = plain if call is None else _reduced(result.dataset, call["reduction"], name)
        chosen = {one: known[one] for one in known if name in (ALL, one, one.partition("[")[0])}
        if not chosen:
            names = list(known if call is None else map(str, result.dataset.data_vars))
            missing.append(f"{text!r} {_remedy(name, names)}")
        for one, (value, unit) in chosen.items():
            column = one if call is None else f"{call['reduction']}({one})"
            values[column], units[column] = value, unit
    return Columns(values, units, f"results = {'; '.join(missing)}" if missing else "")


def _remedy(name: str, known: Sequence[str]) -> str:
    names = known if "[" in name else list(dict.fromkeys(one.partition("[")[0] for one in known))
    return f"is not a numerical result. {suggest(name, list(names))}"


def _plain(result: Result) -> dict[str, tuple[float, str]]:
    """Single numbers of a result, with their units."""
    if isinstance(result, Run):
        return {name: (value, unit_of(name, result.drive) or "1") for name, value in values_of(result).items()}
    found = dict[str, tuple[float, str]]()
    for name, variable in result.dataset.data_vars.items():
        if variable.dtype.kind in _NUMBERS and all(dim in variable.coords for dim in variable.dims):
            found |= dict(_spread(str(name), variable))
    return found


def _reduced(dataset: "xr.Dataset", reduction: str, of: str) -> dict[str, tuple[float, str]]:
    """Numbers that a reduction makes of a variable over time, or along what has no names."""
    found, wanted = dict[str, tuple[float, str]](), of.partition("[")[0]
    for name, variable in dataset.data_vars.items():
        over = [str(dim) for dim in variable.dims if dim not in variable.coords or variable[dim].dtype.kind == "f"]
        if wanted in (name, ALL) and variable.dtype.kind in _NUMBERS and over and variable.size:
            made = _REDUCTIONS[reduction](variable, over)
            found |= dict(_spread(str(name), made.assign_attrs(variable.attrs)))
    return found


def _spread(name: str, variable: "xr.DataArray") -> Iterator[tuple[str, tuple[float, str]]]:
    """The numbers of a variable along names, each with its own."""
    unit = str(variable.attrs.get("units", "1"))
    labels = [[_label(one) for one in variable[dim].values] for dim in variable.dims]
    for names, value in zip(product(*labels), np.ravel(variable.values), strict=True):
        yield f"{name}[{','.join(names)}]" if names else name, (float(value), unit)


def _label(label: object) -> str:
    return f"{label:.6g}" if isinstance(label, float) else str(label)


def require_reductions(wanted: Sequence[str]) -> None:
    """Make sure that results that are asked for are names, or known reductions of one.

    Raises
    ------
    ModelError
        If one is not.
    """
    for text in wanted:
        call = _CALL.fullmatch(text.strip())
        if "(" in text and (call is None or call["reduction"] not in _REDUCTIONS):
            word = text.partition("(")[0]
            raise ModelError(
                f"results: {text!r} is not a result. {suggest(word, list(_REDUCTIONS))}.".replace("?.", "?")
            )

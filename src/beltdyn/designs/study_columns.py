"""Results of any analysis as named numbers, such as "hub_load[driven]" and "largest(span_tension[a-b])"."""

import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.analyses import EQUILIBRIUM
from beltdyn.designs.named_results import AT_REST, scalar_results, unit_of, values_of, variable_and_label
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.messages import suggest
from beltdyn.points.operating_points import DATA, VARIABLES, variables_of
from beltdyn.results import Result, Run
from beltdyn.results.damage import VARIABLES as OF_FATIGUE
from beltdyn.results.schema import VARIABLES as RECORDED
from beltdyn.results.schema import runs_steadily

if TYPE_CHECKING:
    import xarray as xr

ALL = "all"
_CALL = re.compile(r"(?P<reduction>\w+)\((?P<name>[^()]+)\)")
_NUMBERS = "fiu"
"""Kinds of arrays that hold numbers."""
_OF_DRIVES = {"pulley", "span"}
"""Dimensions whose labels are the same at all points."""

_REDUCTIONS: dict[str, Callable[["xr.DataArray", list[str]], "xr.DataArray"]] = {
    "largest": lambda values, dims: values.max(dims),
    "least": lambda values, dims: values.min(dims),
    "mean": lambda values, dims: values.mean(dims),
    "deviation": lambda values, dims: values.std(dims),
    "swing": lambda values, dims: values.max(dims) - values.min(dims),
    "last": lambda values, dims: values.isel(dict.fromkeys(dims, -1)),
}
"""What makes one number of those over time, or along elements and nodes."""

Numbers = Mapping[str, tuple[float, str]]
"""Name -> number and unit."""


class Columns(NamedTuple):
    """Numbers of a result."""

    values: dict[str, float]
    units: dict[str, str]
    absent: list[str]
    """Why there is no number for a requested result that other points may have, a sentence each."""
    unknown: str
    """The requested results that no point can have, as a sentence; empty without any."""


class _Request(NamedTuple):
    """A requested result."""

    reduction: str
    """Empty without one."""
    name: str

    @property
    def variable(self) -> str:
        return variable_and_label(self.name)[0]

    def selects(self, name: str) -> bool:
        return self.name in (ALL, name, variable_and_label(name)[0])

    def column(self, name: str) -> str:
        return f"{self.reduction}({name})" if self.reduction else name


def request_of(text: str) -> _Request:
    """A requested result, such as "hub_load[driven]" or "largest(span_tension)"."""
    call = _CALL.fullmatch(text.strip())
    reduction, name = ("", text.strip()) if call is None else (call["reduction"], call["name"].strip())
    if ("(" in text or ")" in text) and reduction not in _REDUCTIONS:
        word = text.partition("(")[0]
        raise ModelError(f"results: {text!r} is not a result. {suggest(word, list(_REDUCTIONS))}.".replace("?.", "?"))
    return _Request(reduction, name.replace("/", _PER))


def columns_of(
    result: Result, wanted: Sequence[str], axes: Collection[str] = (), documented: Collection[str] = ()
) -> Columns:
    """Read numbers of a result by their names.

    A variable along names, as of pulleys or modes, gives a number for each of them; so does one along numbers that the
    user chose.  Along numbers that an analysis chooses, which differ from point to point, it is reduced.  Of a run over
    time a plain name is that of a mean over the last turns of the belt, as its summary has it, and ``largest(...)``,
    ``least(...)``, ``mean(...)``, ``deviation(...)``, ``swing(...)`` and ``last(...)`` are taken over all outputs.

    Parameters
    ----------
    result
        The result of an analysis.
    wanted
        The requested results.
    axes
        Dimensions with numbers that the user chose.
    documented
        Variables that the analysis may have, though not for each drive.
    """
    requests = [request_of(text) for text in wanted]
    plain = _plain(result, requests, axes)
    values, units, found = dict[str, float](), dict[str, str](), Columns({}, {}, [], "")
    unknown = list[str]()
    for text, request in zip(wanted, requests, strict=True):
        known = _reduced(result.dataset, request) if request.reduction else plain
        chosen = {name: one for name, one in known.items() if request.selects(name)}
        if not chosen:
            reason, is_absent = _missing(result, request, known, axes, documented)
            (found.absent if is_absent else unknown).append(f"{text!r} {reason}")
        for name, (value, unit) in chosen.items():
            values[request.column(name)], units[request.column(name)] = value, unit
    return Columns(values, units, found.absent, f"results = {'; '.join(unknown)}" if unknown else "")


def _plain(result: Result, requests: Sequence[_Request], axes: Collection[str]) -> Numbers:
    """Single numbers of a result; of a run those that are asked for."""
    if isinstance(result, Run):
        names = {one.variable for one in requests if not one.reduction}
        values = values_of(result, scalar_results(result) if ALL in names else names)
        return {name: (value, unit_of(name, result.drive) or "1") for name, value in values.items()}
    found = dict[str, tuple[float, str]]()
    for name, variable in result.dataset.data_vars.items():
        if variable.dtype.kind in _NUMBERS and not [dim for dim in _unnamed(variable) if dim not in axes]:
            found |= dict(_spread(str(name), variable))
    return found


def _unnamed(variable: "xr.DataArray") -> list[str]:
    """Dimensions along which a variable can be reduced: those of numbers, such as time, and those without labels."""
    return [str(dim) for dim in variable.dims if dim not in variable.coords or variable[dim].dtype.kind == "f"]


def _reduced(dataset: "xr.Dataset", request: _Request) -> Numbers:
    """Numbers that a reduction makes of a variable over time, or along what has no names."""
    found = dict[str, tuple[float, str]]()
    for name, variable in dataset.data_vars.items():
        over = _unnamed(variable)
        if request.variable in (name, ALL) and variable.dtype.kind in _NUMBERS and over and variable.size:
            made = _REDUCTIONS[request.reduction](variable, over)
            found |= dict(_spread(str(name), made.assign_attrs(variable.attrs)))
    return found


def _spread(name: str, variable: "xr.DataArray") -> Iterator[tuple[str, tuple[float, str]]]:
    """The numbers of a variable along names, each with its own."""
    unit = str(variable.attrs.get("units", "1"))
    labels = [_labels(variable, str(dim)) for dim in variable.dims]
    for names, value in zip(product(*labels), np.ravel(variable.values), strict=True):
        yield f"{name}[{','.join(names)}]" if names else name, (float(value), unit)


def _labels(variable: "xr.DataArray", dim: str) -> list[str]:
    return [_label(one) for one in variable[dim].values]


_PER = " per "
"""In place of a slash, which names of variables in files must not have."""


def _label(label: object) -> str:
    return f"{label:.6g}" if isinstance(label, float) else str(label).replace("/", _PER)


def _missing(
    result: Result, request: _Request, known: Numbers, axes: Collection[str], documented: Collection[str]
) -> tuple[str, bool]:
    """Why a requested result is not there, and whether other points may have it."""
    name, variable = request.name, request.variable
    if variable == ALL:
        return "finds no number. Choose another analysis, or keep its files with keep_files = true.", True
    there = result.dataset.data_vars.get(variable)
    if there is not None and there.dtype.kind in _NUMBERS:
        unnamed = [dim for dim in _unnamed(there) if request.reduction or dim not in axes]
        if unnamed and not request.reduction and variable not in {variable_and_label(one)[0] for one in known}:
            return f"varies along {' and '.join(unnamed)}. Reduce it, such as largest({name}).", False
        if request.reduction and not unnamed:
            return f"has nothing to reduce. Write {name}.", False
    labels = [one for one in known if variable_and_label(one)[0] == variable]
    if labels:
        dims = _dims_of(result, variable)
        return _remedy(name, labels), not _OF_DRIVES.issuperset(dims)
    if variable in _possible(result, request) or variable in documented:
        needed = DATA.get(variable)
        return (
            f"needs data that the belt does not have. Give {needed}." if needed else "does not exist for this drive."
        ), True
    names = list(map(str, result.dataset.data_vars)) if request.reduction else list(known)
    return _remedy(name, names or list(_possible(result, request)) or [ALL]), False


def _remedy(name: str, known: Sequence[str]) -> str:
    names = known if "[" in name else list(dict.fromkeys(one.partition("[")[0] for one in known))
    said = f"is not a numerical result. {suggest(name, list(names))}"
    return said if said.endswith("?") else f"{said}."


def _dims_of(result: Result, variable: str) -> Sequence[str]:
    if variable in result.dataset.data_vars:
        return [str(dim) for dim in result.dataset[variable].dims if dim in result.dataset[variable].coords]
    return VARIABLES[variable].dims if variable in VARIABLES else ("",)


def _possible(result: Result, request: _Request) -> Collection[str]:
    """Variables that results of this kind have, though not of each drive."""
    if result.kind == EQUILIBRIUM:
        return AT_REST.keys() | {name for name, one in RECORDED.items() if one.at_rest}
    if isinstance(result, Run) and request.reduction:
        return RECORDED.keys()
    if isinstance(result, Run) and not runs_steadily(result.dataset):
        return VARIABLES.keys() - OF_FATIGUE.keys()
    return VARIABLES.keys() if isinstance(result, Run) or "axes" in result.dataset.attrs else ()


def require_possible(wanted: Sequence[str], drive: Drive, paths: Sequence[str]) -> None:
    """Check that the requested results are names, or known reductions of one, and that some point may have the data."""
    for text in wanted:
        variable = request_of(text).variable
        varies = any(path.startswith("belt") for path in paths)
        if variable in DATA and variable not in variables_of(drive) and not varies:
            raise ModelError(f"results: {text!r} needs data that the belt does not have. Give {DATA[variable]}.")

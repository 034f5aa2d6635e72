"""What a process does for a study: it analyses drives that differ in some numbers, one after another."""

import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import version as version_of
from itertools import product
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from beltdyn.analyses import Analysis
from beltdyn.designs.named_results import unit_of, values_of
from beltdyn.designs.processes import heeding, leaving, stopped, wait_for_the_end, working
from beltdyn.errors import BeltdynError, ModelError
from beltdyn.model import Drive
from beltdyn.parts.messages import suggest
from beltdyn.results import Result, Run

if TYPE_CHECKING:
    import xarray as xr

# Results of any analysis as named numbers, such as "hub_load[driven]" and "largest(span_tension[a-b])"

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
    """The requested results that do not exist, as a sentence; empty if all exist."""


def columns_of(result: Result, wanted: Sequence[str]) -> Columns:
    """Read numbers of a result by their names.

    A variable along names, as of pulleys or modes, gives a number for each of them.  Of a run over time a plain name
    is that of a mean over the last turns of the belt, as its summary has it, and ``largest(...)``, ``least(...)``,
    ``mean(...)``, ``deviation(...)``, ``swing(...)`` and ``last(...)`` are taken of a variable over all outputs.
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
    """Check that the requested results are names, or known reductions of one."""
    for text in wanted:
        call = _CALL.fullmatch(text.strip())
        if "(" in text and (call is None or call["reduction"] not in _REDUCTIONS):
            word = text.partition("(")[0]
            raise ModelError(
                f"results: {text!r} is not a result. {suggest(word, list(_REDUCTIONS))}.".replace("?.", "?")
            )


_one_at_a_time = Lock()
"""A process of another engine may have several threads, which would share the memory of kernels."""


@dataclass(frozen=True, slots=True)
class PointWork:
    """What is asked of every point."""

    drive: Drive
    analysis: Analysis
    options: Mapping[str, Any]
    results: tuple[str, ...]
    folder: Path | None
    """Where result files are kept; None if they are not."""
    version: str = field(default_factory=lambda: version_of("beltdyn"))
    """That of beltdyn where the study was started."""

    def file_of(self, point: int) -> Path:
        """The result file of a point, counted from zero."""
        return (self.folder or Path()) / f"{point + 1:06d}.nc"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a point."""

    point: int
    values: dict[str, float]
    failure: str
    """Why there are no values; empty where there are."""
    warnings: str
    """What makes them doubtful, one line each."""
    seconds: float
    """That it took."""
    missing: str = ""
    """Which results there are not; see `Columns`."""


@dataclass(frozen=True, slots=True)
class ChunkOutcome:
    """What became of some points; those are left out that were not finished when the process was told to end."""

    outcomes: list[Outcome]
    units: dict[str, str]
    interrupted: bool = False


def compute_points(work: PointWork, points: Sequence[tuple[int, Mapping[str, Any]]]) -> ChunkOutcome:
    """Analyze drives."""
    wait_for_the_end()
    outcomes, units = list[Outcome](), dict[str, str]()
    with _one_at_a_time, working():
        for point, changes in points:
            if stopped() or leaving():
                return ChunkOutcome(outcomes, units, interrupted=True)
            try:
                outcomes.append(_outcome(work, point, changes, units))
            except KeyboardInterrupt:
                return ChunkOutcome(outcomes, units, interrupted=True)
    return ChunkOutcome(outcomes, units)


def _outcome(work: PointWork, point: int, changes: Mapping[str, Any], units: dict[str, str]) -> Outcome:
    """Analyze the drive of a point; units of results are added to those that are known."""
    begun = time.perf_counter()
    try:
        result = _analysed(work, point, changes)
        if result.status == "interrupted":
            raise KeyboardInterrupt
        columns = columns_of(result, work.results)
        told = "\n".join(result.warnings)
    except BeltdynError as error:
        return Outcome(point, {}, str(error), "", time.perf_counter() - begun)
    except Exception as error:
        return Outcome(point, {}, f"{type(error).__name__}: {error}", "", time.perf_counter() - begun)
    units |= columns.units
    return Outcome(point, columns.values, "", told, time.perf_counter() - begun, columns.missing)


def _analysed(work: PointWork, point: int, changes: Mapping[str, Any]) -> Result:
    """The result at a point, in memory or in a file."""
    if work.version != (own := version_of("beltdyn")):
        raise RuntimeError(
            f"this worker has beltdyn {own}, but the study was started with {work.version}. Install the same version."
        )
    drive = work.drive.with_(changes)
    if work.folder is not None:
        result: Result = work.analysis.write(drive, work.file_of(point), heeding(), True, **work.options)
        return result
    taken = {"progress": heeding()} if work.analysis.tells else {}
    found: Result = work.analysis.function(drive, **taken, **work.options)
    return found

"""Tables of a result as CSV files."""

import csv
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import astuple
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from beltdyn.errors import Parts
from beltdyn.results.atomic import atomic_path, make_folder, require_replaceable
from beltdyn.results.energy_balance import losses_of
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.schema import SPAN_TENSIONS, VARIABLES
from beltdyn.results.summary import Summary, summarize

if TYPE_CHECKING:
    import xarray as xr

_PULLEYS = (
    "pulley_speed",
    "pulley_angle",
    "shaft_speed",
    "pulley_torque",
    "shaft_torque",
    "hub_force",
    "wrap_angle",
    "pulley_center",
    "slip",
    "creep",
    "elastic_creep",
    "radial",
    "bending",
    "regularization",
    "sliding",
    "sliding_arc",
    "slip_safety",
    "own_load_safety",
    "tension_ratio",
    "hub_load",
    "hub_direction",
    "power_in",
    "power_out",
    "friction_power",
    "contact_damping_power",
)
_SPANS = (*SPAN_TENSIONS, "belt_speed", "mid_span_displacement")
_ENERGY = (*(name for name, variable in VARIABLES.items() if variable.dims == ("time",)),)
_TENSIONERS = ("tensioner_position", "tensioner_speed")
_CARRIAGE = ("carriage_position", "carriage_speed", "carriage_error")
_CONTACT = ("contact_position", "contact_pulley", "normal_force", "friction_force", "slip_velocity")

_PULLEY_SUMMARY = (
    "pulley",
    "speed [rad/s]",
    "torque of the belt [N m]",
    "shaft torque [N m]",
    "power [W]",
    "slip [1]",
    "elastic creep [1]",
    "radial [1]",
    "bending [1]",
    "regularization [1]",
    "sliding [1]",
    "sliding speed [m/s]",
    "sliding arc [rad]",
    "slip safety [1]",
    "slip safety by own load [1]",
    "tension ratio [1]",
    "allowed tension ratio [1]",
    "wrap angle [rad]",
    "hub load [N]",
    "rated power [W]",
    "utilization [1]",
)
_SPAN_SUMMARY = (
    *("span", "tension [N]", "least tension [N]", "largest tension [N]"),
    *("tension at start [N]", "tension at end [N]", "belt speed [m/s]"),
)
_LOSS_SUMMARY = ("cause", "power [W]", "share of the power input [1]", "energy since the start [J]")

_FIRST_HEADINGS = {
    **dict.fromkeys(("pulleys", "spans", "energy", "tensioners", "carriage", "rolls"), "time [s]"),
    "contact": "belt_coordinate [m]",
    "pulley_summary": _PULLEY_SUMMARY[0],
    "span_summary": _SPAN_SUMMARY[0],
    "losses": _LOSS_SUMMARY[0],
}
"""Every table of a run -> how it starts."""

_OF_NAMES = ("point", "pulley", "span", "tensioner", "state")
"""Tables of other results; they start with their name."""

NAMES = (*_FIRST_HEADINGS, *_OF_NAMES)
"""Names of tables."""

Column = tuple[str, NDArray[Any]]
"""Its heading and its values."""

Table = Sequence[Column]

MakeTable = Callable[[], Table]
"""Makes a table."""


def write_csv(run: Result, folder: Path | str, overwrite: bool = False) -> list[Path]:
    """Write tables of a result.

    A run gives tables of pulleys, spans, energy and tensioners over time, contact at the last output, and the summary;
    operating points give one row each; other results one row for each pulley, span or other named item.

    Every file has one line of headings, such as ``pulley_speed driver [rad/s]``, and numbers with
    ten significant digits. Derived quantities follow the recorded ones.

    Parameters
    ----------
    run : Result
        The run, or another result.
    folder : Path or str
        Destination folder; created if necessary.
    overwrite : bool
        Replace any regular files, not only tables of beltdyn.

    Returns
    -------
    list of Path
        ``pulleys.csv``, ``spans.csv``, ``energy.csv``, ``tensioners.csv`` if there are any, ``contact.csv``, and the
        means over the end of the run: ``pulley_summary.csv``, ``span_summary.csv`` and ``losses.csv``. Of other results
        ``point.csv`` for operating points, and the name of the dimension for others, such as ``pulley.csv``.

    Raises
    ------
    ModelError
        If the run holds no output, a file cannot be written, or would replace one that is no such table.

    Examples
    --------
    >>> [path.name for path in bd.write_csv(run, "tables")][:4]
    ['pulleys.csv', 'spans.csv', 'energy.csv', 'contact.csv']
    """
    require_tables(folder, overwrite)
    tables = tables_of(run)
    folder = make_folder(Path(folder))
    with Parts() as parts:
        for name, table in tables.items():
            with parts.part(f"bd.write_csv({run.source}, {str(folder)!r}), table {name}"):
                parts.completed.append(_write(folder / f"{name}.csv", overwrite, table()))
    return parts.completed


def tables_folder(path: Path) -> Path:
    """Where the tables of a result file are written."""
    return path.with_name(f"{path.stem}-tables")


def tables_of(result: Result) -> Mapping[str, MakeTable]:
    """Tables of a result by name, such as "pulleys", as `write_csv` writes them; each is made by itself."""
    if not isinstance(result, Run):
        return _tables_of_names(result.dataset)
    result.require_output()
    return _tables_of_run(result)


def _tables_of_run(run: Run) -> Mapping[str, MakeTable]:
    """Tables over time, and of the means."""
    dataset, summary = cache(partial(_with_derived, run)), cache(partial(summarize, run))
    over_time = {
        "pulleys": _with_others(_PULLEYS, "pulley"),
        "spans": _with_others(_SPANS, "span"),
        "energy": _ENERGY,
        "tensioners": _with_others(_TENSIONERS, "tensioner"),
        "carriage": _CARRIAGE,
        "rolls": _with_others((), "roll"),
    }
    tables: dict[str, MakeTable] = {
        name: lambda names=variables: list(_columns(dataset(), ("time", *names)))  # type: ignore[misc]
        for name, variables in over_time.items()
        if variables[0] in run.dataset
    }
    return tables | {
        "contact": lambda: list(_columns(run.fields_at(), ("belt_coordinate", *_CONTACT))),
        "pulley_summary": lambda: _table(_PULLEY_SUMMARY, map(astuple, summary().pulleys)),
        "span_summary": lambda: _table(_SPAN_SUMMARY, map(astuple, summary().spans)),
        "losses": lambda: _table(_LOSS_SUMMARY, _losses(summary(), run)),
    }


def _tables_of_names(dataset: "xr.Dataset") -> Mapping[str, MakeTable]:
    """A table of operating points, and one for each other dimension that has names."""
    axes = str(dataset.attrs.get("axes", "")).split()
    found: dict[str, MakeTable] = {"point": partial(_table_of_points, dataset, axes)} if axes else {}
    for dim in (str(dim) for dim in dataset.dims if dim in dataset.coords and dim not in axes):
        columns = [str(name) for name, one in dataset.data_vars.items() if one.dims[:1] == (dim,)]
        if columns:
            found[dim] = partial(_table_of_names, dataset, dim, columns)
    return found


def _table_of_points(dataset: "xr.Dataset", axes: Sequence[str]) -> Table:
    """A row for each operating point."""
    points = dataset.stack(point=axes, create_index=False)
    numbers = np.arange(1, points.sizes["point"] + 1)
    names = [*axes, *(name for name in (*points.coords, *points.data_vars) if name not in axes)]
    along = [str(name) for name in names if "point" in points[name].dims]
    return [("point", numbers), *_columns(points.transpose("point", ...), along)]


def _table_of_names(dataset: "xr.Dataset", dim: str, columns: Sequence[str]) -> Table:
    return [(dim, dataset[dim].values), *_columns(dataset, columns)]


def require_tables(folder: Path | str, overwrite: bool = False) -> None:
    """Check that tables in a folder replace at most tables of beltdyn."""
    for name in NAMES:
        require_replaceable(Path(folder) / f"{name}.csv", _is_table, overwrite)


def _is_table(path: Path) -> bool:
    """Tell whether a file starts with the heading that its namesake of ours has."""
    heading = f"{_FIRST_HEADINGS.get(path.stem, path.stem)},".encode()
    with suppress(OSError), path.open("rb") as file:
        return file.read(len(heading)) == heading
    return False


def _losses(summary: Summary, run: Run) -> list[tuple[Any, ...]]:
    """Rows of the table of losses."""
    balance = summary.balance
    return [
        (cause, power, power / balance.power_in if balance.power_in > 0.0 else np.nan, float(run.dataset[name][-1]))
        for (name, cause), power in zip(losses_of(run.dataset).items(), balance.losses.values(), strict=True)
    ]


def _with_derived(run: Run) -> "xr.Dataset":
    """Give the dataset with what is derived from it over time for pulleys and spans."""
    from beltdyn.results import derived

    hub = derived.hub_loads(run)[["hub_load", "hub_direction"]]
    parts = (derived.slips(run), derived.sliding_arcs(run), derived.pulley_powers(run), hub, derived.slip_safeties(run))
    ratio = {"tension_ratio": derived.tension_ratios(run)}
    return run.dataset.assign({name: part[name] for part in parts for name in part.data_vars} | ratio)


def _with_others(names: tuple[str, ...], dimension: str) -> tuple[str, ...]:
    """Names of variables over time along a dimension, with those behind that are recorded besides."""
    recorded = (name for name, variable in VARIABLES.items() if variable.dims[:2] == ("time", dimension))
    return (*names, *(name for name in recorded if name not in names))


def _columns(dataset: "xr.Dataset", names: Iterable[str]) -> Iterable[Column]:
    """Take variables apart into columns along their first dimension, those that are there."""
    for name in (name for name in names if name in dataset.variables):
        variable = dataset[name]
        labels = [dataset[dim].values for dim in variable.dims[1:]]
        for index in np.ndindex(*variable.shape[1:]):
            words = [name, *(str(label[i]) for label, i in zip(labels, index, strict=True))]
            unit = f" [{variable.attrs['units']}]" if "units" in variable.attrs else ""
            yield f"{' '.join(words)}{unit}", variable.values[(slice(None), *index)]


def _table(headings: Sequence[str], rows: Iterable[Sequence[Any]]) -> Table:
    """Turn rows into columns."""
    return list(zip(headings, map(np.array, zip(*rows, strict=True)), strict=True))


def _write(path: Path, overwrite: bool, table: Table) -> Path:
    headings, values = zip(*table, strict=True)
    with (
        atomic_path(path, _is_table, overwrite) as temporary,
        temporary.open("w", newline="", encoding="utf-8") as file,
    ):
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headings)
        rows = zip(*values, strict=True)
        writer.writerows([value if isinstance(value, str) else f"{value:.10g}" for value in row] for row in rows)
    return path

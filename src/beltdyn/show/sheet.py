"""Sheets of results: the tables and facts that the screen, notebooks and reports show."""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cache, partial
from importlib import import_module
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.analyses import STUDY
from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.parts.messages import aligned
from beltdyn.parts.quantity import RPM, SHOWN_UNITS
from beltdyn.results.cycles import ends_at_standstill
from beltdyn.results.incidents import Jump, jumps_in
from beltdyn.results.means import PulleySummary
from beltdyn.results.provenance import Resolution, mesh_facts
from beltdyn.results.result import Result
from beltdyn.results.run import Run
from beltdyn.results.schema import VARIOUS, attribute, in_words, runs_steadily, shown_unit
from beltdyn.results.summary import FAILURE, Compared, Summary, steady_comparison, summarize
from beltdyn.results.tooth_loads import ToothLoads, extreme_loads
from beltdyn.show.axis_sheet import carriage_table, peak_tables
from beltdyn.show.tables import Facts, Pieces, Sheet, Table, sheet_of
from beltdyn.show.verdict import limit_rows

if TYPE_CHECKING:
    import xarray as xr

# The sheet of a study: number of points, and range of each input and result

_DIGITS = 5
"""Significant digits of numbers in the sheet of a study: changes of 0.01 % are seen, and columns stay narrow."""
_MAX_RESULTS = 40
"""Number of results in the table at most: the facts say how many there are."""


def _study_pieces(dataset: "xr.Dataset") -> Iterator[Callable[[], Pieces]]:
    """Facts of a study, and tables of its numbers and results."""
    names = str(dataset.attrs["results"]).splitlines()
    numbers = str(dataset.attrs["numbers"]).splitlines()
    yield lambda: (Facts(tuple(_facts(dataset, names))),)
    yield lambda: (Table("", ("number", "", "min", "max"), tuple(_row(dataset[path]) for path in numbers)),)
    if names:
        yield lambda: (_table_of_results(dataset, names[:_MAX_RESULTS]),)


def _table_of_results(dataset: "xr.Dataset", names: Sequence[str]) -> Table:
    rows = tuple(_result_row(dataset[name]) for name in names)
    table = Table("", ("result", "", "min", "at point", "mean", "max", "at point"), rows)
    known = [np.isfinite(dataset[name].values) for name in names]
    return table if np.all(known) else _with_points(table, known)


def _facts(dataset: "xr.Dataset", names: list[str]) -> list[tuple[str, str]]:
    seconds = dataset["seconds"].values
    done, failed = int(dataset.attrs["done"]), int((dataset["failure"] != "").sum())
    facts = [("points", f"{done} of {dataset.sizes['point']}, {failed} failed" if failed else f"{done}")]
    if done < dataset.sizes["point"] and not failed:
        facts = [("points", f"{done} of {dataset.sizes['point']}")]
    if done:
        facts.append(("computing time", f"{np.nansum(seconds):.3g} s, {np.nanmean(seconds):.3g} s per point"))
    if len(names) > _MAX_RESULTS:
        facts.append(("results", f"{len(names)}, {_MAX_RESULTS} shown"))
    return facts


def _with_points(table: Table, known: Sequence[BoolArray]) -> Table:
    """Add a column with the number of points at which each result has a value."""
    counts = (f"{one.sum()} of {one.size}" for one in known)
    rows = tuple((*row, count) for row, count in zip(table.rows, counts, strict=True))
    return table._replace(headings=(*table.headings, "known at"), rows=rows)


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


# The sheet of a run: pulleys, spans, power, tensioners and solver statistics

_COMPARED_UNITS = {**SHOWN_UNITS, "m": ("mm", 1e3), "1": ("%", 100.0)}
"""SI unit -> the one that is shown, and the factor."""
_OF_PARTS = ("rad/s", "N", "N/m")

_LARGEST_SAFETY = 20.0
"""Factor on loads up to which it is within 2 %, and is shown: beyond, guides resist more than in proportion."""
_LARGEST_MARGIN = 100.0
"""Margin to a jump, 1, up to which it is shown as a number."""
_LEAST_SHARE = 0.01
"""Share of the power input from which a shaft is named."""
_ROUNDING_POWER = 1e-9
"""Power below which it is rounding, W."""
_MIN_KILOWATT_POWER = 1e4
"""Power from which powers are shown in kW, W."""


def run_sheet(run: Run) -> Sheet:
    """Summarize a run in tables and facts."""
    if run.outputs == 0:
        return Sheet("The run ended before its first output.", ())
    summary = cache(partial(summarize, run))
    with run.recorded() as recorded:
        stands = ends_at_standstill(recorded, run.prepared)
    pieces: tuple[Callable[[], Pieces], ...] = (
        lambda: carriage_table(run),
        lambda: peak_tables(run) if stands else _mean_tables(run, summary()),
        lambda: _teeth(run),
        lambda: _steady_running(run),
        lambda: (
            Facts(
                (
                    *(() if stands else _power(summary())),
                    *(*_tensioners(run, summary()), *_rolls(run), *_run_up(run)),
                    *(*_mesh_used(run), *_solver(summary())),
                )
            ),
        ),
    )
    return sheet_of(run.drive.name or "", pieces, run.source)


def _mean_tables(run: Run, summary: Summary) -> Pieces:
    """Means of pulleys and spans over the end of a run."""
    title, drive = f"Pulleys{_window(run, summary)}", run.drive
    pulleys = _pulleys(title, summary, drive.guides)
    if drive.belt.teeth is not None:
        pulleys = pulleys.without(_OF_FRICTION)
    return pulleys, _spans(run, summary)


def _teeth(run: Run) -> Pieces:
    """Extremes of the loads of teeth, and whether the belt jumps; empty without teeth, or outputs along the belt."""
    if run.drive.belt.teeth is None:
        return ()
    with run.recorded() as recorded:
        if "contact_pulley" not in recorded:
            return ()
        loads = extreme_loads(recorded, run.prepared)
        jumped = jumps_in(recorded, [pulley.name for pulley in run.prepared.pulleys])
    rows = []
    for one in loads:
        allowed = "–" if math.isnan(one.allowed) else f"{one.allowed:.1f}"
        margin = safety_text(one.jump_margin, _LARGEST_MARGIN)
        rows.append((one.name, f"{one.in_mesh:.1f}", f"{one.largest:.1f}", allowed, margin))
    headings = ("", "teeth\nin mesh", "largest\nload N", "allowed\nN", "margin\nto jump")
    return (Table("Teeth", headings, tuple(rows)), _jumping(jumped, loads)) if rows else ()


def _jumping(jumped: Sequence[Jump], loads: Sequence[ToothLoads]) -> Facts:
    """Whether a belt jumps, in words."""
    least = min(loads, key=lambda one: one.jump_margin)
    margin = safety_text(least.jump_margin, _LARGEST_MARGIN)
    if jumped:
        often = f", {len(jumped)} times" if len(jumped) > 1 else ""
        words = f"the belt jumps on {jumped[0].name} at {jumped[0].time:.4g} s{often}"
    elif least.jump_margin <= 1.0:
        words = f"none, but teeth lift on {least.name}: margin {margin}"
    else:
        words = f"none: the least margin is {margin}, on {least.name}; at 1 a tooth lifts"
    return Facts((("jumps", words),))


def _run_up(run: Run) -> list[tuple[str, str]]:
    """The settling before a run-up, and the quantities held constant in it."""
    with run.recorded() as recorded:
        said, left = recorded.attrs, attribute(recorded, "settling_left", math.nan)
        time, held = attribute(recorded, "settling_time", 0.0), str(said.get("held", ""))
    part = "a transient of unknown size" if math.isnan(left) else f"a transient of {left:.1%} of the tensions"
    before = f"{time:.3g} s at the first speed, not recorded; {part} remains"
    return [*([("settling", before)] if time else []), *([("held constant", held)] if held else [])]


def _mesh_used(run: Run) -> list[tuple[str, str]]:
    """Elements and their number."""
    with run.recorded() as recorded:
        return mesh_facts(recorded.attrs)


def _pulleys(title: str, summary: Summary, guides: BoolArray) -> Table:
    """The table of pulleys; powers in kW where they are large, no slip over guides that stand still."""
    pulleys = summary.pulleys
    unit, watts = power_unit([one.power for one in pulleys])
    headings = (
        "",
        "rpm",
        "torque\nN m",
        f"power\n{unit}",
        "slip",
        "elastic\ncreep",
        "wrap\nangle",
        "slip\narc",
    )
    columns = (
        (one.name for one in pulleys),
        aligned([RPM * one.speed for one in pulleys], 5),
        aligned([one.shaft_torque for one in pulleys]),
        aligned([one.power / watts for one in pulleys]),
        (_share(math.nan if stands else one.slip) for one, stands in zip(pulleys, guides, strict=True)),
        (_share(math.nan if stands else one.elastic_creep) for one, stands in zip(pulleys, guides, strict=True)),
        (f"{math.degrees(one.wrap_angle):.1f}°" for one in pulleys),
        (f"{math.degrees(one.sliding_arc):.1f}°" for one in pulleys),
        (_ratio(one.tension_ratio, one, "2f") for one in pulleys),
        (_ratio(one.allowed_tension_ratio, one, "2g") for one in pulleys),
        (safety_text(one.own_load_safety) for one in pulleys),
        (safety_text(one.slip_safety) for one in pulleys),
        aligned([one.hub_load for one in pulleys]),
    )
    return Table(
        title,
        (*headings, "tension\nratio", "ratio\nmax", "safety\nown", "\nall", "hub\nN"),
        tuple(zip(*columns, strict=True)),
    )


_OF_FRICTION = ("slip", "elastic\ncreep", "slip\narc", "tension\nratio", "ratio\nmax", "safety\nown", "\nall")
"""Columns of pulleys that hold a belt by friction."""


def power_unit(powers: ArrayLike) -> tuple[str, float]:
    """Unit in which powers (W) are shown, and its size in W."""
    return ("kW", 1e3) if np.fmax.reduce(np.abs(np.asarray(powers)), axis=None) >= _MIN_KILOWATT_POWER else ("W", 1.0)


def safeties(values: FloatArray) -> list[str]:
    """Slip safeties; a dash without load."""
    return [f"{one:.2f}" if one < _LARGEST_SAFETY else safety_text(one) for one in values.tolist()]


def _window(run: Run, summary: Summary) -> str:
    """The averaging window and its belt turns; none in steady running."""
    with run.recorded() as recorded:
        if runs_steadily(recorded):
            return " (steady running)"
    if not summary.end > summary.start:
        return ""
    turns = f", {summary.turns} turn{'s'[: summary.turns != 1]} of the belt" if summary.turns else ""
    return f" (means from {summary.start:.4g} to {summary.end:.4g} s{turns})"


def _share(part: float) -> str:
    """A share of the first rim's speed; a dash where that, or a guide, stands still."""
    return "–" if math.isnan(part) else f"{part:z.3%}"


_LARGEST_RATIO = 99.0
"""Largest tension ratio that is shown: no drive comes near."""


def _ratio(ratio: float, pulley: PulleySummary, digits: str) -> str:
    """The tension ratio, or that which friction allows; a dash where friction is not what holds the belt."""
    if math.isnan(pulley.tension_ratio) or not pulley.allowed_tension_ratio > 1.0:
        return "–"
    return f"{ratio:.{digits}}" if ratio < _LARGEST_RATIO else f">{_LARGEST_RATIO:.0f}"


def safety_text(safety: float, largest: float = _LARGEST_SAFETY) -> str:
    """The slip safety; a dash without load."""
    if math.isnan(safety):
        return "–"
    return f"{safety:.3g}" if safety < largest else f"> {largest:.0f}"


TENSION_HEADINGS = ("tension\nmean N", "min\nN", "max\nN", "at start\nN", "at end\nN")
"""Of the columns of `tension_columns`."""


def tension_columns(tensions: ArrayLike) -> list[list[str]]:
    """Columns of tensions of spans (N), shape (spans, 5): mean, least, largest, at both ends; with equal decimals."""
    rows = np.asarray(tensions)
    columns: list[list[str]] = np.reshape(aligned(rows.ravel().tolist()), rows.shape).T.tolist()
    return columns


def _spans(run: Run, summary: Summary) -> Table:
    """The table of spans."""
    headings = ("", *TENSION_HEADINGS, "belt speed\nm/s")
    return Table(f"Spans{_window(run, summary)}", headings, tuple(_span_rows(summary)))


def _span_rows(summary: Summary) -> Iterable[tuple[str, ...]]:
    """Span rows.

    A span has no tension or speed while the belt has left one of its pulleys; a warning says so.
    """
    spans = summary.spans
    tensions = tension_columns([(one.tension, one.lowest, one.highest, one.at_start, one.at_end) for one in spans])
    speeds = aligned([one.belt_speed for one in spans])
    return zip((one.name for one in spans), *tensions, speeds, strict=True)


def _watts(power: float, digits: int = 4) -> str:
    """A power in W or kW with the given significant digits, but at least to the unit."""
    if abs(power) < _ROUNDING_POWER:
        return "0 W"
    value, unit = (power / 1e3, "kW") if abs(power) >= _MIN_KILOWATT_POWER else (power, "W")
    return f"{value:.{digits}g} {unit}" if abs(value) < 10.0**digits - 0.5 else f"{value:.0f} {unit}"


def _power(summary: Summary) -> list[tuple[str, str]]:
    """Power, efficiency and losses by cause, if there is power input."""
    balance = summary.balance
    if not balance.power_in > 0.0:
        return []
    losses = ", ".join(f"{cause} {_watts(power, 3)}" for cause, power in balance.losses.items() if power != 0.0)
    efficiency = f"{balance.efficiency:.2%}" if balance.power_out > 0.0 else "none (no power output)"
    takers = {"the web": -balance.web, "lifting of goods": balance.lifted}
    parts = [f"{name} {_watts(power)}" for name, power in takers.items() if power > 0.0]
    taken = f" ({', '.join(parts)})" if parts else ""
    flows = f"{_watts(balance.power_in)} in{_givers(summary)}, {_watts(balance.power_out)} out{taken}"
    return [
        ("power", f"{flows}, {_watts(balance.stored, 3)} stored" if summary.steps else flows),
        ("efficiency", efficiency),
        ("losses", f"{_watts(balance.lost, 3)}: {losses}" if losses else "none"),
    ]


def _givers(summary: Summary) -> str:
    """The shafts that put power in, and the web of a line, if several."""
    powers = [*((pulley.name, pulley.power) for pulley in summary.pulleys), ("the web", summary.balance.web)]
    powers.append(("goods that go down", -summary.balance.lifted))
    givers = [(name, power) for name, power in powers if power > _LEAST_SHARE * summary.balance.power_in]
    parts = ", ".join(f"{name} {_watts(power)}" for name, power in givers)
    return f" ({parts})" if len(givers) > 1 or summary.balance.lifted < 0.0 else ""


def _tensioners(run: Run, summary: Summary) -> list[tuple[str, str]]:
    """Arm angles, or positions of slides, and their range."""
    facts = []
    for one, carrier in zip(summary.tensioners, run.prepared.carriers, strict=True):
        (what, unit), (place, *ends) = carrier.shown_as, carrier.shown([one.position, one.lowest, one.highest])
        unit = unit.replace("mm", " mm")
        low, high = (f"{end:z.4g}{unit}" for end in sorted(ends))
        travel = f" (range {low} to {high})" if one.highest > one.lowest else ""
        facts.append((f"{what} of {one.name}".replace("position of", "tensioner of"), f"{place:z.4g}{unit}{travel}"))
    return facts


def _rolls(run: Run) -> list[tuple[str, str]]:
    """Radius, inertia and torque of rolls, at the beginning and at the end of a run."""
    if not run.drive.rolls:  # asked of the drive: without rolls the dataset is not needed
        return []
    facts = []
    for name in run.dataset["roll"].values:
        ends = run.dataset.sel(roll=name).isel(time=[0, -1])
        radius, inertia, torque = (ends[one].values for one in ("roll_radius", "roll_inertia", "roll_torque"))
        shown = (_from_to(1e3 * radius, "mm"), _from_to(inertia, "kg m²"), _from_to(torque, "N m"))
        facts.append((f"roll of {name}", ", ".join(shown)))
    return facts


def _from_to(values: FloatArray, unit: str) -> str:
    """A number with its unit, or two where it changes."""
    first, last = (f"{value:.5g}" for value in values)
    return f"{first} {unit}" if first == last else f"{first} to {last} {unit}"


def _solver(summary: Summary) -> list[tuple[str, str]]:
    """Solver statistics: mesh errors, energy balance, steps and computing time; fewer without time steps."""
    steps = f"{summary.steps} accepted, {summary.rejected_steps} rejected"
    facts = [
        ("mesh errors", _mesh(summary.resolution)),
        ("energy balance", f"closes within {abs(summary.energy_closure):.1e} of the energy input"),
        ("time steps", f"{steps}; {summary.outputs} outputs"),
    ]
    prepared = f", plus {summary.compile_time:.3g} s of preparation" if summary.steps else ""
    took = f"{summary.wall_time:.3g} s{_pace(summary)}{prepared}"
    known = not math.isnan(summary.wall_time)
    moves = not math.isnan(summary.resolution.errors["slip"])
    return [*(facts if summary.steps else facts[:moves]), *([("computing time", took)] if known else [])]


def _pace(summary: Summary) -> str:
    """Computing time per simulated second; empty without time steps."""
    pace = summary.computing_time_per_second
    return "" if math.isnan(pace) or not summary.steps else f" ({pace:.3g} s per simulated second)"


def _mesh(resolution: Resolution) -> str:
    """The estimated mesh errors that are known; without slip they are those at rest."""
    known = {name: error for name, error in resolution.errors.items() if not math.isnan(error)}
    errors = ", ".join(f"{name} {error:.1%}" if error < 1.0 else f"{name} > 100%" for name, error in known.items())
    return f"{errors}{', at rest' * ('slip' not in known)}" if errors else "unknown"


def _steady_running(run: Run) -> tuple[Table | Facts, ...]:
    """The comparison with steady running, or why there is none; empty if not requested."""
    with run.recorded() as recorded:
        failure = str(recorded.attrs.get(FAILURE, ""))
    if failure:
        return (Facts((("steady running", failure),)),)
    rows = tuple(map(_comparison_row, steady_comparison(run)))
    return (Table("Against steady running", ("", "run", "steady", "unit", "difference", ""), rows),) if rows else ()


def _comparison_row(one: Compared) -> tuple[str, ...]:
    """A row of the table: slips and places differ by so much, others by a part too."""
    unit, factor = _COMPARED_UNITS.get(one.unit, (one.unit, 1.0))
    pair = aligned([factor * one.run, factor * one.steady], 5)
    share = f"{one.run / one.steady - 1.0:+z.2%}" if one.unit in _OF_PARTS and one.steady else ""
    return (f"{one.quantity} of {one.name}", *pair, unit, f"{factor * (one.run - one.steady):+z.3g}", share)


_SHEET_DIGITS = 5
"""Significant digits of numbers in other sheets: changes of 0.01 % are seen, and columns stay narrow."""
_FIRST_PART = re.compile("[,:]")
_AMONG_WARNINGS = frozenset({"failure"})
"""Variables of long texts, which warnings quote."""


OF_KINDS = {
    "sheet": "beltdyn.show.drive_sheet:drive_sheet",
    "rating": "beltdyn.show.rating_sheet:rating_sheet",
    "stroke": "beltdyn.show.axis_sheet:stroke_sheet",
}
"""Kind of result -> "MODULE:FUNCTION" that gives its sheet, where it has tables of its own."""


def sheet(result: Result) -> Sheet:
    """Give the sheet of a result: the summary of a run, or values and tables of another analysis, and its limits."""
    of_kind = sheet_without_limits(result)
    limits = sheet_of("", [partial(_limits, result)], result.source)
    return of_kind._replace(parts=(*of_kind.parts, *limits.parts), errors=(*of_kind.errors, *limits.errors))


def _limits(result: Result) -> Pieces:
    """The table of the limits of the drive file, if it has any."""
    rows = limit_rows(result)
    return (Table("Limits", ("", "value", "at", "limit", ""), tuple(rows)),) if rows else ()


def sheet_without_limits(result: Result) -> Sheet:
    """Give the sheet of a result without the table of its limits."""
    if isinstance(result, Run):
        return run_sheet(result)
    title = str(result.dataset.attrs["title"])
    if result.kind == STUDY:
        return sheet_of(title, _study_pieces(result.dataset), result.source)
    if result.kind in OF_KINDS:
        module, _, name = OF_KINDS[result.kind].partition(":")
        return sheet_of(title, [lambda: getattr(import_module(module), name)(result).parts], result.source)
    return sheet_of(title, _pieces(result.dataset), result.source)


def _pieces(dataset: "xr.Dataset") -> Iterator[Callable[[], Pieces]]:
    """Numbers, and tables along each dimension."""
    variables = dataset.data_vars.values()
    yield partial(_numbers, dataset)
    axes = tuple(str(dataset.attrs.get("axes", "")).split())
    left_out = _AMONG_WARNINGS | {dataset.attrs.get("tables_by")}
    for dims in dict.fromkeys([axes, *((str(dimension),) for dimension in dataset.dims)]):
        columns = [one for one in variables if dims and one.dims == dims and one.name not in left_out]
        if columns and all(dimension in dataset.coords for dimension in dims):
            labels = [one for one in dataset.coords.values() if one.dims and set(one.dims) <= set(dims)]
            shown = [*(one.broadcast_like(columns[0]) for one in labels), *columns]
            yield partial(_tables, shown, dataset.get(dataset.attrs.get("tables_by")))
    across = str(dataset.attrs.get("columns_by", "")).split()
    for variable in variables:
        if variable.dims[:-1] == axes and variable.dims[-1:] in [(dimension,) for dimension in across]:
            yield partial(_table_across, variable)


def _numbers(dataset: "xr.Dataset") -> Pieces:
    """Single numbers."""
    single = [one for one in dataset.data_vars.values() if not one.dims]
    facts = [*((str(one.attrs["long_name"]), _single(one)) for one in single), *mesh_facts(dataset.attrs)]
    return (Facts(tuple(facts)),) if facts else ()


def _tables(shown: "Sequence[xr.DataArray]", group: "xr.DataArray | None") -> Pieces:
    """A table of columns; or one for each word of a variable along their rows, below that word."""
    headings, rows = tuple(map(_heading, shown)), list(zip(*map(_column, shown), strict=True))
    if group is None or group.dims != shown[0].dims:
        return (Table("", headings, tuple(rows)),)
    words = [str(one) for one in group.values]
    return tuple(
        Table(
            word[:1].upper() + word[1:],
            headings,
            tuple(row for row, own in zip(rows, words, strict=True) if own == word),
        )
        for word in dict.fromkeys(words)
    )


def _table_across(variable: "xr.DataArray") -> Pieces:
    """A table of a variable along two dimensions: rows of the first, columns of the second."""
    rows, columns = (variable.coords[dimension] for dimension in variable.dims)
    name, (unit, _) = _FIRST_PART.split(str(variable.attrs["long_name"]))[0], shown_unit(variable)
    words = [f"{_heading(columns)} {one}" for one in _column(columns)]
    cells = [_column(variable[:, number]) for number in range(columns.size)]
    title = f"{name}, {unit}" if unit else name
    return (Table(title, (_heading(rows), *words), tuple(zip(_column(rows), *cells, strict=True))),)


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
        return ["–" if math.isnan(one) else f"{one:z.{_SHEET_DIGITS}g}" for one in variable.values.ravel()]
    return aligned((shown_unit(variable)[1] * variable.values.ravel()).tolist(), _SHEET_DIGITS)

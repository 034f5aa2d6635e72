"""Figures of a study: results over numbers, in lines, as contours, and along parallel axes."""

import json
import re
from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from beltdyn.analyses import STUDY
from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.results import Result
from beltdyn.results.schema import shown_unit
from beltdyn.show.plot.figures import Choice, figure
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, name_lines, name_once, panels, rows

# What figures of a study share: which numbers and results they show, in which units, and which figures suit it

_MOST_PANELS = 6
_BESIDE = 2
"""Panels beside each other: their words are long."""
_CORNERS = 3
"""Points from which on there are contours."""


def panel_for_each_result(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each of the first results, with one legend where all have the same."""
    draws = [partial(draw, result, name) for name in results_of(result)[:_MOST_PANELS]]
    page = panels(rows(draws, _BESIDE), sharey=False)
    titles = [box.get_title().get_text() for ax in page.axes if (box := ax.get_legend()) is not None]
    name_once(page, next(iter(titles), ""))
    return page


def suits(kind: str) -> Callable[[Result], bool]:
    """Whether a figure is the one, or one of those, that suit a study."""

    def is_suited(result: Result) -> bool:
        if not results_of(result):
            return False
        sampling, count = str(result.dataset.attrs["sampling"]), len(varied_numbers(result))
        if sampling == "one_at_a_time":
            return kind == "tornado"
        if sampling == "saltelli":
            return kind in ("indices", "parallel")
        if count > 2:
            return kind == "parallel"
        return (kind == "lines" and count > 0) or (kind == "contour" and spans_a_plane(result))

    return is_suited


def spans_a_plane(result: Result) -> bool:
    """Whether two numbers vary, and not along a line."""
    varied = varied_numbers(result)
    if len(varied) != 2:
        return False
    places = np.stack([result.dataset[one].values for one in varied], axis=1)
    places = (places - places.mean(axis=0)) / np.ptp(places, axis=0)
    return len(places) >= _CORNERS and int(np.linalg.matrix_rank(places, tol=1e-6)) == 2


def numbers_of(result: Result) -> list[str]:
    """Paths of the numbers of a study."""
    return str(result.dataset.attrs["numbers"]).splitlines()


def varied_numbers(result: Result) -> list[str]:
    """Numbers that have several values; not those that are words."""
    found = [result.dataset[path] for path in numbers_of(result)]
    return [str(one.name) for one in found if one.dtype.kind in "fi" and len(np.unique(one.values)) > 1]


def results_of(result: Result) -> list[str]:
    """Results that are known somewhere."""
    names = str(result.dataset.attrs["results"]).splitlines()
    return [name for name in names if np.isfinite(result.dataset[name].values).any()]


def moved_from_base(values: xr.DataArray) -> BoolArray:
    """Where a number is not that of the drive file."""
    given = json.loads(str(values.attrs.get("base", "null")))
    return np.asarray(values.values != given)


def chosen_result(result: Result, of: str | None) -> str:
    """The requested result; by default the first."""
    names = results_of(result)
    name = (names or [""])[0] if of is None else of
    if name not in names:
        raise ModelError(f"of = {name!r} is not a result of the study. {suggest(name, names)}")
    return name


def chosen_number(result: Result, over: str | None, varied: list[str]) -> str:
    """The requested parameter; by default the one with most values."""
    if over is None and varied:
        return max(varied, key=lambda path: len(np.unique(result.dataset[path].values)))
    if over not in varied:
        raise ModelError(f"over = {over!r} is not a varying parameter of the study. {suggest(str(over), varied)}")
    return over


def in_shown_units(values: xr.DataArray) -> FloatArray:
    """Numbers in the unit in which they are shown."""
    return shown_unit(values)[1] * values.values.astype(float)


def labelled(values: xr.DataArray, width: int = 30) -> str:
    """Name and unit of a number or a result, in lines of so many letters where it can be broken."""
    unit = shown_unit(values)[0].replace("*", "·").replace(" ", "·")
    lines = [""]
    for piece in filter(None, re.split(r"(?<=[._,])|(?=\[)", str(values.name))):
        if lines[-1] and len(lines[-1]) + len(piece) > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(lines) + (f" [{unit}]" if unit else "")


def value_in_words(values: xr.DataArray, value: float) -> str:
    """A value of a number with its unit."""
    unit, factor = shown_unit(values)
    return f"{factor * value:.4g} {unit.replace('*', '·')}".rstrip()


_FAMILY = 7
"""Lines of one panel."""
_MOST_LINES = 1500
_AXES = 4
"""Results along parallel axes."""
_LEVELS = 12
_NARROW = 11
"""Letters in a line below one of them."""
_BACK = {"facecolor": "w", "edgecolor": "none", "pad": 0.8}
"""Behind numbers."""


@figure(suits("lines"), panel_for_each_result, of=(STUDY,))
def study_lines(result: Result, of: str | None = None, over: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw a result of a study over a parameter, with a line for each value of a second one, or points for more.

    Parameters
    ----------
    result : Result
        Of `study`.
    of : str, optional
        Name of the result; by default the first.
    over : str, optional
        Path of the number along the horizontal axis; by default the one that has most values.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result or number.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[{"path": "belt.width", "values": "10..20 mm", "steps": 3}],
    ... )
    >>> bd.plot.study_lines(bd.study(study, drive, jobs=1)).get_xlabel()
    'belt.width [mm]'
    """
    name, ax, varied = chosen_result(result, of), axes_or_new(ax), varied_numbers(result)
    along = chosen_number(result, over, varied)
    others = [one for one in varied if one != along]
    x, y = in_shown_units(result.dataset[along]), in_shown_units(result.dataset[name])
    family = np.unique(result.dataset[others[0]].values) if len(others) == 1 else np.empty(0)
    if others and not 0 < len(family) <= _FAMILY:
        ax.plot(x, y, "o", markersize=3, color=color(0))
    else:
        for number, value in enumerate(family if len(family) else [None]):
            chosen = np.isfinite(y) if value is None else (result.dataset[others[0]].values == value) & np.isfinite(y)
            order = np.flatnonzero(chosen)[np.argsort(x[chosen], kind="stable")]
            told = None if value is None else value_in_words(result.dataset[others[0]], value)
            ax.plot(x[order], y[order], color=color(number), linestyle=dash(number), marker="o", ms=3, label=told)
    if len(family):
        ax.legend(title=str(result.dataset[others[0]].name))
    ax.set(xlabel=labelled(result.dataset[along]), title=labelled(result.dataset[name]))
    return ax


@figure(suits("contour"), panel_for_each_result, of=(STUDY,))
def study_contour(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw a result of a study over two parameters as contours; crosses mark failed points.

    Parameters
    ----------
    result : Result
        Of `study`, in which two numbers vary.
    of : str, optional
        Name of the result; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or other than two numbers vary.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[
    ...         {"path": "belt.width", "values": "10..20 mm", "steps": 2},
    ...         {"path": "pulley[driven].radius", "values": "81..81.5 mm", "steps": 2},
    ...     ],
    ... )
    >>> bd.plot.study_contour(bd.study(study, drive, jobs=1)).get_ylabel()
    'pulley[driven].radius [mm]'
    """
    name = chosen_result(result, of)
    if not spans_a_plane(result):
        raise ModelError(
            f"contours need two varying parameters; this study varies {', '.join(varied_numbers(result)) or 'none'}."
        )
    ax, (first, second) = axes_or_new(ax), varied_numbers(result)
    x, y, z = (in_shown_units(result.dataset[one]) for one in (first, second, name))
    known = np.isfinite(z)
    if np.count_nonzero(known) > 2 and np.ptp(z[known]) > 0.0:
        filled = ax.tricontourf(x[known], y[known], z[known], levels=_LEVELS, cmap="viridis")
        page = ax.get_figure()
        assert page is not None
        page.colorbar(filled, ax=ax)
    ax.set_title(labelled(result.dataset[name]))
    ax.plot(x[known], y[known], ".", color=INK, markersize=2)
    ax.plot(x[~known], y[~known], "x", color=color(1), markersize=5)
    ax.set(xlabel=labelled(result.dataset[first]), ylabel=labelled(result.dataset[second]))
    ax.grid(visible=False)
    return ax


@figure(suits("parallel"), of=(STUDY,))
def parallel_coordinates(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw each point of a study as a line across parallel axes of parameters and results.

    Parameters
    ----------
    result : Result
        Of `study`.
    of : str, optional
        Name of the result that colors the lines; by default the first, which stands last.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension", "hub_load[driven]"],
    ...     number=[{"path": "belt.width", "values": "10..20 mm", "steps": 2}],
    ... )
    >>> ax = bd.plot.parallel_coordinates(bd.study(study, drive, jobs=1))
    >>> ax.get_xticklabels()[0].get_text()
    'belt.width [mm]'
    """
    name = chosen_result(result, of)
    names = [*varied_numbers(result), *[one for one in results_of(result) if one != name][: _AXES - 1], name]
    ax = axes_or_new(ax, (1.6 * len(names) + 1.5, 4.2))
    table = np.stack([in_shown_units(result.dataset[one]) for one in names], axis=1)
    table = table[np.isfinite(table).all(axis=1)]
    table = table[np.unique(np.linspace(0, len(table) - 1, _MOST_LINES).astype(int))]
    low, high = table.min(axis=0), table.max(axis=0)
    scaled = (table - low) / np.where(high > low, high - low, 1.0)
    places = np.arange(len(names))
    paths = [np.column_stack([places, row]) for row in scaled]
    shade = colormaps["viridis"](scaled[:, -1])
    ax.add_collection(LineCollection(paths, colors=shade, linewidths=0.8, alpha=0.6))
    for place, bottom, top in zip(range(len(names)), low, high, strict=True):
        ax.axvline(place, color=INK, linewidth=0.9)
        for value, height, side in ((bottom, -0.02, "top"), (top, 1.02, "bottom")):
            ax.text(place, height, f"{value:.4g}", ha="center", va=side, fontsize=7, bbox=_BACK)
    ax.set_xticks(places, [labelled(result.dataset[one], _NARROW) for one in names], fontsize=7)
    ax.set(xlim=(-0.5, len(names) - 0.5), ylim=(-0.12, 1.12), yticks=[])
    ax.tick_params(axis="x", length=0, pad=8)
    ax.spines[["left", "bottom"]].set_visible(False)
    ax.grid(visible=False)
    return ax


# Sobol indices: what part of the variance of a result is due to each number that varies (Saltelli et al. 2010)

_RESAMPLES = 200
"""Of the bootstrap."""
_LEVEL = 1e-12
"""Change of a result, over its largest value, that is rounding."""


def indices_of(values: FloatArray, dimensions: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """First-order and total Sobol indices at the points of Saltelli's design (Saltelli et al. 2010), and their errors.

    Results have shape (n (d + 2), results); unknown ones leave out the n-th points of all parts of the design. Indices
    have shape (results, d), NaN where a result is known in fewer than two places or does not vary; errors are half of
    the 95 % confidence intervals, by bootstrap over the points.
    """
    parts = values.reshape(dimensions + 2, -1, values.shape[1])
    found = np.full((4, values.shape[1], dimensions), np.nan)
    for result in range(values.shape[1]):
        known = parts[:, np.isfinite(parts[:, :, result]).all(axis=0), result]
        if known.shape[1] < 2 or np.ptp(known) <= _LEVEL * np.max(np.abs(known)):
            continue
        drawn = np.random.default_rng(0).integers(known.shape[1], size=(_RESAMPLES, known.shape[1]))
        spread = np.stack([_indices(known[:, places]) for places in drawn])
        low, high = np.nanquantile(spread, (0.025, 0.975), axis=0)
        found[:, result] = [*_indices(known), *(0.5 * (high - low))]
    return found[0], found[1], found[2], found[3]


def _indices(known: FloatArray) -> FloatArray:
    """First-order indices and total ones, shape (2, d), from results of shape (d + 2, n).

    Those of first order by Saltelli et al. (2010), Table 2 (b), total ones by Jansen, (f).
    """
    first, second, mixed = known[0], known[1], known[2:]
    mean, variance = known[:2].mean(), known[:2].var()
    with np.errstate(divide="ignore", invalid="ignore"):
        alone = ((second - mean) * (mixed - first)).mean(axis=1) / variance
        in_all = 0.5 * ((first - mixed) ** 2).mean(axis=1) / variance
    return np.stack([alone, in_all])


_MOST_BARS = 12
_WIDE = 22
"""Letters in a line beside a bar."""
_TICKS = 5
"""Numbers below a panel at most, less one: they may have many digits."""


@figure(suits("tornado"), panel_for_each_result, of=(STUDY,))
def tornado(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the range of a result as each parameter varies while the others keep their values of the drive file.

    Parameters
    ----------
    result : Result
        Of `study` with the sampling "one_at_a_time".
    of : str, optional
        Name of the result; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or several parameters vary at a time.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[{"path": "belt.width", "values": [0.01, 0.02]}],
    ...     sampling="one_at_a_time",
    ... )
    >>> bd.plot.tornado(bd.study(study, drive, jobs=1)).get_xlabel()
    'tension [N]'
    """
    name, ax = chosen_result(result, of), axes_or_new(ax)
    if result.dataset.attrs["sampling"] != "one_at_a_time":
        raise ModelError('a tornado needs parameters varied one at a time. Use sampling = "one_at_a_time".')
    values = in_shown_units(result.dataset[name])
    moved = {path: moved_from_base(result.dataset[path]) for path in numbers_of(result)}
    at_base = values[~np.any(list(moved.values()), axis=0)]
    base = float(at_base[0]) if at_base.size else np.nan
    spans = {path: (np.append(values[where], base), where) for path, where in moved.items() if where.any()}
    widths = {path: float(np.nan_to_num(np.nanmax(some) - np.nanmin(some))) for path, (some, _) in spans.items()}
    order = sorted(spans, key=lambda path: widths[path])[-_MOST_BARS:]
    for row, path in enumerate(order):
        some, where = spans[path]
        numbers = in_shown_units(result.dataset[path])[where]
        for value, number in ((np.nanmin(some), int(np.nanargmin(some))), (np.nanmax(some), int(np.nanargmax(some)))):
            ax.barh(row, value - base, left=base, color=color(int(value < base)), height=0.7)
            if number < len(numbers):
                side = "left" if value > base else "right"
                ax.annotate(f"{numbers[number]:.4g}", (value, row), (3 if value > base else -3, 0), "data",
                            "offset points", ha=side, va="center", fontsize=8)  # fmt: skip
    ax.axvline(base, color=INK, linewidth=0.9)
    ax.set_yticks(range(len(order)), [labelled(result.dataset[path], _WIDE) for path in order], fontsize=8)
    ax.margins(x=0.2)
    ax.locator_params(axis="x", nbins=_TICKS)
    ax.set_xlabel(labelled(result.dataset[name]))
    return ax


@figure(suits("indices"), panel_for_each_result, of=(STUDY,))
def sobol_indices(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the share of each parameter in the variance of a result, alone and with interactions.

    Bars are first-order and total Sobol indices, with 95 % confidence intervals.

    Parameters
    ----------
    result : Result
        Of `study` with the sampling "saltelli".
    of : str, optional
        Name of the result; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or the study has another sampling.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     results=["tension"],
    ...     number=[{"path": "belt.width", "values": [0.01, 0.02]}],
    ...     sampling="saltelli",
    ...     points=2,
    ... )
    >>> bd.plot.sobol_indices(bd.study(study, drive, jobs=1)).get_yticklabels()[0].get_text()
    'belt.width [mm]'
    """
    name, ax = chosen_result(result, of), axes_or_new(ax)
    if result.dataset.attrs["sampling"] != "saltelli":
        raise ModelError('Sobol indices need a Saltelli design. Use sampling = "saltelli".')
    names = numbers_of(result)
    first, total, first_error, total_error = indices_of(result.dataset[name].values[:, None], len(names))
    places = np.arange(len(names))
    for side, values, errors, told in (
        (0.2, first[0], first_error[0], "alone"),
        (-0.2, total[0], total_error[0], "with interactions"),
    ):
        ax.barh(places + side, values, 0.38, xerr=errors, capsize=2, color=color(int(side < 0.0)), label=told)
    ax.set_yticks(places, [labelled(result.dataset[one], _WIDE) for one in names], fontsize=8)
    ax.set_xlim(left=min(0.0, float(np.nan_to_num(first[0]).min()) - 0.05))
    ax.set_xlabel(f"Share of the variance of\n{name}", fontsize=9)
    name_lines(ax)
    return ax

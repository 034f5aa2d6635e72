"""Figures of a study: results over numbers, in lines, as contours, and along parallel axes."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba

from beltdyn.analyses import STUDY
from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.figures import figure
from beltdyn.show.plot.gaps import count_missing
from beltdyn.show.plot.study_values import (
    along_axis,
    chosen_number,
    chosen_result,
    in_shown_units,
    is_number,
    labelled,
    panel_for_each_result,
    places_of,
    results_of,
    spans_a_plane,
    suits,
    value_in_words,
    values_of,
    varied_numbers,
    varied_paths,
    words_of,
)
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, note

_MAX_FAMILY_LINES = 7
"""Number of lines of one panel at most: for more values of a parameter, points are drawn."""
_MAX_LINES = 1500
"""Lines along parallel axes at most, of points at equal intervals of the study: more would cover each other."""
_MAX_RESULT_AXES = 4
"""Number of results among parallel axes at most: each axis widens the figure."""
_CONTOUR_LEVELS = 12
"""Number of contour levels, about: their limits are round numbers, so that there may be a few more or fewer."""
_ROOM = 0.05
"""Room above and below the points of contours, over their range."""
_TICK_LINE_LENGTH = 11
"""Letters of a line of the name below a parallel axis at most: axes are 1.6 inches apart."""
_UNKNOWN = "0.6"
"""Color of points without a value of the result that colors them."""
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
    name, varied = chosen_result(result, of), varied_paths(result)
    along = chosen_number(result, over, varied)
    ax, others = axes_or_new(ax), [one for one in varied if one != along]
    x, y = along_axis(result.dataset[along]), in_shown_units(result.dataset[name])
    second = result.dataset[others[0]] if len(others) == 1 else None
    values = np.array(values_of(second) if second is not None else [None] * len(x), dtype=object)
    family = sorted(set(values), key=lambda one: (isinstance(one, str), one is not None, one or 0.0))
    if others and (second is None or len(family) > _MAX_FAMILY_LINES):
        ax.plot(x, y, "o", markersize=3, color=color(0))
    else:
        for number, value in enumerate(family):
            chosen = np.array([one == value for one in values]) & np.isfinite(x)
            order = np.flatnonzero(chosen)[np.argsort(x[chosen], kind="stable")]
            told = None if second is None else value_in_words(second, value)
            ax.plot(x[order], y[order], color=color(number), linestyle=dash(number), marker="o", ms=3, label=told)
        if second is not None:
            ax.legend(title=str(second.name))
    if not is_number(result.dataset[along]):
        words = words_of(result.dataset[along])
        ax.set_xticks(range(len(words)), words)
    ax.set(xlabel=labelled(result.dataset[along]), title=labelled(result.dataset[name]))
    note(ax, count_missing(y))
    return ax


@figure(suits("contour"), panel_for_each_result, of=(STUDY,))
def study_contour(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw a result of a study over two parameters as contours; crosses mark points without a value.

    Where the known points lie along a line they are drawn as circles in the colors of their values.

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
    places, z = places_of(result), in_shown_units(result.dataset[name])
    if not spans_a_plane(places):
        raise ModelError(
            f"contours need two varying parameters; this study varies {', '.join(varied_paths(result)) or 'none'}."
        )
    ax, (first, second), (x, y) = axes_or_new(ax), varied_numbers(result), places.T
    known = np.isfinite(z) & np.isfinite(places).all(axis=1)
    if spans_a_plane(places[known]) and np.ptp(z[known]) > 0.0:
        filled: Any = ax.tricontourf(x[known], y[known], z[known], levels=_CONTOUR_LEVELS, cmap="viridis")
        ax.plot(x[known], y[known], ".", color=INK, markersize=2)
    else:
        filled = ax.scatter(x[known], y[known], 30, z[known], cmap="viridis", edgecolor=INK, linewidth=0.5)
    page = ax.get_figure()
    assert page is not None
    page.colorbar(filled, ax=ax)
    ax.set_title(labelled(result.dataset[name]))
    ax.plot(x[~known], y[~known], "x", color=color(1), markersize=5)
    note(ax, count_missing(np.where(known, z, np.nan)))
    ax.set(xlabel=labelled(result.dataset[first]), ylabel=labelled(result.dataset[second]))
    low, high = np.nanmin(y), np.nanmax(y)
    ax.set_ylim(low - _ROOM * (high - low), high + _ROOM * (high - low))
    ax.grid(visible=False)
    return ax


@figure(suits("parallel"), of=(STUDY,))
def parallel_coordinates(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw each point of a study as a line across parallel axes of parameters and results.

    A line joins what is known of its point, and is gray where the result that colors it is not.

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
    name, varied = chosen_result(result, of), varied_paths(result)
    names = [*varied, *[one for one in results_of(result) if one != name][: _MAX_RESULT_AXES - 1], name]
    ax = axes_or_new(ax, (1.6 * len(names) + 1.5, 4.2))
    table = np.stack([along_axis(result.dataset[one]) for one in names], axis=1)
    complete = np.isfinite(table).all(axis=1)
    table = table[np.isfinite(table[:, len(varied) :]).any(axis=1)]
    table = table[np.unique(np.linspace(0, len(table) - 1, _MAX_LINES).astype(int))]
    low, high = np.fmin.reduce(table), np.fmax.reduce(table)
    scaled = (table - low) / np.where(high > low, high - low, 1.0)
    places = np.arange(len(names))
    paths = [np.column_stack([places, row])[np.isfinite(row)] for row in scaled]
    shade = colormaps["viridis"](scaled[:, -1])
    shade[np.isnan(scaled[:, -1])] = to_rgba(_UNKNOWN)
    ax.add_collection(LineCollection(paths, colors=shade, linewidths=0.8, alpha=0.6))
    for place, bottom, top in zip(range(len(names)), low, high, strict=True):
        ax.axvline(place, color=INK, linewidth=0.9)
        for value, height, side in ((bottom, -0.02, "top"), (top, 1.02, "bottom")):
            values = result.dataset[names[place]]
            text = f"{value:.4g}" if is_number(values) else words_of(values)[int(value)]
            ax.text(place, height, text, ha="center", va=side, fontsize=7, bbox=_BACK)
    note(ax, count_missing(np.where(complete, 0.0, np.nan)).replace("no value", "not all values"))
    ax.set_xticks(places, [labelled(result.dataset[one], _TICK_LINE_LENGTH) for one in names], fontsize=7)
    ax.set(xlim=(-0.5, len(names) - 0.5), ylim=(-0.12, 1.12), yticks=[])
    ax.tick_params(axis="x", length=0, pad=8)
    ax.spines[["left", "bottom"]].set_visible(False)
    ax.grid(visible=False)
    return ax

"""What figures of a study share: which numbers and results they show, in which units, and which figures suit it."""

import json
import re
from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.plot.legends import name_once
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice
from beltdyn.results import Result
from beltdyn.results.shown import shown_unit

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
    """The name of a result that is asked for; by default the first."""
    names = results_of(result)
    name = (names or [""])[0] if of is None else of
    if name not in names:
        raise ModelError(f"of = {name!r} is not a result of the study. {suggest(name, names)}")
    return name


def chosen_number(result: Result, over: str | None, varied: list[str]) -> str:
    """The path of a number that is asked for; by default the one that has most values."""
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

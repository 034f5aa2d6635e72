"""Numbers and results of a study, as its figures show them, and the figures that suit a study."""

import json
import re
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.results import Result
from beltdyn.results.schema import shown_unit
from beltdyn.show.plot.figures import Choice
from beltdyn.show.plot.gaps import first_failure, gaps
from beltdyn.show.plot.style import name_once, panels, rows

_MAX_PANELS = 6
"""Panels of a page at most, of the first results of a study: three rows of two."""
_PANEL_COLUMNS = 2
"""Panels beside each other: their words are long."""
_MIN_CONTOUR_POINTS = 3
"""Points from which on there are contours."""


def panel_for_each_result(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each of the first results, with one legend where all have the same."""
    draws = [partial(draw, result, name) for name in known_results(result)[:_MAX_PANELS]]
    page = panels(rows(draws, _PANEL_COLUMNS), sharey=False)
    titles = [box.get_title().get_text() for ax in page.axes if (box := ax.get_legend()) is not None]
    name_once(page, next(iter(titles), ""))
    return page


def suits(kind: str) -> Callable[[Result], bool]:
    """Whether a figure is the one, or one of those, that suit a study."""

    def is_suited(result: Result) -> bool:
        if not results_of(result):
            return False
        sampling, count = str(result.dataset.attrs["sampling"]), len(varied_paths(result))
        if sampling == "one_at_a_time":
            return kind == "tornado"
        if sampling == "saltelli":
            return kind in ("indices", "parallel")
        if count > 2:
            return kind == "parallel"
        return (kind == "lines" and count > 0) or (kind == "contour" and spans_a_plane(places_of(result)))

    return is_suited


def places_of(result: Result) -> FloatArray:
    """Values of the numbers that vary, in the units in which they are shown, shape (points, numbers)."""
    found = [in_shown_units(result.dataset[path]) for path in varied_numbers(result)]
    return np.stack(found, axis=1) if found else np.empty((result.dataset.sizes["point"], 0))


def spans_a_plane(places: FloatArray) -> bool:
    """Whether points of two numbers, shape (points, 2), lie not along a line; those with unknown numbers left out."""
    places = places[np.isfinite(places).all(axis=1)]
    if places.shape[1] != 2 or len(places) < _MIN_CONTOUR_POINTS or not np.ptp(places, axis=0).all():
        return False
    places = (places - places.mean(axis=0)) / np.ptp(places, axis=0)
    return int(np.linalg.matrix_rank(places, tol=1e-6)) == 2


def numbers_of(result: Result) -> list[str]:
    """Paths of the numbers of a study."""
    return str(result.dataset.attrs["numbers"]).splitlines()


def varied_paths(result: Result) -> list[str]:
    """Numbers and words that have several values."""
    return [path for path in numbers_of(result) if len(set(values_of(result.dataset[path]))) > 1]


def varied_numbers(result: Result) -> list[str]:
    """Numbers that have several values; not those that are words."""
    return [path for path in varied_paths(result) if is_number(result.dataset[path])]


def values_of(values: xr.DataArray) -> list[object]:
    """Values of which equal ones are the same, also where the drive file gives none."""
    return [None if one is None or one != one else one for one in values.values.tolist()]


def is_number(values: xr.DataArray) -> bool:
    """Whether values are numbers, or not given."""
    return all(one is None or (isinstance(one, int | float) and not isinstance(one, bool)) for one in values_of(values))


def results_of(result: Result) -> list[str]:
    """Results that are known somewhere."""
    names = str(result.dataset.attrs["results"]).splitlines()
    return [name for name in names if np.isfinite(result.dataset[name].values).any()]


def known_results(result: Result) -> list[str]:
    """Results that are known somewhere; an error where there are none."""
    names = results_of(result)
    if not names:
        failed, why = gaps(result), first_failure(result)
        first = f" The first: {why}" if why else ""
        raise ModelError(f"there is nothing to draw: no result has a value.{f' {failed}.' if failed else ''}{first}")
    return names


def moved_from_base(values: xr.DataArray) -> BoolArray:
    """Where a number is not that of the drive file, which may give none."""
    given = json.loads(str(values.attrs.get("base", "null")))
    return np.array([one != given for one in values_of(values)])


def chosen_result(result: Result, of: str | None) -> str:
    """The requested result; by default the first."""
    return chosen_of(known_results(result), of)


def chosen_of(names: Sequence[str], of: str | None) -> str:
    """The requested one of the names of results; by default the first."""
    name = names[0] if of is None else of
    if name not in names:
        raise ModelError(f"of = {name!r} is not a result. {suggest(name, list(names))}")
    return name


def chosen_number(result: Result, over: str | None, varied: list[str]) -> str:
    """The requested parameter; by default the one with most values."""
    if over is None and varied:
        return max(varied, key=lambda path: len(set(values_of(result.dataset[path]))))
    if over not in varied:
        raise ModelError(f"over = {over!r} is not a varying parameter of the study. {suggest(str(over), varied)}")
    return over


def in_shown_units(values: xr.DataArray) -> FloatArray:
    """Numbers in the unit in which they are shown, NaN where there are none."""
    return shown_unit(values)[1] * np.array(values.values.tolist(), dtype=float)


def words_of(values: xr.DataArray) -> list[str]:
    """Words in the order in which they first occur."""
    return list(dict.fromkeys(map(str, values.values.tolist())))


def along_axis(values: xr.DataArray) -> FloatArray:
    """Numbers in the unit in which they are shown; of words their places in `words_of`."""
    if is_number(values):
        return in_shown_units(values)
    words = words_of(values)
    return np.array([words.index(str(one)) for one in values.values.tolist()], dtype=float)


def labelled(values: xr.DataArray, width: int = 30) -> str:
    """Name and unit of a number or a result, in lines of so many letters where it can be broken."""
    unit = shown_unit(values)[0].replace("*", "·").replace(" ", "·")
    lines = [""]
    for piece in filter(None, re.split(r"(?<=[._,])|(?=\[)", str(values.name))):
        if lines[-1] and len(lines[-1]) + len(piece) > width:
            lines.append("")
        lines[-1] += piece
    return "\n".join(lines) + (f" [{unit}]" if unit else "")


def value_in_words(values: xr.DataArray, value: object) -> str:
    """A value of a number with its unit, or a word."""
    if not isinstance(value, int | float) or isinstance(value, bool):
        return "not given" if value is None else str(value)
    unit, factor = shown_unit(values)
    return f"{factor * value:.4g} {unit.replace('*', '·')}".rstrip()

"""Tornado figures: sensitivity of results to the parameters of a drive."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import axes_or_new, color
from beltdyn.results import Result

_BARS = 10
_MOST = 4


def _all_panels(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each result, of four at most."""
    names = [str(name) for name in result.dataset["result"].values][:_MOST]
    return panels(rows([partial(draw, result, name) for name in names]), sharey=False)


@figure(always, _all_panels, of=("sensitivity",))
def sensitivity(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the parameters with the largest effect on a result, the largest on top.

    Bars are changes of the result with 1 % more of a number, or 1 mm more of a coordinate.

    Parameters
    ----------
    result : Result
        Of `sensitivity`.
    of : str, optional
        Name of one of its results; by default the first.
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
    >>> found = bd.sensitivity(drive, about="rest", of="tension", numbers="belt.width, belt.length")
    >>> [number.get_text() for number in bd.plot.sensitivity(found).get_yticklabels()]
    ['belt.width', 'belt.length']
    """
    return _tornado(result, of, "effect", "change per 1 % or 1 mm", axes_or_new(ax))


def _has_tolerances(result: Result) -> bool:
    """Draw a figure where the drive file has tolerances."""
    return "contribution" in result.dataset


@figure(_has_tolerances, _all_panels, of=("sensitivity",))
def tolerances(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the tolerances with the largest effect on a result, the largest on top.

    Bars are changes of the result with the tolerance of a number. The lowest is the spread of all, which are
    independent: the root of the sum of squares.

    Parameters
    ----------
    result : Result
        Of `sensitivity`, of a drive file with tolerances.
    of : str, optional
        Name of one of its results; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or the drive file has no tolerances.

    Examples
    --------
    >>> text = bd.example("two_pulley").text.replace("width = 0.01", 'width = "10 ± 0.1 mm"')
    >>> found = bd.sensitivity(bd.loads(text), about="rest", of="tension", numbers="belt.width")
    >>> [name.get_text() for name in bd.plot.tolerances(found).get_yticklabels()]
    ['all, independent', 'belt.width']
    """
    if not _has_tolerances(result):
        raise ModelError('the drive file has no tolerances. Write for example width = "12.5 ± 0.1 mm".')
    return _tornado(result, of, "contribution", "change over the tolerance", axes_or_new(ax))


def _tornado(result: Result, of: str | None, variable: str, words: str, ax: Axes) -> Axes:
    """Draw bars of a variable over numbers, the largest on top; below them the spread of tolerances."""
    names = [str(name) for name in result.dataset["result"].values]
    name = names[0] if of is None else of
    if name not in names:
        raise ModelError(f"of = {name!r} is not a result. {suggest(name, names)}")
    chosen = result.dataset.sel(result=name)
    effects = np.nan_to_num(chosen[variable].values)
    labels = [str(path) for path in chosen["number"].values]
    largest = [int(k) for k in np.argsort(-np.abs(effects), kind="stable")[:_BARS][::-1]]
    if variable == "contribution":
        largest = [k for k in largest if effects[k] != 0.0]
    unit, value = str(chosen["unit"].values), float(chosen["value"])
    percent = not unit and name.partition("[")[0] in ("efficiency", "pulley_slip")
    factor, shown = (100.0, "%") if percent else (1.0, unit)
    bars = [(labels[k], float(factor * effects[k]), color(int(effects[k] < 0))) for k in largest]
    if variable == "contribution":
        bars.insert(0, ("all, independent", factor * float(chosen["spread"]), color(2)))
    ticks = range(len(bars))
    drawn = ax.barh(ticks, [length for _, length, _ in bars], color=[shade for _, _, shade in bars])
    ax.bar_label(drawn, fmt="%.2g", padding=2, fontsize=7)
    ax.set_yticks(ticks, [label for label, _, _ in bars], fontsize=7)
    ax.margins(x=0.2)
    found = f"{name} = {factor * value:.4g} {shown}".rstrip()
    ax.set_xlabel(f"{found}\n{words}{f' [{shown}]' if shown else ''}", fontsize=9)
    return ax

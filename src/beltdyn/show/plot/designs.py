"""Figures of an optimization: the goal of the designs that were tried, and the best design beside the start."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.results import Result
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import Choice, always, figure
from beltdyn.show.plot.style import INK, axes_or_new, color, panels, rows

# Tornado figures: sensitivity of results to the parameters of a drive

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
    ax.margins(x=0.35)
    found = f"{name} = {factor * value:.4g} {shown}".rstrip()
    ax.set_xlabel(f"{found}\n{words}{f' [{shown}]' if shown else ''}", fontsize=9)
    return ax


_KEPT = 1e-4
"""Permitted violation of a limit, relative."""


def _goal_and_numbers(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out the goal, and below it where the numbers are between their bounds."""
    return panels([[draw_panel] for draw_panel in (partial(draw, result), partial(_numbers, result))], sharey=False)


@figure(always, _goal_and_numbers, of=("optimize",))
def optimization(result: Result, *, ax: Axes | None = None) -> Axes:
    """Draw the goal of the designs in the order in which they were tried.

    Filled circles are designs within all limits, hollow circles violate some, and crosses have no steady running. The
    line is the best design so far.

    Parameters
    ----------
    result : Result
        Of `optimize`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> study = bd.OptimizationStudy(
    ...     number=[{"path": "belt.length", "least": "1.27 m", "largest": "1.275 m"}],
    ...     goal={"result": "hub_load"},
    ... )
    >>> bd.plot.optimization(bd.optimize(drive, study=study, most=3)).get_xlabel()
    'Design'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    goal, beyond = dataset["design_goal"].values, dataset["design_violation"].values
    number, runs = np.arange(1, goal.size + 1), np.isfinite(goal)
    kept = runs & (beyond <= _KEPT)
    most = str(dataset.attrs["title"]).rpartition(": ")[2].startswith("maximize")
    best = (np.fmax if most else np.fmin).accumulate(np.where(kept, goal, np.nan))
    ax.step(number, best, where="post", color=INK, linewidth=1.0, label="best so far")
    ax.plot(number[kept], goal[kept], "o", color=color(0), label="within all limits")
    beside = runs & ~kept
    if beside.any():
        ax.plot(number[beside], goal[beside], "o", mfc="none", color=color(1), label="violates limits")
    if not runs.all():
        level = float(np.nanmax(goal)) if runs.any() else 0.0
        ax.plot(number[~runs], np.full((~runs).sum(), level), "x", color=color(2), label="no steady running")
    unit = str(dataset["requirement_unit"].values[0])
    name = str(dataset["requirement"].values[0]).partition(" ")[2]
    ax.set(xlabel="Design", ylabel=f"{name} [{unit or '1'}]")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax


def _numbers(result: Result, *, ax: Axes) -> Axes:
    """Draw the parameters of the designs between their bounds."""
    dataset = result.dataset
    least, largest = dataset["least"].values, dataset["largest"].values
    parts = 100.0 * (dataset["design_number"].values - least) / (largest - least)
    number = np.arange(1, len(parts) + 1)
    for line, name in enumerate(dataset["number"].values):
        ax.plot(number, parts[:, line], "o-", markersize=3, color=color(line), label=str(name))
    ax.set(xlabel="Design", ylabel="Position between the bounds [%]", ylim=(-5.0, 105.0))
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax

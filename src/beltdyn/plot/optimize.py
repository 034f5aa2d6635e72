"""Figures of an optimisation: the goal of the designs that were tried, and the best design beside the start."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from beltdyn.plot.legends import name_lines
from beltdyn.plot.panels import panels
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import INK, axes_or_new, color
from beltdyn.results import Result

_KEPT = 1e-4
"""Part of a limit by which it may be violated."""


def _goal_and_numbers(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out the goal, and below it where the numbers are between their bounds."""
    return panels([[draw_panel] for draw_panel in (partial(draw, result), partial(_numbers, result))], sharey=False)


@figure(always, _goal_and_numbers, of=("optimize",))
def optimization(result: Result, *, ax: Axes | None = None) -> Axes:
    """Draw the goal of the designs in the order in which they were tried.

    Full circles are designs that keep to all limits, hollow ones violate some, and crosses do not run. The line is the
    best until then.

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
    ax.step(number, best, where="post", color=INK, linewidth=1.0, label="best until then")
    ax.plot(number[kept], goal[kept], "o", color=color(0), label="keeps to all limits")
    beside = runs & ~kept
    if beside.any():
        ax.plot(number[beside], goal[beside], "o", mfc="none", color=color(1), label="violates limits")
    if not runs.all():
        level = float(np.nanmax(goal)) if runs.any() else 0.0
        ax.plot(number[~runs], np.full((~runs).sum(), level), "x", color=color(2), label="does not run")
    unit = str(dataset["requirement_unit"].values[0])
    name = str(dataset["requirement"].values[0]).partition(" ")[2]
    ax.set(xlabel="Design", ylabel=f"{name} [{unit or '1'}]")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax


def _numbers(result: Result, *, ax: Axes) -> Axes:
    """Draw where the numbers of the designs are between their bounds."""
    dataset = result.dataset
    least, largest = dataset["least"].values, dataset["largest"].values
    parts = 100.0 * (dataset["design_number"].values - least) / (largest - least)
    number = np.arange(1, len(parts) + 1)
    for line, name in enumerate(dataset["number"].values):
        ax.plot(number, parts[:, line], "o-", markersize=3, color=color(line), label=str(name))
    ax.set(xlabel="Design", ylabel="From least to largest [%]", ylim=(-5.0, 105.0))
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax

"""Tornado figure: what results owe to the numbers of a drive."""

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
    """Draw the numbers of a drive to which a result owes most, the largest on top.

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
    """
    names = [str(name) for name in result.dataset["result"].values]
    name = names[0] if of is None else of
    if name not in names:
        raise ModelError(f"of = {name!r} is none of the results. {suggest(name, names)}")
    chosen, ax = result.dataset.sel(result=name), axes_or_new(ax)
    effects = np.nan_to_num(chosen["effect"].values)
    largest = np.argsort(-np.abs(effects), kind="stable")[:_BARS][::-1]
    unit, value = str(chosen["unit"].values), float(chosen["value"])
    percent = not unit and name.partition("[")[0] in ("efficiency", "pulley_slip")
    factor, shown = (100.0, "%") if percent else (1.0, unit)
    bars = ax.barh(range(largest.size), factor * effects[largest], color=[color(int(effects[k] < 0)) for k in largest])
    ax.bar_label(bars, fmt="%.2g", padding=2, fontsize=7)
    ax.set_yticks(range(largest.size), [str(chosen["number"].values[k]) for k in largest], fontsize=7)
    ax.margins(x=0.2)
    found = f"{name} = {factor * value:.4g} {shown}".rstrip()
    ax.set_xlabel(f"{found}: its change\nwith 1 % or 1 mm more{f' [{shown}]' if shown else ''}", fontsize=9)
    return ax

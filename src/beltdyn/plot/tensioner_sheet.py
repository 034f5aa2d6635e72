"""Figures of tensioner sheets: tension and hub load over the travel of a tensioner, with belts of different lengths."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.model.tensioner_balance import held_belt
from beltdyn.plot.legends import name_lines, name_once
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import INK, axes_or_new, color, dash
from beltdyn.results import Result

_SHOWN = ("tension", "hub_load")
_ENDS = ("tension_after_tensioning", "tension_after_yielding")
_POINTS = 60


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out both panels."""
    page = panels(rows([partial(draw, result, name) for name in _SHOWN]), sharey=False)
    name_once(page)
    return page


@figure(always, _both, of=("tensioner",))
def tensioner_sheet(result: Result, variable: str = "tension", *, ax: Axes | None = None) -> Axes:
    """Draw the tension, or the hub load of its pulley, over the travel of a tensioner.

    Points are belts of different lengths at rest, and their bars the band of dry friction. The line is the balance of
    the tensioner by virtual work, without bending stiffness and weight. Vertical lines are the stops.

    Parameters
    ----------
    result : Result
        Of `tensioner_sheet`.
    variable : str
        "tension" or "hub_load".
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> found = bd.tensioner_sheet(drive.replace(tensioner=[slide]), tolerance="1 mm", wear="2 mm")
    >>> bd.plot.tensioner_sheet(found, "hub_load").get_ylabel()
    'Hub load [N]'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    names = [one.pulley for one in result.drive.moving_tensioners]
    number = names.index(str(dataset.attrs["pulley"]))
    carrier = result.drive.carriers[number]
    scale, of_travel = (np.degrees(1.0), "°") if carrier.tensioner.turns else (1e3, "mm")
    place, size = dataset["position"].values, dataset[variable].values
    on = np.isfinite(size) & np.isfinite(dataset["belt_length"].values)
    if on.any():
        line = np.linspace(place[on].min(), place[on].max(), _POINTS)
        ax.plot(scale * line, [_by_hand(result, number, one, variable) for one in line], color=INK, label="by hand")
    for kind, (state, at, value) in enumerate(zip(dataset["state"].values, place, size, strict=True)):
        if np.isfinite(value):
            ax.plot(scale * at, value, "o", color=color(kind), label=str(state))
    if _ENDS[0] in dataset:
        low, high = (size * dataset[name].values / dataset["tension"].values for name in _ENDS)
        ax.vlines(scale * place, low, high, color=INK, linewidth=2.0, alpha=0.4, label="dry friction")
    for stop in carrier.tensioner.stops or ():
        ax.axvline(scale * stop, color=INK, linestyle=dash(2), linewidth=0.8)
    travel = "Arm angle" if carrier.tensioner.turns else "Position"
    ax.set(xlabel=f"{travel} from the given center [{of_travel}]", ylabel=f"{dataset[variable].attrs['long_name']} [N]")
    ax.margins(x=0.06)
    ax.set_ylim(bottom=0.0)
    name_lines(ax)
    return ax


def _by_hand(result: Result, number: int, position: float, variable: str) -> float:
    """Tension or hub load by virtual work, N; NaN where no tension holds the tensioner."""
    drive = result.drive
    positions = drive.balance[1].copy()
    positions[number] = position
    try:
        there = held_belt(drive.path, drive.belt, drive.completed.contact, drive.carriers, positions, number)
    except ValueError:
        return float("nan")
    wrap = float(there.path.wrap_angles[drive.carriers[number].pulley])
    return there.tension * (1.0 if variable == "tension" else float(2.0 * np.sin(0.5 * wrap)))

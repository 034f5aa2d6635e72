"""Figures of the life of a belt: tension and bending strain over a turn, and the shares of pulleys in the damage."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.legends import name_lines, name_once
from beltdyn.show.plot.registry import Choice, always, figure
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, panels, rows

_HISTORIES = {"tension": ("Tension [N]", 1.0), "bending_strain": ("Bending strain inside [%]", 100.0)}
"""Variables over a turn, with their labels and factors."""
_MOST_ROWS = 6
"""Rows of the table that are drawn: those with most damage."""
_WIDTH = 0.8


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out both panels."""
    page = panels(rows([partial(draw, result, name) for name in _HISTORIES]), sharey=False)
    name_once(page)
    return page


@figure(always, _both, of=("life",))
def belt_history(result: Result, variable: str = "tension", *, ax: Axes | None = None) -> Axes:
    """Draw the tension or the bending strain that a material point of the belt meets over a turn.

    Lines are rows of the duty table, at most the six with the largest damage. Names of pulleys stand over their arcs.

    Parameters
    ----------
    result : Result
        Of `life`.
    variable : str
        "tension" or "bending_strain".
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable.

    Examples
    --------
    >>> line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    >>> found = bd.life(drive.replace(belt=drive.belt.replace(cord_fatigue=line)))
    >>> bd.plot.belt_history(found).get_ylabel()
    'Tension [N]'
    """
    if variable not in _HISTORIES:
        raise ModelError(f"variable = {variable!r} is no history of the belt. Choose one of {', '.join(_HISTORIES)}.")
    dataset, ax = result.dataset, axes_or_new(ax)
    title, factor = _HISTORIES[variable]
    place = dataset["place"].values
    damage = next(dataset[name] for name in ("cord_damage_rate", "rib_damage_rate") if name in dataset)
    worst = np.argsort(-np.nan_to_num(damage.values))[:_MOST_ROWS]
    for number, row in enumerate(sorted(worst.tolist())):
        label = f"row {int(dataset['row'][row])}" if dataset.sizes["row"] > 1 else None
        ax.plot(place, factor * dataset[variable].values[row], color=color(number), linestyle=dash(number), label=label)
    for name, at in zip(dataset["pulley"].values, dataset["arc_place"].values[worst[0]], strict=True):
        if np.isfinite(at):
            ax.axvline(at, color=INK, linewidth=0.5, linestyle=dash(2))
            over = ax.get_xaxis_transform()
            ax.text(at, 0.98, str(name), transform=over, rotation=90, ha="right", va="top", fontsize=8, color=INK)
    ax.set(xlabel="Length of belt passed [turns]", ylabel=title, xlim=(0.0, 1.0))
    if dataset.sizes["row"] > 1:
        name_lines(ax)
    return ax


@figure(always, of=("life",))
def damage_shares(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the share of each pulley in the damage of cords and ribs.

    Parameters
    ----------
    result : Result
        Of `life`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    >>> found = bd.life(drive.replace(belt=drive.belt.replace(cord_fatigue=line)))
    >>> bd.plot.damage_shares(found).get_ylabel()
    'Share in the damage [%]'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    names = [str(name) for name in dataset["pulley"].values]
    known = [what for what in ("cord", "rib") if f"{what}_share" in dataset]
    width, places = _WIDTH / max(len(known), 1), np.arange(len(names))
    for number, what in enumerate(known):
        left = places + (number - 0.5 * (len(known) - 1)) * width
        ax.bar(left, 100.0 * dataset[f"{what}_share"].values, width, color=color(number), label=f"{what}s")
    ax.set_xticks(places, names)
    ax.set(ylabel="Share in the damage [%]")
    ax.grid(visible=False, axis="x")
    name_lines(ax)
    return ax

"""Figures of wear intensity, the work of friction."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.plot.legends import name_lines
from beltdyn.plot.registry import figure
from beltdyn.plot.style import axes_or_new, color, dash, label
from beltdyn.results import Run, derived


@figure(compares=True)
def wear_by_arc(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the work of friction over the arcs of the pulleys, from where the belt enters.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.wear_by_arc(run).get_xlabel()
    'Angle from the inlet [°]'
    """
    ax = axes_or_new(ax)
    wear = derived.wear_by_arc(run)
    for number, name in enumerate(wear["pulley"].values):
        worn = wear[number][wear[number].values > 0.0]
        ax.plot(np.degrees(worn["angle"]), worn, color=color(number), linestyle=dash(number), label=str(name))
    ax.set(xlabel="Angle from the inlet [°]", ylabel=label(wear), ylim=(0.0, None))
    name_lines(ax)
    return ax


@figure(compares=True)
def wear_by_belt(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the work of friction over the belt, and what each pulley does of it.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.wear_by_belt(run).get_xlabel()
    "Belt coordinate of the element's middle, unstretched [m]"
    """
    ax = axes_or_new(ax)
    wear = derived.wear_by_belt(run)
    for number, name in enumerate(wear["pulley"].values):
        place = wear["element_coordinate"]
        ax.plot(place, wear[number], color=color(number), linestyle=dash(number), lw=1.1, label=str(name))
    ax.set(xlabel=label(wear["element_coordinate"]), ylabel=label(wear), ylim=(0.0, None))
    name_lines(ax)
    return ax

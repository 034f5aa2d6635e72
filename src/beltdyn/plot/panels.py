"""Panels of a figure, side by side."""

from collections.abc import Callable, Sequence
from math import ceil
from typing import TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.plot.style import new_figure
from beltdyn.results import Result

Item = TypeVar("Item")

_PANEL = (3.7, 2.7)
_COLUMNS = 3


def one_panel(draw: Callable[..., Axes], run: Result, choice: object) -> Figure:
    """Lay out a figure of one panel.

    Parameters
    ----------
    draw : callable
        ``draw(run, ax=None) -> Axes``.
    run : Result
        What is drawn.
    choice : Choice
        Not needed.

    Returns
    -------
    Figure
        The figure.
    """
    figure = new_figure()
    draw(run, ax=figure.add_subplot())
    return figure


def rows(items: Sequence[Item], most: int = _COLUMNS) -> list[list[Item]]:
    """Break a sequence into rows of nearly the same length.

    Parameters
    ----------
    items : sequence
        One or more.
    most : int
        Items of a row at most.

    Returns
    -------
    list of list
        The rows.
    """
    columns = ceil(len(items) / ceil(len(items) / most))
    return [list(items[first : first + columns]) for first in range(0, len(items), columns)]


def panels(calls: Sequence[Sequence[Callable[..., Axes]]], *, sharey: bool = True) -> Figure:
    """Draw rows of panels; the last row may be shorter.

    Parameters
    ----------
    calls : sequence of sequence of callable
        Rows of ``call(ax=...)``.
    sharey : bool
        Whether the panels of a row have the same vertical scale.

    Returns
    -------
    Figure
        The figure.
    """
    columns = len(calls[0])
    figure = new_figure((_PANEL[0] * columns, _PANEL[1] * len(calls)))
    grid = figure.subplots(len(calls), columns, squeeze=False, sharey="row" if sharey else False)
    for axes, draws in zip(grid, calls, strict=True):
        for ax in axes[len(draws) :]:
            ax.remove()
        for column, (ax, draw) in enumerate(zip(axes, draws, strict=False)):
            draw(ax=ax)
            if sharey and column:
                ax.set_ylabel("")
    return figure

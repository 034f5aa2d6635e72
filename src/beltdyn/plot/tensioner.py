"""Spring-loaded tensioners in pictures of a drive: arm and pivot, or the line on which one slides, and stops."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.model.carrier import Carrier

TENSIONER = "#4a5361"
"""Color of all that belongs to tensioners."""
LINE: dict[str, Any] = {"color": TENSIONER, "linewidth": 2.0, "zorder": 4}
"""How arms and lines of sliding are drawn."""
_POINTS = 20


class TensionerPicture:
    """A tensioner that moves with its pulley, drawn with its stops.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    drive : Drive
        The drive.
    carrier : Carrier
        The tensioner with its pulley.
    """

    def __init__(self, ax: Axes, drive: Drive, carrier: Carrier) -> None:
        self._pulley, self._pivot = carrier.pulley, carrier.tensioner.anchor
        self._arm: Line2D | None = None
        draw_stops(ax, drive, carrier)
        if self._pivot is not None:
            (self._arm,) = ax.plot([], [], **LINE)
            draw_pivot(ax, self._pivot)
        elif carrier.tensioner.stops is None:
            center, along = carrier.place(0.0)
            reach = drive.pulleys[carrier.pulley].radius / float(np.hypot(*along)) * np.array([[-1.0], [1.0]])
            ax.plot(*(center + reach * along).T, linestyle=":", **LINE)

    def show(self, centers: FloatArray) -> None:
        """Move the arm to where the pulleys are, shape (n, 2), m."""
        if self._arm is not None and self._pivot is not None:
            self._arm.set_data(*np.array([self._pivot, centers[self._pulley]]).T)


def draw_pivot(ax: Axes, pivot: ArrayLike) -> None:
    """Draw the pivot of an arm, m."""
    ax.plot(
        *np.asarray(pivot), marker="o", markersize=7, markeredgecolor=TENSIONER, markerfacecolor="white", zorder=4.1
    )


def draw_stops(ax: Axes, drive: Drive, carrier: Carrier) -> None:
    """Draw the way of a tensioned pulley from stop to stop, dotted, and its rim at both, dashed.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    drive : Drive
        The drive.
    carrier : Carrier
        The tensioner with its pulley; nothing is drawn of one without stops.
    """
    if carrier.tensioner.stops is None:
        return
    lower, upper = carrier.tensioner.stops
    way = np.array([carrier.place(position)[0] for position in np.linspace(lower, upper, _POINTS)])
    ax.plot(*way.T, color=TENSIONER, linewidth=1.2, linestyle=":", zorder=4)
    radius = drive.pulleys[carrier.pulley].radius
    for center, name in ((way[0], "lower stop"), (way[-1], "upper stop")):
        rim = Circle(center, radius, fill=False, edgecolor=TENSIONER, linewidth=0.8, linestyle="--", zorder=1.5)
        rim.set_label(name)
        ax.add_patch(rim)

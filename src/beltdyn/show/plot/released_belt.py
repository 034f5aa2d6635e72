"""Figures of a belt released from its pulleys: shapes during the iterations (Fig. 5 of the paper), and their steps."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.results.mechanics import centerline, recorded_kind
from beltdyn.show.plot.figures import Choice, always, figure
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, name_lines, new_figure, set_log_scale

_SHAPE_COUNT = 4
"""Shapes that are drawn by default, as many as in the paper."""
_FIGURE_SIZE = (6.4, 5.6)
"""Width and height, inches."""
_HELD = {(True, True): "^", (True, False): "|", (False, True): "_"}
"""Directions in which a node is fixed -> its marker."""


def _page(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a figure that is nearly as high as wide."""
    page = new_figure(_FIGURE_SIZE)
    draw(result, ax=page.add_subplot())
    return page


@figure(always, _page, of=("release",))
def iterations(result: Result, numbers: Sequence[int] | None = None, ax: Axes | None = None) -> Axes:
    """Draw shapes of a released belt during the iterations, with its nodes and fixed points.

    Parameters
    ----------
    result : Result
        Of `release`.
    numbers : sequence of int, optional
        Which iterations, 0 for the initial shape; by default four, equally spaced.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such iteration.

    Examples
    --------
    >>> bd.plot.iterations(bd.release(drive), [0, 10, 50]).get_xlabel()
    'x [m]'
    """
    dataset = result.dataset
    last = int(dataset["iterations"])
    chosen = np.unique(np.linspace(0, last, _SHAPE_COUNT).round().astype(int)).tolist() if numbers is None else numbers
    for number in chosen:
        if not 0 <= number <= last:
            raise ModelError(f"there is no iteration {number}. Choose some of 0 to {last}.")
    ax = axes_or_new(ax, _FIGURE_SIZE)
    for row, number in enumerate(chosen):
        style: dict[str, Any] = {"color": color(row), "linestyle": dash(row)}
        name = "initial shape" if number == 0 else f"iteration {number}"
        ax.plot(*shape_of(result, number).T, **style, label=name)
        ax.plot(*dataset["node_position"].values[number].T, "o", color=color(row), markersize=3.5)
    held = dataset["fixed"].values.astype(bool)
    for node in np.flatnonzero(held.any(axis=1)):
        marker, place = _HELD[tuple(held[node].tolist())], dataset["node_position"].values[chosen[-1], node]
        ax.plot(*place, marker, color=INK, markersize=11.0, markerfacecolor="white", zorder=5)
    ax.set_aspect("equal")
    ax.set(xlabel="x [m]", ylabel="y [m]")
    name_lines(ax)
    return ax


def shape_of(result: Result, number: int) -> FloatArray:
    """The closed centerline at an iteration, ends of elements included, shape (k, 2), m."""
    nodes = result.dataset["nodal_coordinates"].values[number]
    kind = recorded_kind(result.dataset, result.prepared)
    curve = centerline(kind, nodes, np.full(len(nodes), result.drive.belt_length / len(nodes))).reshape(-1, 2)
    return np.vstack([curve, curve[:1]])


@figure(always, of=("release",))
def iteration_steps(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the energy norm of the steps over the iterations, on a logarithmic scale.

    Parameters
    ----------
    result : Result
        Of `release`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> bd.plot.iteration_steps(bd.release(drive)).get_yscale()
    'log'
    """
    ax = axes_or_new(ax)
    steps = result.dataset["step_strain"]
    ax.plot(steps["iteration"].values[1:], steps.values[1:], color=color(0))
    set_log_scale(ax)
    ax.set(xlabel="Iteration", ylabel=str(steps.attrs["long_name"]))
    return ax

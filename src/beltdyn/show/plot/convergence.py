"""Figures of a study of convergence: differences from the finest level over the mesh and over the tolerance."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import LogFormatter, NullFormatter

from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.plot.figures import figure
from beltdyn.show.plot.style import axes_or_new, color, dash, name_lines, note, set_log_scale

_MAX_LINES = 10
"""Results in one figure: as many as there are colors."""
_ROUNDING = 1e-10
"""Relative difference below which there is nothing to draw."""
_FIGURE_SIZE = (7.0, 4.8)
"""Width and height, inches: long names stand above the axes."""
_MARKERS = "osD^v"
"""Of the results in turn."""


def _has(axis: str) -> Callable[[Result], bool]:
    return lambda result: axis in result.dataset.dims


@figure(_has("elements"), of=("convergence",))
def mesh_convergence(result: Result, of: str | None = None, ax: Axes | None = None) -> Axes:
    """Draw the differences of results from the finest mesh over the number of elements, with observed orders.

    Parameters
    ----------
    result : Result
        Of `convergence`.
    of : str, optional
        Name of a result; by default the first ten.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or no axis of meshes.

    Examples
    --------
    >>> found = bd.convergence(drive, of="hub_load", meshes=[12, 16, 24], repeated="equilibrium")
    >>> bd.plot.mesh_convergence(found).get_xscale()
    'log'
    """
    return _draw(result, "mesh", "elements", of, ax)


@figure(_has("tolerance"), of=("convergence",))
def tolerance_convergence(result: Result, of: str | None = None, ax: Axes | None = None) -> Axes:
    """Draw the differences of results from the smallest tolerance over the tolerance, with observed orders.

    Parameters
    ----------
    result : Result
        Of `convergence`.
    of : str, optional
        Name of a result; by default the first ten.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or no axis of tolerances.

    Examples
    --------
    >>> short = drive.with_({"simulation.duration": 0.01, "belt.elements": 12})
    >>> found = bd.convergence(short, of="hub_load", tolerances=[1e-2, 3e-3, 1e-3])
    >>> bd.plot.tolerance_convergence(found).get_xlabel()
    'Tolerance'
    """
    return _draw(result, "tolerance", "tolerance", of, ax)


def _draw(result: Result, level: str, axis: str, of: str | None, ax: Axes | None) -> Axes:
    """Draw relative differences from the finest level over an axis, both logarithmic."""
    dataset = result.dataset
    if axis not in dataset.dims:
        raise ModelError(f"this result has no {axis}. Draw another figure, or compute it with more levels.")
    names = [str(name) for name in dataset["result"].values]
    if of is not None and of not in names:
        raise ModelError(f'"{of}" is not a result. Choose one of {", ".join(names)}.')
    differences, orders = dataset[f"{level}_error"].values[:, :-1], dataset[f"{level}_order"].values[:, -1]
    chosen = [row for row, name in enumerate(names) if of in (None, name) and np.any(differences[row] > _ROUNDING)]
    ax = axes_or_new(ax, _FIGURE_SIZE)
    sizes = dataset[axis].values
    for number, row in enumerate(chosen[:_MAX_LINES]):
        order = "" if np.isnan(orders[row]) else f", order {orders[row]:.2g}"
        ax.plot(
            sizes[:-1],
            np.where(differences[row] > _ROUNDING, differences[row], np.nan),
            color=color(number),
            linestyle=dash(number),
            marker=_MARKERS[number % len(_MARKERS)],
            label=f"{names[row]}{order}",
        )
    ax.set_xscale("log")
    set_log_scale(ax)
    ax.set_xticks(sizes[:-1])
    ax.xaxis.set_major_formatter(LogFormatter() if axis == "tolerance" else "{x:.0f}")
    ax.xaxis.set_minor_formatter(NullFormatter())
    if axis == "tolerance":
        ax.invert_xaxis()
    finest = f"{sizes[-1]:g} elements" if axis == "elements" else f"tolerance {sizes[-1]:g}"
    ax.set(xlabel=str(dataset[axis].attrs["long_name"]), ylabel=f"Difference from {finest}, relative")
    if len(chosen) > _MAX_LINES:
        note(ax, f"the first {_MAX_LINES} of {len(chosen)} results")
    name_lines(ax)
    return ax

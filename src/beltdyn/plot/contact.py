"""Contact forces over the belt laid along the horizontal axis, as in Figs. 10-13 of the paper."""

from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from beltdyn.errors import ModelError
from beltdyn.plot.instant import at
from beltdyn.plot.style import INK, axes_or_new, color, dash, label, reserve, styled, unit
from beltdyn.plot.wrap import Wrap, unwrap
from beltdyn.results import Run

Kind = Literal["normal", "friction"]


@styled
def contact_forces(
    run: Run, pulley: str | int, time: float | None = None, kind: Kind = "normal", ax: Axes | None = None
) -> Axes:
    """Draw the contact forces on the belt from where it enters a pulley to where it leaves.

    Dashed lines beside the friction force are what Coulomb friction allows: the belt slides where the
    force reaches them. Forces that the mesh does not resolve are marked.

    Parameters
    ----------
    run : Run
        The run.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        The instant, s; the output nearest to it is drawn. The last one by default.
    kind : {"normal", "friction"}
        Which force. Friction is positive along the counter-clockwise tangent.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such pulley, or the run holds no output.
    """
    number = _number(run, pulley)
    instant = at(run, time)
    ax = axes_or_new(ax)
    wrap = unwrap(
        instant["belt_coordinate"].values,
        instant["contact_pulley"].values == number,
        run.drive.belt.length,
        float(instant["pulley_speed"][number]),
    )
    if kind == "friction":
        _draw_limits(ax, instant, wrap, run.drive.contact.friction)
    force = instant[f"{kind}_force"]
    values = force.values[wrap.points]
    ax.plot(wrap.distance, values, color=color(number), marker="o", markersize=3.0)
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    coordinate_unit = unit(run.dataset["belt_coordinate"])
    ax.set(xlabel=f"Belt coordinate from entry to exit [{coordinate_unit}]", ylabel=label(force))
    ax.set_title(f"{run.drive.pulleys[number].name}, t = {float(instant['time']):.4g} s")
    if not run.resolution.resolves(number):
        reserve(ax, f"not resolved by {run.drive.belt.elements} elements")
    return ax


def _number(run: Run, pulley: str | int) -> int:
    names = [known.name for known in run.drive.pulleys]
    if pulley in names:
        return names.index(str(pulley))
    if isinstance(pulley, int) and 0 <= pulley < len(names):
        return pulley
    raise ModelError(f"pulley = {pulley!r} is not in this drive. Its pulleys are: {', '.join(names)}.")


def _draw_limits(ax: Axes, instant: xr.Dataset, wrap: Wrap, friction: float) -> None:
    """Draw what Coulomb friction allows, without making room for it: the force may be much smaller."""
    limit = friction * instant["normal_force"].values[wrap.points]
    edges = [np.column_stack([wrap.distance, sign * limit]) for sign in (1, -1)]
    lines = LineCollection(edges, colors=INK, linestyles=dash(1), linewidths=1.0, label="Coulomb limit")
    ax.add_collection(lines, autolim=False)
    ax.legend(loc="lower left", bbox_to_anchor=(0.62, 1.0), borderaxespad=0.2)

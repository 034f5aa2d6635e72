"""Campbell diagram: frequencies of modes and excitations over speed, and damping ratios of the modes."""

from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from beltdyn.arrays import FloatArray
from beltdyn.parts.quantity import RPM
from beltdyn.plot.legends import name_lines
from beltdyn.plot.modes import KINDS
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import INK, axes_or_new, color, label, new_figure, set_log_scale
from beltdyn.results import Result

_SIZE = (8.0, 7.5)
_HEIGHTS = (2.0, 1.0)
_ABOVE = 1.08
"""Upper end of the frequencies that are drawn, over the highest of a mode."""
_LEAST_DAMPING = 1e-5
_STRONG = 0.1
"""Damping ratio below which a critical speed is marked by a filled circle."""
_FINE = 200
"""Speeds at which it is looked where a line leaves the axes."""
_EXCITED = "0.6"
"""Color of excitations."""


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out frequencies above damping ratios."""
    page = new_figure(_SIZE)
    above, below = page.subplots(2, 1, sharex=True, height_ratios=_HEIGHTS)
    draw(result, ax=above)
    mode_damping(result, ax=below)
    twice = below.get_legend()
    assert twice is not None
    twice.remove()
    above.set_xlabel("")
    return page


@figure(always, _both, of=("campbell",))
def campbell(result: Result, ax: Axes | None = None) -> Axes:
    """Draw a Campbell diagram: frequencies of modes over speed, lines of excitations, and where they meet.

    Modes have the color of their kind, and their number at the right end. Circles are critical speeds, filled where the
    damping ratio is below 0.1. Crosses mark what grows by itself.

    Parameters
    ----------
    result : Result
        Of `campbell`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    speed, frequency = RPM * dataset["speed"].values, dataset["frequency"].values
    top = _ABOVE * float(np.nanmax(frequency))
    for line, name in zip(dataset["excitation_frequency"].values.T, dataset["excitation"].values, strict=True):
        ax.plot(speed, line, color=_EXCITED, linewidth=0.8, zorder=1)
        _name_line(ax, speed, line, top, str(name))
    _draw_modes(ax, result, speed, frequency)
    at, meets = RPM * dataset["critical_speed"].values, dataset["critical_frequency"].values
    strong = dataset["critical_damping_ratio"].values < _STRONG
    for chosen, face in ((strong, INK), (~strong, "w")):
        ax.scatter(at[chosen], meets[chosen], 22, facecolor=face, edgecolor=INK, linewidth=0.8, zorder=4)
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=label(dataset["frequency"]), ylim=(0.0, top))
    marks = [
        Line2D([], [], color=INK, marker="o", linestyle="", markerfacecolor=face, markersize=5, label=text)
        for face, text in ((INK, f"critical, damping < {_STRONG:g}"), ("w", "critical, more damped"))
    ]
    _legend(ax, result, [*marks, Line2D([], [], color=_EXCITED, linewidth=0.8, label="excitation")])
    return ax


@figure(of=("campbell",))
def mode_damping(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the damping ratios of modes over speed; crosses mark what grows by itself.

    Parameters
    ----------
    result : Result
        Of `campbell`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    damping = dataset["damping_ratio"].values
    _draw_modes(ax, result, RPM * dataset["speed"].values, np.maximum(damping, _LEAST_DAMPING))
    set_log_scale(ax)
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=label(dataset["damping_ratio"]))
    _legend(ax, result, [])
    return ax


def _draw_modes(ax: Axes, result: Result, speed: FloatArray, values: FloatArray) -> None:
    """Draw a line for each mode, with its number, and crosses where it grows."""
    dataset = result.dataset
    for column, (mode, kind) in enumerate(zip(dataset["mode"].values, dataset["kind"].values, strict=True)):
        line, tint = values[:, column], color(KINDS.index(str(kind)))
        alone = np.isfinite(line).sum() == 1
        ax.plot(speed, line, color=tint, linewidth=1.5, marker="." if alone else None, zorder=2)
        last = np.flatnonzero(np.isfinite(line))[-1]
        ax.annotate(str(mode), (speed[last], line[last]), (3, 0), textcoords="offset points", color=tint, fontsize=8)
        grows = dataset["growth_rate"].values[:, column] > 0.0
        ax.plot(speed[grows], line[grows], color=INK, linestyle="", marker="x", markersize=5, zorder=3)


def _name_line(ax: Axes, speed: FloatArray, line: FloatArray, top: float, name: str) -> None:
    """Write the name of an excitation along its line, where it leaves the axes."""
    known = np.isfinite(line)
    fine = np.linspace(speed[0], speed[-1], _FINE)
    along = np.interp(fine, speed[known], line[known])
    inside = np.flatnonzero(along <= top)
    if inside.size:
        place = fine[inside[-1]], along[inside[-1]]
        slope = float(np.nanmean(line / speed))
        text = ax.annotate(name, place, (-2, 2), textcoords="offset points", fontsize=7, ha="right", color="0.35")
        text.set(rotation=np.degrees(np.arctan(slope)), rotation_mode="anchor", transform_rotates_text=True)


def _legend(ax: Axes, result: Result, others: list[Line2D]) -> None:
    """Write the kinds of modes that there are, and other marks, above the axes."""
    there = [kind for kind in KINDS if kind in result.dataset["kind"].values]
    lines = [Line2D([], [], color=color(KINDS.index(kind)), label=kind) for kind in there]
    if np.any(result.dataset["growth_rate"].values > 0.0):
        others = [*others, Line2D([], [], color=INK, marker="x", linestyle="", markersize=5, label="grows by itself")]
    name_lines(ax, [*lines, *others])

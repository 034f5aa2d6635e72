"""What axes show: a span in which changes mean something, and limits inside it."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from beltdyn.show.plot.style import INK, dash

LEAST_SHARE = 0.05
"""Least span of an axis, over the largest value that it shows: an almost constant quantity is a level line."""

_LEAST = {
    "rad/s": 0.1,
    "rpm": 1.0,
    "m/s": 0.01,
    "N": 0.1,
    "N·m": 1e-3,
    "W": 1e-2,
    "J": 1e-3,
    "mm": 0.01,
    "°": 0.1,
    "%": 0.05,
    "N/m": 1.0,
    "kPa": 0.1,
}
"""Unit -> least span of an axis, whatever it shows: what is smaller is rounding."""
_WHOLE = 100.0
_SQUEEZED = 0.2
"""Part of an axis below which what is drawn is not squeezed for a limit."""
_HEADROOM = 0.08
"""Part of the axis that words beside a limit take."""
LIMIT = "limit"
"""Name of the words at a limit."""
_LINE = 10.0
"""Height of a line of words, points."""


def spread(low: float, high: float, unit: str = "") -> tuple[float, float]:
    """Widen a range to the least one in which changes mean something."""
    least = max(LEAST_SHARE * max(abs(low), abs(high)), _LEAST.get(unit, 0.0))
    missing = least - (high - low)
    if missing <= 0.0:
        return low, high
    bottom, top = low - 0.5 * missing, high + 0.5 * missing
    if low >= 0.0 > bottom:
        return 0.0, least
    if unit == "%" and high <= _WHOLE < top:
        return _WHOLE - least, _WHOLE
    return bottom, top


def unit_of(ax: Axes) -> str:
    """The unit in the label of the vertical axis; empty without one."""
    return str(ax.get_ylabel()).rpartition("[")[2].rstrip("]") if "[" in ax.get_ylabel() else ""


def show_enough(ax: Axes) -> None:
    """Widen a linear vertical axis that fits what is drawn to the least span that means something."""
    if ax.name != "rectilinear" or ax.get_yscale() != "linear" or not ax.get_autoscaley_on():
        return
    low, high = map(float, ax.dataLim.intervaly)
    if ax.get_aspect() == "auto" and np.isfinite([low, high]).all() and low <= high:
        ax.update_datalim([(0.0, edge) for edge in spread(low, high, unit_of(ax))], updatex=False)
        ax.autoscale_view(scalex=False)


def draw_limit(ax: Axes, value: float, text: str, upper: bool | None = None) -> None:
    """Draw a limit across axes, with its words; words alone at the edge where the line would squeeze all else."""
    fitted = ax.get_autoscaley_on()
    low, high = map(float, ax.dataLim.intervaly)
    low, high = spread(low, high, unit_of(ax)) if fitted else ax.get_ylim()
    bottom, top = min(low, value), max(high, value)
    above = value >= 0.5 * (low + high)
    style: dict[str, Any] = {"color": INK, "fontsize": 8, "ha": "right", "gid": LIMIT}
    if high - low < _SQUEEZED * (top - bottom):
        words, place, side, inward = (f"{text} ↑", 1.0, "top", -1.0) if above else (f"{text} ↓", 0.0, "bottom", 1.0)
        before = sum(
            one.get_gid() == LIMIT and one.get_verticalalignment() == side and one.get_text()[-1] in "↑↓"
            for one in ax.texts
        )
        offset = (-4.0, inward * (4.0 + _LINE * before))
        ax.annotate(words, (1.0, place), offset, "axes fraction", "offset points", va=side, **style)
        return
    ax.axhline(value, color=INK, linestyle=dash(1), linewidth=0.9, zorder=1.5)
    above = above if upper is None else upper
    room = _HEADROOM * (top - bottom)
    if fitted:
        ax.update_datalim([(0.0, value + room if above else value - room)], updatex=False)
        ax.autoscale_view(scalex=False)
    else:
        ax.set_ylim(min(low, value - room), max(high, value + room))
    offset, side = ((-4.0, 2.0), "bottom") if above else ((-4.0, -2.0), "top")
    ax.annotate(text, (1.0, value), offset, ("axes fraction", "data"), "offset points", va=side, **style)

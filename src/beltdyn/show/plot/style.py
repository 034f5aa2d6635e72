"""How every figure looks: colors, labels from the dataset, and the span and limits that axes show."""

from collections.abc import Callable, Sequence
from functools import wraps
from math import ceil
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import xarray as xr
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path
from matplotlib.ticker import LogFormatter
from matplotlib.typing import LineStyleType

from beltdyn.results import Result
from beltdyn.show.plot.print_style import GREYS, PRINT_SAMPLE, PRINT_SIZE, finish, printed_size, prints, rules

_SAMPLE_WIDTH, _NAME_SIZE = 45.0, 9.0
"""Width of the line before a name with the gap to the next one, and size of names, points."""
_WIDTH_RATIO = 1.08
"""Width of axes after their layout, over that before it."""
_POINTS_PER_INCH = 72.0
"""Points in an inch: letters are measured in points, and figures in inches."""
_ROW_HEIGHT, _AXES_DISTANCE, _LEGEND_DISTANCE = 13.0, 6.0, 11.0
"""Height of a row, and the distances of a title from axes and from a legend, points."""


def name_lines(ax: Axes, lines: Sequence[Artist] | None = None) -> None:
    """Write the legend of axes above them, in as many columns as fit; names longer than the axes below the figure."""
    lines = ax.get_legend_handles_labels()[0] if lines is None else lines
    names = [str(line.get_label()) for line in lines]
    if not names:
        return
    page = ax.figure.figure
    width = float(_WIDTH_RATIO * ax.get_position().width * page.get_figwidth())
    columns = _columns(names, width)
    if columns == 1 and _widths(names, 1) > width and page.axes == [ax]:
        page.legend(handles=lines, loc="outside lower left")
        return
    ax.legend(handles=lines, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.2)
    if title := ax.get_title(loc="left"):
        ax.set_title(title, loc="left", pad=_LEGEND_DISTANCE + _ROW_HEIGHT * -(-len(names) // columns))


def name_once(page: Figure, title: str = "") -> None:
    """Gather the legends of panels into one below them, in which each name stands once."""
    named = dict[str, Artist]()
    for ax in page.axes:
        box = ax.get_legend()
        if box is None:
            continue
        for text, handle in zip(box.get_texts(), box.legend_handles, strict=True):
            if handle is not None:
                named.setdefault(text.get_text(), handle)
        box.remove()
        if written := ax.get_title(loc="left"):
            ax.set_title(written, loc="left", pad=_AXES_DISTANCE)
    if named:
        columns = _columns(list(named), float(page.get_figwidth()))
        page.legend(list(named.values()), list(named), loc="outside lower left", ncols=columns, title=title or None)


def _columns(names: Sequence[str], width: float) -> int:
    """The most columns of a legend that fit into a width, inches; one where even that is wider."""
    return next((count for count in range(len(names), 1, -1) if _widths(names, count) <= width), 1)


def _widths(names: Sequence[str], columns: int) -> float:
    """Width of a legend of so many columns, which are filled one after the other, inches."""
    sample, size = (PRINT_SAMPLE, PRINT_SIZE) if prints() else (_SAMPLE_WIDTH, _NAME_SIZE)
    font = FontProperties(size=size)
    widths = [text_to_path.get_text_width_height_descent(name, font, False)[0] for name in names]
    return sum(sample + float(part.max()) for part in np.array_split(np.array(widths), columns)) / _POINTS_PER_INCH


P = ParamSpec("P")
R = TypeVar("R")
Dash = LineStyleType

INK = "#2b2f36"
"""Color of text and outlines."""

PALE = "#e9ecf1"
"""Color of surfaces."""

SHADE = "#f6d9c9"
"""Areas where something is at its limit."""

COLORS = (
    *("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"),
    *("#7a5cc9", "#a03050", "#85861f", "#5d5d5d"),
)
"""Colors of pulleys, and of the spans that leave them, in all figures: six of Okabe and Ito (2008), and four more."""

DASHES: tuple[Dash, ...] = ("-", (0, (5, 1.6)), (0, (1.2, 1.4)), (0, (6, 1.4, 1.2, 1.4)))
"""Line styles, so that lines that lie on each other can both be seen."""

SIZE = (7.0, 3.8)
"""Width and height of a figure, inches."""

POLAR_SIZE = (6.2, 4.6)
"""Width and height of a polar figure, inches."""

NOTE = "note"
"""Name of what is written below axes."""

_NOTE_DISTANCE = 38.0
"""Distance of notes from the axes, points: numbers and a label are between them."""

RESERVATION = "reservation"
"""Name of what is written along the right edge."""

_RULES: dict[Any, Any] = {
    "figure.dpi": 110,
    "savefig.dpi": 160,
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.labelsize": 10,
    "axes.labelcolor": INK,
    "axes.edgecolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": cycler(color=COLORS),
    "axes.formatter.useoffset": False,
    "axes.xmargin": 0.02,
    "grid.color": "#dfe3e8",
    "grid.linewidth": 0.7,
    "lines.linewidth": 1.7,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 9,
    "text.color": INK,
    "text.parse_math": False,  # names of files and titles may hold dollars
    "xtick.color": INK,
    "ytick.color": INK,
}


def styled(function: Callable[P, R]) -> Callable[P, R]:
    """Make a function draw in the style of this package."""

    @wraps(function)
    def draw(*args: P.args, **kwargs: P.kwargs) -> R:
        with rules(_RULES):
            drawn = function(*args, **kwargs)
            if prints() and isinstance(drawn, Axes | Figure):
                finish(drawn.figure.figure)
        return drawn

    return draw


def set_log_scale(ax: Axes) -> None:
    """Make the vertical axis logarithmic, with numbers that need no setting of formulas."""
    ax.set_yscale("log")
    ax.yaxis.set_major_formatter(LogFormatter())
    ax.yaxis.set_minor_formatter(LogFormatter())


def fitted(size: tuple[float, float], wide: bool = False) -> tuple[float, float]:
    """Give the size of a figure in the present style, inches; in print a wide one fills the page."""
    return printed_size(size, wide) if prints() else size


def new_figure(size: tuple[float, float] = SIZE, wide: bool = False) -> Figure:
    """Make a figure that belongs to no window, for files; see `fitted`."""
    return Figure(figsize=fitted(size, wide), layout="constrained")


def axes_or_new(ax: Axes | None, size: tuple[float, float] = SIZE) -> Axes:
    """Give the axes to draw on."""
    return plt.subplots(figsize=fitted(size), layout="constrained")[1] if ax is None else ax


def polar_or_new(ax: Axes | None, size: tuple[float, float] = POLAR_SIZE) -> Axes:
    """Give the axes to draw on; new ones are polar. See `axes_or_new`."""
    if ax is not None:
        return ax
    return plt.subplots(figsize=fitted(size), layout="constrained", subplot_kw={"projection": "polar"})[1]


def unit(variable: xr.DataArray) -> str:
    """Give the unit of a variable as it is printed."""
    return str(variable.attrs["units"]).replace(" ", "·")


def label(variable: xr.DataArray) -> str:
    """Give the label of an axis."""
    name, units = str(variable.attrs["long_name"]), unit(variable)
    return name if units == "1" else f"{name} [{units}]"


def reserve(ax: Axes, text: str) -> None:
    """Write a reservation about what is drawn along the right edge, where nothing else stands."""
    ax.annotate(
        text,
        (1.0, 0.5),
        gid=RESERVATION,
        xycoords="axes fraction",
        xytext=(4.0, 0.0),
        textcoords="offset points",
        rotation=90.0,
        verticalalignment="center",
        color=COLORS[1],
        fontsize=9,
    )


def note(ax: Axes, text: str) -> None:
    """Write below the label of the horizontal axis, at the right, where it covers nothing; no empty text."""
    if not text:
        return
    below = -_NOTE_DISTANCE - _ROW_HEIGHT * ax.get_xlabel().count("\n")
    ax.annotate(
        text, (1.0, 0.0), (0.0, below), "axes fraction", "offset points", ha="right", va="top", fontsize=8, gid=NOTE
    )


def shade(ax: Axes, low: float, high: float, text: str) -> None:
    """Shade a band of the values, and write in it what is at its limit there."""
    ax.axhspan(low, high, color=SHADE, linewidth=0.0, zorder=0)
    middle = ("axes fraction", "data")
    ax.annotate(text, (0.005, 0.5 * (low + high)), xycoords=middle, ha="left", va="center", fontsize=9)


def dash(number: int) -> Dash:
    """Give the line style of the line of this number, counted from 0."""
    return DASHES[number % len(DASHES)]


def color(number: int) -> str:
    """Give the color of the line of this number, counted from 0."""
    colors = GREYS if prints() else COLORS
    return colors[number % len(colors)]


def tension_colors() -> Colormap:
    """Give the color map of the tension: from dark blue to yellow, without tones too pale for white paper."""
    return ListedColormap(mpl.colormaps["plasma"](np.linspace(0.0, 0.88, 256)), "tension")


# Panels of a figure, side by side

Item = TypeVar("Item")

_PANEL_SIZE = (3.7, 2.7)
"""Width and height of each panel of a page, inches."""
_MAX_COLUMNS = 3
"""Panels beside each other at most: three of them are 11 inches wide."""


def one_panel(draw: Callable[..., Axes], run: Result, choice: object) -> Figure:
    """Lay out a figure of one panel."""
    figure = new_figure()
    draw(run, ax=figure.add_subplot())
    return figure


def rows(items: Sequence[Item], most: int = _MAX_COLUMNS) -> list[list[Item]]:
    """Break a sequence into rows of nearly the same length."""
    columns = ceil(len(items) / ceil(len(items) / most))
    return [list(items[first : first + columns]) for first in range(0, len(items), columns)]


def panels(calls: Sequence[Sequence[Callable[..., Axes]]], *, sharey: bool = True) -> Figure:
    """Draw rows of panels; the last row may be shorter."""
    columns = len(calls[0])
    figure = new_figure((_PANEL_SIZE[0] * columns, _PANEL_SIZE[1] * len(calls)), columns > 1)
    grid = figure.subplots(len(calls), columns, squeeze=False, sharey="row" if sharey else False)
    for axes, draws in zip(grid, calls, strict=True):
        for ax in axes[len(draws) :]:
            ax.remove()
        for column, (ax, draw) in enumerate(zip(axes, draws, strict=False)):
            draw(ax=ax)
            if sharey and column:
                ax.set_ylabel("")
    return figure


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
_WHOLE_PERCENTAGE = 100.0
"""Whole of which shares are parts, %: an axis extends beyond it only where values do."""
_MIN_DATA_SHARE = 0.2
"""Part of an axis below which what is drawn is not squeezed for a limit."""
_LIMIT_WORDS_SHARE = 0.08
"""Part of the axis that words beside a limit take."""
LIMIT = "limit"
"""Name of the words at a limit."""
_LINE_HEIGHT = 10.0
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
    if unit == "%" and high <= _WHOLE_PERCENTAGE < top:
        return _WHOLE_PERCENTAGE - least, _WHOLE_PERCENTAGE
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
    if high - low < _MIN_DATA_SHARE * (top - bottom):
        words, place, side, inward = (f"{text} ↑", 1.0, "top", -1.0) if above else (f"{text} ↓", 0.0, "bottom", 1.0)
        before = sum(
            one.get_gid() == LIMIT and one.get_verticalalignment() == side and one.get_text()[-1] in "↑↓"
            for one in ax.texts
        )
        offset = (-4.0, inward * (4.0 + _LINE_HEIGHT * before))
        ax.annotate(words, (1.0, place), offset, "axes fraction", "offset points", va=side, **style)
        return
    ax.axhline(value, color=INK, linestyle=dash(1), linewidth=0.9, zorder=1.5)
    above = above if upper is None else upper
    room = _LIMIT_WORDS_SHARE * (top - bottom)
    if fitted:
        ax.update_datalim([(0.0, value + room if above else value - room)], updatex=False)
        ax.autoscale_view(scalex=False)
    else:
        ax.set_ylim(min(low, value - room), max(high, value + room))
    offset, side = ((-4.0, 2.0), "bottom") if above else ((-4.0, -2.0), "top")
    ax.annotate(text, (1.0, value), offset, ("axes fraction", "data"), "offset points", va=side, **style)

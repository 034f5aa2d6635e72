"""A figure as charts that zoom and read out under the pointer: its panels of lines, as they are drawn on paper."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

_BINS = 700
"""Parts of a line, of each of which least and largest values are kept."""
_HEIGHT = 340
_FEW_NAMES, _LINE = 4, 18
"""Names of lines for which there is room, and height for each one more, as on a narrow screen each has a row."""
_DASHES = {"-": "solid", "--": "dashed", ":": "dotted", "-.": "dashdot"}
_FONT = "12px"


def charts(figure: Figure) -> list[Any]:
    """Make a chart of each panel of a figure.

    Parameters
    ----------
    figure : Figure
        As it is drawn on paper.

    Returns
    -------
    list of bokeh.plotting.figure
        Nothing where a panel shows more than lines: such a figure is best as it is.
    """
    panels = [ax for ax in figure.axes if ax.get_visible()]
    return [_chart(ax) for ax in panels] if panels and all(map(_has_lines_alone, panels)) else []


def _has_lines_alone(ax: Axes) -> bool:
    """Whether a panel has lines, and perhaps bands, over straight axes."""
    others = [one for one in ax.collections if not isinstance(one, PolyCollection)]
    bars = [patch for patch in ax.patches if isinstance(patch, Rectangle)]
    return ax.name == "rectilinear" and bool(ax.lines) and not (others or bars or ax.images)


def _chart(ax: Axes) -> Any:
    from bokeh.models import (
        BoxZoomTool,
        CrosshairTool,
        HoverTool,
        Legend,
        LegendItem,
        PanTool,
        Range1d,
        ResetTool,
        WheelZoomTool,
    )
    from bokeh.plotting import figure

    axis_types = {name: "log" if scale == "log" else "linear" for name, scale in _scales(ax).items()}
    zoom = BoxZoomTool(dimensions="auto")
    chart = figure(
        height=_HEIGHT,
        sizing_mode="stretch_width",
        x_axis_type=axis_types["x"],
        y_axis_type=axis_types["y"],
        x_range=Range1d(*map(float, ax.get_xlim())),
        y_range=Range1d(*map(float, ax.get_ylim())),
        tools=[zoom, PanTool(), WheelZoomTool(), ResetTool(), CrosshairTool(line_alpha=0.4)],
        active_drag=zoom,
        active_scroll=None,
        toolbar_location="above",
        background_fill_color=None,
        border_fill_color=None,
        outline_line_color=None,
        tags=[ax.get_xlabel()],
    )
    chart.toolbar.logo = None
    chart.xaxis.axis_label, chart.yaxis.axis_label = ax.get_xlabel(), ax.get_ylabel()
    chart.axis.axis_label_text_font_style = "normal"
    chart.title.text = ax.get_title(loc="left") or ax.get_title()
    chart.title.text_font_style = "normal"
    for one in (*chart.axis, chart.title):
        for name in ("axis_label_text_font_size", "major_label_text_font_size", "text_font_size"):
            if hasattr(one, name):
                setattr(one, name, _FONT)
    named = []
    for lines in _sharing_abscissae([line for line in ax.lines if _of_data(line)]):
        named += _draw(chart, ax, lines, HoverTool)
    _draw_levels(chart, [line for line in ax.lines if not _of_data(line)])
    if named:
        items = [LegendItem(label=name, renderers=[drawn]) for name, drawn in named]
        legend = Legend(items=items, orientation="horizontal", ncols="auto", click_policy="hide")
        legend.update(background_fill_color=None, border_line_color=None, label_text_font_size=_FONT, padding=2)
        chart.add_layout(legend, "above")
        chart.height = _HEIGHT + _LINE * max(len(named) - _FEW_NAMES, 0)
    return chart


def _scales(ax: Axes) -> dict[str, str]:
    return {"x": ax.get_xscale(), "y": ax.get_yscale()}


def _of_data(line: Line2D) -> bool:
    """Whether both coordinates of a line are data, and not a height across the whole panel."""
    return line.axes is not None and line.get_transform() == line.axes.transData


def _sharing_abscissae(lines: Sequence[Line2D]) -> Iterator[list[Line2D]]:
    """Lines over the same abscissae together: they are read out together."""
    for _, group in groupby(lines, lambda line: np.asarray(line.get_xdata(), dtype=float).tobytes()):
        yield list(group)


def _draw(chart: Any, ax: Axes, lines: Sequence[Line2D], hover: Any) -> list[tuple[str, Any]]:
    """Draw lines over the same abscissae; those with names."""
    from bokeh.models import ColumnDataSource

    x = np.asarray(lines[0].get_xdata(), dtype=float)
    values = np.column_stack([np.asarray(line.get_ydata(), dtype=float) for line in lines])
    x, values = thinned(x, values)
    columns = {f"y{number}": column.astype(np.float32) for number, column in enumerate(values.T)}
    source = ColumnDataSource({"x": x.astype(np.float32), **columns})
    named, drawn = [], []
    for number, line in enumerate(lines):
        look = {"color": to_hex(line.get_color()), "line_dash": _dash(line)}
        if str(line.get_linestyle()) not in ("None", ""):
            drawn.append(chart.line("x", f"y{number}", source=source, line_width=1.1 * line.get_linewidth(), **look))
        if line.get_marker() not in ("", "None", None) and len(x) < _BINS:
            drawn.append(chart.scatter("x", f"y{number}", source=source, size=6, color=look["color"]))
        if not str(line.get_label()).startswith("_") and drawn:
            named.append((str(line.get_label()), drawn[-1], f"y{number}"))
    if drawn:
        unit = ax.get_ylabel().partition("[")[2].rstrip("]")
        rows = [(name, f"@{column}{{0.0000a}} {unit}") for name, _, column in named]
        rows = rows or [(ax.get_ylabel(), "@y0")]
        tips = [(ax.get_xlabel(), "@x{0.0000}"), *rows]
        chart.add_tools(hover(renderers=drawn[:1], tooltips=tips, mode="vline", line_policy="nearest"))
    return [(name, glyph) for name, glyph, _ in named]


def _draw_levels(chart: Any, lines: Sequence[Line2D]) -> None:
    """Draw lines across the whole panel, such as a limit."""
    from bokeh.models import Span

    for line in lines:
        x, y = np.unique(line.get_xdata()), np.unique(line.get_ydata())
        across = len(y) == 1
        place = float(y[0] if across else x[0])
        look = {"line_color": to_hex(line.get_color()), "line_width": line.get_linewidth(), "line_dash": _dash(line)}
        chart.add_layout(Span(location=place, dimension="width" if across else "height", **look))


def _dash(line: Line2D) -> Any:
    """The dashes of a line as they are on paper."""
    style = getattr(line, "_unscaled_dash_pattern", (0, None))[1]
    return [max(1, round(2.0 * part)) for part in style] if style else _DASHES.get(str(line.get_linestyle()), "solid")


def thinned(x: NDArray[Any], values: NDArray[Any], bins: int = _BINS) -> tuple[NDArray[Any], NDArray[Any]]:
    """Keep the least and the largest value of each part of lines, in their order, so that no peak is lost.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Abscissae, which lines share.
    values : ndarray, shape (n, lines)
        NaN where there is none.
    bins : int
        Number of parts.

    Returns
    -------
    x : ndarray, shape (m,)
        At most twice the number of parts.
    values : ndarray, shape (m, lines)
        Each line has its two values of a part at the same two abscissae as the others.
    """
    if len(x) <= 2 * bins:
        return x, values
    kept_x, kept = [], []
    for part in np.array_split(np.arange(len(x)), bins):
        group = values[part]
        with np.errstate(invalid="ignore"):
            low = np.where(np.isnan(group), np.inf, group).argmin(axis=0)
            high = np.where(np.isnan(group), -np.inf, group).argmax(axis=0)
        first, second = np.minimum(low, high), np.maximum(low, high)
        lines = np.arange(values.shape[1])
        kept_x += [x[part[0]], x[part[-1]]]
        kept += [group[first, lines], group[second, lines]]
    return np.array(kept_x), np.array(kept)

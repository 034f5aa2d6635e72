"""A figure as charts that zoom and read out under the pointer: its panels of lines, as they are drawn on paper."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.report.glyphs import can_be_charted, draw_areas, draw_levels, draw_lines, name_the_rest, plain, write_words

_HEIGHT = 340
_FEW_NAMES, _LINE = 4, 24
"""Names of lines for which there is room, and height for each one more, as on a narrow screen each has a row."""
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
    return [_chart(ax) for ax in panels] if panels and all(map(can_be_charted, panels)) else []


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

    labels = {name: _label(ax, name) for name in "xy"}
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
        tags=[labels["x"]],
    )
    chart.toolbar.logo = None
    chart.xaxis.axis_label, chart.yaxis.axis_label = plain(labels["x"]), plain(labels["y"])
    chart.axis.axis_label_text_font_style = "normal"
    title = ax.get_title(loc="left") or ax.get_title()
    chart.title.text = plain(title)
    chart.title.text_font_style = "normal"
    for one in (*chart.axis, chart.title):
        for name in ("axis_label_text_font_size", "major_label_text_font_size", "text_font_size"):
            if hasattr(one, name):
                setattr(one, name, _FONT)
    areas = draw_areas(chart, ax)
    named = [*draw_lines(chart, ax, HoverTool), *areas]
    draw_levels(chart, ax)
    write_words(chart, ax)
    named += name_the_rest(chart, ax, named)
    if [one.name for one in named] not in ([], [title]):
        items = [LegendItem(label=one.name, renderers=[one.glyph]) for one in named]
        legend = Legend(items=items, orientation="horizontal", ncols="auto", click_policy="hide")
        legend.update(background_fill_color=None, border_line_color=None, label_text_font_size=_FONT, padding=2)
        chart.add_layout(legend, "above")
        chart.height = _HEIGHT + _LINE * max(len(named) - _FEW_NAMES, 0)
    return chart


def _label(ax: Axes, name: str) -> str:
    """The label of an axis, which panels beside each other share."""
    shared = {"x": ax.get_shared_x_axes, "y": ax.get_shared_y_axes}[name]().get_siblings(ax)
    written = (getattr(one, f"get_{name}label")() for one in (ax, *shared))
    return next(filter(None, written), "")


def _scales(ax: Axes) -> dict[str, str]:
    return {"x": ax.get_xscale(), "y": ax.get_yscale()}

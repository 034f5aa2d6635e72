"""A figure as charts that zoom and read out under the pointer: its panels of lines, as they are drawn on paper."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.collections import Collection, LineCollection, PathCollection, PolyCollection
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, StepPatch
from matplotlib.path import Path
from matplotlib.text import Annotation
from matplotlib.transforms import Transform
from numpy.typing import ArrayLike, NDArray

from beltdyn.errors import ModelError, Parts, classified
from beltdyn.results import Result
from beltdyn.show.plot.figures import FIGURES, Choice, chosen_by_default, data_uri, repeated, why_no_figure
from beltdyn.show.plot.gaps import of_data
from beltdyn.show.plot.style import LIMIT, NOTE, RESERVATION, styled

# What is drawn on the axes of a figure, drawn again on a chart: lines, marks, areas, words and names

_BIN_COUNT = 700
"""Number of intervals of a long line, of each of which the least and largest values are kept: a chart shows no more."""
_SMALL = "11px"
_MARKS = {"o": "circle", "x": "x", "s": "square", "^": "triangle", "D": "diamond"}
_MAX_MARK_SIZE = 6
"""Largest size of the marks of points, pixels: larger ones would cover each other."""
_BASELINES = {"center": "middle", "center_baseline": "middle", "baseline": "alphabetic"}
"""How words stand to their height, of matplotlib -> of Bokeh."""
_AS_DRAWN = (LineCollection, PathCollection, PolyCollection)


class Named(NamedTuple):
    """A line or an area with a name."""

    name: str
    """What the legend calls it."""
    glyph: Any
    """What Bokeh draws."""
    column: str = ""
    """Its column of values; empty of what is not read out."""


def can_be_charted(ax: Axes) -> bool:
    """Whether a panel has lines, over axes that may be stretched one by one, and no bars, pictures or colors."""
    straight = ax.name == "rectilinear" and ax.get_aspect() == "auto" and not ax.images
    others = [one for one in ax.collections if not isinstance(one, _AS_DRAWN) or one.get_array() is not None]
    bars = [one for one in ax.patches if not (isinstance(one, StepPatch) or _across(ax, one))]
    return straight and bool(ax.lines) and not others and not bars


def draw_lines(chart: Any, ax: Axes, hover: Any) -> list[Named]:
    """Draw the lines of a panel, which are read out under the pointer; those with names."""
    named = []
    for lines in _sharing_abscissae(
        [line for line in ax.lines if of_data(line) and len(np.atleast_1d(line.get_xdata()))]
    ):
        named += _draw(chart, ax, lines, hover)
    return named


def draw_levels(chart: Any, ax: Axes) -> None:
    """Draw lines across the whole panel, such as a limit."""
    from bokeh.models import Span

    for line in ax.lines:
        if of_data(line):
            continue
        x, y = np.unique(line.get_xdata()), np.unique(line.get_ydata())
        across = len(y) == 1
        look = {"line_color": to_hex(line.get_color()), "line_width": line.get_linewidth(), "line_dash": dashes(line)}
        place = float(y[0] if across else x[0])
        chart.add_layout(Span(location=place, dimension="width" if across else "height", **look))


def draw_areas(chart: Any, ax: Axes) -> list[Named]:
    """Draw bands, areas between lines, shaded parts, and lines that are not read out; those with names."""
    from bokeh.models import BoxAnnotation

    for patch in ax.patches:
        look = {"fill_color": to_hex(patch.get_facecolor()), "fill_alpha": 0.6, "line_color": None, "level": "underlay"}
        for bounds in _shaded(patch) if isinstance(patch, StepPatch) else [_band(ax, patch)]:
            chart.add_layout(BoxAnnotation(**bounds, **look))
    named = []
    for one in ax.collections:
        glyph = _draw_collection(chart, one)
        if glyph is not None and not str(one.get_label()).startswith("_"):
            named.append(Named(str(one.get_label()), glyph))
    return named


def write_words(chart: Any, ax: Axes) -> None:
    """Write what stands at a point of the data, such as the number of a mode at the end of its line."""
    from bokeh.models import Label

    for text in ax.texts:
        if isinstance(text, Annotation) and _stands_in(text) and text.get_text() and not text.arrow_patch:
            x, y = _place(ax, text)
            right, up = text.get_position()
            look = {
                "text_color": to_hex(text.get_color()),
                "text_font_size": _SMALL,
                "text_align": text.get_horizontalalignment(),
                "text_baseline": _BASELINES.get(aligned := text.get_verticalalignment(), aligned),
            }
            turned = {"angle": float(text.get_rotation()), "angle_units": "deg"}
            chart.add_layout(
                Label(x=x, y=y, x_offset=right, y_offset=up, text=plain(text.get_text()), **look, **turned)
            )


def _stands_in(text: Annotation) -> bool:
    """Whether words stand at data, at the edge beside them, or as a limit off the axes."""
    return text.xycoords == "data" or isinstance(text.xycoords, tuple) or text.get_gid() == LIMIT


def _place(ax: Axes, text: Annotation) -> tuple[float, float]:
    """Where words stand in the data of the axes as they are drawn first."""
    kinds = text.xycoords if isinstance(text.xycoords, tuple) else (text.xycoords, text.xycoords)
    shares = ax.transLimits.inverted().transform(text.xy)
    edges = ax.transScale.inverted().transform(shares)
    x, y = (value if kind == "data" else edge for kind, value, edge in zip(kinds, text.xy, edges, strict=True))
    return float(x), float(y)


def plain(text: str) -> Any:
    """Text as it is: what stands between two dollars Bokeh would set with MathJax, which a page does not hold."""
    from bokeh.models import PlainText

    return PlainText(text=text)


def name_the_rest(chart: Any, ax: Axes, named: Sequence[Named]) -> list[Named]:
    """What the legend of a panel says besides the names of its lines, such as what a mark means."""
    legend, lines = ax.get_legend(), [line for line in ax.lines if of_data(line)]
    if legend is None:
        return []
    known = {one.name for one in named} | {str(line.get_label()) for line in lines} | {line.get_gid() for line in lines}
    said = zip(legend.legend_handles, (text.get_text() for text in legend.get_texts()), strict=True)
    return [Named(text, _sample(chart, handle)) for handle, text in said if handle is not None and text not in known]


class _Pen(RendererBase):
    """Notes the dashes with which a line is drawn: matplotlib tells them to renderers alone."""

    dashes: ArrayLike | None = None

    def draw_path(self, gc: GraphicsContextBase, path: Path, transform: Transform, rgbFace: Any = None) -> None:
        self.dashes = gc.get_dashes()[1]

    def draw_markers(self, *_: Any) -> None:
        pass


def dashes(line: Line2D) -> Any:
    """The dashes of a line as they are on paper."""
    pen = _Pen()
    line.draw(pen)
    if pen.dashes is None:
        return "solid"
    return [max(1, round(2.0 * part / line.get_linewidth())) for part in np.asarray(pen.dashes).tolist()]


def thinned(x: NDArray[Any], values: NDArray[Any], bins: int = _BIN_COUNT) -> tuple[NDArray[Any], NDArray[Any]]:
    """Keep the least and the largest value of each part of lines, in their order, so that no peak is lost.

    In a part, each line has its two values at the same two abscissae as the others.
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


def _across(ax: Axes, patch: Patch) -> bool:
    """Whether a patch is a band across the whole panel."""
    return patch.get_transform() != patch.get_patch_transform() + ax.transData


def _sharing_abscissae(lines: Sequence[Line2D]) -> Iterator[list[Line2D]]:
    """Lines over the same abscissae together: they are read out together."""
    for _, group in groupby(lines, lambda line: np.asarray(line.get_xdata(), dtype=float).tobytes()):
        yield list(group)


def _draw(chart: Any, ax: Axes, lines: Sequence[Line2D], hover: Any) -> list[Named]:
    """Draw lines over the same abscissae; those with names."""
    from bokeh.models import ColumnDataSource

    x = np.asarray(lines[0].get_xdata(), dtype=float)
    values = np.column_stack([np.asarray(line.get_ydata(), dtype=float) for line in lines])
    x, values = thinned(x, values)
    columns = {f"y{number}": column.astype(np.float32) for number, column in enumerate(values.T)}
    source = ColumnDataSource({"x": x.astype(np.float32), **columns})
    named, drawn = [], []
    for number, line in enumerate(lines):
        look = {"color": to_hex(line.get_color()), "line_dash": dashes(line)}
        if str(line.get_linestyle()) not in ("None", ""):
            drawn.append(chart.line("x", f"y{number}", source=source, line_width=1.1 * line.get_linewidth(), **look))
        if line.get_marker() not in ("", "None", None) and len(x) < _BIN_COUNT:
            mark = _MARKS.get(str(line.get_marker()), "circle")
            size = min(_MAX_MARK_SIZE, 1.3 * line.get_markersize())
            drawn.append(chart.scatter("x", f"y{number}", source=source, size=size, marker=mark, color=look["color"]))
        if not str(line.get_label()).startswith("_") and drawn:
            named.append(Named(_name(line), drawn[-1], f"y{number}"))
    if drawn:
        unit = ax.get_ylabel().partition("[")[2].rstrip("]")
        rows = [(one.name, f"@{one.column}{{0.0000a}} {unit}") for one in named]
        tips = [(ax.get_xlabel(), "@x{0.0000}"), *(rows or [(ax.get_ylabel(), "@y0")])]
        chart.add_tools(hover(renderers=drawn[:1], tooltips=tips, mode="vline", line_policy="nearest"))
    return named


def _name(line: Line2D) -> str:
    """The name of a line, with that of its result where several are drawn."""
    name, result = str(line.get_label()), line.get_gid() or ""
    told = not result or name == result or name.endswith(f", {result}")
    return name if told else f"{name}, {result}"


def _shaded(steps: StepPatch) -> Iterator[dict[str, float]]:
    """Parts of the abscissa over which steps are up."""
    up, edges, _ = steps.get_data()
    bounds = np.flatnonzero(np.diff(np.concatenate([[False], np.asarray(up, dtype=bool), [False]])))
    for first, last in bounds.reshape(-1, 2):
        yield {"left": float(edges[first]), "right": float(edges[last])}


def _band(ax: Axes, patch: Patch) -> dict[str, float]:
    """Bounds of a band across a panel: the two that are data."""
    (left, bottom), (right, top) = patch.get_path().transformed(patch.get_patch_transform()).get_extents().get_points()
    if patch.get_transform().contains_branch_seperately(ax.transData)[1]:
        return {"bottom": float(bottom), "top": float(top)}
    return {"left": float(left), "right": float(right)}


def _draw_collection(chart: Any, one: Collection) -> Any:
    """Draw areas, marks or lines."""
    face, edge = _tint(one.get_facecolor()), _tint(one.get_edgecolor())
    if isinstance(one, PathCollection):
        places = np.asarray(one.get_offsets(), dtype=float)
        return chart.scatter(*places.T, size=_MAX_MARK_SIZE, fill_color=face, line_color=edge) if len(places) else None
    outlines = [np.asarray(path.vertices, dtype=float) for path in one.get_paths()]
    columns = [[line[:, axis] for line in outlines if len(line)] for axis in (0, 1)]
    if isinstance(one, LineCollection):
        dashed: Any = one.get_linestyle()
        pattern = [max(1, round(2.0 * part)) for part in dashed[0][1]] if dashed[0][1] else "solid"
        return chart.multi_line(*columns, color=edge, line_width=1.0, line_dash=pattern)
    alpha = float(np.atleast_2d(np.asarray(one.get_facecolor(), dtype=float))[0, -1])
    return chart.patches(*columns, fill_color=face, fill_alpha=alpha, line_color=None, level="underlay")


def _tint(colors: Any) -> str | None:
    """The first color of a collection; None of one that has none."""
    return to_hex(colors[0]) if len(colors) else None


def _sample(chart: Any, handle: Artist) -> Any:
    """Draw nothing, in the look of an entry of a legend."""
    nothing = [float("nan")]
    if isinstance(handle, Line2D):
        tint = to_hex(handle.get_color())
        if str(handle.get_linestyle()) in ("None", ""):
            mark = _MARKS.get(str(handle.get_marker()), "circle")
            face = to_hex(handle.get_markerfacecolor())
            return chart.scatter(nothing, nothing, size=_MAX_MARK_SIZE, marker=mark, line_color=tint, fill_color=face)
        return chart.line(nothing, nothing, color=tint, line_width=handle.get_linewidth(), line_dash=dashes(handle))
    face = to_hex(handle.get_facecolor()) if isinstance(handle, Patch) else "#888888"
    return chart.patch(nothing, nothing, fill_color=face, line_color=None)


_CHART_HEIGHT = 340
"""Height of a chart, pixels, before rows of names are added to its legend."""
_FREE_NAMES, _NAME_HEIGHT = 4, 24
"""Names of lines for which there is room, and height for each one more, as on a narrow screen each has a row."""
_FONT = "12px"


def charts(figure: Figure) -> list[Any]:
    """Make a chart of each panel of a figure."""
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
        height=_CHART_HEIGHT,
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
        chart.height = _CHART_HEIGHT + _NAME_HEIGHT * max(len(named) - _FREE_NAMES, 0)
    return chart


def _label(ax: Axes, name: str) -> str:
    """The label of an axis, which panels beside each other share."""
    shared = {"x": ax.get_shared_x_axes, "y": ax.get_shared_y_axes}[name]().get_siblings(ax)
    written = (getattr(one, f"get_{name}label")() for one in (ax, *shared))
    return next(filter(None, written), "")


def _scales(ax: Axes) -> dict[str, str]:
    return {"x": ax.get_xscale(), "y": ax.get_yscale()}


# Figures of a report, as drawings and as interactive charts

_MAX_DRAWING_LENGTH = 300_000
"""Letters of a drawing of lines from which on it is smaller as pixels."""
_WIDE_PICTURE = 8.0
"""Width of a picture of several panels side by side, inches."""


class Shown(NamedTuple):
    """A figure on the page."""

    name: str
    """Its name in words."""
    source: str
    """The picture, for paper and for browsers without JavaScript."""
    charts: list[str]
    """Where its charts stand on the page; none where it is best as it is."""
    missing: str = ""
    """Why it cannot be drawn of these results, as of drives with other pulleys; empty where it is."""
    notes: tuple[str, ...] = ()
    """What is written on the picture, and stands below its charts."""
    wide: bool = False
    """Whether it has panels side by side, so that it is scrolled where there is no room for it."""


@styled
def charted(
    results: Sequence[Result], parts: Parts, names: Sequence[str] | None = None
) -> tuple[list[Shown], dict[str, Any]]:
    """Draw figures of results; one that has a fault says so, and is among the errors of `parts`."""
    shown: list[Shown] = []
    models: dict[str, Any] = {}
    if unknown := [name for name in names or () if name not in FIGURES]:
        raise ModelError(f"there is no figure {unknown[0]!r}. Choose one of {', '.join(FIGURES)}.")
    chosen = chosen_by_default(results) if names is None else tuple(names)
    if not chosen:
        shown.append(Shown("Figures", "", [], why_no_figure(results)))
    for name in chosen:
        title = name.replace("_", " ").capitalize()
        try:
            drawn = FIGURES[name].arrange(results, Choice())
            places = {f"{name}-{number}": chart for number, chart in enumerate(charts(drawn))}
            picture, notes = _picture(drawn), _notes(drawn)
        except Exception as error:
            told = classified(error, repeated(results, name))
            shown.append(Shown(title, "", [], str(told)))
            if not isinstance(told, ModelError):
                parts.fail(told)
            continue
        shown.append(Shown(title, picture, list(places), "", notes, drawn.get_figwidth() > _WIDE_PICTURE))
        models |= places
    return shown, models


def _notes(drawn: Figure) -> tuple[str, ...]:
    """What is written into the corners and along the edges of panels, each once."""
    texts = (text for ax in drawn.axes for text in ax.texts if text.get_gid() in (NOTE, RESERVATION))
    return tuple(dict.fromkeys(line for text in texts for line in text.get_text().splitlines() if line))


def _picture(drawn: Figure) -> str:
    """A drawing, or pixels where these are smaller."""
    drawn.suptitle("")
    source = data_uri(drawn)
    return source if len(source) < _MAX_DRAWING_LENGTH else data_uri(drawn, "png")

"""Figures for print: widths of columns, sizes of letters, and greys in place of colors."""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from itertools import cycle
from textwrap import fill
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import Collection
from matplotlib.colors import Colormap, ListedColormap, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.textpath import text_to_path

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError

SCREEN, PRINT = "screen", "print"
STYLES = (SCREEN, PRINT)
"""Names of the styles."""
GREYS = ("#000000", "#707070", "#9c9c9c", "#4a4a4a", "#bcbcbc")
"""Colors of lines in print. Their number and that of the line styles have no common factor: twenty lines differ."""
COLUMN, PAGE = 84.0 / 25.4, 174.0 / 25.4
"""Widths of a column and of a page of a journal with two columns, inches."""
PRINT_SIZE, PRINT_SAMPLE = 8.0, 30.0
"""Size of letters, and width of the line before a name with the gap to the next one, points."""
_MAX_COLUMN_WIDTH = 8.0
"""Width up to which a figure for the screen fits into a column, inches."""
_HEIGHT_RATIO = 1.3
"""Height over width in a column over that on the screen, since letters are larger against the axes."""
_PATTERNS = ((0, (7, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1.5, 1.5)), (0, (7, 1.5, 1, 1.5, 1, 1.5)))
"""Line styles of lines that differ on the screen by their colors alone."""
_THIN_LINE_WIDTH = 0.9
"""Width of lines below which they are taken to vibrate, points."""
_LABEL_SHARE = 0.95
"""Part of the width of a figure that labels may fill."""
_LINE_LENGTH_RATIO = 0.9
"""Letters of a line over those of mean width that fill it, since letters differ."""
_POINTS_PER_INCH = 72.0
"""Points in an inch: letters are measured in points, and figures in inches."""
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
"""Parts of red, green and blue in the luminance (Rec. 709)."""

RULES: dict[Any, Any] = {
    "font.family": ["STIXGeneral", "DejaVu Serif"],  # Times, as matplotlib has it
    "mathtext.fontset": "stix",
    "font.size": PRINT_SIZE,
    "axes.titlesize": PRINT_SIZE,
    "axes.labelsize": PRINT_SIZE,
    "legend.fontsize": PRINT_SIZE,
    "legend.handlelength": 2.2,
    "legend.handletextpad": 0.5,
    "legend.columnspacing": 1.0,
    "axes.labelcolor": "black",
    "axes.edgecolor": "black",
    "text.color": "black",
    "xtick.color": "black",
    "ytick.color": "black",
    "axes.linewidth": 0.6,
    "axes.spines.top": True,
    "axes.spines.right": True,
    "axes.grid": False,
    "axes.prop_cycle": cycler(color=GREYS),
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "lines.linewidth": 1.0,
    "lines.markersize": 4,
    "pdf.fonttype": 42,  # journals ask for fonts that can be searched
    "ps.fonttype": 42,
    "savefig.dpi": 600,
}
"""Frames around the axes, ticks inside and no grid, as in the paper's figures."""

_style = ContextVar("style", default=SCREEN)


def prints() -> bool:
    """Whether figures are drawn for print at present."""
    return _style.get() == PRINT


def require_style(name: str) -> None:
    """Refuse a name that is none of a style."""
    if name not in STYLES:
        raise ModelError(f'style = "{name}" is unknown. Choose {" or ".join(STYLES)}.')


@contextmanager
def figure_style(name: str) -> Iterator[None]:
    """Draw all figures in a style meanwhile.

    Parameters
    ----------
    name : {"screen", "print"}
        "print" is for journals: 84 or 174 mm wide, letters of 8 points with serifs, greys and line styles, frames as in
        the paper, and no headline, which the caption replaces.

    Raises
    ------
    ModelError
        If there is no such style.

    Examples
    --------
    >>> with bd.plot.figure_style("print"):
    ...     ax = bd.plot.speeds(run)
    >>> print(f"{25.4 * ax.figure.get_figwidth():.0f} mm")
    84 mm
    """
    require_style(name)
    before = _style.set(name)
    try:
        yield
    finally:
        _style.reset(before)


def printed_size(size: tuple[float, float], wide: bool = False) -> tuple[float, float]:
    """Width and height in print, inches, of a figure of a size on the screen; of wide ones over the page."""
    width = PAGE if wide or size[0] > _MAX_COLUMN_WIDTH else COLUMN
    return width, (_HEIGHT_RATIO if width == COLUMN else 1.0) * size[1] * width / size[0]


def finish(page: Figure) -> None:
    """Make a figure fit for print: greys, line styles that differ, labels no wider than it, ticks once."""
    make_grey(page.findobj())
    for ax in page.axes:
        _tell_apart(ax)
        if ax.child_axes:  # a second axis has ticks of its own
            ax.tick_params(top=False, right=False, which="both")
        for text in (ax.xaxis.label, *(text for text in ax.texts if text.get_gid() == "note")):
            text.set_text(_broken(text.get_text(), text.get_fontproperties(), page.get_figwidth()))
        place, title = ax.get_subplotspec(), ax.get_title(loc="left")
        columns = 1 if place is None else place.get_gridspec().ncols
        for artist in ax.findobj(Text) if title else ():  # changed in place: its distance leaves room for a legend
            if isinstance(artist, Text) and artist.get_text() == title:
                artist.set_text(_broken(title, artist.get_fontproperties(), page.get_figwidth() / columns))


def _broken(text: str, font: FontProperties, width: float) -> str:
    """A text in lines that fit into a width, inches."""
    lines = text.split("\n")
    needed = [
        text_to_path.get_text_width_height_descent(line, font, False)[0] / _POINTS_PER_INCH / _LABEL_SHARE
        for line in lines
    ]
    return "\n".join(
        fill(line, int(_LINE_LENGTH_RATIO * len(line) * width / length)) if length > width else line
        for line, length in zip(lines, needed, strict=True)
    )


def _tell_apart(ax: Axes) -> None:
    """Give solid lines with names other styles from the second on, in axes and legends.

    Thin lines vibrate, and dashes would be lost in them; lines of several results are named by their style.
    """
    solid = [line for line in ax.lines if _is_solid(line) and line.get_linewidth() >= _THIN_LINE_WIDTH]
    if any(line.get_gid() for line in solid):
        return
    boxes = [box for box in (ax.get_legend(), *ax.figure.figure.legends) if box is not None]
    names = {str(line.get_label()): pattern for line, pattern in zip(solid[1:], cycle(_PATTERNS), strict=False)}
    for line in solid[1:]:
        line.set_linestyle(names[str(line.get_label())])
    for box in boxes:
        for text, handle in zip(box.get_texts(), box.legend_handles, strict=True):
            if isinstance(handle, Line2D) and text.get_text() in names:
                handle.set_linestyle(names[text.get_text()])


def _is_solid(line: Line2D) -> bool:
    return line.get_linestyle() == "-" and not str(line.get_label()).startswith("_")


def make_grey(artists: Iterable[Artist]) -> None:
    """Draw artists in greys of the luminance of their colors."""
    for artist in artists:
        if isinstance(artist, Line2D):
            for name in ("color", "markerfacecolor", "markeredgecolor"):
                value = getattr(artist, f"get_{name}")()
                if not (isinstance(value, str) and value in ("none", "auto")):
                    getattr(artist, f"set_{name}")(_greys(value)[0])
        elif isinstance(artist, Text):
            artist.set_color(_greys(artist.get_color())[0])
        elif isinstance(artist, Patch):
            artist.set_facecolor(_greys(artist.get_facecolor())[0])
            artist.set_edgecolor(_greys(artist.get_edgecolor())[0])
        elif isinstance(artist, ScalarMappable) and artist.get_array() is not None:
            artist.set_cmap(_grey_map(artist.get_cmap()))
        elif isinstance(artist, Collection):
            artist.set_facecolor([tuple(row) for row in _greys(artist.get_facecolor()).tolist()])
            artist.set_edgecolor([tuple(row) for row in _greys(artist.get_edgecolor()).tolist()])


def _greys(colors: Any) -> FloatArray:
    """Greys of the luminance of colors, with their opacity, shape (n, 4)."""
    values = to_rgba_array(colors)
    values[:, :3] = (values[:, :3] @ _LUMINANCE)[:, None]
    return np.asarray(values)


def _grey_map(colors: Colormap) -> Colormap:
    """A color map from black to light grey, in the order of the luminance of another."""
    first, last = _greys(colors([0.0, 1.0]))[:, 0]
    values = np.linspace(0.0, 0.85, 256)
    values = values if first <= last else values[::-1]
    return ListedColormap(np.repeat(values[:, None], 3, axis=1), f"{colors.name} grey")


def rules(screen: dict[Any, Any]) -> Any:
    """The context of rules in the present style, those of the screen and what print changes."""
    return mpl.rc_context(screen | RULES if prints() else screen)

"""Legends, which take no width from what is drawn: above one pair of axes, or once below all panels."""

from collections.abc import Sequence

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.textpath import text_to_path

_SAMPLE, _SIZE = 45.0, 9.0
"""Width of the line before a name with the gap to the next one, and size of names, points."""
_WIDER = 1.08
"""Width of axes after their layout, over that before it."""
_INCH = 72.0
_ROW, _GAP, _ABOVE = 13.0, 6.0, 11.0
"""Height of a row, and the distances of a title from axes and from a legend, points."""


def name_lines(ax: Axes, lines: Sequence[Artist] | None = None) -> None:
    """Write the legend of axes above them, in as many columns as fit; names longer than the axes below the figure."""
    lines = ax.get_legend_handles_labels()[0] if lines is None else lines
    names = [str(line.get_label()) for line in lines]
    if not names:
        return
    page = ax.figure.figure
    width = float(_WIDER * ax.get_position().width * page.get_figwidth())
    columns = _columns(names, width)
    if columns == 1 and _widths(names, 1) > width and page.axes == [ax]:
        page.legend(handles=lines, loc="outside lower left")
        return
    ax.legend(handles=lines, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=columns, borderaxespad=0.2)
    if title := ax.get_title(loc="left"):
        ax.set_title(title, loc="left", pad=_ABOVE + _ROW * -(-len(names) // columns))


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
            ax.set_title(written, loc="left", pad=_GAP)
    if named:
        columns = _columns(list(named), float(page.get_figwidth()))
        page.legend(list(named.values()), list(named), loc="outside lower left", ncols=columns, title=title or None)


def _columns(names: Sequence[str], width: float) -> int:
    """The most columns of a legend that fit into a width, inches; one where even that is wider."""
    return next((count for count in range(len(names), 1, -1) if _widths(names, count) <= width), 1)


def _widths(names: Sequence[str], columns: int) -> float:
    """Width of a legend of so many columns, which are filled one after the other, inches."""
    font = FontProperties(size=_SIZE)
    widths = [text_to_path.get_text_width_height_descent(name, font, False)[0] for name in names]
    return sum(_SAMPLE + float(part.max()) for part in np.array_split(np.array(widths), columns)) / _INCH

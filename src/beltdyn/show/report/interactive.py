"""Interactive figures for notebooks, without network access."""

import json
from collections.abc import Sequence
from html import escape

from beltdyn.errors import ModelError
from beltdyn.results import Result
from beltdyn.show.report.build import environment, read, script
from beltdyn.show.report.chart import Shown, charted
from beltdyn.show.report.page_parts import embedded, library

_ROOM, _HEADING = 400, 90
"""Height for a row of charts, and for the name above, pixels."""
_HIGHEST = 900


class InteractiveFigures:
    """Interactive figures of results in a notebook: a self-contained page in a frame of a height in pixels."""

    def __init__(self, page: str, names: tuple[str, ...], height: int) -> None:
        self.page, self.names, self.height = page, names, height

    def __repr__(self) -> str:
        return f"InteractiveFigures({', '.join(self.names)})"

    def _repr_html_(self) -> str:
        """Show the page in a frame of its own, so that it meets no other script of the notebook."""
        size = f"width:100%;height:{self.height}px;border:0"
        return f'<iframe srcdoc="{escape(self.page)}" style="{size}" title="{escape(", ".join(self.names))}"></iframe>'


def interactive(results: Result | Sequence[Result], *names: str) -> InteractiveFigures:
    """Draw interactive figures for a notebook.

    Parameters
    ----------
    results : Result or sequence of Result
        A run, or the result of another analysis; or several, whose lines are laid over each other.
    *names : str
        Names of figures, such as "span_tensions", as `beltdyn plot --figures` has them; by default those of a report.

    Returns
    -------
    InteractiveFigures
        An object that Jupyter displays as charts, offline. It contains the charting library (1.3 MB), so show all
        figures in one cell.

    Raises
    ------
    ModelError
        If there is no such figure, or it cannot be drawn of these results.

    Examples
    --------
    >>> bd.interactive(run, "slip", "span_tensions")
    InteractiveFigures(Slip, Span tensions)
    """
    several = [results] if isinstance(results, Result) else list(results)
    shown, charts = charted(several, names or None)
    if missing := [one.missing for one in shown if one.missing and names]:
        raise ModelError(missing[0])
    page = environment().get_template("interactive.html.jinja")
    text = page.render(
        figures=shown,
        charts=embedded(charts),
        colors=json.dumps([]),
        library=library() if charts else "",
        style=read("page.css"),
        script=script(),
    )
    return InteractiveFigures(text, tuple(one.name for one in shown), _height(shown))


def _height(shown: Sequence[Shown]) -> int:
    """Height that figures take, at two charts beside each other."""
    rows = sum(max(1, -(-len(one.charts) // 2)) * _ROOM + _HEADING for one in shown)
    return min(rows, _HIGHEST)

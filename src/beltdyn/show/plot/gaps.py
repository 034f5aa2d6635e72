"""What a result does not hold: points, designs or states that failed, and figures and panels without a value."""

from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from beltdyn.arrays import FloatArray
from beltdyn.results import Result
from beltdyn.show.plot.style import NOTE

_NOUNS = {"design": "designs", "state": "states", "row": "rows"}
"""What stands along a dimension; points along others."""
_LINE_LENGTH = 34
"""Letters of a line in an empty panel at most: a panel beside others is 3.7 inches wide."""
_MAX_LINES = 5
"""Lines of a text in an empty panel at most: a longer text is cut, since a panel beside others is 2.7 inches high."""


def gaps(result: Result) -> str:
    """How many points of a result have no values, such as "2 of 9 points failed"; empty where all have."""
    if "failure" not in result.dataset:
        return ""
    failure = result.dataset["failure"]
    failed, size = int((failure != "").sum()), failure.size
    noun = _NOUNS.get(str(failure.dims[0]), "points") if failure.ndim == 1 else "points"
    computed = int(result.dataset.attrs.get("done", result.dataset.attrs.get("points", size)))
    missing = [f"{failed} of {size} {noun} failed"] if failed else []
    missing += [f"{size - computed} of {size} {noun} are not computed"] if computed < size else []
    return ", ".join(missing)


def first_failure(result: Result) -> str:
    """Why the first point failed, its first line; empty where none did."""
    if "failure" not in result.dataset:
        return ""
    texts = result.dataset["failure"].values.ravel().tolist()
    return next((str(text).splitlines()[0] for text in texts if text), "")


def count_missing(values: FloatArray) -> str:
    """How many points have no value of a result, in words; empty where all have."""
    missing = int(np.count_nonzero(~np.isfinite(values)))
    return f"no value at {missing} of {values.size} points" if missing else ""


def mark_isolated(ax: Axes) -> None:
    """Mark points of lines between points without a value: a line alone would not show them."""
    for line in ax.lines:
        drawn = str(line.get_linestyle()) not in ("None", "") and line.get_marker() in ("None", "", None)
        points = np.column_stack([line.get_xdata(), line.get_ydata()]).astype(float)
        if drawn and of_data(line) and len(points):
            known = np.isfinite(points).all(axis=1)
            beside = np.append(False, known[:-1]) | np.append(known[1:], False)
            if (known & ~beside).any():
                line.set(marker="o", markersize=3.0, markevery=np.flatnonzero(known & ~beside).tolist())


def explain_empty(ax: Axes, result: Result) -> None:
    """Write into axes on which no value is drawn that there is none, and why."""
    if has_values(ax) or any(text.get_gid() == NOTE for text in ax.texts):
        return
    why = first_failure(result)
    write_inside(ax, f"No value: {gaps(result)}. The first: {why}" if why else "No value")


def write_inside(ax: Axes, text: str) -> None:
    """Write into the middle of axes that are empty otherwise."""
    lines = fill(text, _LINE_LENGTH, max_lines=_MAX_LINES, placeholder=" …")
    ax.annotate(lines, (0.5, 0.5), xycoords="axes fraction", ha="center", va="center", fontsize=8, gid=NOTE)


def has_values(ax: Axes) -> bool:
    """Whether axes hold a picture, a table, or a mark, line, area or bar at finite values."""
    if ax.images or ax.tables or not ax.axison:
        return True
    lines = [np.column_stack([line.get_xdata(), line.get_ydata()]) for line in ax.lines if of_data(line)]
    paths = [np.asarray(path.vertices) for one in ax.collections for path in one.get_paths()]
    outlines = [patch.get_path().transformed(patch.get_patch_transform()) for patch in ax.patches]
    return any(
        np.isfinite(np.asarray(one, dtype=float)).all(axis=1).any() for one in (*lines, *paths) if len(one)
    ) or any(np.isfinite(np.asarray(one.vertices)).all() for one in outlines)


def of_data(line: Line2D) -> bool:
    """Whether both coordinates of a line are data, and not a level across the whole panel."""
    return line.axes is not None and all(line.get_transform().contains_branch_seperately(line.axes.transData))

"""Headline of a figure: name of the drive and operating point."""

import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import count
from textwrap import fill
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from beltdyn.model import loads
from beltdyn.parts.messages import show
from beltdyn.parts.quantity import RPM
from beltdyn.parts.text_file import as_text
from beltdyn.results import Result, Run, StaticResult, power_balance
from beltdyn.results.cycles import ends_at_standstill, mean_window
from beltdyn.results.schema import runs_steadily
from beltdyn.show.plot.gaps import gaps
from beltdyn.show.plot.print_style import prints
from beltdyn.show.plot.style import INK, NOTE, dash, name_lines

# Several results in one figure: what each is called, and how its lines differ from those of the others

_PALENESS_STEP = 0.25
"""By how much the lines of a result are paler than those of the result before."""
_MAX_PALENESS = 0.6
"""Largest share of white in the color of a line: a paler one would be hard to see on white paper."""
_MAX_KEYS = 2
"""Number of keys whose values name a result at most: names must fit into a legend."""
_MAX_JOINT_LENGTH = 30
"""Letters of a line's name with that of its result, up to which both are written behind each other."""
_MAX_LEGEND_LENGTH = 50
"""Letters of a legend from which on the names of results stand below the figure."""


def overlay(
    draw: Callable[[Result, Axes | None], Axes],
    results: Sequence[Result],
    ax: Axes | None,
    shows: Sequence[bool] | None = None,
) -> Axes:
    """Draw results on one pair of axes: a color for each thing that is drawn, a line style for each result."""
    names, drawn, titles = names_of_results(results), dict[int, list[Line2D]](), list[str]()
    notes, limits = list[Text](), list[tuple[float, float]]()
    for number, result in enumerate(results):
        if shows is not None and not shows[number]:
            continue
        before = set(ax.get_children()) if ax is not None else set()
        if ax is not None and drawn:
            ax.autoscale(axis="y")  # what the result before has set holds for it alone
        ax = draw(result, ax)
        limits.append(ax.get_ylim())
        titles.append(ax.get_title(loc="left"))
        new = [artist for artist in ax.get_children() if artist not in before | {ax.patch, *ax.spines.values()}]
        drawn[number] = [artist for artist in new if isinstance(artist, Line2D)]
        for line in drawn[number]:
            line.set_gid(names[number])
        _tell_apart(new, number)
        for one in new:
            if isinstance(one, Text) and one.get_gid() == NOTE:
                notes.append(one)
            if isinstance(one, Patch) or (len(drawn) > 1 and isinstance(one, Text)):  # areas would hide each other
                one.remove()
    assert ax is not None
    ax.set_title(_shared(titles))
    if not ax.get_autoscaley_on():
        ax.set_ylim(min(low for low, _ in limits), max(high for _, high in limits))
    if notes:
        notes[0].set_text(_shared([note.get_text() for note in notes]))
    legend, page = _named(drawn, names), ax.figure.figure
    styles = [line for line in legend if not any(line in lines for lines in drawn.values())]
    if not styles or (len(page.axes) == 1 and sum(len(str(line.get_label())) for line in legend) < _MAX_LEGEND_LENGTH):
        name_lines(ax, legend)
        return ax
    if len(page.axes) == 1 or len(legend) > len(styles) + 1:  # one line is named by the title of its panel
        name_lines(ax, [line for line in legend if line not in styles])
    if not page.legends:
        page.legend(handles=styles, loc="outside upper right", ncols=len(styles))
    return ax


def names_of_results(results: Sequence[Result]) -> list[str]:
    """Name results distinctly."""
    for name in (name_of, file_name):
        names = [name(result) for result in results]
        if all(names) and len(set(names)) == len(names):
            return names
    differing = [(key, [value.strip('"') for value in row]) for key, row in differing_keys(results)[:_MAX_KEYS]]
    names = [", ".join(f"{key} = {row[number]}" for key, row in differing) for number in range(len(results))]
    return names if len(set(names)) == len(names) else [f"result {n}" for n, _ in zip(count(1), results, strict=False)]


def given_keys(result: Result) -> dict[str, Any]:
    """Give the numbers and texts of a drive file with their paths."""
    text = result.dataset.attrs.get("drive_as_given")
    drive = loads(text, base=result.path.parent if result.path else None) if text else result.drive
    return dict(_keys(drive.data))


def differing_keys(results: Sequence[Result]) -> list[tuple[str, list[str]]]:
    """Give the keys in which drives differ, with their values as they stand in the files.

    Where a file holds all keys, as that of a drive changed in Python does, values are those of the drives.
    """
    read = [given_keys(result) for result in results]
    typed = [dict(_keys(tomllib.loads(result.drive_as_given))) for result in results]
    if any(keys.keys() <= text.keys() for keys, text in zip(read, typed, strict=True)):
        typed = read
    names = dict.fromkeys(key for text in typed for key in text)
    rows = {key: [show(text[key]) if key in text else "by default" for text in typed] for key in names}
    same = {key for key in names if all(key in keys for keys in read) and len({show(keys[key]) for keys in read}) == 1}
    return [(key, row) for key, row in rows.items() if len(set(row)) > 1 and key not in same]


def _keys(data: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Numbers and texts of a drive with their paths; what has a name is called by it."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield from _keys(value, f"{path}.{key}" if path else key)
    elif isinstance(data, list) and any(isinstance(one, dict) for one in data):
        for number, one in enumerate(data, 1):
            yield from _keys(one, f"{path}[{one.get('name', one.get('pulley', number))}]")
    else:
        yield path, data


def _shared(texts: Sequence[str]) -> str:
    """What texts have in common, line by line, of their parts between commas, such as the pulley of two instants."""
    rows = zip(*(text.split("\n") for text in texts), strict=False)
    parts = [[row.split(", ") for row in rows_of_all] for rows_of_all in rows]
    return "\n".join(", ".join(part for part in one[0] if all(part in others for others in one)) for one in parts)


def _tell_apart(artists: Sequence[Any], number: int) -> None:
    """Give what a result is drawn with its line style, paler than before; lines without a name keep their style."""
    for artist in artists:
        if isinstance(artist, Line2D):
            artist.set_color(_paler(artist.get_color(), number))
            if _has_name(artist):
                artist.set_linestyle(dash(number))


def _paler(tint: Any, number: int) -> tuple[float, float, float]:
    share = min(_PALENESS_STEP * number, _MAX_PALENESS)
    red, green, blue = (channel + share * (1.0 - channel) for channel in to_rgb(tint))
    return red, green, blue


def _named(drawn: Mapping[int, Sequence[Line2D]], names: Sequence[str]) -> list[Line2D]:
    """Lines of a legend: what all results show once, what only some show with their names, and the line styles."""
    named = {number: [line for line in lines if _has_name(line)] for number, lines in drawn.items()}
    shared = set.intersection(*({str(line.get_label()) for line in lines} for lines in named.values()))
    legend = [line for line in next(iter(named.values())) if line.get_label() in shared]
    rest = [
        (line, names[number]) for number, lines in named.items() for line in lines if line.get_label() not in shared
    ]
    spelled = {line: f"{line.get_label()}, {name}" for line, name in rest}
    short = max(map(len, spelled.values()), default=0) <= _MAX_JOINT_LENGTH
    for line, text in spelled.items():
        if short:
            line.set_label(text)
        legend.append(line)
    if shared or not legend or not short:
        legend += [Line2D([], [], color=INK, linestyle=dash(n), label=name) for n, name in enumerate(names)]
    return legend


def _has_name(line: Line2D) -> bool:
    return not str(line.get_label()).startswith("_")


_HEADLINE_SIZE = 11
"""Size of the letters of a headline, points: one more than those of panel titles."""
_LETTERS_PER_INCH = 11.5
"""Letters of this size in an inch."""


def write_headline(page: Figure, text: str) -> None:
    """Write above all panels of a page, at the left, in as many lines as it takes; in print captions say it."""
    if prints():
        return
    text = fill(text, int(_LETTERS_PER_INCH * page.get_figwidth()))
    page.suptitle(text, x=0.01, horizontalalignment="left", fontsize=_HEADLINE_SIZE)


def headlines(results: Sequence[Result]) -> str:
    """The headline of one result, or the names of the drives of several, as far as they have names."""
    if len(results) == 1:
        return headline(results[0])
    return ", ".join(dict.fromkeys(name for name in map(name_of, results) if name))


def headline(result: Result) -> str:
    """Describe the drive of a result and its operating point."""
    if isinstance(result, Run):
        point = _range(result) or _operating_point(result)
    elif isinstance(result, StaticResult):
        point = f"at rest, mean belt tension {float(result.dataset['tension']):.4g} N"
    else:
        point = "; ".join(part for part in (result.kind.replace("_", " "), gaps(result)) if part)
    return ": ".join(part for part in (name_of(result), point) if part)


def at_instant(result: Result, time: float) -> str:
    """Name an instant of a run; nothing at rest and in steady running, where all instants are alike."""
    lasts = isinstance(result, StaticResult) or runs_steadily(result.dataset)
    return "" if lasts else f"t = {time:.4g} s"


def name_of(result: Result) -> str:
    """Name of a result: that of its drive, or of its file without suffix; empty in memory without either."""
    return result.drive.name or file_name(result)


def file_name(result: Result) -> str:
    """Name of a result's file without suffix; empty in memory."""
    return as_text(result.path.stem) if result.path is not None else ""


def _range(run: Run) -> str:
    """Mean speeds between which a pulley was swept; empty of other runs."""
    swept = run.dataset.attrs.get("swept_pulley", "")
    profile = next((one.speed for one in run.drive.pulleys if one.name == swept), None)
    if profile is None:
        return ""
    first, last = RPM * profile.at(run.dataset["time"].values[[0, -1]])
    return f"{swept} from {_whole(float(first))} to {_whole(float(last))} rpm"


def _operating_point(run: Run) -> str:
    """Mean speed of the pulley with the largest power, and the power input; at the end of a run over time."""
    with run.recorded() as recorded:
        if ends_at_standstill(recorded, run.prepared):
            driver = run.drive.reference
            fastest = RPM * float(np.abs(np.asarray(recorded["pulley_speed"])[:, driver]).max())
            return f"{run.drive.pulleys[driver].name} up to {_whole(fastest)} rpm, at standstill at the end"
        over = mean_window(recorded, run.prepared)
        power = over.product(recorded, "shaft_torque", "shaft_speed")
        speed = run.drive.positive_sense * RPM * over.mean(recorded, "pulley_speed")
        put_in = power_balance(recorded, over).power_in
    first = int(power.argmax()) if put_in > 0.0 else 0
    given = f", {_power(put_in)} input" if put_in > 0.0 else ""
    instant = "" if runs_steadily(run.dataset) else " at the end"
    return f"{run.drive.pulleys[first].name} {_whole(float(speed[first]))} rpm{given}{instant}"


def _power(power: float) -> str:
    return f"{power / 1e3:.3g} kW" if power >= 1e3 else f"{power:.3g} W"


def _whole(number: float) -> str:
    """Four digits, or all those before the point where they are more."""
    return f"{number:z.4g}" if abs(number) < 9999.5 else f"{number:.0f}"

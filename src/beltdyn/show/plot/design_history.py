"""Figures of an optimization: the goal of the designs that were tried, and the best design beside the start."""

from collections.abc import Callable
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from beltdyn.errors import ModelError
from beltdyn.parts.quantity import RPM
from beltdyn.results import Result
from beltdyn.show.plot.figures import Choice, always, figure
from beltdyn.show.plot.study_values import chosen_of
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, name_lines, name_once, panels, rows

# Tornado figures: sensitivity of results to the parameters of a drive

_MAX_BARS = 10
"""Bars of a tornado figure at most, those of the largest effects: each needs a line for its name."""
_MAX_PANELS = 4
"""Panels of a page at most, one for each result: two rows of two."""


def _all_panels(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each result, of four at most."""
    names = [str(name) for name in result.dataset["result"].values][:_MAX_PANELS]
    return panels(rows([partial(draw, result, name) for name in names]), sharey=False)


@figure(always, _all_panels, of=("sensitivity",))
def sensitivity(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the parameters with the largest effect on a result, the largest on top.

    Bars are changes of the result with 1 % more of a number, or 1 mm more of a coordinate.

    Parameters
    ----------
    result : Result
        Of `sensitivity`.
    of : str, optional
        Name of one of its results; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result.

    Examples
    --------
    >>> found = bd.sensitivity(drive, about="rest", of="tension", numbers="belt.width, belt.length")
    >>> [number.get_text() for number in bd.plot.sensitivity(found).get_yticklabels()]
    ['belt.width', 'belt.length']
    """
    return _tornado(result, of, "effect", "change per 1 % or 1 mm", axes_or_new(ax))


def _has_tolerances(result: Result) -> bool:
    """Draw a figure where the drive file has tolerances."""
    return "contribution" in result.dataset


@figure(_has_tolerances, _all_panels, of=("sensitivity",))
def tolerances(result: Result, of: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw the tolerances with the largest effect on a result, the largest on top.

    Bars are changes of the result with the tolerance of a number. The lowest is the spread of all, which are
    independent: the root of the sum of squares.

    Parameters
    ----------
    result : Result
        Of `sensitivity`, of a drive file with tolerances.
    of : str, optional
        Name of one of its results; by default the first.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such result, or the drive file has no tolerances.

    Examples
    --------
    >>> text = bd.example("two_pulley").text.replace("width = 0.01", 'width = "10 ± 0.1 mm"')
    >>> found = bd.sensitivity(bd.loads(text), about="rest", of="tension", numbers="belt.width")
    >>> [name.get_text() for name in bd.plot.tolerances(found).get_yticklabels()]
    ['all, independent', 'belt.width']
    """
    if not _has_tolerances(result):
        raise ModelError('the drive file has no tolerances. Write for example width = "12.5 ± 0.1 mm".')
    return _tornado(result, of, "contribution", "change over the tolerance", axes_or_new(ax))


def _tornado(result: Result, of: str | None, variable: str, words: str, ax: Axes) -> Axes:
    """Draw bars of a variable over numbers, the largest on top; below them the spread of tolerances."""
    name = chosen_of([str(one) for one in result.dataset["result"].values], of)
    chosen = result.dataset.sel(result=name)
    effects = np.nan_to_num(chosen[variable].values)
    labels = [str(path) for path in chosen["number"].values]
    largest = [int(k) for k in np.argsort(-np.abs(effects), kind="stable")[:_MAX_BARS][::-1]]
    if variable == "contribution":
        largest = [k for k in largest if effects[k] != 0.0]
    unit, value = str(chosen["unit"].values), float(chosen["value"])
    percent = not unit and name.partition("[")[0] in ("efficiency", "pulley_slip")
    factor, shown = (100.0, "%") if percent else (1.0, unit)
    bars = [(labels[k], float(factor * effects[k]), color(int(effects[k] < 0))) for k in largest]
    if variable == "contribution":
        bars.insert(0, ("all, independent", factor * float(chosen["spread"]), color(2)))
    ticks = range(len(bars))
    drawn = ax.barh(ticks, [length for _, length, _ in bars], color=[shade for _, _, shade in bars])
    ax.bar_label(drawn, fmt="%.2g", padding=2, fontsize=7)
    ax.set_yticks(ticks, [label for label, _, _ in bars], fontsize=7)
    ax.margins(x=0.35)
    found = f"{name} = {factor * value:.4g} {shown}".rstrip()
    ax.set_xlabel(f"{found}\n{words}{f' [{shown}]' if shown else ''}", fontsize=9)
    return ax


_LIMIT_TOLERANCE = 1e-4
"""Violation of a limit, relative, up to which a design keeps it: the best one often lies on a limit."""


def _goal_and_numbers(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out the goal, and below it where the numbers are between their bounds."""
    return panels([[draw_panel] for draw_panel in (partial(draw, result), partial(_numbers, result))], sharey=False)


@figure(always, _goal_and_numbers, of=("optimize",))
def optimization(result: Result, *, ax: Axes | None = None) -> Axes:
    """Draw the goal of the designs in the order in which they were tried.

    Filled circles are designs within all limits, hollow circles violate some, and crosses have no steady running. The
    line is the best design so far.

    Parameters
    ----------
    result : Result
        Of `optimize`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> study = bd.OptimizationStudy(
    ...     number=[{"path": "belt.length", "least": "1.27 m", "largest": "1.275 m"}],
    ...     goal={"result": "hub_load"},
    ... )
    >>> bd.plot.optimization(bd.optimize(drive, study=study, most=3)).get_xlabel()
    'Design'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    goal, beyond = dataset["design_goal"].values, dataset["design_violation"].values
    number, runs = np.arange(1, goal.size + 1), np.isfinite(goal)
    kept = runs & (beyond <= _LIMIT_TOLERANCE)
    most = str(dataset.attrs["title"]).rpartition(": ")[2].startswith("maximize")
    best = (np.fmax if most else np.fmin).accumulate(np.where(kept, goal, np.nan))
    ax.step(number, best, where="post", color=INK, linewidth=1.0, label="best so far")
    ax.plot(number[kept], goal[kept], "o", color=color(0), label="within all limits")
    beside = runs & ~kept
    if beside.any():
        ax.plot(number[beside], goal[beside], "o", mfc="none", color=color(1), label="violates limits")
    if not runs.all():
        level = float(np.nanmax(goal)) if runs.any() else 0.0
        ax.plot(number[~runs], np.full((~runs).sum(), level), "x", color=color(2), label="no steady running")
    unit = str(dataset["requirement_unit"].values[0])
    name = str(dataset["requirement"].values[0]).partition(" ")[2]
    ax.set(xlabel="Design", ylabel=f"{name} [{unit or '1'}]")
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax


def _numbers(result: Result, *, ax: Axes) -> Axes:
    """Draw the parameters of the designs between their bounds."""
    dataset = result.dataset
    least, largest = dataset["least"].values, dataset["largest"].values
    parts = 100.0 * (dataset["design_number"].values - least) / (largest - least)
    number = np.arange(1, len(parts) + 1)
    for line, name in enumerate(dataset["number"].values):
        ax.plot(number, parts[:, line], "o-", markersize=3, color=color(line), label=str(name))
    ax.set(xlabel="Design", ylabel="Position between the bounds [%]", ylim=(-5.0, 105.0))
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    name_lines(ax)
    return ax


def _over_speed(result: Result) -> bool:
    """Whether a sheet has curves over speed: those of lines have operating points alone."""
    return "speed" in result.dataset.dims


def _of_line(result: Result) -> bool:
    """Whether a sheet is one of a line, whose tensions vary along spans."""
    return not _over_speed(result)


def _require_curves(result: Result) -> None:
    """Refuse the sheet of a line."""
    if not _over_speed(result):
        raise ModelError(
            "the sheet of a web line, a conveyor or a guided belt has operating points, and no curves over speed. "
            'Draw "line_tensions".'
        )


_MAX_SAFETY = 10.0
"""Slip safety at the upper end of the axis, 1, unless all pulleys are above it: larger ones are far from slip."""
_MAX_CURVES = 6
"""Pulleys or spans that are drawn: those nearest to a limit."""


@figure(_over_speed, of=("sheet",))
def sheet_slip_safety(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the slip safety of pulleys over the speed: at full load, and down to the least of all cases and frictions.

    Parameters
    ----------
    result : Result
        Of `sheet`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the sheet is one of a line.

    Examples
    --------
    >>> found = bd.sheet(bd.example("alternator_drive"), points=4)
    >>> bd.plot.sheet_slip_safety(found).get_ylabel()
    'Slip safety'
    """
    _require_curves(result)
    dataset, ax = result.dataset, axes_or_new(ax)
    speed = RPM * dataset["speed"].values
    nominal, least = (dataset[f"{name}_over_speed"].values for name in ("slip_safety", "least_slip_safety"))
    lowest = np.nan_to_num(np.fmin.reduce(least, axis=0), nan=np.inf)
    worst = np.argsort(lowest, kind="stable")[:_MAX_CURVES]
    safe = _MAX_SAFETY <= lowest[worst[0]] < np.inf
    top = 1.1 * float(np.nanmax(nominal[:, worst[0]])) if safe else _MAX_SAFETY
    loaded = worst[lowest[worst] < top].tolist()
    for number, pulley in enumerate(sorted(loaded)):
        tint, name = color(number), str(dataset["pulley"].values[pulley])
        ax.plot(speed, nominal[:, pulley], color=tint, linestyle=dash(number), label=name)
        ax.fill_between(speed, least[:, pulley], nominal[:, pulley], color=tint, alpha=0.15, linewidth=0.0)
    ax.axhline(1.0, color=INK, linewidth=0.8)
    ax.set(xlabel=_speed_label(result), ylabel="Slip safety", ylim=(0.0, top))
    name_lines(ax)
    return ax


@figure(_over_speed, of=("sheet",))
def sheet_tensions(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the tensions of the slackest and the tightest span over the speed: at full load, and in bands all cases.

    The bands hold light load, acceleration and vibration.

    Parameters
    ----------
    result : Result
        Of `sheet`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the sheet is one of a line.

    Examples
    --------
    >>> found = bd.sheet(bd.example("alternator_drive"), points=4)
    >>> bd.plot.sheet_tensions(found).get_ylabel()
    'Span tension [N]'
    """
    _require_curves(result)
    dataset, ax = result.dataset, axes_or_new(ax)
    speed, cases = RPM * dataset["speed"].values, dataset["tension_of_case_over_speed"].values
    mean, swing = dataset["span_tension_over_speed"].values, dataset["tension_amplitude_over_speed"].values
    low, high = np.fmin.reduce(cases, axis=1) - swing, np.fmax.reduce(cases, axis=1) + swing
    chosen = np.unique([np.argmin(np.nan_to_num(mean.mean(axis=0))), np.argmax(np.nan_to_num(mean.mean(axis=0)))])
    for number, span in enumerate(chosen.tolist()):
        tint, name = color(number), str(dataset["span"].values[span])
        ax.plot(speed, mean[:, span], color=tint, linestyle=dash(number), label=name)
        ax.fill_between(speed, low[:, span], high[:, span], color=tint, alpha=0.12, linewidth=0.0)
    ax.set(xlabel=_speed_label(result), ylabel="Span tension [N]")
    name_lines(ax)
    return ax


@figure(_of_line, of=("sheet",))
def line_tensions(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the tension along a web line or a conveyor, in running direction, at each operating point.

    Lines across stand for pulleys, whose names are above them.

    Parameters
    ----------
    result : Result
        Of `sheet`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the drive is another one.

    Examples
    --------
    >>> bd.plot.line_tensions(bd.sheet(bd.example("alternator_drive"), points=2))
    Traceback (most recent call last):
    ...
    beltdyn.errors.ModelError: the drive is no web line, conveyor or guided belt. Draw "sheet_tensions".
    """
    if not _of_line(result):
        raise ModelError('the drive is no web line, conveyor or guided belt. Draw "sheet_tensions".')
    dataset, ax = result.dataset, axes_or_new(ax)
    order = result.drive.path.order[:: int(dataset["running_sense"])]
    lengths = dataset["span_length"].values[order]
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    place = np.stack([ends[:-1], ends[1:]], axis=1).ravel()
    for number, row in enumerate(dataset["row"].values):
        at = dataset.isel(row=number)
        sides = [at[name].values[order] for name in ("tension_at_start", "tension_at_end")]
        ax.plot(place, np.stack(sides, axis=1).ravel(), color=color(number), linestyle=dash(number), label=str(row))
    for end in ends:
        ax.axvline(end, color=INK, linewidth=0.5, alpha=0.3)
    names = [pair[:: int(dataset["running_sense"])] for pair in (result.drive.spans[one] for one in order)]
    above = ax.secondary_xaxis("top")
    above.set_xticks(ends, [names[0][0], *(pair[1] for pair in names)], rotation=30, ha="left")
    ax.set(xlabel="Length along the line [m]", ylabel="Tension [N]", ylim=(0.0, None))
    if dataset.sizes["row"] > 1:
        name_lines(ax)
    return ax


def _speed_label(result: Result) -> str:
    return f"{result.dataset['speed'].attrs['long_name']} [rpm]"


_HISTORIES = {"tension": ("Tension [N]", 1.0), "bending_strain": ("Bending strain inside [%]", 100.0)}
"""Variables over a turn, with their labels and factors."""
_MAX_ROWS = 6
"""Rows of the table that are drawn: those with most damage."""
_GROUP_WIDTH = 0.8
"""Width of the bars of a pulley, over the distance from one pulley to the next: the rest is a gap."""


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out both panels."""
    page = panels(rows([partial(draw, result, name) for name in _HISTORIES]), sharey=False)
    name_once(page)
    return page


@figure(always, _both, of=("life",))
def belt_history(result: Result, variable: str = "tension", *, ax: Axes | None = None) -> Axes:
    """Draw the tension or the bending strain that a material point of the belt meets over a turn.

    Lines are rows of the duty table, at most the six with the largest damage. Names of pulleys stand over their arcs.

    Parameters
    ----------
    result : Result
        Of `life`.
    variable : str
        "tension" or "bending_strain".
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable.

    Examples
    --------
    >>> line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    >>> found = bd.life(drive.replace(belt=drive.belt.replace(cord_fatigue=line)))
    >>> bd.plot.belt_history(found).get_ylabel()
    'Tension [N]'
    """
    if variable not in _HISTORIES:
        raise ModelError(f"variable = {variable!r} is no history of the belt. Choose one of {', '.join(_HISTORIES)}.")
    dataset, ax = result.dataset, axes_or_new(ax)
    title, factor = _HISTORIES[variable]
    place = dataset["place"].values
    damage = next(dataset[name] for name in ("cord_damage_rate", "rib_damage_rate") if name in dataset)
    worst = np.argsort(-np.nan_to_num(damage.values))[:_MAX_ROWS]
    for number, row in enumerate(sorted(worst.tolist())):
        label = f"row {int(dataset['row'][row])}" if dataset.sizes["row"] > 1 else None
        ax.plot(place, factor * dataset[variable].values[row], color=color(number), linestyle=dash(number), label=label)
    for name, at in zip(dataset["pulley"].values, dataset["arc_place"].values[worst[0]], strict=True):
        if np.isfinite(at):
            ax.axvline(at, color=INK, linewidth=0.5, linestyle=dash(2))
            over = ax.get_xaxis_transform()
            ax.text(at, 0.98, str(name), transform=over, rotation=90, ha="right", va="top", fontsize=8, color=INK)
    ax.set(xlabel="Length of belt passed [turns]", ylabel=title, xlim=(0.0, 1.0))
    if dataset.sizes["row"] > 1:
        name_lines(ax)
    return ax


@figure(always, of=("life",))
def damage_shares(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the share of each pulley in the damage of cords and ribs.

    Parameters
    ----------
    result : Result
        Of `life`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
    >>> found = bd.life(drive.replace(belt=drive.belt.replace(cord_fatigue=line)))
    >>> bd.plot.damage_shares(found).get_ylabel()
    'Share in the damage [%]'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    names = [str(name) for name in dataset["pulley"].values]
    known = [what for what in ("cord", "rib") if f"{what}_share" in dataset]
    width, places = _GROUP_WIDTH / max(len(known), 1), np.arange(len(names))
    for number, what in enumerate(known):
        left = places + (number - 0.5 * (len(known) - 1)) * width
        ax.bar(left, 100.0 * dataset[f"{what}_share"].values, width, color=color(number), label=f"{what}s")
    ax.set_xticks(places, names)
    ax.set(ylabel="Share in the damage [%]")
    ax.grid(visible=False, axis="x")
    name_lines(ax)
    return ax

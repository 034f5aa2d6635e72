"""Figures of the pulleys: hub loads, slip, slip safety and powers."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.projections.polar import PolarAxes
from matplotlib.ticker import MaxNLocator

from beltdyn.errors import ModelError
from beltdyn.results import Balance, Run, derived, summarize
from beltdyn.results.cycles import mean_window
from beltdyn.results.incidents import GROSS_SLIP
from beltdyn.results.summary import means_of
from beltdyn.show.plot.figures import Choice, figure, over_time, over_turns, slipping, turning_at_the_end
from beltdyn.show.plot.headline import names_of_results
from beltdyn.show.plot.history import draw_limits, envelope, lines, mark_incidents
from beltdyn.show.plot.print_style import prints
from beltdyn.show.plot.style import (
    INK,
    POLAR_SIZE,
    axes_or_new,
    color,
    label,
    name_lines,
    new_figure,
    note,
    polar_or_new,
    shade,
)

# Power losses by cause, of one run and of several

_GROUP_HEIGHT = 0.8
"""Height of the bars of a cause, over the distance from one cause to the next."""
_POWER_LETTER_SIZE = 8.0
"""Size of the powers behind the bars of several runs, points: the bars are thinner than those of one run."""
_NEGLIGIBLE_LOSS = 1e-3
"""Part of the largest loss below which one is left out."""


def _losses_of_several(runs: Sequence[Run], ax: Axes | None) -> Axes:
    """Draw the losses of runs below each other, cause by cause."""
    ax = axes_or_new(ax)
    for run in runs:
        run.require_output()
    balances = [means_of(run).balance for run in runs]
    causes = _worth_drawing(balances)
    height = _GROUP_HEIGHT / len(runs)
    for number, (balance, name) in enumerate(zip(balances, names_of_results(runs), strict=True)):
        places = [row - 0.5 * _GROUP_HEIGHT + (number + 0.5) * height for row in range(len(causes))]
        powers = [balance.losses.get(cause, 0.0) for cause in causes]
        ax.barh(places, powers, height=0.9 * height, color=color(number), label=name)
        for place, power in zip(places, powers, strict=True):
            _write(ax, balance, power, (max(power, 0.0), place), _POWER_LETTER_SIZE)
    _frame(ax, causes)
    ax.set_xlabel("Power lost [W] and its share of the power input, means at the end of each run")
    name_lines(ax)
    return ax


@figure(turning_at_the_end, compares=_losses_of_several)
def losses(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the power lost by cause: means over the end of the run, as in the summary.

    Friction and contact damping are divided among the pulleys, for a single run. A negative loss is a numerical error.
    Losses below a thousandth of the largest are left out.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.losses(run).get_xlabel().partition(" and ")[0]
    'Power lost [W]'
    """
    run.require_output()
    ax = axes_or_new(ax)
    over = mean_window(run.dataset, run.prepared)
    balance = means_of(run).balance
    by_pulley = derived.pulley_powers(run).map(lambda power: xr.DataArray(over.mean_of(power.values), dims="pulley"))
    by_pulley = by_pulley.assign_coords(pulley=run.dataset["pulley"])
    parts = {"friction": by_pulley["friction_power"], "contact damping": by_pulley["contact_damping_power"]}
    drawn = {cause: balance.losses[cause] for cause in _worth_drawing([balance])}
    for row, (cause, power) in enumerate(drawn.items()):
        ends = _stack(ax, row, parts[cause]) if cause in parts else (min(power, 0.0), max(power, 0.0))
        if cause not in parts:
            ax.barh(row, power, color="0.55", height=0.6)
        _write(ax, balance, power, (max(ends), row))
    _frame(ax, list(drawn))
    ax.set_xlabel(f"Power lost [W] and its share of the power input, mean from {over.start:.4g} to {over.end:.4g} s")
    name_lines(ax)
    return ax


def _worth_drawing(balances: Sequence[Balance]) -> list[str]:
    """Causes that are at least a thousandth of the largest one anywhere, losses or gains."""
    powers = {cause: 0.0 for balance in balances for cause in balance.losses}
    for cause in powers:
        powers[cause] = max(abs(balance.losses.get(cause, 0.0)) for balance in balances)
    largest = max(powers.values(), default=0.0)
    return [cause for cause, power in powers.items() if power > _NEGLIGIBLE_LOSS * largest]


_TEXT_MARGIN, _TEXT_MARGIN_IN_PRINT = 0.3, 0.6
"""Room for the power behind the longest bar, over its length."""


def _frame(ax: Axes, causes: Sequence[str]) -> None:
    """Name the rows, from the top, with a line at zero."""
    ax.set_yticks(range(len(causes)), causes)
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    ax.margins(x=_TEXT_MARGIN_IN_PRINT if prints() else _TEXT_MARGIN)
    if ax.dataLim.x0 >= 0.0:
        ax.set_xlim(left=0.0)
    ax.axvline(0.0, color=INK, linewidth=0.8)


def _write(ax: Axes, balance: Balance, power: float, place: tuple[float, float], size: float | None = None) -> None:
    """Write a power, W, and its share of the power input, behind a bar."""
    share = f" ({power / balance.power_in:z.2%})" if balance.power_in > 0.0 else ""
    ax.annotate(f"{power:.4g} W{share}", place, xytext=(4, 0), textcoords="offset points", va="center", fontsize=size)


def _stack(ax: Axes, row: int, powers: xr.DataArray) -> tuple[float, float]:
    """Draw bars of the pulleys on end, losses to the right of zero and gains to its left; give where both end."""
    left, right = 0.0, 0.0
    for number, (name, power) in enumerate(zip(powers["pulley"].values, powers.values.tolist(), strict=True)):
        begin = left if power < 0.0 else right
        ax.barh(row, power, left=begin, color=color(number), height=0.6, label=str(name) if row == 0 else None)
        left, right = min(left, begin + power), max(right, begin + power)
    return left, right


_MAX_SAFETY = 10.0
"""Slip safety at the upper end of the axis, 1: pulleys that are mostly above it are named, not drawn."""
_RUNNING_SPEED_SHARE = 0.98
"""Part of its mean speed at the end from which on the driver counts as running."""
_RADIAL_INTERVALS = 4
"""Intervals of the radial axis at most: its numbers stand close together along one radius."""
_TOP: dict[str, Any] = {"ha": "right", "va": "top", "fontsize": 8}
"""Alignment of text in the upper right corner."""


@figure(slipping, compares=True)
def slip(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the slip of the pulleys against the driver over time, with its elastic creep dotted.

    Values are means over a turn of the belt and a period of other excitation; the numbers are those of the summary.
    During gross slip all creep is dotted, and the time is shaded. The axis is scaled to the running drive and may cut
    off slip at the start.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.slip(run).get_ylabel()
    'Slip [%]'
    """
    parts, summary = derived.slips(run), summarize(run)
    names = [f"{one.name} {one.slip:z.3%}" if np.isfinite(one.slip) else one.name for one in summary.pulleys]
    ax = lines(parts["slip"], axes_or_new(ax), names)
    notes = [f"numbers: means at the end, from {summary.start:.4g} to {summary.end:.4g} s"]
    slides = bool((np.abs(parts["sliding"]) > 0.0).any())
    inner = parts["creep" if slides else "elastic_creep"]
    for number in range(parts.sizes["pulley"]):
        ax.plot(inner["time"], inner[:, number], color=color(number), linewidth=0.8, linestyle=":")
    notes.append(
        "dotted: creep; the rest is sliding of the whole arc"
        if slides
        else "dotted: elastic creep; the rest is bending and the slope of the friction law"
    )
    note(ax, "\n".join(notes))
    _limit(ax, parts["slip"], _after_start(run, summary.start))
    draw_limits(run, ax, "largest_slip")
    return mark_incidents(run, ax, (GROSS_SLIP,))


def _after_start(run: Run, latest: float) -> float:
    """When the start is over, s: the driver runs, and a tenth of the rest has gone by; before means begin."""
    time, speed = run.dataset["time"].values, np.abs(run.dataset["pulley_speed"].values[:, run.drive.reference])
    reached = time[np.argmax(speed >= _RUNNING_SPEED_SHARE * speed[time >= latest].mean())]
    return float(min(reached + 0.1 * (time[-1] - reached), latest))


def _grips_over_time(run: Run) -> bool:
    """Whether a belt without teeth is held by friction in a run with more than one output."""
    return over_time(run) and run.drive.belt.teeth is None


@figure(_grips_over_time, compares=True)
def slip_safety(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the factor on all loads at which each pulley reaches gross slip, over time; below 1 the belt slides.

    Lightly loaded pulleys, with a slip safety mostly above ten, are named but not drawn. An oscillating slip safety is
    drawn as a band between its minimum and maximum within a hundredth of the time, with its median.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes; values above ten are cut off.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.slip_safety(run).get_ylabel()
    'Slip safety'
    """
    safeties = derived.slip_safety(run)
    safeties, names = safeties.where(np.isfinite(safeties)), safeties["pulley"].values
    seen = (safeties < _MAX_SAFETY).any("time").values
    loaded = (safeties.median("time") < _MAX_SAFETY).values
    shown = loaded if loaded.any() else seen
    ax = envelope(safeties.where(xr.DataArray(shown, dims="pulley")), axes_or_new(ax))
    shade(ax, 0.0, 1.0, "gross slip")
    if not shown.all():
        above = ", ".join(map(str, names[~shown]))
        words = f"above {_MAX_SAFETY:g}: {above} ↑"
        ax.annotate(words, (1.0, 1.0), (-4, -4), "axes fraction", "offset points", **_TOP)
    draw_limits(run, ax, "least_slip_safety")
    ax.set_ylim(0.0, _MAX_SAFETY)
    return ax


@figure(over_turns, compares=True)
def powers(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the power into the drive at each shaft over time; negative at a load.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.powers(run).get_ylabel()
    'Power from the shaft [W]'
    """
    return lines(derived.pulley_powers(run)["power_in"], axes_or_new(ax))


def _one_polar_panel(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a figure of one polar panel."""
    page = new_figure(POLAR_SIZE)
    draw(run, choice.pulley, ax=page.add_subplot(projection="polar"))
    return page


@figure(over_time, _one_polar_panel)
def hub_loads(run: Run, pulley: str | int | None = None, ax: Axes | None = None) -> Axes:
    """Draw the forces of the belt on pulleys over their direction (polar diagram).

    A dot marks the last output. The first half of the run is drawn pale.

    Parameters
    ----------
    run : Run
        The run.
    pulley : str or int, optional
        Name or number of the pulley; all of them by default.
    ax : Axes, optional
        Where to draw: polar axes; a new figure by default.

    Returns
    -------
    Axes
        Polar axes.

    Raises
    ------
    ModelError
        If there is no such pulley, the axes are not polar, or the run holds no output.

    Examples
    --------
    >>> bd.plot.hub_loads(run).name
    'polar'
    """
    ax = polar_or_new(ax)
    if not isinstance(ax, PolarAxes):
        raise ModelError('hub loads are drawn over their direction: give polar axes (projection="polar").')
    loads = derived.hub_loads(run)
    numbers = range(len(run.drive.pulleys)) if pulley is None else [derived.pulley_number(run, pulley)]
    half = loads.sizes["time"] // 2
    for number in numbers:
        of_pulley = loads.isel(pulley=number)
        angle, load = of_pulley["hub_direction"].values, of_pulley["hub_load"].values
        ax.plot(angle[: half + 1], load[: half + 1], color=color(number), linewidth=0.6, alpha=0.35)
        ax.plot(angle[half:], load[half:], color=color(number), linewidth=1.2)
        name = run.drive.pulleys[number].name
        ax.plot(angle[-1:], load[-1:], color=color(number), marker="o", markersize=5.0, label=name, linestyle="")
    ax.set_rmin(0.0)
    ax.yaxis.set_major_locator(MaxNLocator(_RADIAL_INTERVALS))
    ax.tick_params(axis="y", labelsize=8)
    ax.set_rlabel_position(_widest_gap(loads["hub_direction"].values[half:, numbers]))
    ax.set_title(label(loads["hub_load"]), loc="left")
    ax.legend(loc="center left", bbox_to_anchor=(1.12, 0.5))
    return ax


@figure(over_time, compares=True)
def hub_load_sizes(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the magnitudes of the hub loads over time; the numbers are their means at the end of the run.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds no output.

    Examples
    --------
    >>> bd.plot.hub_load_sizes(run).get_ylabel()
    'Hub load [N]'
    """
    run.require_output()
    loads = derived.hub_loads(run)["hub_load"]
    over = mean_window(run.dataset, run.prepared)
    means = over.mean_of(loads.values)
    names = [f"{pulley.name} {mean:.4g} N" for pulley, mean in zip(run.drive.pulleys, means, strict=True)]
    ax = lines(loads, axes_or_new(ax), names)
    draw_limits(run, ax, "largest_hub_load")
    ax.set_ylim(bottom=0.0)
    note(ax, f"numbers: means at the end, from {over.start:.4g} to {over.end:.4g} s")
    return ax


def _widest_gap(directions: np.ndarray) -> float:
    """Middle of the widest sector without a direction, degrees."""
    angles = np.sort(np.degrees(directions), axis=None)
    gaps = np.diff(angles, append=angles[0] + 360.0)
    widest = int(gaps.argmax())
    return float(angles[widest] + 0.5 * gaps[widest])


def _limit(ax: Axes, variable: xr.DataArray, from_: float) -> None:
    """Let what is drawn from an instant on fill the figure, with zero in it: the start may be much larger."""
    known = variable.values[variable["time"].values >= from_]
    known = known[np.isfinite(known)]
    if known.size:
        low, high = min(float(known.min()), 0.0), max(float(known.max()), 0.0)
        margin = 0.1 * max(high - low, 1e-3)
        ax.set_ylim(low - margin, high + margin)

"""Power losses by cause, of one run and of several."""

from collections.abc import Sequence

import xarray as xr
from matplotlib.axes import Axes

from beltdyn.plot.legends import name_lines
from beltdyn.plot.registry import figure, over_turns
from beltdyn.plot.several import names_of_results
from beltdyn.plot.style import INK, axes_or_new, color
from beltdyn.results import Balance, Run, derived, power_balance
from beltdyn.results.cycles import mean_window

_ROOM = 0.8
"""Height of the bars of a cause, over the distance from one cause to the next."""
_SMALL = 8.0
_NEGLIGIBLE = 1e-3
"""Part of the largest loss below which one is left out."""


def _losses_of_several(runs: Sequence[Run], ax: Axes | None) -> Axes:
    """Draw the losses of runs below each other, cause by cause."""
    ax = axes_or_new(ax)
    for run in runs:
        run.require_output()
    balances = [power_balance(run.dataset, mean_window(run.dataset, run.drive)) for run in runs]
    causes = _worth_drawing(balances)
    height = _ROOM / len(runs)
    for number, (balance, name) in enumerate(zip(balances, names_of_results(runs), strict=True)):
        places = [row - 0.5 * _ROOM + (number + 0.5) * height for row in range(len(causes))]
        powers = [balance.losses.get(cause, 0.0) for cause in causes]
        ax.barh(places, powers, height=0.9 * height, color=color(number), label=name)
        for place, power in zip(places, powers, strict=True):
            _write(ax, balance, power, (max(power, 0.0), place), _SMALL)
    _frame(ax, causes)
    ax.set_xlabel("Power lost [W] and its share of the power put in, means at the end of each run")
    name_lines(ax)
    return ax


@figure(over_turns, compares=_losses_of_several)
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
    over = mean_window(run.dataset, run.drive)
    balance = power_balance(run.dataset, over)
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
    ax.set_xlabel(f"Power lost [W] and its share of the power put in, mean from {over.start:.4g} to {over.end:.4g} s")
    name_lines(ax)
    return ax


def _worth_drawing(balances: Sequence[Balance]) -> list[str]:
    """Causes that are at least a thousandth of the largest one anywhere, losses or gains."""
    powers = {cause: 0.0 for balance in balances for cause in balance.losses}
    for cause in powers:
        powers[cause] = max(abs(balance.losses.get(cause, 0.0)) for balance in balances)
    largest = max(powers.values(), default=0.0)
    return [cause for cause, power in powers.items() if power > _NEGLIGIBLE * largest]


def _frame(ax: Axes, causes: Sequence[str]) -> None:
    """Name the rows, from the top, with a line at zero."""
    ax.set_yticks(range(len(causes)), causes)
    ax.invert_yaxis()
    ax.grid(axis="y", visible=False)
    ax.margins(x=0.3)
    if ax.dataLim.x0 >= 0.0:
        ax.set_xlim(left=0.0)
    ax.axvline(0.0, color=INK, linewidth=0.8)


def _write(ax: Axes, balance: Balance, power: float, place: tuple[float, float], size: float | None = None) -> None:
    """Write a power, W, and its share of what is put in, behind a bar."""
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

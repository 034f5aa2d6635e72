"""Figures of a drive sheet over the speed of the driver."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.parts.quantity import RPM
from beltdyn.results import Result
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import always, figure
from beltdyn.show.plot.style import INK, axes_or_new, color, dash

_HIGHEST_SAFETY = 10.0
_MOST = 6
"""Pulleys or spans that are drawn: those nearest to a limit."""


@figure(always, of=("sheet",))
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

    Examples
    --------
    >>> found = bd.sheet(bd.example("alternator_drive"), points=4)
    >>> bd.plot.sheet_slip_safety(found).get_ylabel()
    'Slip safety'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    speed = RPM * dataset["speed"].values
    nominal, least = (dataset[f"{name}_over_speed"].values for name in ("slip_safety", "least_slip_safety"))
    lowest = np.nan_to_num(np.fmin.reduce(least, axis=0), nan=np.inf)
    worst = np.argsort(lowest, kind="stable")[:_MOST]
    safe = _HIGHEST_SAFETY <= lowest[worst[0]] < np.inf
    top = 1.1 * float(np.nanmax(nominal[:, worst[0]])) if safe else _HIGHEST_SAFETY
    loaded = worst[lowest[worst] < top].tolist()
    for number, pulley in enumerate(sorted(loaded)):
        tint, name = color(number), str(dataset["pulley"].values[pulley])
        ax.plot(speed, nominal[:, pulley], color=tint, linestyle=dash(number), label=name)
        ax.fill_between(speed, least[:, pulley], nominal[:, pulley], color=tint, alpha=0.15, linewidth=0.0)
    ax.axhline(1.0, color=INK, linewidth=0.8)
    ax.set(xlabel=_speed_label(result), ylabel="Slip safety", ylim=(0.0, top))
    name_lines(ax)
    return ax


@figure(always, of=("sheet",))
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

    Examples
    --------
    >>> found = bd.sheet(bd.example("alternator_drive"), points=4)
    >>> bd.plot.sheet_tensions(found).get_ylabel()
    'Span tension [N]'
    """
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


def _speed_label(result: Result) -> str:
    return f"{result.dataset['speed'].attrs['long_name']} [rpm]"

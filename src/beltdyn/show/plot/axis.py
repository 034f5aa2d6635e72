"""Figures of linear axes: error of position over time; stiffness and frequency over the stroke."""

from collections.abc import Callable
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Result, Run
from beltdyn.show.plot.figures import Choice, always, figure, over_time
from beltdyn.show.plot.style import axes_or_new, color, name_once, panels, rows


def _carries_over_time(run: Run) -> bool:
    return "carriage_error" in run.dataset and over_time(run)


@figure(_carries_over_time, compares=True)
def carriage_error(run: Run, ax: Axes | None = None) -> Axes:
    """Draw how far the carriage of a linear axis is ahead of its driver over time, in micrometers.

    The driver's way is that of its angle at the pitch radius; a belt that stretches and plays in its grooves lags.

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
        If the drive has no carriage.

    Examples
    --------
    >>> short = bd.example("printer_axis").with_({"simulation.duration": 0.02})
    >>> bd.plot.carriage_error(bd.simulate(short)).get_ylabel()
    'Carriage ahead of the driver [µm]'
    """
    if "carriage_error" not in run.dataset:
        raise ModelError("this drive has no carriage. Choose another figure.")
    ax, dataset = axes_or_new(ax), run.dataset
    ax.plot(
        dataset["time"].values,
        1e6 * dataset["carriage_error"].values[:, 0],
        color=color(0),
        label="carriage",
    )
    ax.set(xlabel="Time [s]", ylabel="Carriage ahead of the driver [µm]")
    return ax


_OVER_STROKE = {"stiffness": ("Stiffness [N/mm]", 1e-3), "frequency": ("Natural frequency [Hz]", 1.0)}
"""Variable -> label of its axis, and factor."""


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out both panels."""
    page = panels(rows([partial(draw, result, name) for name in _OVER_STROKE]), sharey=False)
    name_once(page)
    return page


@figure(always, _both, of=("stroke",), compares=True)
def stroke(result: Result, variable: str = "stiffness", ax: Axes | None = None) -> Axes:
    """Draw stiffness or natural frequency of a linear axis over its stroke.

    Parameters
    ----------
    result : Result
        Of `stroke`.
    variable : str
        "stiffness" or "frequency".
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
    >>> found = bd.stroke(bd.example("printer_axis"), places="0, 80 mm")
    >>> bd.plot.stroke(found).get_ylabel()
    'Stiffness [N/mm]'
    """
    if variable not in _OVER_STROKE:
        raise ModelError(
            f"variable = {variable!r} is not drawn over a stroke. Choose one of {', '.join(_OVER_STROKE)}."
        )
    ax, dataset, (title, factor) = axes_or_new(ax), result.dataset, _OVER_STROKE[variable]
    ax.plot(1e3 * dataset["place"].values, factor * dataset[variable].values, color=color(0), label="carriage")
    ax.set(xlabel="Way of the carriage [mm]", ylabel=title)
    ax.set_ylim(bottom=0.0)
    return ax

"""Figures of linear axes: the way of the carriage and its error over time, stiffness and frequency over the stroke."""

from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Result, Run
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import always, figure, over_time
from beltdyn.show.plot.style import axes_or_new, color, dash


def _carries_over_time(run: Run) -> bool:
    return "carriage_error" in run.dataset and over_time(run)


@figure(_carries_over_time)
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
    ax.plot(dataset["time"].values, 1e6 * dataset["carriage_error"].values[:, 0], color=color(0))
    ax.set(xlabel="Time [s]", ylabel="Carriage ahead of the driver [µm]")
    return ax


@figure(always, of=("stroke",))
def stroke(result: Result, ax: Axes | None = None) -> Axes:
    """Draw stiffness and natural frequency of a linear axis over its stroke.

    Parameters
    ----------
    result : Result
        Of `stroke`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes of the stiffness; those of the frequency are at the right.

    Examples
    --------
    >>> found = bd.stroke(bd.example("printer_axis"), places="0, 80 mm")
    >>> bd.plot.stroke(found).get_ylabel()
    'Stiffness [N/mm]'
    """
    ax, dataset = axes_or_new(ax), result.dataset
    way = 1e3 * dataset["place"].values
    ax.plot(way, 1e-3 * dataset["stiffness"].values, color=color(0), label="stiffness")
    ax.set(xlabel="Way of the carriage [mm]", ylabel="Stiffness [N/mm]")
    right = ax.twinx()
    right.plot(way, dataset["frequency"].values, color=color(1), linestyle=dash(1), label="natural frequency")
    right.set(ylabel="Natural frequency [Hz]")
    right.grid(visible=False)
    name_lines(ax)
    return ax

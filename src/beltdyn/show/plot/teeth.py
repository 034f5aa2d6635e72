"""Figures of toothed drives: load sharing, transmission error and its orders."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.results import Result, Run, derived, tooth_loads
from beltdyn.show.plot.legends import name_lines
from beltdyn.show.plot.registry import figure, over_time
from beltdyn.show.plot.style import axes_or_new, color, dash

_MULTIPLES = 3
"""Multiples of the meshing order that are marked."""
_ORDERS = 1.15
"""Largest order shown, over the last one marked."""


def _in_mesh(run: Run) -> bool:
    """Whether teeth are in mesh at the end."""
    return _with_teeth(run) and run.dataset.sizes["time"] > 0 and bool(tooth_loads(run))


def _with_teeth(result: Result) -> bool:
    """Whether the belt of a result has teeth."""
    return result.drive.belt.teeth is not None


def _turns_with_teeth(run: Run) -> bool:
    return _with_teeth(run) and over_time(run)


@figure(_in_mesh)
def load_sharing(run: Run, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw the force on each tooth in mesh over its place on the arc.

    Parameters
    ----------
    run : Run
        A run or steady running of a belt with teeth.
    time : float, optional
        Instant of an output along the belt, s; the last one by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the belt has no teeth.

    Examples
    --------
    >>> bd.plot.load_sharing(bd.steady_state(bd.example("timing_drive"))).get_ylabel()
    'Force of a tooth on the belt [N]'
    """
    loads = tooth_loads(run, time)
    if not loads:
        raise ModelError("the belt has no teeth in mesh. Use a run of a toothed belt.")
    ax = axes_or_new(ax)
    names = [pulley.name for pulley in run.drive.pulleys]
    for one in loads:
        number = names.index(one.name)
        style = {"color": color(number), "linestyle": dash(number), "marker": "o", "markersize": 4}
        ax.plot(one.places, one.loads, label=one.name, **style)  # type: ignore[arg-type]
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    ax.set(xlabel="Place on the arc from the inlet [pitches]", ylabel="Force of a tooth on the belt [N]")
    name_lines(ax)
    return ax


@figure(_turns_with_teeth)
def transmission_error(run: Run, reference: str | int | None = None, ax: Axes | None = None) -> Axes:
    """Draw the way at the pitch line by which pulleys are ahead of the ratio of the teeth, less its mean.

    Parameters
    ----------
    run : Run
        A run of a belt with teeth.
    reference : str or int, optional
        Name or number of the pulley from whose angle others are expected; the driver by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the belt has no teeth, or the reference has none.

    Examples
    --------
    >>> short = bd.example("timing_drive").with_({"simulation.duration": 0.02})
    >>> bd.plot.transmission_error(bd.simulate(short)).get_ylabel()
    'Transmission error, less its mean [µm]'
    """
    error = derived.transmission_error(run, reference)
    ax = axes_or_new(ax)
    for name in _moving(error.values, error["pulley"].values.tolist()):
        number = run.drive.number_of(name)
        own = 1e6 * error.sel(pulley=name).values
        ax.plot(error["time"].values, own - own.mean(), color=color(number), linestyle=dash(number), label=name)
    ax.set(xlabel="Time [s]", ylabel="Transmission error, less its mean [µm]")
    name_lines(ax)
    return ax


@figure()
def transmission_orders(run: Run, reference: str | int | None = None, ax: Axes | None = None) -> Axes:
    """Draw amplitudes of the transmission error over orders of the reference, with the meshing order and its multiples.

    The second half of the run is taken, in whole turns of the reference. Amplitudes are those of sinusoids.

    Parameters
    ----------
    run : Run
        A run of a belt with teeth of four turns or more.
    reference : str or int, optional
        Name or number of the pulley from whose angle others are expected; the driver by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the belt has no teeth, the reference has none, or the run is too short.

    Examples
    --------
    >>> bd.plot.transmission_orders(run)  # its belt has no teeth
    Traceback (most recent call last):
    beltdyn.errors.ModelError: the belt has no teeth, which a transmission error needs. Use a run of a toothed belt.
    """
    times = run.dataset["time"].values
    error = derived.transmission_error(run, reference, start=0.5 * (times[0] + times[-1]))
    names = error["pulley"].values.tolist()
    moving = _moving(error.values, names)
    first = run.drive.number_of(next(name for name in names if name not in moving))
    angle = run.dataset["pulley_angle"].sel(time=error["time"])[:, first]
    meshing = run.drive.pulleys[first].teeth or 0
    ax = axes_or_new(ax)
    for name in moving:
        number = run.drive.number_of(name)
        found = derived.order_spectrum(error.sel(pulley=name), angle)
        shown = found["order"].values <= _ORDERS * _MULTIPLES * meshing
        ax.semilogy(found["order"].values[shown], 1e6 * found.values[shown], color=color(number), label=name)
    for multiple in range(1, _MULTIPLES + 1):
        ax.axvline(multiple * meshing, color="0.6", linewidth=0.8, linestyle="--", zorder=1)
    ax.set(
        xlabel=f"Order of {run.drive.pulleys[first].name}; dashed: meshing order {meshing} and multiples",
        ylabel="Amplitude of the transmission error [µm]",
    )
    name_lines(ax)
    return ax


def _moving(error: np.ndarray, names: list[str]) -> list[str]:
    """Names of pulleys whose error is not zero throughout, as it is of the reference."""
    return [name for number, name in enumerate(names) if np.any(error[:, number] != 0.0)]

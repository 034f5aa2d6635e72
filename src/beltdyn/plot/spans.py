"""Figures of the spans and tensioners."""

import numpy as np
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.plot.history import lines
from beltdyn.plot.legends import name_lines
from beltdyn.plot.registry import figure, over_time
from beltdyn.plot.style import axes_or_new, color, dash, label, set_log_scale
from beltdyn.plot.view import draw_limit
from beltdyn.results import Run, derived

_FLOOR = 1e-6
"""Part of the largest amplitude below which a spectrum is cut off."""


@figure(compares=True)
def mid_spans(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the transverse displacements of the spans at their middle over time.

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
    >>> bd.plot.mid_spans(run).get_ylabel()
    'Mid-span displacement [mm]'
    """
    displacement = derived.mid_span_displacements(run)
    return lines((1e3 * displacement).assign_attrs(displacement.attrs | {"units": "mm"}), axes_or_new(ax))


@figure(compares=True)
def tension_spectrum(run: Run, start: float | None = None, end: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw the amplitude spectra of the span tensions.

    Parameters
    ----------
    run : Run
        The run.
    start, end : float, optional
        From when to when, s; by default the second half of the run, when it is more likely to be steady.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds too few outputs, or nothing for spectra.

    Examples
    --------
    >>> fine = drive.simulation.replace(duration=0.01, output_interval=0.0001)
    >>> bd.plot.tension_spectrum(bd.simulate(drive.replace(simulation=fine)), start=0.0).get_xlabel()
    'Frequency [Hz]'
    """
    run.require_output()
    run.require("filtered_span_tension")
    time = run.dataset["time"].values
    start = 0.5 * (time[0] + time[-1]) if start is None else start
    tension = run.dataset["filtered_span_tension"].sel(filtered_time=slice(start, end))
    spectrum = derived.amplitude_spectrum(tension)
    ax = axes_or_new(ax)
    for number, name in enumerate(spectrum["span"].values):
        amplitude = spectrum[1:, number]
        ax.plot(amplitude["frequency"], amplitude, color=color(number), linestyle=dash(number), label=str(name), lw=1.2)
    highest = float(spectrum.max())
    ax.set(xlabel=label(spectrum["frequency"]), ylabel=label(spectrum))
    set_log_scale(ax)
    ax.set_ylim(bottom=max(_FLOOR * highest, float(np.percentile(spectrum[1:], 1.0))))
    name_lines(ax)
    return ax


def _moves_over_time(run: Run) -> bool:
    return over_time(run) and "tensioner_position" in run.dataset


@figure(_moves_over_time, compares=True)
def tensioners(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the positions of the tensioners over time: mm along a line, degrees of an arm.

    Dashed lines are stops; one that is far off is named at the edge.

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
        If the drive has no tensioner that moves.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> sprung = drive.replace(tensioner=[slide], simulation=drive.simulation.replace(duration=0.005))
    >>> bd.plot.tensioners(bd.simulate(sprung)).get_ylabel()
    'Tensioner position [mm]'
    """
    if "tensioner_position" not in run.dataset:
        raise ModelError("this drive has no moving tensioner. Choose another figure.")
    position = run.dataset["tensioner_position"]
    rotary = np.array([one.turns for one in run.drive.moving_tensioners])
    units = [name for name, there in (("mm", not rotary.all()), ("°", rotary.any())) if there]
    factors = np.where(rotary, np.degrees(1.0), 1e3)
    scaled = (position * factors).assign_attrs(position.attrs | {"units": ", ".join(units)})
    ax = lines(scaled, axes_or_new(ax), pulleys=[carrier.pulley for carrier in run.drive.carriers])
    for tensioner, factor, turns in zip(run.drive.moving_tensioners, factors.tolist(), rotary, strict=True):
        for name, stop in zip(("lower", "upper"), tensioner.stops or (), strict=False):
            place = f"{factor * stop:.4g}{'°' if turns else ' mm'}"
            draw_limit(ax, factor * stop, f"{tensioner.pulley}: {name} stop {place}")
    return ax

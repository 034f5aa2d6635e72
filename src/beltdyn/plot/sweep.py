"""Figures of a run-up: spectra over speed, and orders."""

from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice, figure, on_request
from beltdyn.plot.style import axes_or_new, color, dash, label, unit
from beltdyn.results import Run, derived

_RPM = 30.0 / np.pi
_DECADES = 1e-3
_STRONGEST = 5
_HARMONICS = (1, 2, 3)
"""Multiples of the frequency at which elements pass that are marked."""
_DISTANCE = 0.4
"""Orders nearer to each other than this are one, and lower ones a trend."""


def _one_by_one(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a panel for each pulley, span or tensioner that the chosen variable is recorded for."""
    names = names_of(run, choice.variable)
    pulley = run.dataset.attrs.get("swept_pulley", 0) if choice.pulley is None else choice.pulley
    calls = [partial(draw, run, choice.variable, name, pulley) for name in names]
    return panels(rows(calls), sharey=False)


@figure(on_request, _one_by_one)
def waterfall(
    run: Run, variable: str = "span_tension", of: str | int = 0, pulley: str | int = 0, ax: Axes | None = None
) -> Axes:
    """Draw short-time spectra of a variable over the speed of a pulley.

    Dashed lines are where elements of the mesh pass, and twice and three times as often: what lies on them belongs to
    the mesh. Variables that are recorded for spectra are drawn up to where their filter keeps amplitudes.

    Parameters
    ----------
    run : Run
        A run-up.
    variable : str
        A variable over time and pulley, span or tensioner.
    of : str or int
        Name or number of the one to draw.
    pulley : str or int
        Name or number of the pulley whose speed is the vertical axis.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable or pulley, or the run holds too few outputs.
    """
    number = derived.pulley_number(run, pulley)
    values = _series(run, variable, of)
    amplitude = derived.waterfall(values, run.dataset["pulley_speed"][:, number])
    ax = axes_or_new(ax)
    highest = float(amplitude[:, 1:].max())
    mesh = ax.pcolormesh(
        amplitude["frequency"][1:],
        _RPM * amplitude["speed"],
        np.maximum(amplitude[:, 1:], _DECADES * highest),
        norm=LogNorm(_DECADES * highest, highest),
        cmap="viridis",
        shading="nearest",
        rasterized=True,
    )
    figure = ax.get_figure()
    assert figure is not None
    figure.colorbar(mesh, ax=ax, label=f"Amplitude [{unit(amplitude)}]")
    _mark_elements(ax, derived.element_order(run.drive, number), amplitude)
    ax.set(xlabel=label(amplitude["frequency"]), ylabel=f"Speed of {run.drive.pulleys[number].name} [rpm]")
    ax.set_title(f"{values.attrs['long_name']}, {values.attrs['of']}")
    ax.grid(visible=False)
    return ax


@figure(on_request, _one_by_one, compares=True)
def orders(
    run: Run, variable: str = "span_tension", of: str | int = 0, pulley: str | int = 0, ax: Axes | None = None
) -> Axes:
    """Draw the amplitudes of the strongest orders of a pulley's rotation over its speed.

    Orders at which elements of the mesh pass are named, and drawn thin and grey. Variables that are recorded for
    spectra are drawn up to the speed at which their filter keeps the order.

    Parameters
    ----------
    run : Run
        A run-up.
    variable : str
        A variable over time and pulley, span or tensioner.
    of : str or int
        Name or number of the one to draw.
    pulley : str or int
        Name or number of the pulley whose rotation counts.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable or pulley, or the run is too short.
    """
    number = derived.pulley_number(run, pulley)
    values = _series(run, variable, of)
    amplitude = derived.orders(values, run.dataset["pulley_angle"][:, number])
    ax = axes_or_new(ax)
    speed = _RPM * amplitude["speed"]
    for line, place in enumerate(_strongest(amplitude)):
        order = float(amplitude["order"][place])
        of_mesh = _multiple(order, derived.element_order(run.drive, number))
        name, tint = f"order {order:.3g}{', of the mesh' * of_mesh}", "0.6" if of_mesh else color(line)
        ax.plot(speed, amplitude[:, place], label=name, color=tint, linestyle=dash(line), lw=0.8 if of_mesh else None)
    ax.set(xlabel=f"Speed of {run.drive.pulleys[number].name} [rpm]", ylabel=f"Amplitude [{unit(amplitude)}]")
    ax.set_title(f"{values.attrs['long_name']}, {values.attrs['of']}")
    ax.set_ylim(bottom=0.0)
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return ax


def _strongest(amplitude: xr.DataArray) -> list[int]:
    """Numbers of the orders that stand out most at some speed, ascending."""
    from scipy.signal import find_peaks

    highest = np.where(amplitude["order"] < _DISTANCE, 0.0, amplitude.max("speed").fillna(0.0).values)
    apart = max(1, round(_DISTANCE / float(amplitude["order"][1])))
    peaks, _ = find_peaks(highest, distance=apart)
    return sorted(peaks[np.argsort(highest[peaks])[::-1][:_STRONGEST]].tolist())


def _multiple(order: float, elements: float) -> bool:
    """Whether an order is one, two or three times that at which elements pass."""
    return any(abs(order - k * elements) < _DISTANCE for k in _HARMONICS)


def _mark_elements(ax: Axes, elements: float, amplitude: xr.DataArray) -> None:
    """Draw lines where elements pass."""
    speed, highest = amplitude["speed"].values, float(amplitude["frequency"][-1])
    for k in _HARMONICS:
        frequency = k * elements * speed / (2.0 * np.pi)
        shown = frequency <= highest
        if np.any(shown):
            ax.plot(frequency[shown], _RPM * speed[shown], color="w", linestyle="--", linewidth=0.8)
            place = frequency[shown][-1], _RPM * speed[shown][-1]
            words = "elements pass" if k == 1 else f"{k} ×"
            ax.annotate(words, place, (-3, -3), "data", "offset points", color="w", fontsize=8, ha="right", va="top")


def names_of(run: Run, variable: str) -> list[str]:
    """Give the names of what a variable over time is recorded for.

    Parameters
    ----------
    run : Run
        The run.
    variable : str
        Its name.

    Returns
    -------
    list of str
        Of pulleys, spans or tensioners.

    Raises
    ------
    ModelError
        If there is no such variable.
    """
    known = [
        str(name) for name, values in run.dataset.data_vars.items() if values.ndim == 2 and values.dims[0] == "time"
    ]
    named = [name for name in known if run.dataset[name].dims[1] in run.dataset.coords]
    if variable not in named:
        raise ModelError(f"variable = {variable!r} is not known over time. Those are: {', '.join(named)}.")
    values = run.dataset[variable]
    return [str(name) for name in values[values.dims[1]].values]


def _series(run: Run, variable: str, of: str | int) -> xr.DataArray:
    """One variable over time, filtered if it was recorded so, with the name of what it belongs to."""
    run.require_output()
    names = names_of(run, variable)
    if of in names:
        of = names.index(str(of))
    if not isinstance(of, int) or not 0 <= of < len(names):
        raise ModelError(f"of = {of!r} is not in this drive. Choose one of {', '.join(names)}.")
    filtered = f"filtered_{variable}"
    return run.dataset[filtered if filtered in run.dataset else variable][:, of].assign_attrs(of=names[of])

"""Figures of a run-up: spectra over speed, and orders."""

from collections.abc import Callable, Sequence
from functools import partial
from math import isfinite

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.quantity import RPM, SHOWN_UNITS
from beltdyn.results import Run, derived
from beltdyn.show.plot.figures import Choice, figure, on_request
from beltdyn.show.plot.style import INK, axes_or_new, color, dash, label, name_lines, name_once, panels, rows, unit

# A variable over time of one pulley, span or tensioner, in the unit of run-up figures

HUB_LOAD = "hub_load"
"""Magnitude of the hub force."""

_SHOWN = {**SHOWN_UNITS, "m": ("mm", 1e3)}
"""Unit of a variable -> the one that is shown, and the factor on its numbers."""


def names_of(run: Run, variable: str) -> list[str]:
    """Give the names of what a variable over time is recorded for."""
    known = {
        str(name): str(values.dims[1])
        for name, values in run.dataset.data_vars.items()
        if values.ndim == 2 and values.dims[0] == "time" and values.dims[1] in run.dataset.coords
    }
    if "hub_force" in run.dataset:
        known[HUB_LOAD] = "pulley"
    if variable not in known:
        raise ModelError(f"variable = {variable!r} is not a variable over time. Choose from: {', '.join(known)}.")
    return [str(name) for name in run.dataset[known[variable]].values]


def series(run: Run, variable: str, of: str | int) -> xr.DataArray:
    """One variable over time, filtered if it was recorded so."""
    run.require_output()
    names = names_of(run, variable)
    if of in names:
        of = names.index(str(of))
    if not isinstance(of, int) or not 0 <= of < len(names):
        raise ModelError(f"of = {of!r} is not in this drive. Choose one of {', '.join(names)}.")
    recorded = "hub_force" if variable == HUB_LOAD else variable
    filtered = f"filtered_{recorded}"
    values = run.dataset[filtered if filtered in run.dataset else recorded][:, of]
    unit = str(values.attrs["units"])
    if variable == HUB_LOAD:
        attributes = values.attrs | {"long_name": "Hub load"}
        values = values.isel(axis=0, drop=True).copy(data=np.hypot(*values.values.T)).assign_attrs(attributes)
    if variable.startswith("tensioner_"):
        unit = unit.split(", ")[run.drive.moving_tensioners[of].turns]
    shown, factor = _SHOWN.get(unit, (unit, 1.0))
    scaled: xr.DataArray = factor * values
    return scaled.assign_attrs(values.attrs | {"units": shown, "of": names[of]})


_LEVEL_RANGE = 60.0
"""Range of levels in color, dB: those more than 60 dB below the highest are one color."""
_MAP = "viridis"
_MAX_ORDERS = 5
"""Number of orders that are named or drawn if none are chosen: those with the largest peaks."""
_NAME_ROWS, _ROW_SHARE = 4, 0.08
"""Rows of names in a waterfall, and the part of a line from one to the next."""
_LOW_FREQUENCY_SHARE = 0.1
"""Part of the highest frequency below which names stand right of their lines."""
_HARMONICS = (1, 2, 3)
"""Multiples of the frequency at which elements pass that are marked."""
_MIN_ORDER_DISTANCE = 0.4
"""Orders nearer to each other than this are one, and lower ones a trend."""


def _swept(run: Run, choice: Choice) -> tuple[list[str], str | int]:
    """Names of the panels, and the pulley whose speed counts."""
    pulley = run.dataset.attrs.get("swept_pulley", 0) if choice.pulley is None else choice.pulley
    return names_of(run, choice.variable), pulley


def _common_orders(run: Run, choice: Choice) -> list[float]:
    """The orders that stand out in any of the panels; none where the run is too short to tell."""
    names, pulley = _swept(run, choice)
    try:
        found = [_amplitudes(run, choice.variable, name, pulley) for name in names]
    except ModelError:
        return []
    highest = [one.max("speed").fillna(0.0).values for one in found]
    return _strongest(found[0]["order"].values, np.max([one / max(one.max(), 1e-300) for one in highest], axis=0))


def _waterfalls(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a panel for each pulley, span or tensioner, with the same colors for the same levels."""
    names, pulley = _swept(run, choice)
    number = derived.pulley_number(run, pulley)
    found = [series(run, choice.variable, name) for name in names]
    spectra = [derived.waterfall(values, run.dataset["pulley_speed"][:, number]) for values in found]
    highest = max(float(_levels(one).max()) for one in spectra)
    which = _common_orders(run, choice)
    calls = [partial(draw, run, choice.variable, name, pulley, which=which, highest=highest) for name in names]
    page = panels(rows(calls), sharey=False)
    scale = ScalarMappable(Normalize(highest - _LEVEL_RANGE, highest), _MAP)
    units = ", ".join(dict.fromkeys(unit(one) for one in spectra))
    page.colorbar(scale, ax=page.axes, label=f"Amplitude (peak) [dB re 1 {units}]")
    return page


def _all_orders(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a panel for each pulley, span or tensioner, with the same orders in the same colors."""
    names, pulley = _swept(run, choice)
    which = _common_orders(run, choice) or None
    calls = [partial(draw, run, choice.variable, name, pulley, which=which) for name in names]
    page = panels(rows(calls), sharey=False)
    name_once(page)
    return page


@figure(on_request, _waterfalls)
def waterfall(
    run: Run,
    variable: str = "span_tension",
    of: str | int = 0,
    pulley: str | int = 0,
    *,
    which: Sequence[float] = (),
    highest: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw short-time spectra of a variable over the speed of a pulley.

    Amplitudes are those of sinusoids (peak, not RMS). Thin lines are orders of the pulley's rotation. Dashed lines are
    the frequency at which elements of the mesh pass and its double and triple: peaks on them belong to the mesh.
    Variables recorded for spectra are drawn within the pass band of their filter.

    Parameters
    ----------
    run : Run
        A run-up.
    variable : str
        A variable over time and pulley, span or tensioner, or "hub_load".
    of : str or int
        Name or number of the one to draw.
    pulley : str or int
        Name or number of the pulley whose speed is the vertical axis.
    which : sequence of float
        Orders to mark.
    highest : float, optional
        Level at the upper end of the color scale, dB; by default the highest one, with a color bar.
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
    values = series(run, variable, of)
    amplitude = derived.waterfall(values, run.dataset["pulley_speed"][:, number])
    level = _levels(amplitude)
    top = float(level.max()) if highest is None else highest
    ax = axes_or_new(ax)
    mesh = ax.pcolormesh(
        amplitude["frequency"][1:],
        RPM * amplitude["speed"],
        np.maximum(level, top - _LEVEL_RANGE),
        norm=Normalize(top - _LEVEL_RANGE, top),
        cmap=_MAP,
        shading="nearest",
        rasterized=True,
    )
    if highest is None:
        page = ax.get_figure()
        assert page is not None
        page.colorbar(mesh, ax=ax, label=f"Amplitude (peak) [dB re 1 {unit(amplitude)}]")
    elements = derived.element_order(run.drive, number)
    marks = [(order, f"{order:.3g}", "-") for order in which]
    marks += [(k * elements, "elements pass" if k == 1 else f"{k} ×", "--") for k in _HARMONICS if isfinite(elements)]
    for place, (order, words, style) in enumerate(sorted(marks)):
        _mark(ax, order, amplitude, words, style, place % _NAME_ROWS)
    ax.set(xlabel=label(amplitude["frequency"]), ylabel=f"Speed of {run.drive.pulleys[number].name} [rpm]")
    ax.set_title(f"{values.attrs['long_name']}, {values.attrs['of']}")
    ax.grid(visible=False)
    return ax


@figure(on_request, _all_orders, compares=True)
def orders(
    run: Run,
    variable: str = "span_tension",
    of: str | int = 0,
    pulley: str | int = 0,
    *,
    which: Sequence[float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the amplitudes of the strongest orders of a pulley's rotation over its speed, and the overall level.

    Amplitudes are those of sinusoids (peak, not RMS); the overall level is the root mean square of all frequencies
    times the square root of 2, so that a single order lies on it. Orders at which elements of the mesh pass are
    labeled, thin and gray. Variables recorded for spectra are drawn within the pass band of their filter.

    Parameters
    ----------
    run : Run
        A run-up.
    variable : str
        A variable over time and pulley, span or tensioner, or "hub_load".
    of : str or int
        Name or number of the one to draw.
    pulley : str or int
        Name or number of the pulley that defines the orders.
    which : sequence of float, optional
        Orders to draw; the strongest by default.
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
    values = series(run, variable, of)
    amplitude = _amplitudes(run, variable, of, pulley)
    ax = axes_or_new(ax)
    overall = derived.overall_level(derived.waterfall(values, run.dataset["pulley_speed"][:, number]))
    ax.plot(RPM * overall["speed"], np.sqrt(2.0) * overall, color=INK, linewidth=1.0, label="overall (√2 RMS)")
    speed, along = RPM * amplitude["speed"], amplitude["order"].values
    chosen = _strongest(along, amplitude.max("speed").fillna(0.0).values) if which is None else which
    for line, order in enumerate(chosen):
        of_mesh = _multiple(order, derived.element_order(run.drive, number))
        name, tint = f"order {order:.3g}{', of the mesh' * of_mesh}", "0.6" if of_mesh else color(line)
        place = int(np.argmin(np.abs(along - order)))
        ax.plot(speed, amplitude[:, place], label=name, color=tint, linestyle=dash(line), lw=0.8 if of_mesh else None)
    ax.set(xlabel=f"Speed of {run.drive.pulleys[number].name} [rpm]", ylabel=f"Amplitude (peak) [{unit(amplitude)}]")
    ax.set_title(f"{values.attrs['long_name']}, {values.attrs['of']}")
    ax.set_ylim(bottom=0.0)
    name_lines(ax)
    return ax


def _amplitudes(run: Run, variable: str, of: str | int, pulley: str | int) -> xr.DataArray:
    """Amplitudes of orders over speed."""
    angle = run.dataset["pulley_angle"][:, derived.pulley_number(run, pulley)]
    return derived.orders(series(run, variable, of), angle)


def _levels(amplitude: xr.DataArray) -> FloatArray:
    """Levels without that at zero frequency, dB; NaN where the amplitude is unknown."""
    known = amplitude.values[:, 1:]
    return np.asarray(20.0 * np.log10(np.maximum(known, np.finfo(float).tiny)))


def _strongest(order: FloatArray, highest: FloatArray) -> list[float]:
    """The orders that stand out most at some speed, ascending."""
    from scipy.signal import find_peaks

    highest = np.where(order < _MIN_ORDER_DISTANCE, 0.0, highest)
    peaks, _ = find_peaks(highest, distance=max(1, round(_MIN_ORDER_DISTANCE / float(order[1]))))
    return sorted(order[peaks[np.argsort(highest[peaks])[::-1][:_MAX_ORDERS]]].tolist())


def _multiple(order: float, elements: float) -> bool:
    """Whether an order is one, two or three times that at which elements pass."""
    return any(abs(order - k * elements) < _MIN_ORDER_DISTANCE for k in _HARMONICS)


def _mark(ax: Axes, order: float, amplitude: xr.DataArray, words: str, style: str, row: int) -> None:
    """Draw a line where an order lies, if it is seen, with its name near its upper end, in one of a few rows."""
    speed, highest = amplitude["speed"].values, float(amplitude["frequency"][-1])
    frequency = order * speed / (2.0 * np.pi)
    shown = frequency <= highest
    if np.any(shown):
        ax.plot(frequency[shown], RPM * speed[shown], color="w", linestyle=style, linewidth=0.6, alpha=0.7)
        named = int((1.0 - _ROW_SHARE * row) * (np.count_nonzero(shown) - 1))
        place = frequency[shown][named], RPM * speed[shown][named]
        side, ha = (-3, "right") if place[0] > _LOW_FREQUENCY_SHARE * highest else (3, "left")
        ax.annotate(words, place, (side, -3), "data", "offset points", color="w", fontsize=8, ha=ha, va="top")

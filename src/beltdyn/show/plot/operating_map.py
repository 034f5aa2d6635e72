"""Figures of operating points: over speed or load, as efficiency map, and the traction curve of a pulley."""

from collections.abc import Callable
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model.static_estimate import held_belt
from beltdyn.parts.quantity import SHOWN_UNITS
from beltdyn.results import Result
from beltdyn.results.checks.machines import LIFTS
from beltdyn.show.plot.figures import Choice, always, figure
from beltdyn.show.plot.history import tensioner_places
from beltdyn.show.plot.style import (
    INK,
    axes_or_new,
    color,
    dash,
    label,
    name_lines,
    name_once,
    panels,
    rows,
    spread,
)

# Figures of tensioner sheets

_SHOWN = ("tension", "hub_load")
_ENDS = ("tension_after_tensioning", "tension_after_yielding")
_CURVE_POINTS = 60
"""Number of positions of the tensioner at which the curve by virtual work is computed: it must look smooth."""


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out both panels."""
    page = panels(rows([partial(draw, result, name) for name in _SHOWN]), sharey=False)
    name_once(page)
    return page


@figure(always, _both, of=("tensioner_sheet",))
def tensioner_sheet(result: Result, variable: str = "tension", *, ax: Axes | None = None) -> Axes:
    """Draw the tension, or the hub load of its pulley, over the travel of a tensioner.

    Points are belts of different lengths at rest, and their bars the band of dry friction. The line is the balance of
    the tensioner by virtual work, without bending stiffness and weight. Vertical lines are the stops.

    Parameters
    ----------
    result : Result
        Of `tensioner_sheet`.
    variable : str
        "tension" or "hub_load".
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> found = bd.tensioner_sheet(drive.replace(tensioner=[slide]), tolerance="1 mm", wear="2 mm")
    >>> bd.plot.tensioner_sheet(found, "hub_load").get_ylabel()
    'Hub load [N]'
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    names = [one.pulley for one in result.drive.moving_tensioners]
    number = names.index(str(dataset.attrs["pulley"]))
    carrier = result.prepared.carriers[number]
    place, size = dataset["position"].values, dataset[variable].values
    on = np.isfinite(size) & np.isfinite(dataset["belt_length"].values)
    if on.any():
        line = np.linspace(place[on].min(), place[on].max(), _CURVE_POINTS)
        ax.plot(
            carrier.shown(line),
            [_by_hand(result, number, one, variable) for one in line],
            color=INK,
            label="virtual work",
        )
    for kind, (state, at, value) in enumerate(zip(dataset["state"].values, place, size, strict=True)):
        if np.isfinite(value):
            ax.plot(carrier.shown(at), value, "o", color=color(kind), label=str(state))
    if _ENDS[0] in dataset:
        low, high = (size * dataset[name].values / dataset["tension"].values for name in _ENDS)
        ax.vlines(carrier.shown(place), low, high, color=INK, linewidth=2.0, alpha=0.4, label="dry friction")
    for stop in carrier.tensioner.stops or ():
        ax.axvline(float(carrier.shown(stop)), color=INK, linestyle=dash(2), linewidth=0.8)
    what, unit = carrier.shown_as
    ax.set(
        xlabel=f"{what.capitalize()}{' from the given center' * (unit == 'mm')} [{unit}]",
        ylabel=f"{dataset[variable].attrs['long_name']} [N]",
    )
    ax.margins(x=0.06)
    ax.set_ylim(bottom=0.0)
    name_lines(ax)
    return ax


def _by_hand(result: Result, number: int, position: float, variable: str) -> float:
    """Tension or hub load by virtual work, N; NaN where no tension holds the tensioner."""
    prepared = result.prepared
    positions = prepared.installation.tensioner_positions.copy()
    positions[number] = position
    try:
        there = held_belt(prepared.path, prepared.belt, prepared.contact, prepared.carriers, positions, number)
    except ValueError:
        return float("nan")
    wrap = float(there.path.wrap_angles[prepared.carriers[number].pulley])
    return there.tension * (1.0 if variable == "tension" else float(2.0 * np.sin(0.5 * wrap)))


_FRICTION_USED = "friction_used"
_UNITS = (
    *("span_tension", "hub_load", "pulley_slip", _FRICTION_USED, "slip_safety", "tooth_load", "jump_margin"),
    *("tensioner_position", "efficiency"),
)
_PERCENT = ("pulley_slip", "efficiency", _FRICTION_USED)
_OF_GRIP = ("pulley_slip", _FRICTION_USED, "slip_safety")
"""What is drawn of belts without teeth."""
_FULL_SLIDING_SHARE = 0.99
"""Share of an arc that slides, from which on the arc counts as sliding as a whole."""
_MAX_SAFETY = 10.0
"""Slip safety, or margin to a jump, 1, up to which it is drawn: larger ones are far from slip."""
_WARNED = {"slip_safety": 1.5, "jump_margin": LIFTS}
"""Values below which warnings begin."""


def _all_panels(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each variable with a value; the first one where there is none."""
    dataset, toothed = _with_friction_used(result.dataset), result.drive.belt.teeth is not None
    drawn = [name for name in _UNITS if name in dataset and not (toothed and name in _OF_GRIP)]
    known = [name for name in drawn if dataset[name].notnull().any()] or drawn[:1]
    page = panels(rows([partial(draw, result, name) for name in known]), sharey=False)
    name_once(page)
    return page


def _with_friction_used(dataset: xr.Dataset) -> xr.Dataset:
    """Operating points with the friction that pulleys need over that which there is, by Euler's formula."""
    ratios = ("tension_ratio", "allowed_tension_ratio")
    if not {*ratios} <= set(dataset):
        return dataset
    needed, allowed = (np.log(dataset[name].where(dataset[name] > 1.0).values) for name in ratios)
    used = dataset[ratios[0]].copy(data=needed / allowed)
    about = {"long_name": "Friction used: required over available", "units": "1"}
    return dataset.assign({_FRICTION_USED: used.assign_attrs(about)})


def _over_both(result: Result) -> bool:
    """Whether a map is over speed and load."""
    return {"speed", "load"} <= set(result.dataset.dims)


def _mark_points(ax: Axes, values: xr.DataArray, norm: Normalize) -> None:
    """Draw known points of a map over load and speed as circles in their colors, and unknown ones as crosses."""
    load, speed = np.meshgrid(values["load"].values, _in_shown_units(values["speed"]).values, indexing="ij")
    known = np.isfinite(values.values)
    ax.scatter(speed[known], load[known], 30, values.values[known], cmap="viridis", norm=norm, edgecolor=INK)
    ax.plot(speed[~known], load[~known], "x", color=color(1), markersize=5, clip_on=False)


def _over_slip(result: Result) -> bool:
    """Whether it is the traction curve of a pulley without teeth."""
    return "slip" in result.dataset.dims


@figure(lambda result: not _over_slip(result), _all_panels, of=("operating_map", "duty", "traction"), compares=True)
def operating_points(result: Result, variable: str = "span_tension", *, ax: Axes | None = None) -> Axes:
    """Draw a variable of operating points over speed, load, torque on teeth, or the rows of a duty table.

    Of a map over speed and load it is drawn over the speed, at the load nearest to that of the drive file; over the
    load where there is one speed.

    Parameters
    ----------
    result : Result
        Of `operating_map`, `duty`, or `traction` of a pulley with teeth.
    variable : str
        Name of a variable of numbers, such as "hub_load"; or "friction_used", the friction that each pulley needs over
        that which there is: at 100 % the whole arc slides.
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
    >>> found = bd.operating_map(drive, speed="60, 120 rpm")
    >>> bd.plot.operating_points(found, "hub_load").get_ylabel()
    'Hub load [N]'
    """
    dataset = _with_friction_used(result.dataset)
    axis = str(dataset.attrs["axes"]).split()[0]
    if _over_both(result) and dataset.sizes["speed"] == 1:
        axis = "load"
    numbers = [str(name) for name, one in dataset.data_vars.items() if axis in one.dims and one.dtype.kind == "f"]
    if variable not in numbers:
        raise ModelError(
            f"variable = {variable!r} is not a variable of operating points. Choose one of {', '.join(numbers)}."
        )
    values = dataset[variable]
    ax, over_both = axes_or_new(ax), _over_both(result)
    if over_both:
        values = values.isel(speed=0) if axis == "load" else values.sel(load=1.0, method="nearest")
        held = values["speed" if axis == "load" else "load"]
        shown = _in_shown_units(held)
        ax.set_title(f"{held.name} {float(shown):.4g} {shown.attrs['units']}".removesuffix(" 1"))
    if variable == "tensioner_position":
        values = tensioner_places(values.transpose(..., "tensioner"), result.prepared.carriers)
    else:
        values = _in_shown_units(values)
    along = _in_shown_units(dataset[axis])
    for number, (name, line) in enumerate(_lines(values, axis)):
        mark = "o" if axis == "row" else None
        ax.plot(along, line, color=color(number), linestyle=dash(number), marker=mark, label=name)
    if variable == "efficiency":
        ax.update_datalim([(0.0, 100.0)], updatex=False)  # what is lost is the distance to it
        ax.autoscale_view(scalex=False)
    if variable == _FRICTION_USED:
        ax.axhline(100.0, color=INK, linewidth=0.7)
        ax.set_ylim(bottom=0.0)
    if variable in _WARNED:
        ax.axhline(_WARNED[variable], color=INK, linewidth=0.7)
        ax.set_ylim(0.0, _top(values))
    toothing = result.drive.belt.toothing
    if variable == "tooth_load" and toothing is not None and toothing.largest_tooth_load is not None:
        ax.axhline(toothing.largest_tooth_load, color=INK, linewidth=0.7, label="allowed")
    title = str(values.attrs["long_name"]).partition(":")[0]
    ax.set(xlabel=label(along), ylabel=label(values.assign_attrs(long_name=title)))
    if values.ndim > 1:
        name_lines(ax)
    return ax


def _top(safety: xr.DataArray) -> float:
    """Upper end of an axis of safeties: large ones are cut off where there are small ones."""
    known = safety.values[np.isfinite(safety.values)]
    if known.size == 0:
        return _MAX_SAFETY
    top = 1.1 * float(known.max())
    return min(_MAX_SAFETY, top) if known.min() < _MAX_SAFETY else top


def _over_a_grid(result: Result) -> bool:
    """Whether a map has several speeds and several loads."""
    return _over_both(result) and min(result.dataset.sizes[name] for name in ("speed", "load")) > 1


@figure(_over_a_grid, of=("operating_map",))
def efficiency_map(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the efficiency over speed and load, with lines of the least slip safety.

    Where points failed, crosses mark them, and circles the known ones.

    Parameters
    ----------
    result : Result
        Of `operating_map` over both.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the map has one speed or one load.

    Examples
    --------
    >>> found = bd.operating_map(drive, speed="60, 120 rpm", load="0.5, 1")
    >>> bd.plot.efficiency_map(found).get_ylabel()
    'Load'
    """
    if not _over_a_grid(result):
        raise ModelError("an efficiency map needs several speeds and loads. Give them to `beltdyn operating-map`.")
    dataset, ax = result.dataset, axes_or_new(ax)
    speed, load = _in_shown_units(dataset["speed"]), dataset["load"]
    efficiency = 100.0 * dataset["efficiency"].transpose("load", "speed")
    known, page = np.isfinite(efficiency.values), ax.get_figure()
    assert page is not None
    if known.any():
        low, high = spread(float(efficiency.min()), float(efficiency.max()), "%")
        levels = 12 if known.all() else np.linspace(low, high, 13)
        filled = ax.contourf(speed, load, efficiency, levels=levels, cmap="viridis")
        page.colorbar(filled, ax=ax, label="Efficiency [%]")
        if not known.all():
            _mark_points(ax, efficiency, Normalize(low, high))
    safety = dataset["least_slip_safety"].transpose("load", "speed")
    if safety.notnull().any():
        lines = ax.contour(speed, load, safety, levels=[1.0, 1.5, 2.0, 3.0, 5.0], colors="w", linewidths=0.9)
        ax.clabel(lines, fmt="slip safety %g", fontsize=8)
    ax.set(xlabel=label(speed), ylabel=label(load))
    ax.grid(visible=False)
    return ax


@figure(_over_slip, of=("traction",))
def traction_curve(result: Result, ax: Axes | None = None) -> Axes:
    """Draw slip over torque past gross slip, with elastic creep and what bending and the friction law add to it.

    A circle marks where the whole arc of a pulley begins to slide, and names the pulley. The vertical line is the
    largest torque by Euler's formula, with the tensions there.

    Parameters
    ----------
    result : Result
        Of `traction` of a pulley without teeth.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the pulley has teeth.

    Examples
    --------
    >>> bd.plot.traction_curve(bd.traction(drive, slip="0..0.2 %", points=3)).get_ylabel()
    'Slip [%]'
    """
    if not _over_slip(result):
        raise ModelError("a belt does not slip on teeth. Use `bd.plot.operating_points`, with the variable tooth_load.")
    dataset, ax = result.dataset, axes_or_new(ax)
    torque = dataset["torque"].values
    ax.plot(torque, 100.0 * dataset["slip"], color=color(0), marker=".", label="slip")
    ax.plot(torque, 100.0 * dataset["elastic"], color=color(1), linestyle=dash(1), label="elastic creep")
    both = 100.0 * (dataset["elastic"] + dataset["added"])
    ax.fill_between(
        torque,
        100.0 * dataset["elastic"],
        both,
        color=color(4),
        alpha=0.25,
        linewidth=0.0,
        label="bending and friction law",
    )
    known = np.flatnonzero(np.isfinite(torque))
    if known.size:
        limit = float(dataset["capstan_torque"][known[np.argmax(torque[known])]])
        ax.axvline(limit, color=INK, linestyle=dash(2), linewidth=1.0, label=f"Euler's limit {limit:.4g} N·m")
        _mark_gross_slip(ax, dataset, torque)
    ax.set(xlabel=f"Torque on {dataset.attrs['pulley']} [N·m]", ylabel="Slip [%]")
    name_lines(ax)
    return ax


def _mark_gross_slip(ax: Axes, dataset: xr.Dataset, torque: FloatArray) -> None:
    """Mark the first point at which the whole arc of a pulley slides, and name the pulley."""
    slides = (dataset["sliding_arc"] > _FULL_SLIDING_SHARE * dataset["wrap_angle"]).transpose("slip", "pulley").values
    points = np.flatnonzero(slides.any(axis=1) & np.isfinite(torque))
    if points.size:
        first = points[0]
        names = " and ".join(map(str, dataset["pulley"].values[slides[first]]))
        at = float(torque[first]), 100.0 * float(dataset["slip"][first])
        ax.plot(*at, "o", color=INK, markersize=8, markerfacecolor="none", linestyle="")
        words = f"{names} slips\nat {at[0]:.4g} N·m"
        ax.annotate(words, at, (-10, 4), textcoords="offset points", ha="right", va="bottom", fontsize=9)


def _lines(values: xr.DataArray, axis: str) -> list[tuple[str, xr.DataArray]]:
    """Names and values of the lines of a variable along an axis."""
    others = [str(dim) for dim in values.dims if dim != axis]
    if not others:
        return [("", values)]
    return [(str(name), values.sel({others[0]: name})) for name in values[others[0]].values]


def _in_shown_units(values: xr.DataArray) -> xr.DataArray:
    """A variable in the unit in which it is drawn."""
    units = str(values.attrs["units"])
    shown, factor = ("%", 100.0) if values.name in _PERCENT else SHOWN_UNITS.get(units, (units, 1.0))
    return (factor * values).assign_attrs(values.attrs | {"units": shown})

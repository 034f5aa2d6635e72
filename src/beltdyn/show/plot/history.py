"""Figures over time."""

from collections.abc import Collection, Sequence
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from beltdyn.errors import ModelError
from beltdyn.model.carrier import Carrier
from beltdyn.parts.quantity import RPM
from beltdyn.results import Run, derived
from beltdyn.results.energy_balance import largest_closure, losses_of
from beltdyn.results.incidents import GROSS_SLIP, JUMP, SLACK, STOP, incidents
from beltdyn.show.plot.figures import figure, over_time
from beltdyn.show.plot.style import (
    SHADE,
    Dash,
    axes_or_new,
    color,
    dash,
    draw_limit,
    label,
    name_lines,
    note,
    reserve,
    set_log_scale,
    unit,
    unit_of,
)

_MIN_ENERGY_SHARE = 0.01
"""Share of the largest energy above which another one is drawn: smaller ones lie on the axis."""
_ENERGIES = (
    "driver_work",
    "torque_work",
    "kinetic_energy",
    "strain_energy",
    "penalty_energy",
    "spring_energy",
    "potential_energy",
)
_PARTS, _LINE = 100, 0.06
"""Parts of a run that periods are at least apart from each other, and height of a line of words over that of axes."""
_LATE_SHARE = 0.6
"""Part of a run from which on periods are named to their left."""
_MAX_DASHED_WAVES = 5.0
"""Number of vibrations across the figure above which dashed lines are indistinct."""


@figure(over_time, compares=True)
def speeds(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the speeds of the pulleys over time, in rad/s and rpm, and those of the shafts behind hub chains.

    Gross slip is shaded.

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

    Examples
    --------
    >>> bd.plot.speeds(run).get_ylabel()
    'Pulley speed [rad/s]'
    """
    ax = lines(_in_positive_sense(run, "pulley_speed"), axes_or_new(ax))
    shafts = _in_positive_sense(run, "shaft_speed")
    for number, pulley in enumerate(run.drive.pulleys):
        if pulley.hub:
            name = f"shaft of {pulley.name}"
            ax.plot(shafts["time"], shafts[:, number], label=name, color=color(number), linewidth=0.9)
    if not ax.child_axes:
        scale = ax.secondary_yaxis("right", functions=(partial(np.multiply, RPM), partial(np.multiply, 1.0 / RPM)))
        scale.set_ylabel("[rpm]")
    name_lines(ax)
    return mark_incidents(run, ax, (GROSS_SLIP,))


def _in_positive_sense(run: Run, name: str) -> xr.DataArray:
    """Speeds or torques of pulleys, positive in the sense in which they are so in the drive file."""
    values = run.dataset[name]
    return values.copy(data=run.drive.positive_sense * values.values)


@figure(over_time, compares=True)
def torques(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the torques of the belt on the pulleys over time.

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

    Examples
    --------
    >>> bd.plot.torques(run).get_ylabel()
    'Torque of the belt on the pulley [N·m]'
    """
    return lines(_in_positive_sense(run, "pulley_torque"), axes_or_new(ax))


@figure(over_time, compares=True)
def span_tensions(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the tensions of the spans over time, marked where the mesh does not resolve them.

    Gross slip, a slack span, a jump of a toothed belt and a tensioner on a stop are shaded.

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

    Examples
    --------
    >>> bd.plot.span_tensions(run).get_ylabel()
    'Span tension [N]'
    """
    ax = axes_or_new(ax)
    if not run.resolution.resolves("tension"):
        reserve(ax, f"off by about {run.resolution.errors['tension']:.0%} with {run.drive.elements} elements")
    lines(run.dataset["span_tension"], ax)
    draw_limits(run, ax, "largest_tension", "least_tension")
    return mark_incidents(run, ax, (GROSS_SLIP, SLACK, JUMP, STOP))


@figure(over_time)
def energy(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the energy balance over time: work done on the drive, energy stored, and the sum of all losses.

    Energies below a hundredth of the largest are omitted.

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
    >>> bd.plot.energy(run).get_ylabel()
    'Energy [J]'
    """
    run.require_output()
    ax = axes_or_new(ax)
    parts = {str(run.dataset[name].attrs["long_name"]): run.dataset[name] for name in _ENERGIES}
    parts["Losses"] = sum((run.dataset[name] for name in losses_of(run.dataset)), xr.zeros_like(run.dataset["time"]))
    largest = max(float(np.abs(values).max()) for values in parts.values())
    for number, (name, values) in enumerate(parts.items()):
        if float(np.abs(values).max()) > _MIN_ENERGY_SHARE * largest:
            style = "-" if name.endswith("energy") else dash(1 if name.startswith("Work") else 2)
            _line(ax, values, name, number, style)
    ax.set(xlabel=label(run.dataset["time"]), ylabel=f"Energy [{unit(run.dataset[_ENERGIES[0]])}]")
    closure = abs(largest_closure(run.dataset).error)
    note(ax, f"energy balance closes within {closure:.1e} of the energy input")
    name_lines(ax)
    return ax


def draw_limits(run: Run, ax: Axes, *keys: str) -> None:
    """Draw limits of the drive file that are stated, in the unit of the axes: slip in %."""
    for key in keys:
        limit = getattr(run.drive.limits, key)
        if limit is not None:
            value, units = (100.0 * limit, "%") if key == "largest_slip" else (limit, unit_of(ax))
            words = f"{key.replace('_', ' ')} {value:.4g} {units}".rstrip()
            draw_limit(ax, value, words, upper=key.startswith("largest"))


def mark_incidents(run: Run, ax: Axes, kinds: Collection[str]) -> Axes:
    """Shade the periods in which a belt slides, goes slack or jumps, or a tensioner lies on a stop, and name them.

    Periods that are closer than a hundredth of the run are drawn as one.
    """
    with run.recorded() as recorded:
        found = [one for one in incidents(recorded, run.prepared) if one.kind in kinds]
        time = np.asarray(recorded["time"])
    gap = float(np.ptp(time)) / _PARTS
    for number, one in enumerate(found):
        merged = list[list[float]]()
        for begin, end in one.periods:
            if merged and begin - merged[-1][1] < gap:
                merged[-1][1] = end
            else:
                merged.append([begin, end])
        for begin, end in merged:
            ax.axvspan(begin, max(end, begin + 0.2 * gap), color=SHADE, alpha=0.7, linewidth=0.0, zorder=0)
        if merged:
            late = merged[0][0] - time[0] > _LATE_SHARE * np.ptp(time)
            at, side = (merged[-1][1], "right") if late else (merged[0][0], "left")
            ax.annotate(
                f"{one.kind}: {one.name}",
                (at, 0.98 - _LINE * number),
                xycoords=("data", "axes fraction"),
                ha=side,
                va="top",
                fontsize=8,
                bbox={"facecolor": SHADE, "edgecolor": "none", "pad": 0.5, "alpha": 0.8},
            )
    return ax


def lines(
    variable: xr.DataArray, ax: Axes, names: Sequence[str] | None = None, pulleys: Sequence[int] | None = None
) -> Axes:
    """Draw one line for each name along the second dimension, dashed unless it vibrates a lot; none without values.

    A line has the color of the pulley of its number, or of the one named: a span that of the pulley which it leaves.
    """
    vibrating = vibrates(variable)
    for number, name in enumerate(variable[variable.dims[1]].values if names is None else names):
        if bool(variable[:, number].isnull().all()):
            continue
        pulley = number if pulleys is None else pulleys[number]
        if vibrating[number]:
            ax.plot(variable["time"], variable[:, number], label=str(name), color=color(pulley), linewidth=0.8)
        else:
            _line(ax, variable[:, number], str(name), pulley, dash(pulley))
    ax.set(xlabel=label(variable["time"]), ylabel=label(variable))
    name_lines(ax)
    return ax


def envelope(variable: xr.DataArray, ax: Axes, parts: int = 100) -> Axes:
    """Draw lines as `lines` does, but what vibrates as a band from least to largest values, and their medians."""
    vibrating = vibrates(variable)
    time = variable["time"].values
    part = np.minimum((parts * (time - time[0]) / np.ptp(time)).astype(int), parts - 1) if len(time) > 1 else time * 0
    first = np.unique(part, return_index=True)[1]
    middles = np.array([group.mean() for group in np.split(time, first[1:])])
    for number, name in enumerate(variable[variable.dims[1]].values):
        values = variable[:, number]
        if bool(values.isnull().all()):
            continue
        if not vibrating[number]:
            _line(ax, values, str(name), number, dash(number))
            continue
        groups = [group[np.isfinite(group)] for group in np.split(values.values, first[1:])]
        of_parts = [np.percentile(group, (0, 50, 100)) if group.size else np.full(3, np.nan) for group in groups]
        low, median, high = np.transpose(of_parts)
        ax.fill_between(middles, low, high, color=color(number), alpha=0.25, linewidth=0.0)
        ax.plot(middles, median, color=color(number), linestyle=dash(number), label=str(name))
    ax.set(xlabel=label(variable["time"]), ylabel=label(variable))
    name_lines(ax)
    return ax


def vibrates(variable: xr.DataArray) -> np.ndarray:
    """Tell which lines, shape (lines,), go up and down by more than many times the height of all that is drawn.

    The height is that of the middle 98 %.
    """
    values = variable.values
    if not np.isfinite(values).any():
        return np.zeros(values.shape[1], dtype=bool)
    low, high = np.nanpercentile(values[np.isfinite(values)], (1.0, 99.0))
    traveled = np.nansum(np.abs(np.diff(np.clip(values, low, high), axis=0)), axis=0)
    return np.asarray(traveled > 2.0 * _MAX_DASHED_WAVES * (high - low))


def _line(ax: Axes, values: xr.DataArray, name: str, number: int, style: Dash) -> None:
    marker = "o" if values.size == 1 else ""
    ax.plot(values["time"], values, label=name, color=color(number), linestyle=style, marker=marker)


# Figures of the spans and tensioners

_SPECTRUM_FLOOR = 1e-6
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
        Time range, s; by default the second half of the run, when it is more likely to be steady.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If the run holds too few outputs, or none recorded for spectra.

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
    ax.set_ylim(bottom=max(_SPECTRUM_FLOOR * highest, float(np.percentile(spectrum[1:], 1.0))))
    name_lines(ax)
    return ax


def _moves_over_time(run: Run) -> bool:
    return over_time(run) and "tensioner_position" in run.dataset


def tensioner_places(positions: xr.DataArray, carriers: Sequence[Carrier]) -> xr.DataArray:
    """Positions of tensioners, along the last dimension, as they are shown: arm angles, °, or slides, mm."""
    values = [one.shown(positions.values[..., number]) for number, one in enumerate(carriers)]
    names, units = zip(*dict.fromkeys(one.shown_as for one in carriers), strict=True)
    titles = {"arm angle": "Arm angle", "position": "Tensioner position"}
    about = {"units": ", ".join(units), "long_name": " or ".join(titles[name] for name in names).capitalize()}
    return positions.copy(data=np.stack(values, axis=-1)).assign_attrs(about)


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
    carriers = run.prepared.carriers
    ax = lines(tensioner_places(position, carriers), axes_or_new(ax), pulleys=[one.pulley for one in carriers])
    for one in carriers:
        for name, stop in zip(("lower", "upper"), one.tensioner.stops or (), strict=False):
            place = float(one.shown(stop))
            draw_limit(ax, place, f"{one.tensioner.pulley}: {name} stop {place:.4g}{one.shown_as[1]}")
    return ax

"""Contact on a pulley: forces over the belt laid straight, as in Figs. 10-13 of the paper; pressure over the arc."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal, get_args

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from beltdyn.analyses import EQUILIBRIUM, RUN
from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.results import Result, Run, StaticResult, derived, tooth_loads
from beltdyn.show.plot.figures import Choice, always, figure, on_request, over_time
from beltdyn.show.plot.headline import at_instant
from beltdyn.show.plot.style import INK, SHADE, axes_or_new, color, dash, label, name_lines, panels, reserve, rows, unit

# The part of the belt that lies on a pulley, laid out from where the belt enters


@dataclass(frozen=True, slots=True)
class Wrap:
    """Contact points on a pulley, from where the belt enters to where it leaves."""

    points: IntArray
    """Numbers of the contact points, free ones between touching ones included, shape (k,)."""
    distance: FloatArray
    """Unstretched length of belt between the first of them and each, m, shape (k,)."""


def unwrap(belt_coordinate: FloatArray, touching: BoolArray, length: float, speed: float) -> Wrap:
    """Find the points of a closed belt on a pulley, and their distances from its entry, m.

    The part on the pulley is what is left without the longest free stretch; at a negative speed the belt enters at the
    other end.
    """
    (on,) = np.nonzero(touching)
    if on.size == 0:
        return Wrap(on, np.empty(0))
    count = len(belt_coordinate)
    gaps = np.diff(belt_coordinate[on], append=belt_coordinate[on[0]] + length)
    widest = int(np.argmax(gaps))
    first, last = on[(widest + 1) % on.size], on[widest]
    points = (first + np.arange((last - first) % count + 1)) % count
    distance = (belt_coordinate[points] - belt_coordinate[first]) % length
    if speed < 0.0:
        return Wrap(points[::-1], distance[-1] - distance[::-1])
    return Wrap(points, distance)


Kind = Literal["normal", "friction"]
_KILOPASCAL = 1e3
"""One kilopascal, Pa: contact stresses are shown in kPa."""
_SAME_SCALE_RATIO = 4.0
"""Radii over each other up to which pressures have one scale."""


def _pulleys(run: Result, choice: Choice) -> list[list[str]]:
    """Names of the chosen pulleys, in rows, by default of those that the belt wraps."""
    if choice.pulley is not None:
        return rows([choice.pulleys[choice.pulley]])
    beside = {nip.roller for nip in run.drive.nips}
    return rows([name for name in choice.pulleys if name not in beside])


def _kinds_by_pulleys(draw: Callable[..., Axes], run: Result, choice: Choice) -> Figure:
    """Lay out a panel for each kind of force and pulley; at rest nothing rubs."""
    kinds = ("normal",) if isinstance(run, StaticResult) else get_args(Kind)
    blocks = [(block, kind) for block in _pulleys(run, choice) for kind in kinds]
    return panels([[partial(draw, run, name, kind=kind) for name in block] for block, kind in blocks])


def _by_pulleys(draw: Callable[..., Axes], run: Result, choice: Choice) -> Figure:
    """Lay out a panel for each pulley, with one legend for all."""
    radii = [pulley.radius for pulley in run.drive.pulleys]
    alike = max(radii) < _SAME_SCALE_RATIO * min(radii)
    page = panels([[partial(draw, run, name) for name in row] for row in _pulleys(run, choice)], sharey=alike)
    named = [
        Line2D([], [], color=INK, label="pressure"),
        Line2D([], [], color=INK, linestyle=dash(1), label="shear"),
        Patch(color=SHADE, label="sliding part of the arc"),
    ]
    page.legend(handles=named[: 1 if isinstance(run, StaticResult) else 3], loc="outside lower left", ncols=3)
    return page


@figure(on_request, _kinds_by_pulleys, of=(RUN, EQUILIBRIUM), compares=True)
def contact_forces(
    run: Run | StaticResult, pulley: str | int, time: float | None = None, kind: Kind = "normal", ax: Axes | None = None
) -> Axes:
    """Draw the contact forces on the belt from the inlet to the outlet of a pulley.

    Dashed lines are the Coulomb limit of the friction force: the belt slides where the force reaches them. Forces that
    the mesh does not resolve are marked.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.
    kind : {"normal", "friction"}
        Which force. Friction is positive along the counter-clockwise tangent.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such pulley, or the run holds no output.

    Examples
    --------
    >>> bd.plot.contact_forces(run, pulley="driver").get_xlabel()
    'Belt coordinate from entry to exit [m]'
    """
    number = derived.pulley_number(run, pulley)
    instant = run.fields_at(time)
    ax = axes_or_new(ax)
    wrap = unwrap(
        instant["belt_coordinate"].values,
        instant["contact_pulley"].values == number,
        run.drive.belt_length,
        run.drive.pulleys[number].turning * float(instant["pulley_speed"][number]),
    )
    if kind == "friction":
        _draw_limits(ax, instant, wrap, float(run.drive.frictions[number]))
    force = instant[f"{kind}_force"]
    values = force.values[wrap.points]
    name = run.drive.pulleys[number].name
    ax.plot(wrap.distance, values, color=color(number), marker="o", markersize=3.0, label=name)
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    ax.locator_params(axis="x", nbins=5)
    coordinate_unit = unit(run.dataset["belt_coordinate"])
    ax.set(xlabel=f"Belt coordinate from entry to exit [{coordinate_unit}]", ylabel=label(force))
    ax.set_title(_title(run, name, float(instant["time"])))
    if not run.resolution.resolves("peak pressure"):
        reserve(ax, f"peaks not resolved by {run.drive.elements} elements")
    return ax


@figure(always, _by_pulleys, of=(RUN, EQUILIBRIUM))
def contact_pressure(
    run: Run | StaticResult, pulley: str | int, time: float | None = None, ax: Axes | None = None
) -> Axes:
    """Draw contact pressure and shear over the angle from the inlet of a pulley.

    The sliding arc, where friction is saturated, is shaded. Stresses that the mesh does not resolve are marked.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes. Shear is positive in the direction in which the rim moves.

    Raises
    ------
    ModelError
        If there is no such pulley, or the run holds no output.

    Examples
    --------
    >>> bd.plot.contact_pressure(run, pulley="driver").get_xlabel()
    'Angle from the inlet [°]'
    """
    number = derived.pulley_number(run, pulley)
    arc = derived.contact_arc(run, number, time)
    ax = axes_or_new(ax)
    angle = np.degrees(arc["angle"].values)
    parts = (("pressure", color(number), "-"), ("shear", INK, dash(1)))
    for part, tint, style in parts[: 1 if isinstance(run, StaticResult) else 2]:  # at rest nothing rubs
        ax.plot(angle, arc[part] / _KILOPASCAL, color=tint, linestyle=style, label=str(arc[part].attrs["long_name"]))
    ax.margins(x=0.0)
    _shade_sliding(ax, angle, arc["sliding"].values)
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    ax.set(xlabel="Angle from the inlet [°]", ylabel="Contact stress [kPa]")
    ax.set_title(_title(run, run.drive.pulleys[number].name, float(arc["time"])))
    if not run.resolution.resolves("peak pressure"):
        reserve(ax, f"peaks not resolved by {run.drive.elements} elements")
    return ax


Quantity = Literal["tension", "normal", "friction"]
_QUANTITIES = {"tension": "belt_tension", "normal": "normal_force", "friction": "friction_force"}
"""Kind of `arc_forces` -> variable over the arc."""


def _quantities_by_pulleys(draw: Callable[..., Axes], run: Result, choice: Choice) -> Figure:
    """Lay out a row for each quantity, a panel for each pulley; at rest nothing rubs."""
    kinds = get_args(Quantity)[: 2 if isinstance(run, StaticResult) else 3]
    blocks = [(block, kind) for block in _pulleys(run, choice) for kind in kinds]
    return panels([[partial(draw, run, name, kind=kind) for name in block] for block, kind in blocks])


@figure(on_request, _quantities_by_pulleys, of=(RUN, EQUILIBRIUM), compares=True)
def arc_forces(
    run: Run | StaticResult,
    pulley: str | int,
    time: float | None = None,
    kind: Quantity = "normal",
    ax: Axes | None = None,
) -> Axes:
    """Draw tension, normal or friction force on the belt over the angle from the inlet of a pulley.

    Forces that the mesh does not resolve are marked.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    pulley : str or int
        Name or number of the pulley.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.
    kind : {"tension", "normal", "friction"}
        Which one. Friction is positive in the direction in which the rim moves.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such pulley or kind, or the run holds no output.

    Examples
    --------
    >>> bd.plot.arc_forces(run, pulley="driver", kind="tension").get_ylabel()
    'Belt tension [N]'
    """
    if kind not in _QUANTITIES:
        raise ModelError(f'kind = "{kind}" is unknown. Choose one of {", ".join(_QUANTITIES)}.')
    number = derived.pulley_number(run, pulley)
    arc = derived.contact_arc(run, number, time)
    force, name = arc[_QUANTITIES[kind]], run.drive.pulleys[number].name
    ax = axes_or_new(ax)
    ax.plot(np.degrees(arc["angle"]), force, color=color(number), label=name)
    if kind == "friction":
        ax.axhline(0.0, color="0.4", linewidth=0.6, zorder=1)
    ax.set(xlabel="Angle from the inlet [°]", ylabel=label(force))
    ax.set_title(_title(run, name, float(arc["time"])))
    if kind != "tension" and not run.resolution.resolves("peak pressure"):
        reserve(ax, f"peaks not resolved by {run.drive.elements} elements")
    return ax


def _title(run: Result, name: str, time: float) -> str:
    """The pulley, and the instant of a run."""
    return ", ".join(filter(None, (name, at_instant(run, time))))


def _shade_sliding(ax: Axes, angle: FloatArray, sliding: FloatArray) -> None:
    """Shade what slides, half of the way to the neighbors of each point."""
    if angle.size:
        edges = np.concatenate([angle[:1], 0.5 * (angle[1:] + angle[:-1]), angle[-1:]])
        ax.stairs(sliding, edges, transform=ax.get_xaxis_transform(), fill=True, color=SHADE, zorder=0)


def _draw_limits(ax: Axes, instant: xr.Dataset, wrap: Wrap, friction: float) -> None:
    """Draw what Coulomb friction allows, without making room for it: the force may be much smaller."""
    limit = friction * instant["normal_force"].values[wrap.points]
    edges = [np.column_stack([wrap.distance, sign * limit]) for sign in (1, -1)]
    lines = LineCollection(edges, colors=INK, linestyles=dash(1), linewidths=1.0, label="Coulomb limit")
    ax.add_collection(lines, autolim=False)
    ax.legend(handles=[lines], loc="lower left", bbox_to_anchor=(0.62, 1.0), borderaxespad=0.2)


# Figures of wear intensity, the work of friction


@figure(compares=True)
def wear_by_arc(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the work of friction over the arcs of the pulleys, from where the belt enters.

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
    >>> bd.plot.wear_by_arc(run).get_xlabel()
    'Angle from the inlet [°]'
    """
    ax = axes_or_new(ax)
    wear = derived.wear_by_arc(run)
    for number, name in enumerate(wear["pulley"].values):
        worn = wear[number][wear[number].values > 0.0]
        ax.plot(np.degrees(worn["angle"]), worn, color=color(number), linestyle=dash(number), label=str(name))
    ax.set(xlabel="Angle from the inlet [°]", ylabel=label(wear), ylim=(0.0, None))
    name_lines(ax)
    return ax


@figure(compares=True)
def wear_by_belt(run: Run, ax: Axes | None = None) -> Axes:
    """Draw the work of friction over the belt, and what each pulley does of it.

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
    >>> bd.plot.wear_by_belt(run).get_xlabel()
    'Belt coordinate of the element midpoint, unstretched [m]'
    """
    ax = axes_or_new(ax)
    wear = derived.wear_by_belt(run)
    for number, name in enumerate(wear["pulley"].values):
        place = wear["element_coordinate"]
        ax.plot(place, wear[number], color=color(number), linestyle=dash(number), lw=1.1, label=str(name))
    ax.set(xlabel=label(wear["element_coordinate"]), ylabel=label(wear), ylim=(0.0, None))
    name_lines(ax)
    return ax


def _has_nips(run: Run) -> bool:
    """Whether the drive of a run has nips, and the run outputs."""
    return bool(run.drive.nips) and run.dataset.sizes["field_time"] > 0


def _by_nips(draw: Callable[..., Axes], run: Run, choice: Choice) -> Figure:
    """Lay out a panel for each nip."""
    return panels([[partial(draw, run, nip.roller) for nip in run.drive.nips] or [partial(draw, run)]])


@figure(_has_nips, _by_nips)
def nip_pressure(run: Run, roller: str | int | None = None, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw pressure and shear over a nip on both faces of the belt.

    Parameters
    ----------
    run : Run
        A run or steady running of a drive with nips.
    roller : str or int, optional
        Name or number of the roller beside the path; that of the first nip by default.
    time : float, optional
        Instant of an output along the belt, s; the last one by default.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes. Shear on the belt is positive in the direction in which it runs.

    Raises
    ------
    ModelError
        If there is no such nip, or the run holds no output.

    Examples
    --------
    >>> bd.plot.nip_pressure(run)
    Traceback (most recent call last):
    ...
    beltdyn.errors.ModelError: "driver" is not the roller of a nip. The drive has no [[nip]].
    """
    if roller is None:
        roller = run.drive.nips[0].roller if run.drive.nips else 0
    profile = derived.nip_profile(run, roller, time)
    ax = axes_or_new(ax)
    for face in profile["face"].values.tolist():
        number, own = run.drive.number_of(face), profile.sel(face=face)
        for part, style in (("pressure", "-"), ("shear", dash(1))):
            values = own[part] / _KILOPASCAL
            ax.plot(1e3 * own["distance"], values, color=color(number), linestyle=style, label=f"{part}, {face}")
    ax.axhline(0.0, color="0.4", linewidth=0.8, zorder=1)
    ax.set(xlabel=f"{profile['distance'].attrs['long_name']} [mm]", ylabel="Stress in the nip [kPa]")
    ax.set_title(" on ".join(profile["face"].values.tolist()))
    name_lines(ax)
    return ax


_MESH_MULTIPLES = 3
"""Multiples of the meshing order that are marked."""
_ORDER_RANGE_RATIO = 1.15
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
        shown = found["order"].values <= _ORDER_RANGE_RATIO * _MESH_MULTIPLES * meshing
        ax.semilogy(found["order"].values[shown], 1e6 * found.values[shown], color=color(number), label=name)
    for multiple in range(1, _MESH_MULTIPLES + 1):
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

"""Order cuts: amplitudes of linear response over speed, beside those of a run-up and measured ones."""

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.parts.quantity import RPM, SHOWN_UNITS
from beltdyn.results import Result
from beltdyn.show.plot.animation import film
from beltdyn.show.plot.drive_picture import LINE, extent_of, size_of
from beltdyn.show.plot.figures import Choice, always, figure
from beltdyn.show.plot.style import (
    INK,
    PALE,
    SHADE,
    Dash,
    axes_or_new,
    color,
    dash,
    label,
    name_lines,
    name_once,
    new_figure,
    panels,
    rows,
    set_log_scale,
    styled,
)

# Mode shapes of a drive, still or animated

_DISPLACEMENT_SHARE = 0.06
"""Size at which the largest displacement is drawn, over that of the drive."""
_MAX_MODES = 12
"""Number of modes on a page at most: four rows of three."""
KINDS = ("span", "rotational", "tensioner", "coupled")
"""Kinds of modes, in the order of their colors."""
_FRAMES_PER_PERIOD = 24
"""Pictures of a period of a mode: the phase advances by 15° from each to the next, which looks smooth."""


class Swing(NamedTuple):
    """How the parts of a drive move in a mode: the real part of these, times exp(i phase), at a phase."""

    belt: ComplexArray
    """Ways of the points of the belt, m, shape (points, 2)."""
    centers: ComplexArray
    """Ways of the centers of the pulleys, m, shape (pulleys, 2)."""
    angles: ComplexArray
    """Rotation of the pulleys, rad, shape (pulleys,)."""
    size: float
    """The largest of these ways, those of rims included, m."""


def swing(result: Result, mode: int) -> Swing:
    """How parts move in a mode, at a size that is seen."""
    one, drive = result.dataset.sel(mode=mode), result.drive
    size = _DISPLACEMENT_SHARE * float(np.ptp(extent_of(drive, drive.path), axis=0).max())
    belt = size * _complex(one["belt_shape"].values)[:, None] * one["point_normal"].values
    centers = np.zeros((len(drive.pulleys), 2), complex)
    arms = _complex(one["tensioner_shape"].values) if "tensioner_shape" in one else np.zeros(0, complex)
    for carrier, way in zip(result.prepared.carriers, arms, strict=True):
        along = carrier.place(0.0)[1]
        centers[carrier.pulley] = size * way * along / np.linalg.norm(along)
    return Swing(belt, centers, size * _complex(one["rim_shape"].values) / np.abs(drive.path.radii), size)


def shown_modes(result: Result) -> list[int]:
    """Numbers of the modes that are drawn on a page: the first ones."""
    return [int(one) for one in result.dataset["mode"].values[:_MAX_MODES]]


def mode_name(result: Result, mode: int) -> str:
    """What a mode is, in two lines: frequency and damping ratio, and what moves."""
    one = result.dataset.sel(mode=mode)
    dry = f", arm {one['dry_tensioners'].values}" if "dry_tensioners" in one else ""
    shown = f"{mode}: {float(one['frequency']):.4g} Hz, damping {float(one['damping_ratio']):.2%}{dry}"
    return f"{shown}\n{one['kind'].values}: {one['moving_parts'].values}"


def tint_of(result: Result, mode: int) -> str:
    """Color of the kind of a mode."""
    return color(KINDS.index(str(result.dataset["kind"].sel(mode=mode).values)))


class ModePicture:
    """A mode of a drive (counted from 1), which can be moved to another phase."""

    def __init__(self, result: Result, mode: int, ax: Axes) -> None:
        drive, self._swing = result.drive, swing(result, mode)
        extent, size = extent_of(drive, drive.path), self._swing.size
        self._place = result.dataset["point_position"].values
        self._carriers, self._radii, self._centers = (
            result.prepared.carriers,
            np.abs(drive.path.radii),
            drive.path.centers,
        )
        tint = tint_of(result, mode)
        ax.plot(*_closed(self._place).T, color=INK, linewidth=0.6, linestyle=":", zorder=2)
        self._line = ax.plot([], [], color=tint, linewidth=2.0, zorder=3)[0]
        self._marks = [_draw_pulley(ax, *item, tint) for item in zip(self._centers, self._radii, strict=True)]
        self._held = [ax.plot([], [], **LINE)[0] if one.tensioner.anchor else None for one in self._carriers]
        low, high = extent[0] - 1.5 * size, extent[1] + 1.5 * size
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        ax.set_axis_off()
        ax.set_title(mode_name(result, mode), fontsize=8)

    def show(self, phase: float) -> None:
        """Move everything to a phase, rad."""
        turn = np.exp(1j * phase)
        self._line.set_data(*_closed(self._place + np.real(turn * self._swing.belt)).T)
        centers = self._centers + np.real(turn * self._swing.centers)
        for carrier, arm in zip(self._carriers, self._held, strict=True):
            if arm is not None:
                arm.set_data(*np.array([carrier.tensioner.anchor, centers[carrier.pulley]]).T)
        angles = np.real(turn * self._swing.angles)
        for (rim, mark), center, radius, angle in zip(self._marks, centers, self._radii, angles, strict=True):
            rim.center = tuple(center)
            mark.set_data(*np.array([center, center + radius * np.array([-np.sin(angle), np.cos(angle)])]).T)


def _complex(parts: FloatArray) -> ComplexArray:
    """A shape from its real and imaginary part."""
    return np.asarray(parts[0] + 1j * parts[1])


def _closed(points: FloatArray) -> FloatArray:
    """Points of a closed curve, the first once more."""
    return np.concatenate([points, points[:1]])


def _draw_pulley(ax: Axes, center: FloatArray, radius: float, tint: str) -> tuple[Circle, Line2D]:
    rim = Circle((float(center[0]), float(center[1])), radius, facecolor=PALE, edgecolor=INK, linewidth=0.7, zorder=1)
    ax.add_patch(rim)
    return rim, ax.plot([], [], color=tint, linewidth=2.0, zorder=2)[0]


def _all_modes(draw: object, result: Result, choice: Choice) -> Figure:
    """Lay out the first modes."""
    return panels(rows([partial(mode_shape, result, one) for one in shown_modes(result)]), sharey=False)


@figure(always, _all_modes, of=("modes",))
def mode_shape(result: Result, mode: int = 1, *, ax: Axes | None = None) -> Axes:
    """Draw the shape of a mode at its largest displacement: belt, pulleys and tensioner arms.

    The color tells its kind: span, rotational, tensioner or coupled.

    Parameters
    ----------
    result : Result
        Of `modes`.
    mode : int
        Which one, from 1 on.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such mode.

    Examples
    --------
    >>> found = bd.modes(drive, about="rest", count=2)
    >>> bd.plot.mode_shape(found, mode=2).get_aspect()
    1.0
    """
    numbers = result.dataset["mode"].values
    if mode not in numbers:
        raise ModelError(
            f"mode = {mode} does not exist; this result has modes {', '.join(map(str, numbers))}. Choose one of these."
        )
    ax = axes_or_new(ax, size_of(result.drive))
    ModePicture(result, mode, ax).show(0.0)
    return ax


@styled
def animate_modes(result: Result, path: Path | str, frame_rate: int = 25, overwrite: bool = False) -> Path:
    """Write an animation of modes, about one period per second, without their decay.

    Parameters
    ----------
    result : Result
        Of `modes`.
    path : Path or str
        The file: a GIF, or an MP4, which needs the extra ``beltdyn[video]`` or the program ffmpeg.
    frame_rate : float
        Pictures shown per second.
    overwrite : bool
        Replace any regular file, and not only animations of beltdyn.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If the result is of another kind, the format is unknown or needs a program that is missing, or the file cannot
        be written or would replace one that is no animation of ours.
    """
    if result.kind != "modes":
        raise ModelError(f"an animation of modes needs a result of `modes`, not of {result.kind}.")
    pictures = list[ModePicture]()

    def add(mode: int, *, ax: Axes) -> Axes:
        pictures.append(ModePicture(result, mode, ax))
        return ax

    page = panels(rows([partial(add, one) for one in shown_modes(result)]), sharey=False)
    with film(page, Path(path), frame_rate, overwrite) as take:
        for phase in 2.0 * np.pi * np.arange(_FRAMES_PER_PERIOD) / _FRAMES_PER_PERIOD:
            for picture in pictures:
                picture.show(float(phase))
            take()
    return Path(path)


# Campbell diagram: frequencies of modes and excitations over speed, and damping ratios of the modes

_CAMPBELL_SIZE = (8.0, 7.5)
"""Width and height of a Campbell diagram, inches: it has two panels below each other."""
_HEIGHT_RATIOS = (2.0, 1.0)
"""Heights of the panels of frequencies and of damping ratios, relative to each other: the upper one has more lines."""
_FREQUENCY_RANGE_RATIO = 1.08
"""Upper end of the frequencies that are drawn, over the highest of a mode."""
_MIN_DAMPING = 1e-5
"""Least damping ratio drawn, 1: the axis is logarithmic, and undamped or unstable modes are drawn at it."""
_RESONANT_DAMPING = 0.1
"""Damping ratio below which a critical speed is marked by a filled circle."""
_CROSSING_POINTS = 200
"""Number of speeds at which lines are evaluated to find where they leave the axes."""
_EXCITED = "0.6"
"""Color of excitations."""


def _both(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out frequencies above damping ratios."""
    page = new_figure(_CAMPBELL_SIZE)
    above, below = page.subplots(2, 1, sharex=True, height_ratios=_HEIGHT_RATIOS)
    draw(result, ax=above)
    mode_damping(result, ax=below)
    twice = below.get_legend()
    assert twice is not None
    twice.remove()
    above.set_xlabel("")
    return page


@figure(always, _both, of=("campbell",))
def campbell(result: Result, ax: Axes | None = None) -> Axes:
    """Draw a Campbell diagram: frequencies of modes over speed, lines of excitations, and where they meet.

    Modes have the color of their kind, and their number at the right end. Circles are critical speeds, filled where the
    damping ratio is below 0.1. Crosses mark unstable modes.

    Parameters
    ----------
    result : Result
        Of `campbell`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    speed, frequency = RPM * dataset["speed"].values, dataset["frequency"].values
    top = _FREQUENCY_RANGE_RATIO * float(np.nanmax(frequency)) if np.isfinite(frequency).any() else 1.0
    for line, name in zip(dataset["excitation_frequency"].values.T, dataset["excitation"].values, strict=True):
        ax.plot(speed, line, color=_EXCITED, linewidth=0.8, zorder=1)
        _name_line(ax, speed, line, top, str(name))
    _draw_modes(ax, result, speed, frequency)
    at, meets = RPM * dataset["critical_speed"].values, dataset["critical_frequency"].values
    strong = dataset["critical_damping_ratio"].values < _RESONANT_DAMPING
    for chosen, face in ((strong, INK), (~strong, "w")):
        ax.scatter(at[chosen], meets[chosen], 22, facecolor=face, edgecolor=INK, linewidth=0.8, zorder=4)
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=label(dataset["frequency"]), ylim=(0.0, top))
    marks = [
        Line2D([], [], color=INK, marker="o", linestyle="", markerfacecolor=face, markersize=5, label=text)
        for face, text in ((INK, f"critical, damping < {_RESONANT_DAMPING:g}"), ("w", "critical, more damped"))
    ]
    _legend(ax, result, [*marks, Line2D([], [], color=_EXCITED, linewidth=0.8, label="excitation")])
    return ax


@figure(of=("campbell",))
def mode_damping(result: Result, ax: Axes | None = None) -> Axes:
    """Draw the damping ratios of modes over speed; crosses mark unstable modes.

    Parameters
    ----------
    result : Result
        Of `campbell`.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.
    """
    dataset, ax = result.dataset, axes_or_new(ax)
    damping = dataset["damping_ratio"].values
    _draw_modes(ax, result, RPM * dataset["speed"].values, np.maximum(damping, _MIN_DAMPING))
    set_log_scale(ax)
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=label(dataset["damping_ratio"]))
    _legend(ax, result, [])
    return ax


def _draw_modes(ax: Axes, result: Result, speed: FloatArray, values: FloatArray) -> None:
    """Draw a line for each mode, with its number, and crosses where it grows."""
    dataset = result.dataset
    for column, (mode, kind) in enumerate(zip(dataset["mode"].values, dataset["kind"].values, strict=True)):
        line, tint = values[:, column], color(KINDS.index(str(kind)))
        known = np.flatnonzero(np.isfinite(line))
        if not known.size:
            continue
        ax.plot(speed, line, color=tint, linewidth=1.5, zorder=2)
        last = known[-1]
        ax.annotate(str(mode), (speed[last], line[last]), (3, 0), textcoords="offset points", color=tint, fontsize=8)
        grows = dataset["growth_rate"].values[:, column] > 0.0
        ax.plot(speed[grows], line[grows], color=INK, linestyle="", marker="x", markersize=5, zorder=3)


def _name_line(ax: Axes, speed: FloatArray, line: FloatArray, top: float, name: str) -> None:
    """Write the name of an excitation along its line, where it leaves the axes."""
    known = np.isfinite(line)
    if not known.any():
        return
    fine = np.linspace(speed[0], speed[-1], _CROSSING_POINTS)
    along = np.interp(fine, speed[known], line[known])
    inside = np.flatnonzero(along <= top)
    if inside.size:
        place = fine[inside[-1]], along[inside[-1]]
        slope = float(np.nanmean(line / speed))
        text = ax.annotate(name, place, (-2, 2), textcoords="offset points", fontsize=7, ha="right", color="0.35")
        text.set(rotation=np.degrees(np.arctan(slope)), rotation_mode="anchor", transform_rotates_text=True)


def _legend(ax: Axes, result: Result, others: list[Line2D]) -> None:
    """Write the kinds of modes that there are, and other marks, above the axes."""
    there = [kind for kind in KINDS if kind in result.dataset["kind"].values]
    lines = [Line2D([], [], color=color(KINDS.index(kind)), label=kind) for kind in there]
    if np.any(result.dataset["growth_rate"].values > 0.0):
        others = [*others, Line2D([], [], color=INK, marker="x", linestyle="", markersize=5, label="unstable (grows)")]
    name_lines(ax, [*lines, *others])


_SHOWN = {**SHOWN_UNITS, "m": ("mm", 1e3)}
_BESIDE: dict[str, tuple[Dash, str, str]] = {"run_up": ("--", "", "in the run-up"), "measured": ("", "o", "measured")}
"""Compared data -> line style, marker and name."""
_END = "_amplitude"


def _all_panels(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each span, pulley or tensioner of a variable."""
    values = result.dataset[_name(result, choice.variable)]
    names = [str(one) for one in values[values.dims[-1]].values]
    page = panels(rows([partial(draw, result, choice.variable, one) for one in names]), sharey=False)
    name_once(page)
    return page


def _shade_beyond_range(ax: Axes, result: Result, speed: FloatArray) -> None:
    """Shade the speeds (rpm) at which the estimated error of amplitudes is more than that of a linear response."""
    dataset = result.dataset
    if "amplitude_error" not in dataset:
        return
    limit = float(dataset.attrs["linear_range"])
    between = 0.5 * (speed[1:] + speed[:-1])
    edges = np.concatenate([speed[:1], between, speed[-1:]])
    label = f"beyond linear range (error above {100.0 * limit:g}%)"
    for row in np.flatnonzero(dataset["amplitude_error"].values > limit):
        ax.axvspan(edges[row], edges[row + 1], color=SHADE, linewidth=0.0, zorder=0, label=label)
        label = "_"


_OVERVIEW = ("tensioner_position", "span_tension", "hub_load", "friction_used")
"""What is drawn over speed, with a line for each span, pulley or tensioner."""


def _overview(draw: Callable[..., Axes], result: Result, choice: Choice) -> Figure:
    """Lay out a panel for each kind of result."""
    known = [name for name in _OVERVIEW if _total(result, name) is not None]
    page = panels(rows([partial(draw, result, name) for name in known]), sharey=False)
    name_once(page)
    return page


def _total(result: Result, variable: str) -> xr.DataArray | None:
    """Sum of the amplitudes of all excitations, or the friction used, in shown units; None if there is none."""
    dataset, name = result.dataset, f"{variable}{_END}"
    if variable == "friction_used":
        if "largest_friction_used" not in dataset or result.drive.belt.teeth is not None:
            return None
        values = 100.0 * dataset["largest_friction_used"]
        return values.assign_attrs(long_name="Friction used, at most", units="%") if values.notnull().any() else None
    if name not in dataset:
        return None
    units = str(dataset[name].attrs["units"])
    unit, factor = _SHOWN.get(units, (units, 1.0))
    title = str(dataset[name].attrs["long_name"]).rpartition(",")[0]
    if variable == "tensioner_position" and unit == "°":
        title = "Arm angle"
    total = factor * dataset[name].sum("excitation", skipna=False)
    return total.assign_attrs(long_name=title, units=unit)


@figure(always, _overview, of=("response",), compares=True)
def amplitudes(result: Result, variable: str = "tensioner_position", *, ax: Axes | None = None) -> Axes:
    """Draw the amplitudes of all spans, pulleys or tensioners over speed: sums over the excitations, an upper bound.

    Friction used is the largest share of the friction that a pulley needs in a period: from 100 % on its whole arc
    slides. Shaded speeds are beyond the range of a linear response.

    Parameters
    ----------
    result : Result
        Of `response`.
    variable : str
        "tensioner_position" (of an arm, its angle), "friction_used", or another result, such as "hub_load".
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
    >>> wave = [{"order": 2, "amplitude": 0.02}]
    >>> wavy = drive.replace(pulley=[drive.pulleys[0].replace(harmonics=wave), drive.pulleys[1]])
    >>> bd.plot.amplitudes(bd.response(wavy, speed="80, 120 rpm"), "hub_load").get_ylabel()
    'Amplitude [N]'
    """
    total = _total(result, variable)
    if total is None:
        _name(result, variable)
        raise ModelError(f"variable = {variable!r} is not a result of this response. Choose another.")
    ax, speed = axes_or_new(ax), RPM * result.dataset["speed"].values
    _shade_beyond_range(ax, result, speed)
    names = total[total.dims[-1]].values
    for number, name in enumerate(names):
        if bool(total[:, number].notnull().any()):
            named = str(name) if len(names) > 1 else None  # one tensioner is known by the title
            ax.plot(speed, total[:, number], color=color(number), linestyle=dash(number), label=named)
    if variable == "friction_used":
        ax.axhline(100.0, color=INK, linewidth=0.7)
    unit = str(total.attrs["units"]).replace(" ", "·")
    ax.set_title(str(total.attrs["long_name"]))
    quantity = "Share" if variable == "friction_used" else "Amplitude"
    ax.set(xlabel=label(result.dataset["speed"]).replace("rad/s", "rpm"), ylabel=f"{quantity} [{unit}]")
    ax.set_ylim(bottom=0.0)
    name_lines(ax)
    return ax


@figure(always, _all_panels, of=("response",))
def response(result: Result, variable: str = "span_tension", of: str | int = 0, *, ax: Axes | None = None) -> Axes:
    """Draw the amplitudes of a result over speed, a line for each excitation, and their sum.

    The sum of all amplitudes is an upper bound. Dashed lines are the same orders in a run-up, circles are measured
    amplitudes, if given to `response`. Shaded speeds are beyond the range of a linear response.

    Parameters
    ----------
    result : Result
        Of `response`.
    variable : str
        A result, such as "hub_load".
    of : str or int
        Name or number of the span, pulley or tensioner.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ModelError
        If there is no such variable, span, pulley or tensioner.

    Examples
    --------
    >>> wave = [{"order": 2, "amplitude": 0.02}]
    >>> wavy = drive.replace(pulley=[drive.pulleys[0].replace(harmonics=wave), drive.pulleys[1]])
    >>> bd.plot.response(bd.response(wavy, speed="80, 120 rpm")).get_ylabel()
    'Amplitude [N]'
    """
    dataset, name = result.dataset, _name(result, variable)
    names = [str(one) for one in dataset[dataset[name].dims[-1]].values]
    place = names.index(of) if of in names else of
    if not isinstance(place, int) or not 0 <= place < len(names):
        raise ModelError(f"of = {of!r} is not in this drive. Choose one of {', '.join(names)}.")
    ax, speed = axes_or_new(ax), RPM * dataset["speed"].values
    unit, factor = _SHOWN.get(str(dataset[name].attrs["units"]), (str(dataset[name].attrs["units"]), 1.0))
    linear = factor * dataset[name].values[:, :, place]
    _shade_beyond_range(ax, result, speed)
    if linear.shape[1] > 1:
        ax.plot(speed, linear.sum(axis=1), color=INK, linewidth=0.9, label="sum of amplitudes")
    for number, one in enumerate(dataset["excitation"].values):
        ax.plot(speed, linear[:, number], color=color(number), label=str(one))
        for kind, (dashes, mark, _) in _BESIDE.items():
            if f"{kind}_{name}" in dataset:
                other = factor * dataset[f"{kind}_{name}"].values[:, number, place]
                ax.plot(speed, other, color=color(number), linestyle=dashes, marker=mark, markersize=3.5, linewidth=1.1)
    title = str(dataset[name].attrs["long_name"]).rpartition(",")[0]
    ax.set(xlabel=label(dataset["speed"]).replace("rad/s", "rpm"), ylabel=f"Amplitude [{unit.replace(' ', '·')}]")
    ax.set_title(f"{title}, {names[place]}")
    ax.set_ylim(bottom=0.0)
    there = [
        Line2D([], [], color=INK, linestyle=dashes, marker=mark, markersize=3.5, label=words)
        for kind, (dashes, mark, words) in _BESIDE.items()
        if f"{kind}_{name}" in dataset
    ]
    name_lines(ax, [*ax.get_legend_handles_labels()[0], *there])
    return ax


def _name(result: Result, variable: str) -> str:
    """Name of the amplitudes of a result."""
    known = [
        str(name).removesuffix(_END)
        for name, values in result.dataset.data_vars.items()
        if str(name).endswith(_END) and values.ndim == 3 and not str(name).startswith(tuple(_BESIDE))
    ]
    if variable not in known:
        raise ModelError(f"variable = {variable!r} is not a result of a response. {suggest(variable, known)}")
    return f"{variable}{_END}"

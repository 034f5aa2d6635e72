"""The picture of a drive at one instant, which can be moved to another instant."""

import pathlib
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch
from matplotlib.path import Path as Outline
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from beltdyn.analyses import EQUILIBRIUM, RUN
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Entry, Path, Pulley, prepare
from beltdyn.model.carrier import Carrier
from beltdyn.results import Result, Run, StaticResult
from beltdyn.results.mechanics import centerline, present_lengths, recorded_kind
from beltdyn.show.plot.figures import Choice, always, figure, save
from beltdyn.show.plot.headline import at_instant
from beltdyn.show.plot.style import (
    COLORS,
    INK,
    PALE,
    axes_or_new,
    color,
    dash,
    label,
    new_figure,
    spread,
    styled,
    tension_colors,
)
from beltdyn.stretch import Linear

# Spring-loaded tensioners in pictures of a drive: arm and pivot, or the line on which one slides, and stops

TENSIONER = "#4a5361"
"""Color of all that belongs to tensioners."""
LINE: dict[str, Any] = {"color": TENSIONER, "linewidth": 2.0, "zorder": 4}
"""How arms and lines of sliding are drawn."""
_WAY_POINTS = 20
"""Number of points of the way between stops: those of an arm lie on an arc, which must look smooth."""
_MAX_SCALE_TICKS = 4
"""Intervals of the scale of tension at most: its numbers must not overlap."""


class TensionerPicture:
    """A tensioner that moves with its pulley, drawn with its stops."""

    def __init__(self, ax: Axes, drive: Drive, carrier: Carrier) -> None:
        self._pulley, self._pivot = carrier.pulley, carrier.tensioner.anchor
        self._arm: Line2D | None = None
        draw_stops(ax, drive, carrier)
        if self._pivot is not None:
            (self._arm,) = ax.plot([], [], **LINE)
            draw_pivot(ax, self._pivot)
        elif carrier.tensioner.stops is None:
            center, along = carrier.place(0.0)
            reach = drive.pulleys[carrier.pulley].radius / float(np.hypot(*along)) * np.array([[-1.0], [1.0]])
            ax.plot(*(center + reach * along).T, linestyle=":", **LINE)

    def show(self, centers: FloatArray) -> None:
        """Move the arm to where the pulleys are, shape (n, 2), m."""
        if self._arm is not None and self._pivot is not None:
            self._arm.set_data(*np.array([self._pivot, centers[self._pulley]]).T)


def draw_pivot(ax: Axes, pivot: ArrayLike) -> None:
    """Draw the pivot of an arm, m."""
    ax.plot(
        *np.asarray(pivot), marker="o", markersize=7, markeredgecolor=TENSIONER, markerfacecolor="white", zorder=4.1
    )


def draw_stops(ax: Axes, drive: Drive, carrier: Carrier) -> None:
    """Draw the way of a tensioned pulley from stop to stop, dotted, and its rim at both, dashed."""
    if carrier.tensioner.stops is None:
        return
    lower, upper = carrier.tensioner.stops
    way = np.array([carrier.place(position)[0] for position in np.linspace(lower, upper, _WAY_POINTS)])
    ax.plot(*way.T, color=TENSIONER, linewidth=1.2, linestyle=":", zorder=4)
    radius = drive.pulleys[carrier.pulley].radius
    for center, name in ((way[0], "lower stop"), (way[-1], "upper stop")):
        rim = Circle(center, radius, fill=False, edgecolor=TENSIONER, linewidth=0.8, linestyle="--", zorder=1.5)
        rim.set_label(name)
        ax.add_patch(rim)


_ARROW_RADIUS = 0.62
"""Radius of the arrow of rotation, over that of the pulley: it lies inside the mark on the rim."""
_ARROW_ANGLE = np.radians(60.0)
"""Half the angle of the arrow of rotation, rad: it extends equally to both sides of the top."""
_MARK_RADII = (0.84, 0.97)
"""Radii of both ends of the mark that turns with a pulley, over that of the pulley: it lies just inside the rim."""
_MIN_LABEL_RADIUS = 0.13
"""Radius of a pulley, over the extent of the drive, above which its name has room inside."""
_CENTERED_COMPONENT = 0.4
"""Component of the direction of a text, a unit vector, up to which it is centered; beyond, its edge is at its point."""
_USUAL_WIDTH, _MAX_HEIGHT, _MIN_WIDTH = 7.0, 6.0, 4.0
"""Width of a drive that is not long, and the greatest height and the least width of any, inches."""
_LONG_DRIVE_RATIO, _MAX_WIDTH = 0.25, 13.0
"""Height over width below which a drive is long, and drawn wider; the greatest width, inches."""
_WORDS_WIDTH, _WORDS_HEIGHT = 1.0, 2.2
"""What words take of the width and of the height of a figure, inches."""
_MARGIN_SHARE = 0.04
"""Margin around the drive and its texts, over the longer side of their extent."""
_LAYOUT_ITERATIONS = 8
"""Iterations of limits and the meters that texts cover: each depends on the other, as letters keep their size."""
_ENLARGEMENT = 1.6
"""How much larger letters may get against the drive, when a headline takes its share of the figure."""
_POINTS_PER_INCH = 72.0
"""Points in an inch: letters are measured in points, and figures in inches."""
_TICK_WIDTH = 50.0
"""Width that a number below the axis takes, points."""


class DrivePicture:
    """Belt with its tension in color (N, scaled by `norm`), turning pulleys with names, and moving tensioners."""

    def __init__(self, run: Run | StaticResult, ax: Axes, norm: Normalize) -> None:
        self._kind = recorded_kind(run.dataset, run.prepared)
        self._belt_length = run.drive.belt_length
        self._radii = [pulley.radius for pulley in run.drive.pulleys]
        self._centers = run.drive.centers
        self._bodies = [_draw_pulley(ax, pulley, number) for number, pulley in enumerate(run.prepared.pulleys)]
        extent = float(np.ptp(extent_of(run.drive, run.drive.path), axis=0).max())
        for number, pulley in enumerate(run.drive.pulleys):
            write_pulley(ax, run.drive.path, number, pulley.name, extent, color(number))
        self._belt = LineCollection([], cmap=tension_colors(), norm=norm, linewidths=4.0, capstyle="round", zorder=3)
        self._belt.set_snap(False)
        ax.add_collection(self._belt)
        self._title = ax.set_title("")
        self._tensioners = [TensionerPicture(ax, run.drive, carrier) for carrier in run.prepared.carriers]
        _draw_scale(ax, self._belt, run.dataset["belt_tension"])
        _frame(ax, run)

    def show(self, instant: xr.Dataset) -> None:
        """Move everything to an instant."""
        lengths = present_lengths(instant, self._belt_length)
        self._belt.set_segments(list(centerline(self._kind, instant["nodal_coordinates"].values, lengths)))
        self._belt.set_array(instant["belt_tension"].values)
        centers = instant["pulley_center"].values if "pulley_center" in instant else self._centers
        angles = instant["pulley_angle"].values
        for body, center, radius, angle in zip(self._bodies, centers, self._radii, angles, strict=True):
            direction = np.array([np.cos(angle), np.sin(angle)])
            body.mark.set_data(*(center[:, None] + radius * np.outer(direction, _MARK_RADII)))
            body.rim.center = body.hub.center = tuple(center)
        for tensioner in self._tensioners:
            tensioner.show(centers)
        self._title.set_text(f"t = {float(instant['time']):.4g} s")


def draw_rotation(ax: Axes, center: ArrayLike, radius: float, speed: float) -> None:
    """Draw the direction of rotation as an arrow inside the pulley; nothing at speed zero."""
    if speed == 0.0:
        return
    turn = np.copysign(_ARROW_ANGLE, speed)
    angles = np.linspace(np.pi / 2 - turn, np.pi / 2 + turn, 40)
    points = np.asarray(center) + _ARROW_RADIUS * radius * np.column_stack([np.cos(angles), np.sin(angles)])
    style = "-|>,head_length=5,head_width=2.6"
    ax.add_patch(FancyArrowPatch(path=Outline(points), arrowstyle=style, color=INK, linewidth=1.3, zorder=2))


def size_of(drive: Drive) -> tuple[float, float]:
    """Width and height of a figure of a drive, inches: as wide and as high as it needs."""
    width, height = np.ptp(extent_of(drive, drive.path), axis=0)
    shape = float(height / width)
    wide = min(_USUAL_WIDTH * max(1.0, _LONG_DRIVE_RATIO / shape), _MAX_WIDTH, max(_MAX_HEIGHT / shape, _MIN_WIDTH))
    return wide + _WORDS_WIDTH, min(wide * shape, _MAX_HEIGHT) + _WORDS_HEIGHT


def fit_height(page: Figure, ax: Axes) -> None:
    """Make a page of one drive no higher than the drive needs after room was made for all words beside it."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    needed = (page.get_figwidth() - _WORDS_WIDTH) * (high - low) / (right - left) + _WORDS_HEIGHT
    page.set_figheight(min(page.get_figheight(), needed))


def extent_of(drive: Drive, path: Path) -> FloatArray:
    """Lower left and upper right corner of what is drawn, shape (2, 2), m."""
    radii = np.maximum(np.abs(path.radii), [pulley.radius for pulley in drive.pulleys])[:, None]
    points = [*(path.centers - radii), *(path.centers + radii)]
    points += [np.array(one.anchor) for one in drive.tensioners if one.anchor is not None]
    points += [] if path.ends is None else list(path.ends)
    for carrier in prepare(drive).carriers:
        ends = [carrier.place(position)[0] for position in carrier.tensioner.stops or ()]
        points += [end + side * radii[carrier.pulley] for end in ends for side in (-1.0, 1.0)]
    return np.array([np.min(points, axis=0), np.max(points, axis=0)])


def make_room(ax: Axes, extent: FloatArray) -> None:
    """Set limits and equal scales such that a rectangle, lower left to upper right (m), and all texts fit."""
    ax.set_aspect("equal")
    held = extent
    for _ in range(_LAYOUT_ITERATIONS):  # letters keep their size, so that they cover more meters when the limits grow
        margin = _MARGIN_SHARE * float(np.ptp(held, axis=0).max())
        low, high = held.min(axis=0) - margin, held.max(axis=0) + margin
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
        ax.figure.canvas.figure.draw_without_rendering()
        drawn = [text.get_window_extent().expanded(_ENLARGEMENT, _ENLARGEMENT).get_points() for text in ax.texts]
        boxes = [ax.transData.inverted().transform(box) for box in drawn]
        held = np.concatenate([extent, *boxes])
        if np.all(held > low) and np.all(held < high):
            break
    ax.apply_aspect()
    width = ax.get_window_extent().width * _POINTS_PER_INCH / ax.figure.dpi
    ax.xaxis.set_major_locator(MaxNLocator(max(2, int(width / _TICK_WIDTH)), steps=[1, 2, 2.5, 5, 10]))


def arc(path: Path, number: int) -> FloatArray:
    """Angles along the arc on a pulley, in the direction of motion, rad."""
    enters = path.span_points[path.reaching[number], 1] - path.centers[number]
    start = np.arctan2(enters[1], enters[0])
    turned = np.linspace(0.0, path.wrap_angles[number], 90)
    return np.asarray(start + np.sign(path.radii[number]) * turned)


def write_pulley(ax: Axes, path: Path, number: int, text: str, extent: float, tint: str = INK) -> None:
    """Write into a pulley; beside one too small for a drive of this extent, where there is no belt or beyond it."""
    style: dict[str, Any] = {"color": tint, "fontsize": 9, "weight": "bold", "linespacing": 1.2, "zorder": 6}
    radius = abs(path.radii[number])
    if radius > _MIN_LABEL_RADIUS * extent:
        place = path.centers[number] - [0.0, 0.28 * radius]
        style |= {"horizontalalignment": "center", "verticalalignment": "center"}
        ax.text(place[0], place[1], text, **style)
        return
    away = path.ends is None and path.radii[number] < 0 and path.wrap_angles[number] < np.pi
    middle = float(np.mean(arc(path, number)[[0, -1]])) + (np.pi if away else 0.0)
    nip = next((pair for pair in path.nips if number in pair), None)
    if nip is not None:
        other = nip[1] if number == nip[0] else nip[0]
        way = path.centers[number] - path.centers[other]
        middle = float(np.arctan2(way[1], way[0]))
    x, y = np.cos(middle), np.sin(middle)
    ax.annotate(
        text,
        tuple(path.centers[number] + radius * np.array([x, y])),
        xytext=(8.0 * x, 8.0 * y),
        textcoords="offset points",
        **aligned(x, y),
        **style,
    )


def aligned(x: float, y: float) -> dict[str, Any]:
    """Alignment of a text that lies in the direction (x, y) of its point, so that it keeps clear of it."""
    return {
        "horizontalalignment": "left" if x > _CENTERED_COMPONENT else "right" if x < -_CENTERED_COMPONENT else "center",
        "verticalalignment": "bottom" if y > _CENTERED_COMPONENT else "top" if y < -_CENTERED_COMPONENT else "center",
    }


class _Body(NamedTuple):
    """What is drawn of a pulley: rim and hub, which a tensioner may move, and the mark that turns."""

    rim: Circle
    hub: Circle
    mark: Line2D


def _draw_pulley(ax: Axes, pulley: Pulley, number: int) -> _Body:
    rim = Circle(pulley.center, pulley.radius, facecolor=PALE, edgecolor=INK, linewidth=0.9, zorder=1)
    hub = Circle(pulley.center, 0.05 * pulley.radius, color=INK, zorder=2)
    ax.add_patch(rim)
    ax.add_patch(hub)
    return _Body(rim, hub, ax.plot([], [], color=color(number), linewidth=3.0, zorder=2)[0])


def _frame(ax: Axes, run: Run | StaticResult) -> None:
    """Make room for the pulleys, and for the belt at any time."""
    positions = run.dataset["node_position"]
    places, (left, right) = positions.values.reshape(-1, 2), extent_of(run.drive, run.drive.path)
    low, high = np.minimum(places.min(axis=0), left), np.maximum(places.max(axis=0), right)
    ax.set(xlabel=f"x [{positions.attrs['units']}]", ylabel=f"y [{positions.attrs['units']}]")
    make_room(ax, np.array([low, high]))


def _draw_scale(ax: Axes, belt: LineCollection, tension: xr.DataArray) -> None:
    figure = ax.figure
    bar = figure.colorbar(belt, ax=ax, orientation="horizontal", fraction=0.06, aspect=45, pad=0.03)
    bar.locator = MaxNLocator(_MAX_SCALE_TICKS, steps=[1, 2, 2.5, 5, 10])
    bar.set_label(label(tension))
    bar.outline.set_visible(False)


# The drive as it stands at one instant


def _one_large_panel(draw: Callable[..., Axes], run: Result, choice: Choice) -> Figure:
    """Lay out a figure of one panel, as large as the drive asks for."""
    page = new_figure(size_of(run.drive))
    fit_height(page, draw(run, ax=page.add_subplot()))
    return page


@figure(always, _one_large_panel, of=(RUN, EQUILIBRIUM))
def configuration(run: Run | StaticResult, time: float | None = None, ax: Axes | None = None) -> Axes:
    """Draw belt and pulleys at one instant, the belt's tension in color.

    Parameters
    ----------
    run : Run or StaticResult
        The run, or the drive at rest.
    time : float, optional
        Time, s; the nearest output along the belt is used. By default the last one.
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
    >>> bd.plot.configuration(run).get_xlabel()
    'x [m]'
    """
    instant = run.fields_at(time)
    ax = axes_or_new(ax, size_of(run.drive))
    tension = instant["belt_tension"].values
    DrivePicture(run, ax, Normalize(*spread(float(tension.min()), float(tension.max()), "N"))).show(instant)
    ax.set_title(at_instant(run, float(instant["time"])))
    centers = instant["pulley_center"].values if "pulley_center" in instant else run.drive.centers
    for pulley, center, speed in zip(run.drive.pulleys, centers, instant["pulley_speed"].values, strict=True):
        draw_rotation(ax, center, pulley.radius, float(speed))
    return ax


_STRAIN_RANGE_RATIO = 1.1
"""Largest strain that is drawn, over the last one that was measured: the curve is seen to continue."""
_DEFAULT_MAX_STRAIN = 0.01
"""Largest strain that is drawn of a belt without a curve."""


@styled
def stretch(entry: Entry, name: str = "", ax: Axes | None = None) -> Axes:
    """Draw the tension of a catalogue belt over its strain, with the measured points.

    The dashed line is the initial slope.

    Parameters
    ----------
    entry : Entry
        The profile, as `beltdyn.read_catalogue` gives it.
    name : str
        The title; by default that of the entry.
    ax : Axes, optional
        Where to draw; a new figure by default.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> bd.plot.stretch(bd.read_catalogue()["PK"], name="PK").get_xlabel()
    'Strain [%]'
    """
    ax, curve = axes_or_new(ax), entry.stretch_curve
    law = Linear(entry.axial_stiffness) if curve is None else curve.parameters
    strain = np.linspace(0.0, _DEFAULT_MAX_STRAIN if curve is None else _STRAIN_RANGE_RATIO * curve.strains[-1], 200)
    tension = law.tension(1.0 + strain)
    ax.plot(100.0 * strain, tension, color=COLORS[0], label="in a drive")
    if curve is not None:
        points = 100.0 * np.array(curve.strains), np.array(curve.tensions)
        ax.plot(*points, color=COLORS[1], marker="o", linestyle="", label="measured")
        begins = f"{entry.axial_stiffness:.4g} N × strain"
        ax.plot(
            100.0 * strain, entry.axial_stiffness * strain, color=INK, linewidth=0.8, linestyle=dash(1), label=begins
        )
        ax.set_ylim(0.0, 1.2 * float(max(tension)))
        ax.legend(loc="lower right")
    ax.set(xlabel="Strain [%]", ylabel="Tension [N]")
    ax.set_title(name or entry.title)
    return ax


@styled
def save_stretch(entry: Entry, path: pathlib.Path | str, name: str = "", *, overwrite: bool = False) -> pathlib.Path:
    """Save the tension-strain diagram of a catalogue belt; see `stretch`.

    Parameters
    ----------
    entry : Entry
        The profile.
    path : pathlib.Path or str
        The file: PNG, SVG, PDF or another format of matplotlib.
    name : str
        The title; by default that of the entry.
    overwrite : bool
        Replace any regular file, and not only figures of beltdyn.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    ModelError
        If the format is unknown, the file cannot be written, or would replace one that is no figure of ours.

    Examples
    --------
    >>> belt = bd.read_catalogue()["PK"]
    >>> bd.plot.save_stretch(belt, "stretch.svg", name="PK").name
    'stretch.svg'
    """
    figure = new_figure()
    stretch(entry, name, figure.add_subplot())
    return save(figure, pathlib.Path(path), overwrite)

"""The picture of a drive at one instant, which can be moved to another instant."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, FancyArrowPatch
from matplotlib.path import Path as Outline
from numpy.typing import ArrayLike

from beltdyn.model import Pulley
from beltdyn.plot.curve import centerline, element_lengths
from beltdyn.plot.style import INK, PALE, color, label, tension_colors
from beltdyn.results import Run

_ARROW_RADIUS = 0.62
_ARROW_ANGLE = np.radians(60.0)
_MARK = (0.84, 0.97)
_ROOMY = 0.12
_STEEP = 0.5


class DrivePicture:
    """Belt with its tension in color, pulleys with names, marks and the direction of rotation.

    Parameters
    ----------
    run : Run
        The run.
    ax : Axes
        Where to draw.
    norm : Normalize
        Tensions, N, at the ends of the color scale.
    """

    def __init__(self, run: Run, ax: Axes, norm: Normalize) -> None:
        self._lengths = element_lengths(run.dataset, run.drive.belt.length)
        self._radii = [pulley.radius for pulley in run.drive.pulleys]
        self._centers = run.drive.centers
        self._bodies = [_draw_pulley(ax, pulley, number) for number, pulley in enumerate(run.drive.pulleys)]
        _write_names(ax, run.drive.pulleys)
        self._belt = LineCollection([], cmap=tension_colors(), norm=norm, linewidths=4.0, capstyle="round", zorder=3)
        self._belt.set_snap(False)
        ax.add_collection(self._belt)
        self._title = ax.set_title("")
        _frame(ax, run)
        _draw_scale(ax, self._belt, run.dataset["belt_tension"])

    def show(self, instant: xr.Dataset) -> None:
        """Move everything to an instant.

        Parameters
        ----------
        instant : xarray.Dataset
            The result at one time.
        """
        self._belt.set_segments(list(centerline(instant["nodal_coordinates"].values, self._lengths)))
        self._belt.set_array(instant["belt_tension"].values)
        centers = instant["pulley_center"].values if "pulley_center" in instant else self._centers
        angles = instant["pulley_angle"].values
        for body, center, radius, angle in zip(self._bodies, centers, self._radii, angles, strict=True):
            direction = np.array([np.cos(angle), np.sin(angle)])
            body.mark.set_data(*(center[:, None] + radius * np.outer(direction, _MARK)))
            body.rim.center = body.hub.center = tuple(center)
        self._title.set_text(f"t = {float(instant['time']):.4g} s")


def draw_rotation(ax: Axes, center: ArrayLike, radius: float, speed: float) -> None:
    """Draw the direction of rotation as an arrow inside the pulley; nothing when it stands still.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    center : array_like, shape (2,), m
        Center of the pulley.
    radius : float
        Its radius, m.
    speed : float
        Its speed, rad/s, counter-clockwise positive.
    """
    if speed == 0.0:
        return
    turn = np.copysign(_ARROW_ANGLE, speed)
    angles = np.linspace(np.pi / 2 - turn, np.pi / 2 + turn, 40)
    points = np.asarray(center) + _ARROW_RADIUS * radius * np.column_stack([np.cos(angles), np.sin(angles)])
    style = "-|>,head_length=5,head_width=2.6"
    ax.add_patch(FancyArrowPatch(path=Outline(points), arrowstyle=style, color=INK, linewidth=1.3, zorder=2))


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


def _write_names(ax: Axes, pulleys: Sequence[Pulley]) -> None:
    """Write names into the pulleys; beside those too small, on the side of the middle of the drive."""
    centers = np.array([pulley.center for pulley in pulleys])
    middle, extent = centers.mean(axis=0), np.ptp(centers, axis=0).max()
    for number, pulley in enumerate(pulleys):
        place, offset, align = np.array([0.0, -0.32]), np.zeros(2), "center"
        if pulley.radius < _ROOMY * extent:
            place = (middle - pulley.center) / np.linalg.norm(middle - pulley.center)
            offset = 12.0 * place
            align = "center" if abs(place[0]) < _STEEP else "left" if place[0] > 0 else "right"
        x, y = pulley.center + pulley.radius * place
        ax.annotate(
            pulley.name,
            (x, y),
            xytext=(offset[0], offset[1]),
            textcoords="offset points",
            horizontalalignment=align,
            verticalalignment="center",
            color=color(number),
            weight="bold",
            zorder=4,
        )


def _frame(ax: Axes, run: Run) -> None:
    """Make room for the pulleys, and for the belt at any time."""
    positions = run.dataset["node_position"]
    centers = np.array([pulley.center for pulley in run.drive.pulleys])
    radii = np.array([[pulley.radius] for pulley in run.drive.pulleys])
    low = np.min([positions.min(("time", "node")), *(centers - radii)], axis=0)
    high = np.max([positions.max(("time", "node")), *(centers + radii)], axis=0)
    margin = 0.06 * float((high - low).max())
    ax.set(xlim=(low[0] - margin, high[0] + margin), ylim=(low[1] - margin, high[1] + margin))
    ax.set_aspect("equal")
    ax.set(xlabel=f"x [{positions.attrs['units']}]", ylabel=f"y [{positions.attrs['units']}]")


def _draw_scale(ax: Axes, belt: LineCollection, tension: xr.DataArray) -> None:
    figure = ax.figure
    bar = figure.colorbar(belt, ax=ax, orientation="horizontal", fraction=0.06, aspect=45, pad=0.03)
    bar.set_label(label(tension))
    bar.outline.set_visible(False)

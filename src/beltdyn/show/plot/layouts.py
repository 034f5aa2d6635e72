"""The layout of a drive at rest."""

from collections.abc import Iterator
from itertools import chain
from pathlib import Path as FilePath
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyArrowPatch, Wedge
from matplotlib.path import Path as Outline
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.machines import FixedTensioner, Tensioner
from beltdyn.model import Drive, Installation, Path, install, prepare
from beltdyn.model.end import End
from beltdyn.model.path import crossings
from beltdyn.show.plot.drive_picture import (
    LINE,
    TENSIONER,
    aligned,
    arc,
    draw_pivot,
    draw_rotation,
    draw_stops,
    extent_of,
    fit_height,
    make_room,
    size_of,
    write_pulley,
)
from beltdyn.show.plot.figures import save
from beltdyn.show.plot.style import COLORS, INK, PALE, axes_or_new, color, new_figure, styled

_BELT = COLORS[0]
_WAY_LENGTH, _WAY_POINTS = 1.4, 20
"""Length of a way that is drawn, over the radius of the pulley, and its number of points."""
_MIN_LABEL_SHARE = 0.06
"""Share of the extent of a drive from which on a span has room for its length."""
_ARROW = "-|>,head_length=5,head_width=2.4"


@styled
def layout(drive: Drive, installation: Installation | None = None, ax: Axes | None = None) -> Axes:
    """Draw belt and pulleys at rest: spans and their lengths, wrap angles, directions of rotation, tensioners.

    A tensioner is drawn with its arm and pivot, or its line, an arrow in its tensioning direction, and its pulley at
    both stops (dashed).

    Parameters
    ----------
    drive : Drive
        The drive.
    installation : Installation, optional
        Its belt at rest; by default in static equilibrium, or as estimated by hand where there is none.
    ax : Axes, optional
        Where to draw; a new figure by default, as high as the drive needs.

    Returns
    -------
    Axes
        The axes.

    Examples
    --------
    >>> bd.plot.layout(drive).get_aspect()
    1.0
    """
    if installation is None:
        drive, installation = _at_rest(drive)
    path = installation.path
    extent = extent_of(drive, path)
    ax = axes_or_new(ax, size_of(drive))
    for number in range(path.count):
        _draw_pulley(ax, drive, path, number)
    _draw_belt(ax, path)
    for carrier in prepare(drive).carriers:
        draw_stops(ax, drive, carrier)
    for tensioner, way in _ways(drive, installation):
        _draw_tensioner(ax, tensioner, way)
    if path.ends is not None:
        for end, point, way in zip(drive.ends, path.ends, path.ways_out, strict=True):
            _draw_end(ax, end, point, way)
    for number, pulley in enumerate(drive.pulleys):
        text = f"{number + 1} {pulley.name}\n{np.degrees(path.wrap_angles[number]):.0f}°"
        write_pulley(ax, path, number, text, float(np.ptp(extent, axis=0).max()))
    _write_spans(ax, path, _MIN_LABEL_SHARE * float(np.ptp(extent, axis=0).max()))
    ax.set(xlabel="x [m]", ylabel="y [m]")
    name = f"{drive.name}\n" if drive.name else ""
    ax.set_title(
        f"{name}belt {drive.belt_length:.5g} m on a path of {path.length:.5g} m, {installation.tension:.4g} N at rest"
    )
    make_room(ax, extent)
    return ax


@styled
def save_layout(
    drive: Drive, path: FilePath | str, installation: Installation | None = None, overwrite: bool = False
) -> FilePath:
    """Draw the layout of a drive into a file.

    Parameters
    ----------
    drive : Drive
        The drive.
    path : Path or str
        The file: PNG, SVG, PDF or another format of matplotlib.
    installation : Installation, optional
        Its belt at rest; by default in static equilibrium, or as estimated by hand where there is none.
    overwrite : bool
        Replace any regular file, and not only figures of beltdyn.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If the format is unknown, the file cannot be written, or would replace one that is no figure of ours.

    Examples
    --------
    >>> bd.plot.save_layout(drive, "layout.svg").name
    'layout.svg'
    """
    path = FilePath(path)
    figure = new_figure(size_of(drive))
    fit_height(figure, layout(drive, installation, figure.add_subplot()))
    return save(figure, path, overwrite)


def _at_rest(drive: Drive) -> tuple[Drive, Installation]:
    """The drive, with the length or take-up that was found, and its belt at rest."""
    from beltdyn.state.installation import bring_to_rest

    if drive.stays_at_rest:
        return drive, install(drive)
    try:
        rest = bring_to_rest(drive)
    except ConvergenceError:
        return drive, install(drive)
    return rest.drive, rest.installation


def _draw_pulley(ax: Axes, drive: Drive, path: Path, number: int) -> None:
    """Draw a pulley with the sector that the belt wraps, and its direction of rotation."""
    center, radius = path.centers[number], drive.pulleys[number].radius
    ax.add_patch(Circle(tuple(center), radius, facecolor=PALE, edgecolor="none", zorder=1))
    start, end = np.degrees(arc(path, number)[[0, -1]])
    tint: dict[str, Any] = {"facecolor": color(number), "alpha": 0.22, "edgecolor": "none", "zorder": 1.1}
    ax.add_patch(Wedge(tuple(center), radius, min(start, end), max(start, end), **tint))
    ax.add_patch(Circle(tuple(center), radius, facecolor="none", edgecolor=INK, linewidth=0.9, zorder=1.2))
    ax.add_patch(Circle(tuple(center), 0.05 * radius, color=INK, zorder=2))
    if not drive.guides[number]:
        draw_rotation(ax, center, radius, drive.running_sense * drive.pulleys[number].turning)


def _draw_belt(ax: Axes, path: Path) -> None:
    """Draw arcs and spans with the direction of motion, each span over those before it."""
    crossing = set(chain(*crossings(path)))
    for number in path.on.tolist():
        angle = arc(path, number)
        points = path.centers[number] + abs(path.radii[number]) * np.column_stack([np.cos(angle), np.sin(angle)])
        ax.plot(*points.T, color=_BELT, linewidth=3.0, solid_capstyle="butt", zorder=3)
    for number, (start, end) in enumerate(path.span_points):
        style: dict[str, Any] = {"solid_capstyle": "butt", "zorder": 3.1 + 0.01 * number}
        if number in crossing:
            free = np.array([start + 0.15 * (end - start), start + 0.85 * (end - start)])
            ax.plot(*free.T, color="white", linewidth=7.0, **style)
        ax.plot(*np.array([start, end]).T, color=_BELT, linewidth=3.0, **style)
        ax.add_patch(_arrow([start + 0.7 * (end - start), start + 0.8 * (end - start)], _BELT, 14))


def _ways(drive: Drive, installation: Installation) -> Iterator[tuple[Tensioner, FloatArray]]:
    """Tensioners, each with the way on which the center of its pulley tensions the belt, shape (n, 2), m."""
    path, parts = installation.path, np.linspace(0.0, _WAY_LENGTH, _WAY_POINTS)
    radii = np.abs(path.radii)
    for tensioner in drive.tensioners:
        if isinstance(tensioner, FixedTensioner):
            number = drive.carried(tensioner)
            yield tensioner, path.centers[number] + np.outer(radii[number] * parts, tensioner.direction)
    for carrier, position in zip(prepare(drive).carriers, installation.tensioner_positions.tolist(), strict=True):
        step = radii[carrier.pulley] / np.linalg.norm(carrier.place(position)[1])
        yield carrier.tensioner, np.array([carrier.place(position + step * part)[0] for part in parts])


def _draw_tensioner(ax: Axes, tensioner: Tensioner, way: FloatArray) -> None:
    """Draw the arm or the line of a tensioner, and an arrow the way in which it tensions the belt."""
    center, pivot = way[0], tensioner.anchor
    if pivot is None:
        ax.plot(*np.array([2.0 * center - way[-1], center]).T, linestyle=":", **LINE)
    else:
        ax.plot(*np.array([pivot, center]).T, **LINE)
        draw_pivot(ax, pivot)
    ax.add_patch(_arrow(way, TENSIONER, 9))


def _draw_end(ax: Axes, end: End, point: FloatArray, way: FloatArray) -> None:
    """Draw an end of an open belt with its name, beyond it: a square that is fixed, or an arrow that pulls."""
    if end.held:
        ax.plot(*point, marker="s", markersize=8, color=INK, zorder=4)
    ax.annotate(
        end.name,
        tuple(point),
        xytext=tuple((8.0 if end.held else 36.0) * way),
        textcoords="offset points",
        arrowprops=None if end.held else {"arrowstyle": "<|-", "color": TENSIONER, "linewidth": 1.6},
        **aligned(*way),
        color=INK,
        fontsize=9,
        weight="bold",
        zorder=6,
    )


def _arrow(points: ArrayLike, paint: str, size: float) -> FancyArrowPatch:
    return FancyArrowPatch(
        path=Outline(np.asarray(points)),
        arrowstyle=_ARROW,
        color=paint,
        linewidth=1.6,
        mutation_scale=size / 8,
        zorder=5,
    )


def _write_spans(ax: Axes, path: Path, room: float) -> None:
    """Write the length of each span that has room (m) for it beside its middle, on the belt's back."""
    crossing = set(chain(*crossings(path)))
    for number, (start, end) in enumerate(path.span_points):
        along, length = path.span_directions[number], path.span_lengths[number]
        if length < room:
            continue
        place = 0.22 if number in crossing else 0.42
        angle = np.degrees(np.arctan2(along[1], along[0]))
        x, y = along[1], -along[0]
        ax.annotate(
            f"{length:.4g} m",
            tuple(start + place * (end - start)),
            xytext=(9.0 * x, 9.0 * y),
            textcoords="offset points",
            rotation=(angle + 90.0) % 180.0 - 90.0,
            rotation_mode="anchor",
            horizontalalignment="center",
            verticalalignment="center",
            color=_BELT,
            fontsize=8,
            zorder=6,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6, "alpha": 0.8},
        )

"""Mode shapes of a drive, still or animated."""

from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.errors import ModelError
from beltdyn.plot.animation import film
from beltdyn.plot.drive import extent_of, size_of
from beltdyn.plot.panels import panels, rows
from beltdyn.plot.registry import Choice, always, figure
from beltdyn.plot.style import INK, PALE, axes_or_new, color, styled
from beltdyn.plot.tensioner import LINE
from beltdyn.results import Result

_DRAWN = 0.06
"""Size at which the largest displacement is drawn, over that of the drive."""
_MOST = 12
"""Modes on a page."""
KINDS = ("span", "rotational", "tensioner", "coupled")
"""Kinds of modes, in the order of their colors."""
_FRAMES = 24


class Swing(NamedTuple):
    """How the parts of a drive move in a mode: the real part of these, times exp(i phase), at a phase.

    Attributes
    ----------
    belt : ndarray, shape (points, 2)
        Ways of the points of the belt, m.
    centers : ndarray, shape (pulleys, 2)
        Ways of the centers of the pulleys, m.
    angles : ndarray, shape (pulleys,)
        Rotation of the pulleys, rad.
    size : float
        The largest of these ways, those of rims included, m.
    """

    belt: ComplexArray
    centers: ComplexArray
    angles: ComplexArray
    size: float


def swing(result: Result, mode: int) -> Swing:
    """How parts move in a mode, at a size that is seen.

    Parameters
    ----------
    result : Result
        Of `modes`.
    mode : int
        Which one, from 1 on.
    """
    one, drive = result.dataset.sel(mode=mode), result.drive
    size = _DRAWN * float(np.ptp(extent_of(drive, drive.path), axis=0).max())
    belt = size * _complex(one["belt_shape"].values)[:, None] * one["point_normal"].values
    centers = np.zeros((len(drive.pulleys), 2), complex)
    arms = _complex(one["tensioner_shape"].values) if "tensioner_shape" in one else np.zeros(0, complex)
    for carrier, way in zip(drive.carriers, arms, strict=True):
        along = carrier.place(0.0)[1]
        centers[carrier.pulley] = size * way * along / np.linalg.norm(along)
    return Swing(belt, centers, size * _complex(one["rim_shape"].values) / np.abs(drive.path.radii), size)


def shown_modes(result: Result) -> list[int]:
    """Numbers of the modes that are drawn on a page: the first ones."""
    return [int(one) for one in result.dataset["mode"].values[:_MOST]]


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
    """A mode of a drive, which can be moved to another phase.

    Parameters
    ----------
    result : Result
        Of `modes`.
    mode : int
        Which one, from 1 on.
    ax : Axes
        Where to draw.
    """

    def __init__(self, result: Result, mode: int, ax: Axes) -> None:
        drive, self._swing = result.drive, swing(result, mode)
        extent, size = extent_of(drive, drive.path), self._swing.size
        self._place = result.dataset["point_position"].values
        self._carriers, self._radii, self._centers = drive.carriers, np.abs(drive.path.radii), drive.path.centers
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
        The file: a GIF, or an MP4, for which ``pip install "beltdyn[video]"`` or the program ffmpeg is needed.
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
        for phase in 2.0 * np.pi * np.arange(_FRAMES) / _FRAMES:
            for picture in pictures:
                picture.show(float(phase))
            take()
    return Path(path)

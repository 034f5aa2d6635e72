"""A run as a moving picture."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import which

import matplotlib as mpl
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from PIL.Image import Image

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.quantity import number_in
from beltdyn.results import Run
from beltdyn.results.atomic import MARK, atomic_path, is_marked, require_replaceable
from beltdyn.show.plot.drive_picture import DrivePicture, size_of
from beltdyn.show.plot.style import new_figure, spread, styled

_RESOLUTION = 100
"""Resolution of the pictures of an animation, pixels per inch: a drive 7 inches wide has 700 pixels."""
_EVEN = ("-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p")
"""Widths and heights of pictures must be even, and all players know these colors."""
_STEP_TOLERANCE = 0.02
"""Part of a step of the angle by which outputs may lie further apart, as where the speed has ripple."""


@styled
def animate(
    run: Run,
    path: Path | str,
    frames: int = 150,
    frame_rate: int = 25,
    overwrite: bool = False,
    *,
    start: float | str | None = None,
    end: float | str | None = None,
    per_turn: int | None = None,
) -> Path:
    """Write an animation of belt and pulleys, the belt's tension in color.

    Parameters
    ----------
    run : Run
        The run.
    path : Path or str
        The file: a GIF, or an MP4, which needs the extra ``beltdyn[video]`` or the program ffmpeg.
    frames : int
        Largest number of pictures; they are spread evenly over the outputs of fields.
    frame_rate : float
        Pictures shown per second.
    overwrite : bool
        Replace any regular file, and not only animations of beltdyn.
    start, end : float or str, optional
        Time range, such as "0.5 s", or in s; by default the whole run.
    per_turn : int, optional
        Pictures for each turn of the first pulley, in place of `frames`: slow motion in which the eye can follow it.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If the run holds no output, or too few for this; the format is unknown or needs a program that is missing; or
        the file cannot be written or would replace one that is no animation of ours.
    """
    path = Path(path)
    run.require_output()
    chosen = _instants(run, frames, start, end, per_turn)
    figure = new_figure(size_of(run.drive))
    tension = run.dataset["belt_tension"].sel(field_time=slice(chosen[0], chosen[-1]))
    with film(figure, path, frame_rate, overwrite) as take:
        picture = DrivePicture(
            run, figure.add_subplot(), Normalize(*spread(float(tension.min()), float(tension.max()), "N"))
        )
        for time in chosen:
            picture.show(run.fields_at(time))
            take()
    return path


@contextmanager
def film(figure: Figure, path: Path, frame_rate: int, overwrite: bool) -> Iterator[Callable[[], None]]:
    """Write an animation: what is given takes the figure as it is as the next picture."""
    with mpl.rc_context({"animation.ffmpeg_path": _ffmpeg()}):
        writer = _writer(path, frame_rate)
        require_replaceable(path, is_marked, overwrite)

        def take() -> None:
            writer.grab_frame()
            figure.set_layout_engine("none")

        with atomic_path(path, is_marked, overwrite) as temporary, writer.saving(figure, str(temporary), _RESOLUTION):
            yield take


def _instants(
    run: Run, frames: int, start: float | str | None, end: float | str | None, per_turn: int | None
) -> FloatArray:
    """Outputs of fields that are shown, s."""
    times = run.dataset["field_time"].values
    first = times[0] if start is None else number_in("start", start, "s")
    last = times[-1] if end is None else number_in("end", end, "s")
    inside = times[(times >= first) & (times <= last)]
    if inside.size == 0:
        raise ModelError(
            f"there is no output along the belt from {first:.4g} to {last:.4g} s; there are outputs from "
            f"{times[0]:.4g} to {times[-1]:.4g} s. Choose a longer time, or reduce simulation.field_interval."
        )
    if per_turn is None:
        return np.asarray(inside[np.unique(np.linspace(0, len(inside) - 1, frames).round().astype(int))])
    if per_turn < 1:
        raise ModelError(f"{per_turn} pictures per turn must be 1 or more.")
    turned = np.abs(run.dataset["pulley_angle"][:, 0].sel(time=inside).values) / (2.0 * np.pi)
    largest = float(np.max(np.diff(turned))) if inside.size > 1 else np.inf
    if largest * per_turn > 1.0 + _STEP_TOLERANCE:
        most = f"take {int(1.0 / largest)} a turn or fewer, or " if largest < 1.0 else ""
        raise ModelError(
            f"{per_turn} pictures per turn need more outputs along the belt: between two of them "
            f"{run.drive.pulleys[0].name} makes up to {largest:.3g} turns. In the animation {most}reduce "
            "simulation.field_interval and run again."
        )
    wanted = np.arange(turned[0], turned[-1], 1.0 / per_turn)
    return np.asarray(inside[np.unique(np.searchsorted(turned, wanted).clip(max=len(inside) - 1))])


def _ffmpeg() -> str:
    """The program that writes MP4: that of the system, or that of the package imageio-ffmpeg."""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe
    except ImportError:
        return which("ffmpeg") or "ffmpeg"  # a folder's own matplotlibrc may name any program
    return str(get_ffmpeg_exe())


class _MarkedGif(PillowWriter):
    """A GIF whose comment says who made it."""

    _frames: list[Image]

    def finish(self) -> None:
        """Write the file."""
        self._frames[0].info["comment"] = MARK.encode()
        super().finish()


def _writer(path: Path, frame_rate: int) -> AbstractMovieWriter:
    match path.suffix.lower():
        case ".gif":
            return _MarkedGif(fps=frame_rate)
        case ".mp4" if FFMpegWriter.isAvailable():
            return FFMpegWriter(fps=frame_rate, metadata={"comment": MARK}, extra_args=list(_EVEN))
        case ".mp4":
            raise ModelError(
                f"{path} cannot be written: MP4 needs the program ffmpeg. Install beltdyn with its extra "
                "beltdyn[video], or write a .gif."
            )
        case suffix:
            raise ModelError(
                f"{path} cannot be written: {suffix or 'no suffix'} is not a format for animations. Use .gif or .mp4."
            )

"""A run as a moving picture."""

from pathlib import Path

import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.colors import Normalize
from PIL.Image import Image

from beltdyn.errors import ModelError
from beltdyn.plot.drive import DrivePicture, size_of
from beltdyn.plot.style import new_figure, styled
from beltdyn.results import Run
from beltdyn.results.atomic import MARK, atomic_path, is_marked, require_replaceable

_DPI = 100


@styled
def animate(run: Run, path: Path | str, frames: int = 150, frame_rate: int = 25, overwrite: bool = False) -> Path:
    """Write an animation of belt and pulleys, the belt's tension in color.

    Parameters
    ----------
    run : Run
        The run.
    path : Path or str
        The file: a GIF, or an MP4 where the program ffmpeg is installed.
    frames : int
        Largest number of pictures; they are spread evenly over the outputs of fields.
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
        If the run holds no output, the format is unknown or needs a program that is missing, or the file
        cannot be written or would replace one that is no animation of ours.
    """
    path = Path(path)
    run.require_output()
    writer = _writer(path, frame_rate)
    require_replaceable(path, is_marked, overwrite)
    figure = new_figure(size_of(run.drive))
    tension = run.dataset["belt_tension"]
    picture = DrivePicture(run, figure.add_subplot(), Normalize(float(tension.min()), float(tension.max())))
    times = run.dataset["field_time"].values
    chosen = times[np.unique(np.linspace(0, len(times) - 1, frames).round().astype(int))]
    with atomic_path(path, is_marked, overwrite) as temporary, writer.saving(figure, str(temporary), _DPI):
        for time in chosen:
            picture.show(run.fields_at(time))
            writer.grab_frame()
            figure.set_layout_engine("none")
    return path


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
            return FFMpegWriter(fps=frame_rate, metadata={"comment": MARK})
        case ".mp4":
            raise ModelError(f"{path} cannot be written: MP4 needs the program ffmpeg. Install it, or write a .gif.")
        case suffix:
            raise ModelError(
                f"{path} cannot be written: {suffix or 'no suffix'} is not a format for animations. Use .gif or .mp4."
            )

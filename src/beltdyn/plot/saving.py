"""Figures into files."""

from pathlib import Path

from matplotlib.figure import Figure

from beltdyn.results.atomic import MARK, atomic_path, is_marked

_SAYS_WHO_MADE_IT = {".png": "Software", ".svg": "Creator", ".pdf": "Creator", ".ps": "Creator", ".eps": "Creator"}
"""Suffix -> the field of the file's own description that names its maker."""


def save(figure: Figure, path: Path, overwrite: bool = False) -> Path:
    """Write a figure.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : Path
        The file, whose suffix is the format; a figure of beltdyn that is there is replaced.
    overwrite : bool
        Replace any regular file.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    ModelError
        If the file cannot be written, or would replace one that is no figure of ours.
    """
    field = _SAYS_WHO_MADE_IT.get(path.suffix.lower())
    with atomic_path(path, is_marked, overwrite) as temporary:
        figure.savefig(temporary, metadata={field: MARK} if field else None)
    return path

"""Saving of figures to files and pages."""

import base64
import io
from pathlib import Path
from typing import Literal

from matplotlib import rc_context
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results.atomic import MARK, atomic_path, is_marked

_SAYS_WHO_MADE_IT = {".png": "Software", ".svg": "Creator", ".pdf": "Creator", ".ps": "Creator", ".eps": "Creator"}
"""Suffix -> the field of the file's own description that names its maker."""

_PNG_DPI = 200


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
        If the format is unknown, the file cannot be written, or would replace one that is no figure of ours.
    """
    formats = figure.canvas.get_supported_filetypes()
    if path.suffix.lower().lstrip(".") not in formats:
        raise ModelError(
            f"{path} cannot be written: {path.suffix or 'no suffix'} is not a format for figures. "
            f"Use one of {', '.join(formats)}."
        )
    field = _SAYS_WHO_MADE_IT.get(path.suffix.lower())
    with atomic_path(path, is_marked, overwrite) as temporary:
        figure.savefig(temporary, metadata={field: MARK} if field else None)
    return path


def data_uri(figure: Figure, file_format: Literal["svg", "png"] = "svg") -> str:
    """Write a figure as an address that holds it, for the attribute ``src`` of a page's ``img``.

    Parameters
    ----------
    figure : Figure
        The figure.
    file_format : {"svg", "png"}
        PNG for figures with very many points.

    Returns
    -------
    str
        The same for the same figure.
    """
    stream = io.BytesIO()
    with rc_context({"svg.hashsalt": MARK, "path.simplify_threshold": 0.3}):
        metadata = {"Date": None} if file_format == "svg" else None
        figure.savefig(
            stream, format=file_format, dpi=_PNG_DPI, metadata=metadata, bbox_inches="tight", pad_inches=0.03
        )
    kind = {"svg": "svg+xml", "png": "png"}[file_format]
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode()}"

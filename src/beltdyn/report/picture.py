"""Figures as pictures inside the page."""

import base64
import io
from collections.abc import Callable
from functools import wraps
from typing import Literal, ParamSpec

from matplotlib import rc_context
from matplotlib.figure import Figure

from beltdyn.plot.style import styled
from beltdyn.report.statement import Picture

P = ParamSpec("P")
_PNG_DPI = 200


def picture(
    caption: str, file_format: Literal["svg", "png"] = "svg"
) -> Callable[[Callable[P, Figure]], Callable[P, Picture]]:
    """Make a function that draws a figure give a picture of the page, in the style of this package.

    Parameters
    ----------
    caption : str
        What the figure shows.
    file_format : {"svg", "png"}
        PNG for figures with very many points.
    """

    def decorate(draw: Callable[P, Figure]) -> Callable[P, Picture]:
        @wraps(draw)
        @styled
        def give(*args: P.args, **kwargs: P.kwargs) -> Picture:
            return Picture(_data_uri(draw(*args, **kwargs), file_format), caption)

        return give

    return decorate


def _data_uri(figure: Figure, file_format: Literal["svg", "png"]) -> str:
    stream = io.BytesIO()
    with rc_context({"svg.hashsalt": "beltdyn", "path.simplify_threshold": 0.3}):
        metadata = {"Date": None} if file_format == "svg" else None
        figure.savefig(
            stream, format=file_format, dpi=_PNG_DPI, metadata=metadata, bbox_inches="tight", pad_inches=0.03
        )
    kind = {"svg": "svg+xml", "png": "png"}[file_format]
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode()}"

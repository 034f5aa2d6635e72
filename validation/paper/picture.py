"""Figures as pictures inside the page."""

from collections.abc import Callable
from functools import wraps
from typing import Literal, ParamSpec

from matplotlib.figure import Figure

from beltdyn.show.plot.figures import data_uri
from beltdyn.show.plot.style import styled
from validation.paper.statement import Picture

P = ParamSpec("P")


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
            return Picture(data_uri(draw(*args, **kwargs), file_format), caption)

        return give

    return decorate

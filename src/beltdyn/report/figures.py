"""Figures of a report, as drawings and as interactive charts."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.plot.figures import chosen_by_default
from beltdyn.plot.registry import FIGURES, Choice
from beltdyn.plot.saving import data_uri
from beltdyn.plot.style import NOTE, RESERVATION, styled
from beltdyn.report.chart import charts
from beltdyn.results import Result

_LARGEST_DRAWING = 300_000
"""Letters of a drawing of lines from which on it is smaller as pixels."""
_WIDE = 8.0
"""Width of a picture of several panels side by side, inches."""


class Shown(NamedTuple):
    """A figure on the page.

    Attributes
    ----------
    name : str
        Its name in words.
    source : str
        The picture, for paper and for browsers without JavaScript.
    charts : list of str
        Where its charts stand on the page; none where it is best as it is.
    missing : str
        Why it cannot be drawn of these results, as of drives with other pulleys; empty where it is.
    notes : tuple of str
        What is written on the picture, and stands below its charts.
    wide : bool
        Whether it has panels side by side, so that it is scrolled where there is no room for it.
    """

    name: str
    source: str
    charts: list[str]
    missing: str = ""
    notes: tuple[str, ...] = ()
    wide: bool = False


@styled
def charted(results: Sequence[Result], names: Sequence[str] | None = None) -> tuple[list[Shown], dict[str, Any]]:
    """Draw figures of results.

    Parameters
    ----------
    results : sequence of Result
        One or more, which are compared.
    names : sequence of str, optional
        Names of the figures; by default those that these results have by default.

    Returns
    -------
    shown : list of Shown
        The figures.
    charts : dict
        Place on the page -> chart of Bokeh.

    Raises
    ------
    ModelError
        If there is no figure of such a name.
    """
    shown: list[Shown] = []
    models: dict[str, Any] = {}
    if unknown := [name for name in names or () if name not in FIGURES]:
        raise ModelError(f"there is no figure {unknown[0]!r}. Choose one of {', '.join(FIGURES)}.")
    for name in chosen_by_default(results) if names is None else names:
        title = name.replace("_", " ").capitalize()
        try:
            drawn = FIGURES[name].arrange(results, Choice())
        except ModelError as error:
            shown.append(Shown(title, "", [], str(error)))
            continue
        places = {f"{name}-{number}": chart for number, chart in enumerate(charts(drawn))}
        shown.append(Shown(title, _picture(drawn), list(places), "", _notes(drawn), drawn.get_figwidth() > _WIDE))
        models |= places
    return shown, models


def _notes(drawn: Figure) -> tuple[str, ...]:
    """What is written into the corners and along the edges of panels, each once."""
    texts = (text for ax in drawn.axes for text in ax.texts if text.get_gid() in (NOTE, RESERVATION))
    return tuple(dict.fromkeys(line for text in texts for line in text.get_text().splitlines() if line))


def _picture(drawn: Figure) -> str:
    """A drawing, or pixels where these are smaller."""
    drawn.suptitle("")
    source = data_uri(drawn)
    return source if len(source) < _LARGEST_DRAWING else data_uri(drawn, "png")

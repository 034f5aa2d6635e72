"""Figures by name. A figure registers itself with the decorator `figure`, and is then drawn by `save_all`."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, NamedTuple, ParamSpec

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.analyses import RUN
from beltdyn.errors import ModelError
from beltdyn.plot.panels import one_panel
from beltdyn.plot.style import styled
from beltdyn.results import Result, Run

P = ParamSpec("P")


class Choice(NamedTuple):
    """What a user chose for the figures of a run.

    Attributes
    ----------
    pulley : int or None
        Number of the pulley to show; None for all.
    variable : str
        Name of the variable whose spectra are shown.
    """

    pulley: int | None = None
    variable: str = "span_tension"


@dataclass(frozen=True, slots=True)
class Registered:
    """A figure and how it is saved.

    Attributes
    ----------
    arrange : callable
        ``arrange(run, choice) -> Figure``: all its panels on one page.
    by_default : callable
        ``by_default(run) -> bool``: whether it is drawn where no figures are chosen.
    of : tuple of str
        Kinds of the results that it is drawn of, names of analyses.
    """

    arrange: Callable[[Any, Choice], Figure]
    by_default: Callable[[Any], bool]
    of: tuple[str, ...]


FIGURES: dict[str, Registered] = {}
"""All figures by name."""


def on_request(result: Result) -> bool:
    """Draw a figure only where it is chosen."""
    return False


def always(result: Result) -> bool:
    """Draw a figure of every result of its kind."""
    return True


def over_time(run: Run) -> bool:
    """Draw a figure of every run with more than one output."""
    return run.dataset.sizes["time"] > 1


def figure(
    by_default: Callable[[Any], bool] = on_request,
    arrange: Callable[[Callable[..., Axes], Any, Choice], Figure] = one_panel,
    of: tuple[str, ...] = (RUN,),
) -> Callable[[Callable[P, Axes]], Callable[P, Axes]]:
    """Register a figure under the name of the function that draws it, and draw it in the style of this package.

    Parameters
    ----------
    by_default : callable
        Whether it is drawn where no figures are chosen: `on_request`, `always`, `over_time`, or a function of the run.
    arrange : callable
        ``arrange(draw, run, choice) -> Figure`` lays its panels out where it is saved; one panel by default.
    of : tuple of str
        Kinds of the results that it is drawn of, names of analyses: of runs by default.

    Returns
    -------
    callable
        The decorator of ``draw(run, ..., ax=None) -> Axes``, which refuses results of other kinds.
    """

    def register(draw: Callable[P, Axes]) -> Callable[P, Axes]:
        @wraps(draw)
        def drawn(*args: P.args, **kwargs: P.kwargs) -> Axes:
            result: Any = next(iter((*args, *kwargs.values())))
            require_kind(draw.__name__, result, of)
            return styled(draw)(*args, **kwargs)

        FIGURES[draw.__name__] = Registered(lambda run, choice: arrange(drawn, run, choice), by_default, of)
        return drawn

    return register


def require_kind(name: str, result: Result, kinds: tuple[str, ...]) -> None:
    """Make sure that a figure can be drawn of a result.

    Parameters
    ----------
    name : str
        Name of the figure.
    result : Result
        The result.
    kinds : tuple of str
        Kinds of results that it is drawn of.

    Raises
    ------
    ModelError
        If its kind is none of these.
    """
    if result.kind not in kinds:
        has = [other for other, one in FIGURES.items() if result.kind in one.of]
        raise ModelError(
            f"the figure {name!r} shows results of {' and '.join(kinds)}, and these are of {result.kind}. "
            + (f"Of these there are: {', '.join(has)}." if has else "Look at their dataset.")
        )

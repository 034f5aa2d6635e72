"""Figures by name. A figure registers itself with the decorator `figure`, and is then drawn by `save_all`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial, wraps
from inspect import signature
from typing import Any, NamedTuple, ParamSpec

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.analyses import RUN
from beltdyn.errors import ModelError
from beltdyn.kinds import Registry
from beltdyn.results import Result, Run
from beltdyn.results.schema import runs_steadily
from beltdyn.show.plot.headline import headlines, overlay, write_headline
from beltdyn.show.plot.style import one_panel, styled
from beltdyn.show.plot.view import show_enough

P = ParamSpec("P")
_TURNS = 0.01
"""Speed from which on a pulley turns, rad/s."""
Together = Callable[[Sequence[Any], Axes | None], Axes]
"""What draws several results into one pair of axes."""


class Choice(NamedTuple):
    """What a user chose for the figures of a run."""

    pulley: int | None = None
    """Number of the pulley to show; None for all."""
    variable: str = "span_tension"
    """Name of the variable whose spectra are shown."""
    pulleys: tuple[str, ...] = ()
    """Names of all pulleys of the results on the page, those of the first result first; set by its figure."""


@dataclass(frozen=True, slots=True)
class Registered:
    """A figure and how it is saved."""

    name: str
    """Its name."""
    draw: Callable[..., Axes]
    """``draw(result, ..., ax=None) -> Axes``."""
    arrange: Callable[[Result | Sequence[Result], Choice], Figure]
    """``arrange(results, choice) -> Figure``: all its panels on one page, of one result or more."""
    by_default: Callable[[Any], bool]
    """``by_default(run) -> bool``: whether it is drawn where no figures are chosen."""
    of: tuple[str, ...]
    """Kinds of the results that it is drawn of, names of analyses."""
    compares: bool
    """Whether it shows several results together."""


FIGURES = Registry[Registered]("figure", Registered)
"""All figures by name."""


def on_request(result: Result) -> bool:
    """Draw a figure only where it is chosen."""
    return False


def always(result: Result) -> bool:
    """Draw a figure of every result of its kind."""
    return True


def over_time(run: Run) -> bool:
    """Draw a figure of every run with more than one output: in steady running there are but level lines."""
    return run.dataset.sizes["time"] > 1 and not runs_steadily(run.dataset)


def over_turns(run: Run) -> bool:
    """Draw a figure over time where the driver turns: at rest there is nothing in it."""
    return over_time(run) and bool(np.abs(run.dataset["pulley_speed"].values[:, run.drive.reference]).max() > _TURNS)


def figure(
    by_default: Callable[[Any], bool] = on_request,
    arrange: Callable[[Callable[..., Axes], Any, Choice], Figure] = one_panel,
    of: tuple[str, ...] = (RUN,),
    compares: bool | Together = False,
) -> Callable[[Callable[P, Axes]], Callable[P, Axes]]:
    """Register a figure under the name of the function that draws it, and draw it in the style of this package.

    A figure that is drawn on axes of its own gets a headline, with the drive and its operating point.
    """

    def register(draw: Callable[P, Axes]) -> Callable[P, Axes]:
        name, form, painted = draw.__name__, signature(draw), styled(draw)

        @wraps(draw)
        def drawn(*args: P.args, **kwargs: P.kwargs) -> Axes:
            bound = form.bind(*args, **kwargs)
            first, given = next(iter(bound.arguments.items()))
            results = require_results(name, given)

            def on(result: Result, ax: Axes | None) -> Axes:
                bound.arguments |= {first: result, "ax": ax}
                return painted(*bound.args, **bound.kwargs)

            ax = bound.arguments.get("ax")
            if len(results) == 1:
                made = on(results[0], ax)
            else:
                asked = bound.arguments.get("pulley")
                shows = [not isinstance(asked, str) or asked in pulleys_of([result]) for result in results]
                together = partial(overlay, on, shows=shows if any(shows) else None)
                made = styled(compares if callable(compares) else together)(results, ax=ax)
            show_enough(made)
            if ax is None:
                write_headline(made.figure.figure, headlines(results))
            return made

        @styled
        def page(given: Result | Sequence[Result], choice: Choice) -> Figure:
            results = require_results(name, given)

            def draw_all(_: Result, *args: Any, **kwargs: Any) -> Axes:
                return drawn(results, *args, **kwargs)  # type: ignore[arg-type]

            named = choice._replace(pulleys=pulleys_of(results))
            made = arrange(draw_all if len(results) > 1 else drawn, results[0], named)
            write_headline(made, headlines(results))
            return made

        FIGURES.add(Registered(name, drawn, page, by_default, of, bool(compares)), draw.__module__)
        return drawn

    return register


def pulleys_of(results: Sequence[Result]) -> tuple[str, ...]:
    """Names of the pulleys of results, each once: those of the first result, and then what others have besides."""
    return tuple(dict.fromkeys(pulley.name for result in results for pulley in result.drive.pulleys))


def require_results(name: str, given: Result | Sequence[Result]) -> list[Result]:
    """Make sure that a figure can be drawn of a result, or of several."""
    results = [given] if isinstance(given, Result) else list(given)
    if not results:
        raise ModelError(f"the figure {name!r} needs at least one result.")
    for result in results:
        require_kind(name, result, FIGURES[name].of)
    if len(results) > 1 and not FIGURES[name].compares:
        others = [other for other, one in FIGURES.items() if one.compares]
        raise ModelError(
            f"the figure {name!r} shows one result, but there are {len(results)}. Draw each separately. Figures "
            f"of several results: {', '.join(others)}."
        )
    return results


def require_kind(name: str, result: Result, kinds: tuple[str, ...]) -> None:
    """Make sure that a figure can be drawn of a result."""
    if result.kind not in kinds:
        has = [other for other, one in FIGURES.items() if result.kind in one.of]
        raise ModelError(
            f"the figure {name!r} shows results of {' and '.join(kinds)}; these are of {result.kind}. "
            + (f"Available figures: {', '.join(has)}." if has else "Use their dataset.")
        )

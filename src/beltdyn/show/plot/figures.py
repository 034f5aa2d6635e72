"""Figures by name. A figure registers itself with the decorator `figure`, and is then drawn by `save_all`."""

import base64
import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial, wraps
from inspect import signature
from pathlib import Path
from typing import Any, Literal, NamedTuple, ParamSpec

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.analyses import RUN
from beltdyn.errors import ModelError, Parts
from beltdyn.kinds import Registry
from beltdyn.results import Result, Run, derived
from beltdyn.results.atomic import MARK, atomic_path, is_marked, make_folder, require_replaceable
from beltdyn.results.cycles import ends_at_standstill
from beltdyn.results.schema import runs_steadily
from beltdyn.show.plot.gaps import explain_empty, first_failure, gaps, mark_isolated
from beltdyn.show.plot.headline import headlines, overlay, write_headline
from beltdyn.show.plot.print_style import PRINT, SCREEN, figure_style, require_style, rules
from beltdyn.show.plot.style import one_panel, show_enough, styled

P = ParamSpec("P")
_MIN_SPEED = 0.01
"""Speed above which the driver turns, rad/s: at rest such figures would be empty."""
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
    return over_time(run) and bool(
        np.abs(run.dataset["pulley_speed"].values[:, run.drive.reference]).max() > _MIN_SPEED
    )


def slipping(run: Run) -> bool:
    """Draw a figure of slip where the driver turns a belt without teeth: with teeth nothing slips."""
    return over_turns(run) and run.drive.belt.teeth is None


def turning_at_the_end(run: Run) -> bool:
    """Draw a figure of means at the end where the drive turns then."""
    return over_turns(run) and not ends_at_standstill(run.dataset, run.prepared)


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
                axes = painted(*bound.args, **bound.kwargs)
                mark_isolated(axes)
                explain_empty(axes, result)
                return axes

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


# Saving of figures to files and pages

_SAYS_WHO_MADE_IT = {".png": "Software", ".svg": "Creator", ".pdf": "Creator", ".ps": "Creator", ".eps": "Creator"}
"""Suffix -> the field of the file's own description that names its maker."""

_PNG_RESOLUTION = 200
"""Resolution of PNG figures in pages, pixels per inch: about twice the 96 pixels of an inch on a page."""


def save(figure: Figure, path: Path, overwrite: bool = False) -> Path:
    """Write a figure."""
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
    """Write a figure as an address that holds it, for the attribute ``src`` of a page's ``img``."""
    stream = io.BytesIO()
    with rc_context({"svg.hashsalt": MARK, "path.simplify_threshold": 0.3}):
        metadata = {"Date": None} if file_format == "svg" else None
        figure.savefig(
            stream, format=file_format, dpi=_PNG_RESOLUTION, metadata=metadata, bbox_inches="tight", pad_inches=0.03
        )
    kind = {"svg": "svg+xml", "png": "png"}[file_format]
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode()}"


_FORMATS = {SCREEN: "png", PRINT: "pdf"}
"""Style -> suffix of the files of figures."""

_READING = (
    *("carriage_error", "configuration", "speeds", "span_tensions", "slip", "hub_load_sizes", "hub_loads"),
    *("slip_safety", "torques", "powers", "losses", "tensioners", "energy", "contact_pressure"),
)
"""Figures of a run in the order in which they are read; others follow."""


@styled
def save_all(
    run: Result | Sequence[Result],
    folder: Path | str,
    figures: Iterable[str] | None = None,
    pulley: str | int | None = None,
    variable: str = "span_tension",
    overwrite: bool = False,
    style: str = SCREEN,
) -> list[Path]:
    """Save figures of a result: as PNG, or for print as PDF.

    Parameters
    ----------
    run : Result or sequence of Result
        The run or other result; or several, to compare them.
    folder : Path or str
        Destination folder; created if necessary.
    figures : iterable of str, optional
        Names from `FIGURES`; by default the essential ones (over time only if there is more than one output), or for
        several results those that compare them.
    pulley : str or int, optional
        Name or number of the pulley of hub loads and contact, all by default, and of the speed in a sweep, by default
        the one that was swept, or else the first.
    variable : str
        What is drawn in a sweep: a variable over time and pulley, span or tensioner.
    overwrite : bool
        Replace any regular files, and not only figures of beltdyn.
    style : {"screen", "print"}
        See `figure_style`.

    Returns
    -------
    list of Path
        A file for each, named after it.

    Raises
    ------
    ModelError
        If a figure, the pulley or the variable is not known or cannot be drawn, there is nothing to draw, a file cannot
        be written, or would replace one that is no figure of ours.
    InternalError
        If a figure has a fault; the others are written, and are its `completed`.

    Examples
    --------
    >>> [path.name for path in bd.plot.save_all(run, "figures", figures=["speeds"])]
    ['speeds.png']
    """
    require_style(style)
    results = [run] if isinstance(run, Result) else list(run)
    for result in results:
        if isinstance(result, Run):
            result.require_output()
    known = _known(results)
    if not known:
        kinds = " and ".join(dict.fromkeys(result.kind for result in results))
        raise ModelError(f"there is no figure for {kinds}. Use its dataset: `bd.open_result(path).dataset`.")
    chosen = chosen_by_default(results) if figures is None else tuple(figures)
    if not chosen:
        raise ModelError(why_no_figure(results))
    for name in chosen:
        if name not in FIGURES:
            raise ModelError(f"figure {name!r} is unknown. Choose from {', '.join(known)}.")
        require_results(name, results)
    choice = Choice(None if pulley is None else _number(results, pulley), variable)
    paths = {name: Path(folder) / f"{name}.{_FORMATS[style]}" for name in chosen}
    for path in paths.values():
        require_replaceable(path, is_marked, overwrite)
    with Parts(refuses=True) as parts:
        drawn = dict[str, Figure]()
        for name in chosen:
            with parts.part(repeated(results, name, pulley, variable, style)), figure_style(style):
                drawn[name] = FIGURES[name].arrange(results, choice)
        if drawn:
            make_folder(Path(folder))
        for name, page in drawn.items():
            with parts.part(repeated(results, name, pulley, variable, style)), figure_style(style), rules({}):
                parts.completed.append(save(page, paths[name], overwrite))
    return parts.completed


def repeated(
    results: Sequence[Result],
    name: str,
    pulley: str | int | None = None,
    variable: str = Choice().variable,
    style: str = SCREEN,
) -> str:
    """Python that draws a figure of results again."""
    drawn = "" if style == SCREEN else f", style={style!r}"
    sources = results[0].source if len(results) == 1 else f"[{', '.join(one.source for one in results)}]"
    return f"bd.plot.save_all({sources}, 'figures', [{name!r}], {pulley!r}, {variable!r}{drawn})"


def _number(results: Sequence[Result], pulley: str | int) -> int:
    """Number of a pulley among those of all results."""
    names = pulleys_of(results)
    return names.index(pulley) if pulley in names else derived.pulley_number(results[0], pulley)


def chosen_by_default(results: Sequence[Result]) -> tuple[str, ...]:
    """Give the names of the default figures."""
    reading = [name for name in _READING if name in (known := _known(results))]
    figures = {name: FIGURES[name] for name in dict.fromkeys([*reading, *known])}
    return tuple(
        name
        for name, figure in figures.items()
        if all(map(figure.by_default, results)) and (figure.compares or len(results) == 1)
    )


def why_no_figure(results: Sequence[Result]) -> str:
    """Say why no figure is drawn of results by default, and what can be drawn."""
    first, known = results[0], _known(results)
    kinds = " and ".join(dict.fromkeys(result.kind for result in results))
    comparing = [name for name in known if FIGURES[name].compares]
    if len(results) > 1 and not comparing:
        return f"no figure shows several results of {kinds} together. Plot each separately, or write one report of all."
    if len(results) == 1 and (why := first_failure(first)):
        return f"there is nothing to draw: {gaps(first)}. The first: {why}"
    requested = comparing if len(results) > 1 else known
    return f"no figure of {kinds} is drawn by default here. Choose some of {', '.join(requested)}."


def _known(results: Sequence[Result]) -> list[str]:
    """Names of the figures of all these results."""
    return [name for name, figure in FIGURES.items() if all(result.kind in figure.of for result in results)]

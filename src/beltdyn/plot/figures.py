"""Figures of a run, in files."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.plot.registry import FIGURES, Choice, pulleys_of, require_results
from beltdyn.plot.saving import save
from beltdyn.plot.style import styled
from beltdyn.results import Result, Run, derived
from beltdyn.results.atomic import is_marked, make_folder, require_replaceable

_READING = (
    *("configuration", "speeds", "span_tensions", "slip", "hub_load_sizes", "hub_loads", "capstan_margins", "torques"),
    *("powers", "losses", "tensioners", "energy", "contact_pressure"),
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
) -> list[Path]:
    """Save figures of a result as PNG.

    Parameters
    ----------
    run : Result or sequence of Result
        The run or other result; or several, to compare them.
    folder : Path or str
        Where to write; made if need be.
    figures : iterable of str, optional
        Names out of `FIGURES`; by default the essential ones, those over time only if there is more than one output,
        and of several results those that compare them.
    pulley : str or int, optional
        Name or number of the pulley of hub loads and contact, all by default, and of the speed in a sweep, by default
        the one that was swept, or else the first.
    variable : str
        What is drawn in a sweep: a variable over time and pulley, span or tensioner.
    overwrite : bool
        Replace any regular files, and not only figures of beltdyn.

    Returns
    -------
    list of Path
        A file for each, named after it.

    Raises
    ------
    ModelError
        If a figure, the pulley or the variable is not known or cannot be drawn, the run holds no output, a file cannot
        be written, or would replace one that is no figure of ours.

    Examples
    --------
    >>> [path.name for path in bd.plot.save_all(run, "figures", figures=["speeds"])]
    ['speeds.png']
    """
    results = [run] if isinstance(run, Result) else list(run)
    for result in results:
        if isinstance(result, Run):
            result.require_output()
    known = _known(results)
    if not known:
        kinds = " and ".join(dict.fromkeys(result.kind for result in results))
        raise ModelError(f"there is no figure for {kinds}. Use its dataset: `bd.open_result(path).dataset`.")
    chosen = chosen_by_default(results) if figures is None else tuple(figures)
    for name in chosen:
        if name not in FIGURES:
            raise ModelError(f"figure {name!r} is unknown. Choose from {', '.join(known)}.")
        require_results(name, results)
    choice = Choice(None if pulley is None else _number(results, pulley), variable)
    paths = {name: Path(folder) / f"{name}.png" for name in chosen}
    for path in paths.values():
        require_replaceable(path, is_marked, overwrite)
    drawn = {name: FIGURES[name].arrange(results, choice) for name in chosen}
    make_folder(Path(folder))
    return [save(figure, paths[name], overwrite) for name, figure in drawn.items()]


def _number(results: Sequence[Result], pulley: str | int) -> int:
    """Number of a pulley among those of all results."""
    names = pulleys_of(results)
    return names.index(pulley) if pulley in names else derived.pulley_number(results[0], pulley)


def chosen_by_default(results: Sequence[Result]) -> tuple[str, ...]:
    """Give the names of the default figures.

    Parameters
    ----------
    results : sequence of Result
        One or more; of several, those figures that compare them.
    """
    reading = [name for name in _READING if name in (known := _known(results))]
    figures = {name: FIGURES[name] for name in dict.fromkeys([*reading, *known])}
    return tuple(
        name
        for name, figure in figures.items()
        if all(map(figure.by_default, results)) and (figure.compares or len(results) == 1)
    )


def _known(results: Sequence[Result]) -> list[str]:
    """Names of the figures of all these results."""
    return [name for name, figure in FIGURES.items() if all(result.kind in figure.of for result in results)]

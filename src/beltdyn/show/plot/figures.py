"""Figures of a run, in files."""

import base64
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal

from matplotlib import rc_context
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.results import Result, Run, derived
from beltdyn.results.atomic import MARK, atomic_path, is_marked, make_folder, require_replaceable
from beltdyn.show.plot.registry import FIGURES, Choice, pulleys_of, require_results
from beltdyn.show.plot.style import styled

# Saving of figures to files and pages

_SAYS_WHO_MADE_IT = {".png": "Software", ".svg": "Creator", ".pdf": "Creator", ".ps": "Creator", ".eps": "Creator"}
"""Suffix -> the field of the file's own description that names its maker."""

_PNG_DPI = 200


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
            stream, format=file_format, dpi=_PNG_DPI, metadata=metadata, bbox_inches="tight", pad_inches=0.03
        )
    kind = {"svg": "svg+xml", "png": "png"}[file_format]
    return f"data:image/{kind};base64,{base64.b64encode(stream.getvalue()).decode()}"


_READING = (
    *("configuration", "speeds", "span_tensions", "slip", "hub_load_sizes", "hub_loads", "slip_safety", "torques"),
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
    """Give the names of the default figures."""
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

"""Every figure of a run, in files."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from math import ceil
from pathlib import Path
from typing import TypeVar, get_args

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.errors import ModelError
from beltdyn.plot.configuration import configuration
from beltdyn.plot.contact import Kind, contact_forces, contact_pressure
from beltdyn.plot.drive import size_of
from beltdyn.plot.history import energy, span_tensions, speeds, torques
from beltdyn.plot.pulleys import capstan_margins, hub_loads, losses, powers, slip
from beltdyn.plot.saving import save
from beltdyn.plot.spans import mid_spans, tension_spectrum, tensioners
from beltdyn.plot.style import SIZE, new_figure, styled
from beltdyn.plot.sweep import names_of, orders, waterfall
from beltdyn.plot.wear import wear_by_arc, wear_by_belt
from beltdyn.results import Run, derived
from beltdyn.results.atomic import is_marked, make_folder, require_replaceable

Draw = Callable[..., Axes]
Item = TypeVar("Item")

_WHOLE: Mapping[str, Draw] = {
    "configuration": configuration,
    "speeds": speeds,
    "torques": torques,
    "span_tensions": span_tensions,
    "energy": energy,
    "slip": slip,
    "capstan_margins": capstan_margins,
    "powers": powers,
    "losses": losses,
    "tensioners": tensioners,
    "mid_spans": mid_spans,
    "tension_spectrum": tension_spectrum,
    "wear_by_arc": wear_by_arc,
    "wear_by_belt": wear_by_belt,
}
_SWEEPS: Mapping[str, Draw] = {"waterfall": waterfall, "orders": orders}

FIGURES = (*_WHOLE, "contact_forces", "contact_pressure", "hub_loads", *_SWEEPS)
"""Names of all figures."""

_ESSENTIAL = (
    *("speeds", "torques", "span_tensions", "energy"),
    *("slip", "capstan_margins", "powers", "losses", "hub_loads"),
)
"""Figures over time that are drawn unless others are chosen."""

_AT_AN_INSTANT = ("configuration", "contact_forces", "contact_pressure")
_PANEL = (4.2, 2.9)
_POLAR = (6.2, 4.6)
_COLUMNS = 4


@styled
def save_all(
    run: Run,
    folder: Path | str,
    figures: Iterable[str] | None = None,
    pulley: str | int | None = None,
    variable: str = "span_tension",
    overwrite: bool = False,
) -> list[Path]:
    """Write figures as PNG.

    Parameters
    ----------
    run : Run
        The run.
    folder : Path or str
        Where to write; made if need be.
    figures : iterable of str, optional
        Names out of `FIGURES`; by default the essential ones, those over time only if there is more than one output.
    pulley : str or int, optional
        Name or number of the pulley of hub loads and contact, all by default, and of the speed in a sweep, the first by
        default.
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
    """
    run.require_output()
    chosen = _essential(run) if figures is None else tuple(figures)
    unknown = [name for name in chosen if name not in FIGURES]
    if unknown:
        raise ModelError(f"figure {unknown[0]!r} is not known. Choose out of {', '.join(FIGURES)}.")
    number = None if pulley is None else derived.pulley_number(run, pulley)
    paths = {name: Path(folder) / f"{name}.png" for name in chosen}
    for path in paths.values():
        require_replaceable(path, is_marked, overwrite)
    drawn = {name: _figure(run, name, number, variable) for name in chosen}
    make_folder(Path(folder))
    return [save(figure, paths[name], overwrite) for name, figure in drawn.items()]


def _essential(run: Run) -> tuple[str, ...]:
    if run.dataset.sizes["time"] == 1:
        return _AT_AN_INSTANT
    moving = ("tensioners",) if "tensioner_position" in run.dataset else ()
    return (*_AT_AN_INSTANT, *_ESSENTIAL, *moving)


def _figure(run: Run, name: str, pulley: int | None, variable: str) -> Figure:
    """Draw a figure, with as many panels as it needs."""
    if name in _WHOLE:
        figure = new_figure(size_of(run.drive) if name == "configuration" else SIZE)
        _WHOLE[name](run, ax=figure.add_subplot())
        return figure
    if name == "hub_loads":
        figure = new_figure(_POLAR)
        hub_loads(run, pulley, ax=figure.add_subplot(projection="polar"))
        return figure
    if name in _SWEEPS:
        calls = [partial(_SWEEPS[name], run, variable, one, pulley or 0) for one in names_of(run, variable)]
        return _panels(_rows(calls), sharey=False)
    pulleys = range(len(run.drive.pulleys)) if pulley is None else [pulley]
    if name == "contact_pressure":
        figure = _panels(_rows([partial(contact_pressure, run, number) for number in pulleys]))
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside upper right", ncols=2)
        return figure
    kinds: tuple[Kind, ...] = get_args(Kind)
    rows = [(block, kind) for block in _rows(list(pulleys)) for kind in kinds]
    return _panels([[partial(contact_forces, run, number, kind=kind) for number in block] for block, kind in rows])


def _rows(items: Sequence[Item]) -> list[list[Item]]:
    """Break a sequence into rows of nearly the same length."""
    columns = ceil(len(items) / ceil(len(items) / _COLUMNS))
    return [list(items[first : first + columns]) for first in range(0, len(items), columns)]


def _panels(rows: Sequence[Sequence[Draw]], *, sharey: bool = True) -> Figure:
    """Draw rows of panels, those of a row at the same scale if need be; the last row may be shorter."""
    columns = len(rows[0])
    figure = new_figure((_PANEL[0] * columns, _PANEL[1] * len(rows)))
    panels = figure.subplots(len(rows), columns, squeeze=False, sharey="row" if sharey else False)
    for axes, draws in zip(panels, rows, strict=True):
        for ax in axes[len(draws) :]:
            ax.remove()
        for column, (ax, draw) in enumerate(zip(axes, draws, strict=False)):
            draw(ax=ax)
            if sharey and column:
                ax.set_ylabel("")
    return figure

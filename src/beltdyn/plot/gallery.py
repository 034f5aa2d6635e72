"""Every figure of a run, in files."""

from collections.abc import Callable
from pathlib import Path
from typing import get_args

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beltdyn.plot.configuration import configuration
from beltdyn.plot.contact import Kind, contact_forces
from beltdyn.plot.history import energy, span_tensions, speeds, torques
from beltdyn.plot.style import new_figure, styled
from beltdyn.results import Run
from beltdyn.results.atomic import atomic_path, make_folder

_HISTORIES: tuple[Callable[[Run, Axes], Axes], ...] = (speeds, torques, span_tensions, energy)
_PANEL = (4.2, 2.9)


@styled
def save_all(run: Run, folder: Path | str) -> list[Path]:
    """Write every figure as PNG; those over time only if there is more than one output.

    Parameters
    ----------
    run : Run
        The run.
    folder : Path or str
        Where to write; made if need be.

    Returns
    -------
    list of Path
        ``configuration.png``, ``contact_forces.png``, ``speeds.png``, ``torques.png``,
        ``span_tensions.png`` and ``energy.png``.

    Raises
    ------
    ModelError
        If the run holds no output, or a file cannot be written.
    """
    folder = make_folder(Path(folder))
    figures = {"configuration": new_figure(), "contact_forces": _contact_panels(run)}
    configuration(run, ax=figures["configuration"].add_subplot())
    if run.dataset.sizes["time"] > 1:
        for draw in _HISTORIES:
            figures[draw.__name__] = new_figure()
            draw(run, figures[draw.__name__].add_subplot())
    return [_save(figure, folder / f"{name}.png") for name, figure in figures.items()]


def _contact_panels(run: Run) -> Figure:
    """Draw a row for each kind of force and a column for each pulley."""
    kinds: tuple[Kind, ...] = get_args(Kind)
    pulleys = len(run.drive.pulleys)
    figure = new_figure((_PANEL[0] * pulleys, _PANEL[1] * len(kinds)))
    panels = figure.subplots(len(kinds), pulleys, squeeze=False, sharey="row")
    for row, kind in zip(panels, kinds, strict=True):
        for number, ax in enumerate(row):
            contact_forces(run, number, kind=kind, ax=ax)
            ax.label_outer()
    return figure


def _save(figure: Figure, path: Path) -> Path:
    with atomic_path(path) as temporary:
        figure.savefig(temporary)
    return path

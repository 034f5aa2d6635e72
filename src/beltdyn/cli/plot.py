"""`beltdyn plot`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show

if TYPE_CHECKING:
    from beltdyn.results import Run


def plot(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    animate: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Draw the figures of a result file.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run`.
    output
        The folder of the figures; by default beside the result file, named after it with -figures.
    animate
        Draw an animation too, which takes longer.
    """
    from beltdyn.results import open_run

    draw(open_run(file), output or file.with_name(f"{file.stem}-figures"), animate)


def draw(run: "Run", folder: Path, animate: bool) -> None:
    """Draw all figures of a run into a folder, and say where they are."""
    from beltdyn import plot as figures

    paths = figures.save_all(run, folder)
    if animate:
        paths = [*paths, figures.animate(run, folder / "animation.gif")]
    show(f"Figures in {folder}: {', '.join(path.name for path in paths)}")

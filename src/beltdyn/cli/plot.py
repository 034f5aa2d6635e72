"""`beltdyn plot`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.results import Result


def plot(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    figures: str | None = None,
    pulley: str | None = None,
    variable: str = "span_tension",
    animate: Annotated[bool, Parameter(negative="")] = False,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Draw the figures of a result file.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run` or another command.
    output
        The folder of the figures; by default beside the result file, named after it with -figures.
    figures
        Names of figures with commas between, such as slip,hub_loads; by default the essential ones. A name that is not
        known gives the list of all.
    pulley
        The pulley of hub loads and contact, by default all; and the one whose speed counts in waterfall and orders, by
        default the one that was swept, or else the first.
    variable
        What waterfall and orders show, such as span_tension, pulley_speed or pulley_torque.
    animate
        Draw an animation too, which takes longer.
    force
        Replace other files than figures of beltdyn too.
    """
    from beltdyn.results import open_result

    folder = output or file.with_name(f"{file.stem}-figures")
    choice = {"figures": _names(figures), "pulley": pulley, "variable": variable, "overwrite": force}
    draw(open_result(file), folder, animate, **choice)


def draw(result: "Result", folder: Path, animate: bool, **choice: Any) -> None:
    """Draw figures of a result into a folder, as `plot.save_all` does, and say where they are."""
    from beltdyn import plot
    from beltdyn.results import Run

    if animate and not isinstance(result, Run):
        raise ModelError(f"--animate needs results over time, and these are of {result.kind}. Leave it away.")
    paths = plot.save_all(result, folder, **choice)
    if animate and isinstance(result, Run):
        paths = [*paths, plot.animate(result, folder / "animation.gif", overwrite=bool(choice.get("overwrite")))]
    show(f"Figures in {folder}: {', '.join(path.name for path in paths)}")


def _names(figures: str | None) -> list[str] | None:
    return None if figures is None else [name.strip() for name in figures.split(",")]

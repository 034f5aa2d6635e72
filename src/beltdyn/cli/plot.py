"""`beltdyn plot`."""

from collections.abc import Sequence
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
    *more: Path,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    figures: str | None = None,
    pulley: str | None = None,
    variable: str = "span_tension",
    animate: Annotated[bool, Parameter(negative="")] = False,
    mp4: Annotated[bool, Parameter(negative="")] = False,
    start: float | str | None = None,
    end: float | str | None = None,
    frames_per_turn: int | None = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Draw the figures of a result file, or of several files, to compare them.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run` or another command.
    more
        More result files, whose lines are drawn into the same figures.
    output
        The folder of the figures; by default beside the first result file, named after the files with -figures.
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
    mp4
        Write it as MP4 in place of GIF, which needs `pip install "beltdyn[video]"` or the program ffmpeg.
    start, end
        From when to when it shows the drive, such as "0.5 s", or in s; all of the run by default.
    frames_per_turn
        Pictures for each turn of the first pulley: slow motion. By default 150 pictures in all.
    force
        Replace other files than figures of beltdyn too.
    """
    from beltdyn.results import open_result

    others = f"-and-{more[0].stem if len(more) == 1 else f'{len(more)}-more'}" if more else ""
    folder = output or file.with_name(f"{file.stem}{others}-figures")
    choice = {"figures": _names(figures), "pulley": pulley, "variable": variable, "overwrite": force}
    film = {"start": start, "end": end, "per_turn": frames_per_turn}
    results = [open_result(one) for one in (file, *more)]
    draw(results, folder, (folder / f"animation.{'mp4' if mp4 else 'gif'}", film) if animate or mp4 else None, **choice)


def draw(
    results: "Sequence[Result]", folder: Path, animation: tuple[Path, dict[str, Any]] | None = None, **choice: Any
) -> None:
    """Draw figures of results into a folder, as `plot.save_all` does, and an animation with its options; name them."""
    from beltdyn import plot
    from beltdyn.results import Run

    first = results[0]
    if animation and not ((isinstance(first, Run) or first.kind == "modes") and len(results) == 1):
        these = f"are of {first.kind}" if len(results) == 1 else f"are {len(results)}"
        raise ModelError(f"--animate needs results over time of one run, or modes, and these {these}. Leave it away.")
    paths = plot.save_all(results, folder, **choice)
    if animation:
        path, film = animation
        overwrite = bool(choice.get("overwrite"))
        if isinstance(first, Run):
            paths.append(plot.animate(first, path, overwrite=overwrite, **film))
        else:
            paths.append(plot.animate_modes(first, path, overwrite=overwrite))
    show(f"Figures in {folder}: {', '.join(path.name for path in paths)}")


def _names(figures: str | None) -> list[str] | None:
    return None if figures is None else [name.strip() for name in figures.split(",")]

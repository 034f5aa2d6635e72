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
    """Plot the figures of a result file, or compare several.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run` or another analysis.
    more
        More result files, plotted in the same figures.
    output
        The folder of the figures; by default FILE-figures beside the first result file.
    figures
        Names of figures separated by commas, such as slip,hub_loads; by default the essential ones. An unknown name
        lists all.
    pulley
        The pulley of hub loads and contact figures, by default all; in waterfall and orders, the reference pulley of
        the speed, by default the swept one, or else the first.
    variable
        The result in waterfall and orders, such as span_tension, pulley_speed or pulley_torque.
    animate
        Also make an animation, which takes longer.
    mp4
        Write the animation as MP4 instead of GIF; needs the extra beltdyn[video] or the program ffmpeg.
    start, end
        The period of the animation, such as "0.5 s", or in s; by default the whole run.
    frames_per_turn
        Frames per turn of the first pulley, for slow motion. By default 150 frames in all.
    force
        Also replace files that are no figures of beltdyn.
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
    """Plot figures of results to a folder by `plot.save_all`, and an animation with its options; show their names."""
    from beltdyn import plot
    from beltdyn.results import Run

    first = results[0]
    if animation and not ((isinstance(first, Run) or first.kind == "modes") and len(results) == 1):
        these = f"results of {first.kind}" if len(results) == 1 else f"{len(results)} results"
        raise ModelError(f"--animate needs the results of one run, or modes, not {these}. Omit it.")
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

"""`beltdyn demo`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from beltdyn.analyses import ANALYSES, SIMULATE
from beltdyn.cli.console import show
from beltdyn.cli.new import refuse_existing, write_text
from beltdyn.cli.output import analyse_to, ended
from beltdyn.errors import ModelError, Parts

if TYPE_CHECKING:
    from beltdyn.results import Result


# `beltdyn export`


def export(
    file: Path,
    /,
    *,
    vtk: Annotated[bool, Parameter(negative="")] = False,
    csv: Annotated[bool, Parameter(negative="")] = False,
    mat: Annotated[bool, Parameter(negative="")] = False,
    xlsx: Annotated[bool, Parameter(negative="")] = False,
    parquet: Annotated[bool, Parameter(negative="")] = False,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Export a result file to other programs: ParaView, spreadsheets, MATLAB, data frames.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn simulate` or another analysis.
    vtk
        Belt and pulleys over time for ParaView and VTK, FILE-belt.vtkhdf and FILE-pulleys.vtkhdf; runs and sweeps only.
    csv
        Plain tables, in the folder FILE-tables.
    mat
        The same tables for MATLAB and Octave, FILE.mat.
    xlsx
        The same tables as a workbook for spreadsheets, FILE.xlsx; needs the extra beltdyn[xlsx].
    parquet
        The same tables as Parquet for data frames, in the folder FILE-tables; needs the extra beltdyn[parquet].
    output
        The folder of the exported files; by default that of the result file.
    force
        Also replace files that beltdyn did not write.
    """
    from beltdyn.results import export as export_result
    from beltdyn.results import open_result
    from beltdyn.results.atomic import make_folder

    wanted = {"vtk": vtk, "csv": csv, "mat": mat, "xlsx": xlsx, "parquet": parquet}
    formats = [name for name, asked in wanted.items() if asked]
    if not formats:
        raise ModelError(f"export needs a format: one or more of {', '.join(f'--{name}' for name in wanted)}.")
    result = open_result(file)
    folder = file.parent if output is None else make_folder(output)
    with Parts(refuses=True) as parts:
        with parts.part():
            parts.completed += export_result(result, formats, folder / file.name, force)
        show(f"Written: {', '.join(map(str, parts.completed)) or 'nothing'}")


# `beltdyn report`


def report(
    file: Path,
    /,
    *more: Path,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Write a report of a result file, or of several side by side: one HTML page to read, mail and print.

    The page is self-contained. It shows key results against the limits in the drive file, warnings with remedies, an
    animation of the drive, interactive figures, tables, the drive file, and the provenance of the results.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn simulate` or another analysis.
    more
        More result files, to compare with the first.
    output
        The HTML page; by default beside the first result file, and named after it.
    force
        Also replace files that are no reports.
    """
    from beltdyn.results import open_result
    from beltdyn.show.report import report_file, require_report, write_report

    path = output or report_file((file, *more))
    require_report(path, force)
    results = [open_result(one) for one in (file, *more)]
    with Parts(refuses=True) as parts:
        with parts.part():
            parts.completed.append(write_report(results, path, force))
        show(f"Report: {path if parts.completed else 'none'}")


# `beltdyn plot`


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
    style: str = "screen",
    force: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Plot the figures of a result file, or compare several.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn simulate` or another analysis.
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
    style
        "screen", or "print" for figures of journals: PDF, 84 or 174 mm wide, in greys, with letters of 8 points.
    force
        Also replace files that are no figures of beltdyn.
    """
    from beltdyn.results import open_result

    others = f"-and-{more[0].stem if len(more) == 1 else f'{len(more)}-more'}" if more else ""
    folder = output or file.with_name(f"{file.stem}{others}-figures")
    choice = {"figures": _names(figures), "pulley": pulley, "variable": variable, "overwrite": force, "style": style}
    film = {"start": start, "end": end, "per_turn": frames_per_turn}
    results = [open_result(one) for one in (file, *more)]
    draw(results, folder, (folder / f"animation.{'mp4' if mp4 else 'gif'}", film) if animate or mp4 else None, **choice)


def draw(
    results: "Sequence[Result]", folder: Path, animation: tuple[Path, dict[str, Any]] | None = None, **choice: Any
) -> None:
    """Plot figures of results to a folder by `plot.save_all`, and an animation with its options; show their names."""
    from beltdyn.results import Run
    from beltdyn.show import plot

    first = results[0]
    if animation and not ((isinstance(first, Run) or first.kind == "modes") and len(results) == 1):
        these = f"results of {first.kind}" if len(results) == 1 else f"{len(results)} results"
        raise ModelError(f"--animate needs the results of one run, or modes, not {these}. Omit it.")
    with Parts(refuses=True) as parts:
        with parts.part():
            parts.completed += plot.save_all(results, folder, **choice)
        if animation:
            path, film = animation
            overwrite = bool(choice.get("overwrite"))
            with parts.part(f"bd.plot.animate({first.source}, {path.name!r})"):
                if isinstance(first, Run):
                    parts.completed.append(plot.animate(first, path, overwrite=overwrite, **film))
                else:
                    parts.completed.append(plot.animate_modes(first, path, overwrite=overwrite))
        show(f"Figures in {folder}: {', '.join(path.name for path in parts.completed) or 'none'}")


def _names(figures: str | None) -> list[str] | None:
    return None if figures is None else [name.strip() for name in figures.split(",")]


_DRIVE = "fan_direct_start"


def demo(folder: Path = Path("beltdyn-demo"), /) -> int:
    """Simulate the start of a 15 kW fan by an induction motor and three V-belts, and plot the figures.

    Parameters
    ----------
    folder
        The folder for the drive file, its results and its figures.
    """
    from beltdyn.model import load
    from beltdyn.model.toml import example_text

    file, text = folder / f"{_DRIVE}.toml", example_text(_DRIVE)
    if not (file.is_file() and file.read_text("utf-8", "replace") == text):
        refuse_existing(file)
        write_text(file, text)
    show(f"Drive file: {file}   (summary: beltdyn check {file})")
    run = analyse_to(ANALYSES[SIMULATE], load(file), folder / f"{_DRIVE}.nc")
    if run.status == "completed":
        draw([run], folder)
    return ended(run)

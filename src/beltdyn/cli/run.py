"""`beltdyn run`."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter
from cyclopts.validators import Number

from beltdyn.cli.console import show, show_error
from beltdyn.cli.progress import progress_bar
from beltdyn.cli.summary import show_summary
from beltdyn.errors import ModelError, SimulationError
from beltdyn.signals import exit_code

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Run

DOUBTFUL = 4


def run(
    file: Path,
    /,
    *more: Path,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    jobs: Annotated[int | None, Parameter(alias="-j", validator=Number(gte=1))] = None,
    csv: Annotated[bool, Parameter(negative="")] = False,
    strict: Annotated[bool, Parameter(negative="")] = False,
    force: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Simulate a drive: a progress bar, then a summary, and the results in a NetCDF file.

    Several drives run side by side on all cores. Ctrl-C, or the signal to terminate, ends the simulation and
    keeps what was computed. Earlier results are replaced, and no other files.

    Parameters
    ----------
    file
        The drive file, TOML.
    more
        More drive files.
    output
        The result file; by default the drive file's name with the ending .nc. Of several drives, the folder for these.
    jobs
        How many drives to simulate at a time; by default as many as there are cores.
    csv
        Write plain tables too, into a folder beside the result file, named after it with -tables.
    strict
        End with an error (exit code 4) where a warning makes results doubtful; they are kept.
    force
        Replace other files too.
    """
    if more:
        from beltdyn.cli.batch import run_several

        return run_several((file, *more), output, jobs, csv=csv, strict=strict, force=force)
    from beltdyn.model import load

    drive = load(file)
    path = output or file.with_suffix(".nc")
    require_output(path, (file,), csv, force)
    finished = simulate_to(drive, path, force)
    if csv and finished.outputs:
        write_tables(finished, path, force)
    return ended(finished) or (doubt(finished.warnings) if strict else 0)


def require_output(path: Path, files: Iterable[Path], csv: bool, force: bool) -> None:
    """Make sure that results and their tables would replace nothing but such, and never a drive file.

    Raises
    ------
    ModelError
        If they would.
    """
    from beltdyn.results.atomic import require_replaceable
    from beltdyn.results.dataset import is_result
    from beltdyn.results.tables import require_tables

    if path.resolve() in {file.resolve() for file in files}:
        raise ModelError(f"{path} is the drive file: the results would overwrite it. Choose another --output.")
    require_replaceable(path, is_result, force)
    if csv:
        require_tables(tables_folder(path), force)


def tables_folder(path: Path) -> Path:
    """Where the tables of a result file are written."""
    return path.with_name(f"{path.stem}-tables")


def write_tables(run: "Run", path: Path, force: bool) -> None:
    """Write plain tables into a folder beside the result file, and name them."""
    from beltdyn.results import write_csv

    show(f"Tables: {', '.join(str(table) for table in write_csv(run, tables_folder(path), force))}")


def simulate_to(drive: "Drive", path: Path, force: bool = False) -> "Run":
    """Simulate into a file with a progress bar, and show the summary.

    Raises
    ------
    SimulationError
        If the simulation cannot go on.
    """
    from beltdyn.results import describe_size
    from beltdyn.results.atomic import leftovers
    from beltdyn.solve import simulate

    show(f"Results of about {describe_size(drive)}")
    try:
        with progress_bar() as report:
            finished = simulate(drive, path, report, force)
    except SimulationError:
        show(f"What was computed is in {path}")
        raise
    show_summary(finished)
    if finished.status == "interrupted":
        show("\nInterrupted: what was computed is kept.")
    show(f"\nResults: {path}   (figures: beltdyn plot {path})")
    for file in leftovers(path):
        show(f"A killed run has left {file}, which nobody needs: remove it.")
    return finished


def doubt(warnings: Sequence[str]) -> int:
    """Exit code where warnings are errors, which are said; 0 without any."""
    if not warnings:
        return 0
    count = f"{len(warnings)} warnings make" if warnings[1:] else "a warning makes"
    show_error(f"{count} these results doubtful. They are kept; without --strict this is no error.")
    return DOUBTFUL


def ended(run: "Run") -> int:
    """Exit code of a run that ended without an error."""
    return exit_code() if run.status == "interrupted" else 0

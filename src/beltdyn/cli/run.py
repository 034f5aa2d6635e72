"""`beltdyn run`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show
from beltdyn.cli.progress import progress_bar
from beltdyn.cli.summary import show_summary
from beltdyn.errors import ConvergenceError, ModelError

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Run

_INTERRUPTED = 130


def run(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Parameter(alias="-o")] = None,
    csv: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Simulate a drive: a progress bar, then a summary, and the results in a NetCDF file.

    Ctrl-C ends the simulation and keeps what was computed.

    Parameters
    ----------
    file
        The drive file, TOML.
    output
        The result file; by default the drive file's name with the ending .nc.
    csv
        Write plain tables too, into a folder beside the result file, named after it with -tables.
    """
    from beltdyn.model import load

    drive = load(file)
    path = output or file.with_suffix(".nc")
    if path.resolve() == file.resolve():
        raise ModelError(f"{path} is the drive file: the results would overwrite it. Choose another --output.")
    finished = simulate_to(drive, path)
    if csv and finished.dataset.sizes["time"]:
        from beltdyn.results import write_csv

        folder = path.with_name(f"{path.stem}-tables")
        show(f"Tables: {', '.join(str(table) for table in write_csv(finished, folder))}")
    return exit_code(finished)


def simulate_to(drive: "Drive", path: Path) -> "Run":
    """Simulate into a file with a progress bar, and show the summary.

    Raises
    ------
    ConvergenceError
        If the simulation cannot go on.
    """
    from beltdyn.solve import simulate

    try:
        with progress_bar() as report:
            finished = simulate(drive, path, report)
    except ConvergenceError:
        show(f"What was computed is in {path}")
        raise
    show_summary(finished)
    if finished.status == "interrupted":
        show("\nInterrupted: what was computed is kept.")
    show(f"\nResults: {path}   (figures: beltdyn plot {path})")
    return finished


def exit_code(run: "Run") -> int:
    """Exit code of a run that ended without an error."""
    return _INTERRUPTED if run.status == "interrupted" else 0

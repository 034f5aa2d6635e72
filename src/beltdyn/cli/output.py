"""From a drive to a result file, and what is said and ended with."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from beltdyn.analyses import Analysis
from beltdyn.cli.console import show, show_error
from beltdyn.cli.progress import progress_bar
from beltdyn.cli.result import show_result
from beltdyn.errors import LostOutputError, ModelError, SimulationError
from beltdyn.signals import exit_code

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Result, Run

DOUBTFUL = 4


class Extras(NamedTuple):
    """What is written beside a result file.

    Attributes
    ----------
    csv : bool
        Plain tables, in a folder.
    report : bool
        A page.
    """

    csv: bool
    report: bool


NO_EXTRAS = Extras(csv=False, report=False)


def require_output(path: Path, files: Iterable[Path], extras: Extras, force: bool) -> None:
    """Make sure that results, tables and reports would replace nothing but such, and never a drive file.

    Raises
    ------
    ModelError
        If they would.
    """
    from beltdyn.results.atomic import require_replaceable, target_of
    from beltdyn.results.dataset import is_result
    from beltdyn.results.tables import require_tables, tables_folder

    if target_of(path) in {target_of(file) for file in files}:
        raise ModelError(f"{path} is the drive file: the results would overwrite it. Choose another --output.")
    require_replaceable(path, is_result, force)
    if extras.csv:
        require_tables(tables_folder(path), force)
    if extras.report:
        from beltdyn.report import report_file, require_report

        require_report(report_file([path]), force)


def write_extras(result: "Result", path: Path, extras: Extras, force: bool) -> None:
    """Write what is asked for beside a result file, and name it."""
    from beltdyn.results import open_result
    from beltdyn.results.tables import tables_folder, write_csv

    if extras.csv:
        show(f"Tables: {', '.join(str(table) for table in write_csv(result, tables_folder(path), force))}")
    if extras.report:
        from beltdyn.report import report_file, write_report

        show(f"Report: {write_report(open_result(path), report_file([path]), force)}")


def analyse_to(
    analysis: Analysis,
    drive: "Drive | Run",
    path: Path,
    extras: Extras = NO_EXTRAS,
    force: bool = False,
    **options: Any,
) -> "Result":
    """Analyse a drive into a file with a progress bar, show the result, and write what is asked for beside it.

    Raises
    ------
    SimulationError
        If the analysis cannot go on.
    """
    from beltdyn.results.atomic import locked_output, stamp

    before = stamp(path)
    try:
        with progress_bar() as report, locked_output(path):
            result: Result = analysis.write(drive, path, report, force, **options)
    except LostOutputError:
        show("No results are kept.")
        raise
    except SimulationError:
        show(nothing_kept(path) if stamp(path) in (before, None) else f"What was computed is in {path}")
        raise
    show_result(result)
    if stamp(path) == before:
        show(f"\n{nothing_kept(path)}")
        return result
    if result.status == "interrupted":
        from beltdyn.solve.checkpoint import checkpoint_file

        goes_on = f" Go on with it: beltdyn {analysis.name} --resume {path}" if checkpoint_file(path).exists() else ""
        show(f"\nInterrupted: what was computed is kept.{goes_on}")
    show(f"\nResults: {path}   (figures: beltdyn plot {path})")
    write_extras(result, path, extras, force)
    return result


def nothing_kept(path: Path) -> str:
    """Say that an analysis ended before it had results, and whose the result file is then."""
    return "No results are kept." + f" {path} holds those of an earlier analysis, as before." * path.exists()


def doubt(warnings: Sequence[str]) -> int:
    """Exit code where warnings are errors, which are said; 0 without any."""
    if not warnings:
        return 0
    count = f"{len(warnings)} warnings make" if warnings[1:] else "a warning makes"
    show_error(f"{count} these results doubtful. They are kept; without --strict this is no error.")
    return DOUBTFUL


def ended(result: "Result") -> int:
    """Exit code of an analysis that ended without an error."""
    return exit_code() if result.status == "interrupted" else 0

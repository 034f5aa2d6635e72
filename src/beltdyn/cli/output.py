"""Analyze a drive into a result file: outputs, messages and exit codes."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from beltdyn.analyses import RUN, Analysis
from beltdyn.cli.console import show, show_error, show_facts, show_table, show_warnings
from beltdyn.cli.progress import progress_bar
from beltdyn.errors import (
    BeltdynError,
    InternalError,
    LostOutputError,
    ModelError,
    Parts,
    SimulationError,
    is_internal,
)
from beltdyn.signals import exit_code

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Result, Run
    from beltdyn.show.tables import Facts, Table


# A result on the screen: its sheet, and its warnings


def show_result(result: "Result") -> tuple[BeltdynError, ...]:
    """Write tables and facts of a result, 100 columns and as few lines as a drive of seven pulleys needs to fit.

    Returns the errors of parts that have a fault.
    """
    from beltdyn.show.sheet import sheet
    from beltdyn.show.tables import Table

    title, parts, errors = sheet(result)
    if title:
        show(f"\n{title}")
    if parts:
        show()
    show_parts(parts)
    if result.warnings and not (parts and not isinstance(parts[-1], Table)):
        show()
    show_warnings(result.warnings)
    return errors


def show_parts(parts: "Sequence[Table | Facts]") -> None:
    """Write the parts of a sheet, with a line between."""
    from beltdyn.show.tables import Table

    for number, part in enumerate(parts):
        if number:
            show()
        if isinstance(part, Table):
            show_table(*part)
        else:
            if part.title:
                show(part.title)
            show_facts(part.facts)


_DOUBTFUL_EXIT_CODE = 4
"""Exit code where a warning under --strict makes results doubtful; 2 and 3 are those of errors."""


class Extras(NamedTuple):
    """Additional outputs beside a result file."""

    csv: bool
    """Plain tables, in a folder."""
    report: bool
    """A page."""


NO_EXTRAS = Extras(csv=False, report=False)


def require_output(path: Path, files: Iterable[Path], extras: Extras, force: bool) -> None:
    """Make sure that results, tables and reports replace only files of their kind, and never a drive file."""
    from beltdyn.results.atomic import require_replaceable, target_of
    from beltdyn.results.dataset import is_result
    from beltdyn.results.tables import require_tables, tables_folder

    if target_of(path) in {target_of(file) for file in files}:
        raise ModelError(f"{path} is the drive file; the results would overwrite it. Choose another --output.")
    require_replaceable(path, is_result, force)
    if extras.csv:
        require_tables(tables_folder(path), force)
    if extras.report:
        from beltdyn.show.report import report_file, require_report

        require_report(report_file([path]), force)


def write_extras(result: "Result", path: Path, extras: Extras, force: bool, whole: Parts) -> None:
    """Write the requested tables and report beside a result file, and show their names."""
    from beltdyn.results import open_result
    from beltdyn.results.tables import tables_folder, write_csv

    if extras.csv:
        before = len(whole.completed)
        with whole.part(f"bd.write_csv(bd.open_result({str(path)!r}), 'tables')"):
            whole.completed += write_csv(result, tables_folder(path), force)
        show(f"Tables: {', '.join(map(str, whole.completed[before:])) or 'none'}")
    if extras.report:
        from beltdyn.show.report import report_file, write_report

        before = len(whole.completed)
        with whole.part(f"bd.write_report(bd.open_result({str(path)!r}), 'report.html')"):
            whole.completed.append(write_report(open_result(path), report_file([path]), force))
        show(f"Report: {', '.join(map(str, whole.completed[before:])) or 'none'}")


def analyse_to(
    analysis: Analysis,
    drive: "Drive | Run",
    path: Path,
    extras: Extras = NO_EXTRAS,
    force: bool = False,
    **options: Any,
) -> "Result":
    """Analyze a drive into a file with a progress bar, show the result, and write the extras."""
    from beltdyn.results.atomic import locked_output, stamp

    before = stamp(path)
    try:
        with progress_bar() as report, locked_output(path):
            result: Result = analysis.write(drive, path, report, force, **options)
    except LostOutputError:
        show("No results were kept.")
        raise
    except SimulationError:
        show(nothing_kept(path) if stamp(path) in (before, None) else f"The results computed so far are in {path}")
        raise
    with Parts() as parts:
        parts.errors += show_result(result)
        if not _tell_end(analysis, result, path, is_same=stamp(path) == before):
            return result
        show(f"\nResults: {path}   (figures: beltdyn plot {path})")
        write_extras(result, path, extras, force, parts)
    return result


def _tell_end(analysis: Analysis, result: "Result", path: Path, *, is_same: bool) -> bool:
    """Say how an analysis ended: whether there are results in its file."""
    if is_same and result.status == "completed":
        show(f"\n{path} is complete: there was nothing left to compute.")
    elif is_same:
        show(f"\nInterrupted. {nothing_kept(path)}")
        return False
    if result.status == "interrupted":
        from beltdyn.transient.checkpoint import checkpoint_file

        goes_on = f" Resume with: beltdyn {analysis.command} --resume {path}" if checkpoint_file(path).exists() else ""
        show(f"\nInterrupted. The results computed so far are kept.{goes_on}")
    return True


def nothing_kept(path: Path) -> str:
    """Say that an analysis ended without results, and that an older result file is unchanged."""
    return "No results were kept." + f" {path} still holds those of an earlier analysis." * path.exists()


def doubt(warnings: Sequence[str]) -> int:
    """Exit code under --strict, with a message; 0 without warnings."""
    if not warnings:
        return 0
    count = f"{len(warnings)} warnings" if warnings[1:] else "1 warning"
    show_error(f"{count}, which --strict treats as errors. The results are kept.")
    return _DOUBTFUL_EXIT_CODE


def ended(result: "Result") -> int:
    """Exit code of an analysis that ended without an error, but perhaps with internal errors at some points."""
    if result.status == "interrupted":
        return exit_code()
    has_points = result.kind != RUN and "failure" in result.dataset
    failures = result.dataset["failure"].values.ravel() if has_points else ()
    return InternalError.exit_code if any(is_internal(str(one)) for one in (*failures, *result.warnings)) else 0

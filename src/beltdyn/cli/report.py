"""`beltdyn report`."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from beltdyn.cli.console import show


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
        The result file, NetCDF, written by `beltdyn run` or another analysis.
    more
        More result files, to compare with the first.
    output
        The HTML page; by default beside the first result file, and named after it.
    force
        Also replace files that are no reports.
    """
    from beltdyn.report import report_file, require_report, write_report
    from beltdyn.results import open_result

    path = output or report_file((file, *more))
    require_report(path, force)
    show(f"Report: {write_report([open_result(one) for one in (file, *more)], path, force)}")

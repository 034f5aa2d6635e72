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
    """Write a report of a result file, or of several side by side: one page to mail, to look at and to print.

    The page needs a browser and nothing else. It shows key numbers beside the limits that the drive file states,
    warnings with remedies, the drive moving, figures that zoom, tables, the drive file, and where it all comes from.

    Parameters
    ----------
    file
        The result file, NetCDF, written by `beltdyn run` or another command.
    more
        More result files, which are compared with the first.
    output
        The page, HTML; by default beside the first result file, and named after it.
    force
        Replace other files than reports too.
    """
    from beltdyn.report import report_file, require_report, write_report
    from beltdyn.results import open_result

    path = output or report_file((file, *more))
    require_report(path, force)
    show(f"Report: {write_report([open_result(one) for one in (file, *more)], path, force)}")

"""The command `beltdyn study`: any analysis of many variants of a drive, on all cores or on a cluster."""

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter as Option
from cyclopts.validators import Number

from beltdyn.cli.console import show, show_error
from beltdyn.cli.output import show_result
from beltdyn.cli.progress import progress_bar
from beltdyn.errors import ModelError, SimulationError
from beltdyn.signals import exit_code


def study(
    file: Path,
    /,
    *,
    output: Annotated[Path | None, Option(alias="-o")] = None,
    jobs: Annotated[int | None, Option(alias="-j", validator=Number(gte=1))] = None,
    scheduler: str | None = None,
    retry: Annotated[bool, Option(negative="")] = False,
    report: Annotated[bool, Option(negative="")] = False,
    force: Annotated[bool, Option(negative="")] = False,
) -> int:
    """Analyze many variants of a drive, on all cores or on a cluster.

    A failed point is marked with its reason, and the others continue. Rows are written to a CSV file as points finish.
    The same command resumes a study that was interrupted or killed, or that has new points.

    Parameters
    ----------
    file
        The study file, TOML.
    output
        The result file; by default STUDY.nc beside the study file. The rows are in the
        CSV file of the same name.
    jobs
        The number of points to compute at a time; by default the number of cores.
    scheduler
        Compute on a Dask cluster instead: the address of its scheduler, such as tcp://host:8786.
    retry
        Recompute points that failed before.
    report
        Also write a report, one HTML page beside the result file.
    force
        Recompute all points, and also replace files that beltdyn did not write.
    """
    from beltdyn.cli.output import Extras, nothing_kept, write_extras
    from beltdyn.designs.study import study as compute
    from beltdyn.results.atomic import stamp, target_of

    path = output or file.with_suffix(".nc")
    if target_of(file) in (target_of(path), target_of(path.with_suffix(".csv"))):
        raise ModelError(f"{file} is the study file; the results would overwrite it. Choose another --output.")
    before = stamp(path)
    with progress_bar() as tell:
        result = compute(file, jobs=jobs, scheduler=scheduler, retry=retry, output=path, progress=tell, overwrite=force)
    show_result(result)
    if stamp(path) == before:
        show(f"\n{nothing_kept(path)}")
        return exit_code()
    if result.status == "interrupted":
        show("\nInterrupted. The results computed so far are kept; the same command resumes the study.")
    show(f"\nResults: {path}, {path.with_suffix('.csv')}   (figures: beltdyn plot {path})")
    write_extras(result, path, Extras(csv=False, report=report), force)
    if result.status == "interrupted":
        return exit_code()
    if result.dataset.sizes["point"] == int((result.dataset["failure"] != "").sum()):
        show_error("all points of the study failed.")
        return SimulationError.exit_code
    return 0

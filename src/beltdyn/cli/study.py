"""The command `beltdyn study`: any analysis of many variants of a drive, on all cores or on a cluster."""

from collections import Counter
from collections.abc import Mapping, Sequence
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args

from cyclopts import Parameter as Option
from cyclopts.validators import Number

from beltdyn.analyses import Analysis
from beltdyn.cli.console import lines_of_file, show, show_error, show_table, show_warnings
from beltdyn.cli.output import Extras, doubt, ended, require_output, show_result, write_extras
from beltdyn.cli.progress import progress_bar, runs_bar
from beltdyn.errors import InternalError, ModelError, Parts, SimulationError, is_internal
from beltdyn.signals import exit_code

if TYPE_CHECKING:
    from beltdyn.designs.processes import Ending
    from beltdyn.model import Drive
    from beltdyn.results import Run
    from beltdyn.solvers.run_progress import Progress


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
    from beltdyn.cli.output import nothing_kept
    from beltdyn.designs.study import study as compute
    from beltdyn.results.atomic import stamp

    path = output or file.with_suffix(".nc")
    before = stamp(path)
    begun = False

    with progress_bar() as bar:

        def tell(progress: "Progress") -> None:
            nonlocal begun
            begun = True
            bar(progress)

        result = compute(file, jobs=jobs, scheduler=scheduler, retry=retry, output=path, progress=tell, overwrite=force)
    with Parts() as parts:
        parts.errors += show_result(result)
        if not begun:
            show(f"\n{path} is complete: there was nothing left to compute.")
        if stamp(path) == before:
            show(f"\nInterrupted. {nothing_kept(path)}")
            return exit_code()
        if result.status == "interrupted":
            show("\nInterrupted. The results computed so far are kept; the same command resumes the study.")
        show(f"\nResults: {path}, {path.with_suffix('.csv')}   (figures: beltdyn plot {path})")
        write_extras(result, path, Extras(csv=False, report=report), force, parts)
    if code := ended(result):
        return code
    if result.dataset.sizes["point"] == int((result.dataset["failure"] != "").sum()):
        show_error("all points of the study failed.")
        return SimulationError.exit_code
    return 0


# The input file of a command: a drive, or a run whose drive is used


def takes_runs(analysis: Analysis) -> bool:
    """Whether a run can replace the drive: the first parameter of the function may be one."""
    from beltdyn.results import Run

    first = next(iter(signature(analysis.function, eval_str=True).parameters.values()))
    return Run in get_args(first.annotation)


def read_given(analysis: Analysis, file: Path) -> "Drive | Run":
    """Read a drive file, or a result file if the analysis accepts runs."""
    from beltdyn.model import load
    from beltdyn.results import Run, open_result
    from beltdyn.results.dataset import is_result

    if not (takes_runs(analysis) and is_result(file)):
        return load(file)
    found = open_result(file)
    if not isinstance(found, Run):
        raise ModelError(
            f"{file} holds results of {found.kind}, not of a run. Give the result file of `beltdyn simulate` or "
            "`beltdyn steady-state`, or a drive file."
        )
    return found


def analyse_several(
    analysis: Analysis,
    files: Sequence[Path],
    folder: Path | None,
    jobs: int | None,
    extras: Extras,
    *,
    strict: bool,
    force: bool,
    **options: Any,
) -> int:
    """Analyze drives in parallel, show a table of them, and return the exit code.

    All drive files and outputs are checked before anything is computed.
    """
    given = _read_all(analysis, files)
    results = _result_files(analysis, files, folder)
    for path in results.values():
        require_output(path, files, extras, force)
    if folder is not None:
        from beltdyn.results.atomic import make_folder

        make_folder(folder)
    from beltdyn.designs.batch import analyse_all

    with runs_bar() as report:
        wanted = {results[file]: given[file] for file in files}
        endings = analyse_all(analysis, wanted, report, jobs, force, **options)
    ends = {file: endings[results[file]] for file in files}
    _show_endings(ends, results)
    if any(extras):
        _write_all_extras(ends, results, extras, force)
    if any(end.status in ("interrupted", "not started") for end in ends.values()):
        show("Interrupted. The results computed so far are kept.")
        return exit_code()
    errors = [end.error for end in ends.values() if end.error]
    if errors:
        return (InternalError if any(map(is_internal, errors)) else SimulationError).exit_code
    return doubt([warning for end in ends.values() for warning in end.warnings]) if strict else 0


def _read_all(analysis: Analysis, files: Sequence[Path]) -> "dict[Path, Drive | Run]":
    """Read drive files and runs, or say what is wrong with all of them."""
    given: dict[Path, Drive | Run] = {}
    wrong: list[str] = []
    for file in files:
        try:
            given[file] = read_given(analysis, file)
        except ModelError as error:
            wrong += lines_of_file(file, error)
    if wrong:
        raise ModelError("\n".join(wrong))
    return given


def _result_files(analysis: Analysis, files: Sequence[Path], folder: Path | None) -> dict[Path, Path]:
    """The result file of every drive file."""
    results = [(folder or file.parent) / analysis.result_file(file).name for file in files]
    from beltdyn.results.atomic import target_of

    for path, count in Counter(map(target_of, results)).items():
        if count > 1:
            sharing = [str(file) for file, result in zip(files, results, strict=True) if target_of(result) == path]
            raise ModelError(
                f"{' and '.join(sharing)} would share the result file {path}. Rename one, or run them separately."
            )
    return dict(zip(files, results, strict=True))


def _show_endings(ends: Mapping[Path, "Ending"], results: Mapping[Path, Path]) -> None:
    """Write a table of all, their warnings, and why some failed."""
    headings = ("", "status", "speed of last pulley", "steps", "wall time", "warnings", "results")
    rows = [(str(file), end.status, *_numbers(end), str(results[file]) * end.kept) for file, end in ends.items()]
    filled = [column for column in zip(headings, *rows, strict=True) if any(column[1:])]
    headings, *rows = zip(*filled, strict=True)
    show_table("\nDrives", headings, rows)
    show()
    for file, end in ends.items():
        show_warnings(f"{file}: {warning}" for warning in end.warnings)
    for file, end in ends.items():
        for line in end.error.splitlines():
            show_error(f"{file}: {line}")


def _numbers(end: "Ending") -> tuple[str, str, str, str]:
    """Numbers of a run, and how many warnings there are."""
    summary, warnings = end.summary, f"{len(end.warnings)}" * end.kept
    if summary is None:
        return "", "", "", warnings
    speed = f"{summary.pulleys[-1].speed:z.4f} rad/s"
    return speed, f"{summary.steps}", f"{summary.wall_time:.3g} s", warnings


def _write_all_extras(ends: Mapping[Path, "Ending"], results: Mapping[Path, Path], extras: Extras, force: bool) -> None:
    """Write tables and reports of all drives with results."""
    from beltdyn.results import open_result

    with Parts() as parts:
        for file, end in ends.items():
            if end.kept:
                with parts.part():
                    result = open_result(results[file])
                    write_extras(result, results[file], extras, force, parts)
                    result.dataset.close()

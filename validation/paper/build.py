"""From nothing to the page: run every case, judge every statement, write one file."""

import os
import platform
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import provenance
from beltdyn.results.atomic import make_folder, unwritable
from beltdyn.solvers.run_progress import BatchProgress
from validation.paper.forecast import Forecast
from validation.paper.page import write_page
from validation.paper.runs import REPEATS, RunMissingError, Runs, run_all
from validation.paper.statement import Section
from validation.paper.statements import SECTIONS, Part

PAGE = "paper.html"
RUNS = "runs"


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the page.

    Attributes
    ----------
    page : Path
        The HTML file.
    sections : tuple of Section
        Its parts with their statements.
    failures : dict
        Name -> reason of every run that failed.
    """

    page: Path
    sections: tuple[Section, ...]
    failures: dict[str, str]


def build_paper(
    folder: Path, progress: Callable[[BatchProgress], None] | None = None, parts: Sequence[Part] = SECTIONS
) -> Outcome:
    """Run the cases of the paper and write the page that compares them with its statements.

    Parameters
    ----------
    folder : Path
        Where to write ``paper.html`` and, into the folder ``runs``, a drive file and what is kept of its run for every
        run; made if need be.
    progress : callable, optional
        Told of the runs.
    parts : sequence of Part
        Which parts of the page to make.

    Returns
    -------
    Outcome
        The page, and what failed.

    Raises
    ------
    ModelError
        If the folder cannot be written to.
    """
    begun = time.perf_counter()
    _check_folder(folder)
    cases = _all_cases(parts)
    forecast = Forecast(cases, progress)
    runs = run_all(cases, folder / RUNS, forecast.runs)
    names = _timed(parts, runs)
    expected = {name: float(runs[name].dataset.attrs["cpu_time"]) for name in names}
    runs.take_times(names, folder / RUNS, forecast.timed(expected, REPEATS))
    sections = tuple(_section(part, runs) for part in parts)
    facts = _facts(time.perf_counter() - begun, folder, runs)
    write_page(folder / PAGE, sections, runs.failures, facts)
    return Outcome(folder / PAGE, sections, runs.failures)


def _check_folder(folder: Path) -> None:
    """Make sure that the folder can be written to before anything is computed."""
    make_folder(folder)
    try:
        with tempfile.TemporaryFile(dir=folder):
            return
    except OSError as error:
        raise ModelError(unwritable(folder / PAGE, error)) from error


def _all_cases(parts: Sequence[Part]) -> dict[str, Drive]:
    """What all parts want to have run, each drive once."""
    drives: dict[str, Drive] = {}
    for part in parts:
        for name, drive in part.cases().items():
            if drives.setdefault(name, drive) != drive:
                raise ValueError(f"two parts of the page name different drives {name}")
    return drives


def _timed(parts: Sequence[Part], runs: Runs) -> list[str]:
    """Names of the runs that parts want timed, each once; none of parts that lack a run."""
    names = dict[str, None]()
    for part in parts:
        if hasattr(part, "timed"):
            with suppress(RunMissingError):
                names |= dict.fromkeys(map(runs.name_of, part.timed(runs)))
    return list(names)


def _section(part: Part, runs: Runs) -> Section:
    """A part of the page, or why it could not be made."""
    try:
        return part.section(runs)
    except RunMissingError as error:
        name = part.__name__.rpartition(".")[2].replace("_", "-")
        return Section(name, name.replace("-", " ").capitalize(), f"This part could not be made: {error}")


def _facts(seconds: float, folder: Path, runs: Runs) -> dict[str, str]:
    """Where the page comes from."""
    origin = provenance("", "")
    packages = ", ".join(f"{name} {origin[f'{name}_version']}" for name in ("numba", "numpy", "scipy"))
    return {
        "Version": f"beltdyn {origin['beltdyn_version']}",
        "Made": datetime.now(UTC).strftime("%d %B %Y, %H:%M UTC"),
        "Command": f"python -m validation.paper --out {folder}",
        "Environment": f"Python {origin['python_version']}, {packages}; {platform.system()} {platform.machine()}, "
        f"{os.cpu_count()} cores",
        "Runs": f"{len(runs) + len(runs.failures)}; their drive files, and what this page needs of their results, are "
        f"in the folder {RUNS} beside it",
        "Run time": f"{seconds:.0f} s, compilation included",
    }

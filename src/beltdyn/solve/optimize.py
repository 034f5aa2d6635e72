"""Optimisation: parameters of a drive that minimise or maximise a result within limits."""

from pathlib import Path

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.study import OptimizationStudy
from beltdyn.model.toml_reader import read_study
from beltdyn.results import Result
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.studies.descent import Descent
from beltdyn.solve.studies.designs import Designs, free_number
from beltdyn.solve.studies.goals import aims_of
from beltdyn.solve.studies.optimization_history import History
from beltdyn.solve.studies.study_points import held, study_points


def optimize(
    drive: Drive,
    *,
    study: Path | str | OptimizationStudy,
    most: int = 60,
    force_tolerance: float | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Minimise or maximise a result over parameters of a drive, within limits.

    A study names the numbers that may change with their bounds, the operating points, the goal, and what must be kept:
    limits of results, distances of modes from orders, clearances. Every design is a drive in steady running at all
    operating points; one without is no solution, for the reason that is told. What is found is the best design near to
    the drive that is given; another start may lead to another one.

    Parameters
    ----------
    drive
        The drive, at which the search starts.
    study
        The study file, TOML.
    most
        How many designs to try, at most.
    force_tolerance
        Error of contact forces, over the largest of a pulley, up to which the mesh is refined; by default that of the
        drive, 0.01.
    output
        Result file (NetCDF4), written as designs are tried, with the best drive file beside it; without one the
        results stay in memory.
    progress
        Called now and then with a `Progress`.
    overwrite
        Replace any regular file by the results, and not only earlier results.

    Returns
    -------
    Result
        Along ``number`` ``start`` and ``best``; along ``requirement`` the worst of each result before and after; along
        ``design`` the goal of each design and by how much it violates limits; along ``point`` and ``result``
        ``start_result`` and ``best_result``. Its drive is the best one, of which the attribute ``best_drive`` is the
        text, with the comments of the file that was read.

    Raises
    ------
    ModelError
        If the study is none, or does not fit the drive.
    ConvergenceError
        If the drive that is given has no steady running at an operating point.

    Examples
    --------
    >>> study = bd.OptimizationStudy(
    ...     number=[{"path": "belt.length", "least": "1.27 m", "largest": "1.275 m"}],
    ...     goal={"result": "hub_load"},
    ...     requirement=[{"result": "slip_safety", "at_least": 5.0}],
    ... )
    >>> found = bd.optimize(drive, study=study)
    >>> bool(found.dataset.goal_found < found.dataset.goal_at_start)
    True
    """
    if most < 2:
        raise ModelError(f"most = {most} must be 2 or more designs.")
    given = study if isinstance(study, OptimizationStudy) else read_study(study, OptimizationStudy)
    base = Path() if isinstance(study, OptimizationStudy) else Path(study).parent
    numbers, there = tuple(free_number(drive, one) for one in given.numbers), held(drive, given.points)
    points = study_points(drive, given.points, base)
    aims = aims_of(given, there, points)
    history = History(drive, numbers, points, aims, output, overwrite, study=study)

    def tell(part: float) -> None:
        if progress is not None:
            done = len(history.tried) + part
            progress(Progress(done, float(most), 0.0, len(history.tried), "designs"))

    designs = Designs(drive, numbers, points, given.points, aims.watched, force_tolerance, tell)
    start = designs.find({one.path: one.start for one in numbers})
    if start.failure:
        raise ConvergenceError(f"the search starts from the given drive, which does not run. {start.failure}")
    history.note(start)
    descent = Descent(designs, aims, most, history.note)
    with history:
        ended = descent.run(start)
        history.end(ended, designs.refined(history.best), designs.failed)
    return history.result()

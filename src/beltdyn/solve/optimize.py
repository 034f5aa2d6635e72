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

    A study names the parameters with their bounds, the operating points, the goal, and the constraints: limits of
    results, distances of modes from orders, clearances. Each design must have steady running at all operating points;
    otherwise it is marked as failed with the reason. The search finds a local optimum near the given drive; another
    start may lead to another one.

    Parameters
    ----------
    drive
        The drive, with the starting values.
    study
        The study file, TOML.
    most
        Largest number of designs to try.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), updated design by design, with the best drive file beside it; without it the results stay
        in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Along ``number`` ``start`` and ``best``; along ``requirement`` the worst of each result before and after; along
        ``design`` the goal of each design and its violation of limits; along ``point`` and ``result`` ``start_result``
        and ``best_result``. Its drive is the best one, whose file text, with the original comments, is the attribute
        ``best_drive``.

    Raises
    ------
    ModelError
        If the study is invalid, or does not fit the drive.
    ConvergenceError
        If the given drive has no steady running at an operating point.

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

"""Optimization: parameters of a drive that minimize or maximize a result within limits."""

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import held, study_points
from beltdyn.designs.designs import Design, Designs, free_numbers
from beltdyn.designs.optimization_history import Aims, History, aims_of
from beltdyn.errors import ConvergenceError, InternalError, is_internal
from beltdyn.model import Drive
from beltdyn.model.parameter_study import OptimizationStudy
from beltdyn.model.toml import read_study
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.quantity import Count
from beltdyn.results import Result
from beltdyn.solvers.run_progress import Progress, Report

# The search for the best design: linear programs in a trust region (Fletcher and Sainz de la Maza 1989)

_MIN_EXPECTED_FALL = 1e-4
"""Expected fall of goal and violations at which the search ends, over their scales."""
_FIRST_PART, _LARGEST_PART, _LEAST_PART = 0.15, 0.5, 1e-4
"""Part of the ways between bounds that the first, the largest and the least step may take."""
_ACCEPTED_RATIO, _POOR_RATIO, _GOOD_RATIO = 0.1, 0.3, 0.7
"""Fall over the expected one from which a step is taken, below which the next is shorter, and from which longer."""
_EXPANSION, _REDUCTION, _FAILURE_REDUCTION = 2.0, 0.4, 0.25
"""Factors on the size of the trust region: after a good step, after a poor one, and after a design that could not be
computed. They affect how many designs are tried."""
_PENALTY = 100.0
"""M, with the goal over its scale, and violations over that of their limits."""
_LAZINESS = 1e-5
"""e: what does not matter stays as it is."""
_UNBOUND = 1e3
"""Distance from a limit of a result that has no value there, such as the slip safety of a pulley without load."""


class _Place(NamedTuple):
    """A design as the search sees it."""

    parts: FloatArray
    """Of the ways from the least to the largest values, shape (n,)."""
    design: Design
    goals: FloatArray
    """Over the scale of the goal."""
    distances: FloatArray
    """From limits, over their scales."""

    @property
    def merit(self) -> float:
        """What is to fall."""
        return float(np.max(self.goals) + _PENALTY * max(0.0, -np.min(self.distances, initial=0.0)))


class Descent:
    """Tries designs, each from the states of the last one that was better, until none is."""

    def __init__(self, designs: Designs, aims: Aims, most: int, note: Callable[[Design], None]) -> None:
        self._designs, self._aims, self._most, self._note = designs, aims, most, note
        self._ranges = np.array([one.largest - one.least for one in designs.numbers])
        self._goal_scale, self._scales = 1.0, np.ones(0)

    def run(self, start: Design) -> str:
        """Search from a design that runs."""
        parts = np.array([(one.start - one.least) / (one.largest - one.least) for one in self._designs.numbers])
        derivatives = self._designs.derivatives(start)
        self._set_scales(start, derivatives)
        here, reach, tried = self._place(parts, start), _FIRST_PART, 1
        step, expected = self._step(here, derivatives, reach)
        while expected > _MIN_EXPECTED_FALL and reach > _LEAST_PART:
            if tried >= self._most:
                return f"{self._most} designs were tried"
            ahead = self._try(here, step)
            tried += 1
            if ahead is None:
                reach *= _FAILURE_REDUCTION
            else:
                fall = (here.merit - ahead.merit) / expected
                if fall >= _ACCEPTED_RATIO:
                    here, derivatives = ahead, self._designs.derivatives(ahead.design)
                reach = min(
                    reach * (_EXPANSION if fall >= _GOOD_RATIO else _REDUCTION if fall < _POOR_RATIO else 1.0),
                    _LARGEST_PART,
                )
            step, expected = self._step(here, derivatives, reach)
        return "no better design nearby"

    def _set_scales(self, start: Design, derivatives: FloatArray) -> None:
        """Measure the goal by its change along the whole way between bounds, limits by themselves."""
        worst = int(np.argmax(self._aims.goal_values(start.values)))
        slopes = self._aims.goal_slopes(start.values, derivatives)[worst]
        self._goal_scale = float(np.abs(slopes * self._ranges).max()) or 1.0
        limits = [abs(limit.value) or 1.0 for limit in self._aims.limits for _ in range(self._aims.places(limit))]
        self._scales = np.array(limits)

    def _place(self, parts: FloatArray, design: Design) -> _Place:
        distances = np.nan_to_num(
            self._aims.distances(design.values) / self._scales, nan=_UNBOUND, posinf=_UNBOUND, neginf=-_UNBOUND
        )
        return _Place(parts, design, self._aims.goal_values(design.values) / self._goal_scale, distances)

    def _try(self, here: _Place, step: FloatArray) -> _Place | None:
        """A design a step ahead; None if it does not run."""
        parts = np.clip(here.parts + step, 0.0, 1.0)
        changes = {one.path: one.at(part) for one, part in zip(self._designs.numbers, parts, strict=True)}
        design = self._designs.find(changes, here.design)
        self._note(design)
        return None if design.failure else self._place(parts, design)

    def _step(self, here: _Place, derivatives: FloatArray, reach: float) -> tuple[FloatArray, float]:
        """The best step by the linear program, and by how much goal and violations are to fall."""
        from scipy.optimize import linprog

        program: Callable[..., Any] = linprog
        goals = self._aims.goal_slopes(here.design.values, derivatives) * self._ranges / self._goal_scale
        limits = self._aims.distances(derivatives) * self._ranges / self._scales[:, None]
        count = self._ranges.size
        last = np.zeros((len(goals) + len(limits), 2))
        last[: len(goals), 0], last[len(goals) :, 1] = -1.0, -1.0
        slopes = np.concatenate([goals, -limits])
        found = program(
            np.concatenate([np.full(2 * count, _LAZINESS), [1.0, _PENALTY]]),
            A_ub=np.hstack([slopes, -slopes, last]),
            b_ub=np.concatenate([-here.goals, here.distances]),
            bounds=[
                *((0.0, float(min(reach, room))) for room in 1.0 - here.parts),
                *((0.0, float(min(reach, room))) for room in here.parts),
                (None, None),
                (0.0, None),
            ],
        )
        if found.x is None:
            return np.zeros(count), 0.0
        step = np.asarray(found.x[:count] - found.x[count : 2 * count])
        return step, float(here.merit - found.x[-2] - _PENALTY * found.x[-1])


@takes_options
def optimize(
    drive: Drive,
    *,
    study: Path | str | OptimizationStudy,
    most: Annotated[Count, Field(ge=2)] = 60,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Minimize or maximize a result over parameters of a drive, within limits.

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
    given = study if isinstance(study, OptimizationStudy) else read_study(study, OptimizationStudy)
    base = Path() if isinstance(study, OptimizationStudy) else Path(study).parent
    numbers, there = free_numbers(drive, given.numbers), held(drive, given.points)
    points = study_points(drive, given.points, base, [one.path for one in numbers])
    aims = aims_of(given, there, points)
    history = History(drive, numbers, points, aims, output, overwrite, study=study)

    def tell(part: float) -> None:
        if progress is not None:
            done = len(history.tried) + part
            progress(Progress(done, float(most), 0.0, len(history.tried), "designs"))

    designs = Designs(drive, numbers, points, given.points, aims.watched, force_tolerance, tell)
    start = designs.find({one.path: one.start for one in numbers})
    if start.failure:
        kind = InternalError if is_internal(start.failure) else ConvergenceError
        raise kind(f"the search starts from the given drive, which does not run. {start.failure}")
    aims.require_values(start.values)
    history.note(start)
    descent = Descent(designs, aims, most, history.note)
    with history:
        ended = descent.run(start)
        history.end(ended, designs.refined(history.best), designs.failed)
    return history.result()

"""Parameter studies: any analysis for many variants of a drive."""

import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import suppress
from math import ceil
from pathlib import Path
from typing import Any

import numpy as np

from beltdyn.analyses import ANALYSES, Analysis
from beltdyn.designs.point_work import ChunkOutcome, Outcome, PointWork, compute_points
from beltdyn.designs.processes import GONE, ThisProcess, Workers, workers_of
from beltdyn.designs.study_columns import require_possible
from beltdyn.designs.study_plan import plan_of
from beltdyn.designs.study_table import StudyTable, rows_file
from beltdyn.errors import ModelError, SimulationError, cause_of
from beltdyn.model import Drive, ParameterStudy, load
from beltdyn.model.pulley import refuse_functions
from beltdyn.model.toml import read_study
from beltdyn.parts.kind_fields import refuse_kinds_of_scripts
from beltdyn.parts.options import options_of, read_options, require_options
from beltdyn.points.duty import Column, duty_of, require_distinct_columns
from beltdyn.results import Result
from beltdyn.results.atomic import make_folder, target_of
from beltdyn.signals import uninterrupted
from beltdyn.solvers.run_progress import Pace, Phase, Progress, Report
from beltdyn.transient.beginning import compile_ahead

# Points of a study go to those who compute them, in chunks that take about a second, and come back in any order

_CHUNK_TIME = 1.0
"""Computing time of a chunk that is aimed at, s."""
_MAX_CHUNK_POINTS = 1000
"""Points in a chunk, at most, where a point takes less than a millisecond."""
_QUEUED_CHUNKS = 2
"""Chunks on their way for each process."""
_FINAL_CHUNKS = 4
"""Chunks for each process among which the last points are shared out at least."""
_LATEST_WEIGHT = 0.5
"""Weight of the latest chunk in the mean time of a point."""
_MAX_ATTEMPTS = 3
"""How often a process may be killed while it computes a point."""
_POLL_INTERVAL = 0.5
"""Longest wait for the end of a chunk, s: progress is reported at least this often."""

Chunk = tuple[int, ...]


class Dispatch:
    """Sends points out, and takes what comes back."""

    def __init__(
        self,
        workers: Workers,
        work: PointWork,
        changes: Callable[[int], Mapping[str, Any]],
        take: Callable[[list[Outcome], Mapping[str, str]], None],
        tell: Callable[[], None],
    ) -> None:
        self._workers, self._work, self._changes, self._take, self._tell = workers, work, changes, take, tell
        self._waiting: deque[int] = deque()
        self._again: deque[int] = deque()
        self._attempts: dict[int, int] = {}
        self._flying: dict[Future[ChunkOutcome], Chunk] = {}
        self._seconds = 0.0

    def run(self, points: Iterable[int]) -> None:
        """Have points computed."""
        self._waiting.extend(points)
        try:
            while self._waiting or self._again or self._flying:
                self._fill()
                for future in wait(self._flying, timeout=_POLL_INTERVAL, return_when=FIRST_COMPLETED).done:
                    with uninterrupted():
                        self._land(future)
                self._tell()
        except BaseException:
            try:
                self._workers.close(abandon=True)
            finally:
                self._take_what_came()
            raise
        self._workers.close()

    def _fill(self) -> None:
        """Send chunks out, as many as may be on their way."""
        while len(self._flying) < _QUEUED_CHUNKS * self._workers.slots and (chunk := self._next()):
            future = self._workers.submit(compute_points, self._work, [(one, self._changes(one)) for one in chunk])
            self._flying[future] = chunk
            if isinstance(self._workers, ThisProcess):
                return

    def _next(self) -> Chunk:
        """The next points to send together; none where others have to come back first."""
        if self._again:
            alone = self._attempts[self._again[0]] > 1
            return () if alone and self._flying else (self._again.popleft(),)
        if any(self._attempts.get(chunk[0], 0) > 1 for chunk in self._flying.values()):
            return ()
        fair = ceil(len(self._waiting) / (_FINAL_CHUNKS * max(self._workers.slots, 1)))
        wanted = int(_CHUNK_TIME / self._seconds) if self._seconds > 0.0 else 1
        size = min(max(min(wanted, fair, _MAX_CHUNK_POINTS), 1), len(self._waiting))
        return tuple(self._waiting.popleft() for _ in range(size))

    def _land(self, future: Future[ChunkOutcome]) -> None:
        """Take what a chunk has become."""
        chunk = self._flying.pop(future)
        if future.cancelled():
            raise SimulationError(GONE)
        error = future.exception()
        if error is not None and self._workers.lost(error):
            self._lose(chunk)
        elif error is not None:
            self._tell_alone(chunk, error)
        else:
            found = future.result()
            self._take_outcomes(found)
            if found.interrupted and isinstance(self._workers, ThisProcess):
                raise KeyboardInterrupt
            done = {one.point for one in found.outcomes}
            self._waiting.extendleft(point for point in reversed(chunk) if point not in done)

    def _take_outcomes(self, found: ChunkOutcome) -> None:
        if found.outcomes:
            latest = sum(one.seconds for one in found.outcomes) / len(found.outcomes)
            self._seconds += (_LATEST_WEIGHT if self._seconds > 0.0 else 1.0) * (latest - self._seconds)
            self._take(found.outcomes, found.units)

    def _tell_alone(self, chunk: Chunk, error: BaseException) -> None:
        """Compute points again, each alone: the one whose answer cannot be passed on has failed."""
        if not isinstance(error, Exception):
            raise error
        if chunk[1:]:
            self._attempts |= {point: max(self._attempts.get(point, 0), _MAX_ATTEMPTS - 1) for point in chunk}
            self._again.extend(chunk)
        else:
            told = cause_of(error, self._work.call(self._changes(chunk[0])))
            self._take([Outcome(chunk[0], {}, told, "", 0.0)], {})

    def _lose(self, chunk: Chunk) -> None:
        """Recompute points whose process was killed; a point that kills too many processes has failed."""
        for point in chunk:
            self._attempts[point] = attempts = self._attempts.get(point, 0) + 1
            if attempts < _MAX_ATTEMPTS:
                self._again.append(point)
            else:
                failure = (
                    f"its process was killed {attempts} times, possibly because memory ran out. Run fewer at once."
                )
                self._take([Outcome(point, {}, failure, "", 0.0)], {})

    def _take_what_came(self) -> None:
        """Take what came back before the end."""
        for future in list(self._flying):
            with suppress(BaseException):
                if future.done() and not future.cancelled():
                    self._take_outcomes(future.result())


_LEFT_OUT = ("resume",)
"""Options of analyses that make no sense at points."""


def study(
    study: Path | str | ParameterStudy,
    drive: Drive | None = None,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    retry: bool = False,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Analyze many variants of a drive, on all cores or on a cluster.

    Failed points are marked with their reason. Results are written as points finish; an interrupted or killed study, or
    one with added points, resumes when it is started again with the same file.

    Parameters
    ----------
    study
        The study file, TOML, or the study.
    drive
        The drive; by default that of the file that the study names.
    jobs
        Number of points computed in parallel; by default the number of cores. With 1 they are computed in this process.
    scheduler
        Address of the scheduler of a Dask cluster to use instead, such as "tcp://host:8786".
    retry
        Recompute points that failed before.
    output
        Result file (NetCDF4), with a CSV file of all finished points beside it; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Start again, and overwrite any regular files.

    Returns
    -------
    Result
        Along ``point`` the results, each under its name such as "hub_load[driven]", the numbers that vary as
        coordinates under their paths, ``seconds``, ``failure`` and ``point_warnings``.

    Raises
    ------
    ModelError
        If the study does not fit the drive or its analysis, there is no such result, files cannot be written, or hold
        points of another study.
    SimulationError
        If the cluster is lost.

    Examples
    --------
    >>> study = bd.ParameterStudy(
    ...     analysis="equilibrium",
    ...     number=[{"path": "belt.width", "values": "10, 15 mm"}],
    ...     results=["hub_load"],
    ... )
    >>> found = bd.study(study, drive, jobs=1)
    >>> found.dataset["hub_load[driven]"].round(1).values.tolist()  # N
    [53.5, 77.9]
    """
    given, base = (study, Path()) if isinstance(study, ParameterStudy) else (_read(study), Path(study).parent)
    drive = _drive_of(given, base) if drive is None else drive
    analysis = ANALYSES[given.analysis]
    options = _options(analysis, given.options, base)
    plan = plan_of(given, drive, base)
    if isinstance(table := options.get("table"), Path):
        require_distinct_columns(drive, duty_of(drive, table) or [], table, plan.paths)
    if any(key in options for key in ("speed", "from_")):
        swept = Column("speed", str(options.get("pulley") or ""), [])
        require_distinct_columns(drive, [swept], "[options]", plan.paths)
    require_possible(given.results, drive, plan.paths)
    path = None if output is None else Path(output)
    inputs = [study if isinstance(study, Path | str) else None, given.table and base / given.table]
    inputs += [given.drive and base / given.drive, *(one for one in options.values() if isinstance(one, Path))]
    if path is not None:
        _spare([Path(one) for one in inputs if one], path)
    source = f"bd.load({(base / given.drive).as_posix()!r})" if given.drive else "drive"
    work = PointWork(drive, analysis, options, given.results, _folder(given, path), source=source)
    workers = workers_of(jobs, scheduler)
    if not isinstance(workers, ThisProcess):
        rule = "points are computed by other processes, which a Python function cannot be passed to"
        refuse_functions(drive.pulleys, rule, "Compute them in this process with jobs = 1.")
        refuse_kinds_of_scripts(drive.own_kinds)
    files = {name: one for name, one in options.items() if isinstance(one, Path)}
    with StudyTable(given, drive, plan, path, overwrite, retry, files) as rows:
        waiting = np.flatnonzero(~rows.done).tolist()
        teller = _Teller(rows, progress, workers)
        if waiting and scheduler is None:
            teller.compiling()
            compile_ahead(drive)
        Dispatch(workers, work, plan.changes, rows.take, teller.tell).run(waiting)
    return rows.result()


def _read(file: Path | str) -> ParameterStudy:
    return read_study(file, ParameterStudy)


def _drive_of(study: ParameterStudy, base: Path) -> Drive:
    if study.drive is None:
        raise ModelError('the study names no drive. Write drive = "drive.toml", relative to the study file.')
    return load(base / study.drive)


def _options(analysis: Analysis, given: Mapping[str, Any], base: Path) -> dict[str, Any]:
    """Options of the analysis, with files by their paths from here."""
    require_options(analysis.function, given, analysis.name, _LEFT_OUT)
    try:
        read_options(analysis.function, given)
    except ModelError as error:
        raise ModelError(f"options: {error}") from error
    known = options_of(analysis.function)
    return {
        name: (base / value).resolve() if isinstance(value, str) and "Path" in str(known[name].annotation) else value
        for name, value in given.items()
    }


def _spare(inputs: Sequence[Path], output: Path) -> None:
    """Make sure that results overwrite no input of the study."""
    targets = {target_of(one) for one in (output, rows_file(output))}
    for file in inputs:
        if target_of(file) in targets:
            raise ModelError(
                f"{file} is an input of the study; the results would overwrite it. Choose another --output."
            )


def _folder(study: ParameterStudy, output: Path | None) -> Path | None:
    """Where result files of points are kept."""
    if not study.keep_files:
        return None
    if output is None:
        raise ModelError("keep_files = true needs a result file, beside which the files are kept. Give an output.")
    return make_folder(output.with_name(f"{output.stem}-points")).resolve()


class _Teller:
    """Tells of progress."""

    def __init__(self, table: StudyTable, progress: Report | None, workers: Workers) -> None:
        self._table, self._progress, self._workers = table, progress, workers
        self._begun, self._pace, self._before = time.perf_counter(), Pace(), int(table.done.sum())

    def compiling(self) -> None:
        if self._progress is not None:
            self._progress(Progress(0.0, float(len(self._table.done)), 0.0, 0, "compiling"))

    def tell(self) -> None:
        if self._progress is not None:
            done, elapsed = int(self._table.done.sum()), time.perf_counter() - self._begun
            pace = self._pace.at(elapsed, float(done - self._before))
            phase: Phase = "points" if self._workers.slots else "no workers"
            self._progress(Progress(float(done), float(len(self._table.done)), 0.0, done, phase, elapsed, "", pace))

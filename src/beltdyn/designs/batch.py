"""Parallel simulations on all cores, each into its own file."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from typing import Any

from beltdyn.analyses import ANALYSES, SIMULATE, Analysis
from beltdyn.designs.worker import SPAWN, Ending, Work, analyse, bare_workers, start_worker
from beltdyn.model import Drive
from beltdyn.model.drive import refuse_functions
from beltdyn.observation.compilation import usable_cores
from beltdyn.results import Run
from beltdyn.solvers.progress import BatchProgress
from beltdyn.transient.beginning import compile_ahead

_POLL = 0.2  # s


def simulate_all(
    drives: Mapping[Path, Drive] | Mapping[str, Drive],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
) -> dict[Path, Ending]:
    """Simulate several drives in parallel, each in its own process; see `analyse_all`.

    Kernels are compiled once beforehand, unless they are on disk already.  A failed simulation does not affect the
    others.  Ctrl-C ends the running ones, which keep their results so far.  Processes do not import the caller's
    script, so it needs no ``if __name__ == "__main__"``.

    Parameters
    ----------
    drives : mapping
        Result file -> drive.
    progress : callable, optional
        Called at the start, and several times a second while simulations run.
    jobs : int, optional
        Number of parallel simulations; by default the number of cores.
    overwrite : bool
        Overwrite any regular files, not only earlier results.
    finish : callable, optional
        A function of a module, called with each completed run in its process; it may replace the file.

    Returns
    -------
    dict
        Result file -> `Ending` of its simulation, in the order of `drives`.
    """
    return analyse_all(ANALYSES[SIMULATE], drives, progress, jobs, overwrite, finish)


def analyse_all(
    analysis: Analysis,
    drives: Mapping[Path, Drive | Run] | Mapping[str, Drive | Run],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
    **options: Any,
) -> dict[Path, Ending]:
    """Analyze several drives in parallel, each in its own process."""
    endings: dict[Path, Ending] = {}
    files = {Path(file): drive for file, drive in drives.items()}
    for file, drive in files.items():
        rule = f"{file.name} runs in another process, which a Python function cannot be passed to"
        refuse_functions(_drive_of(drive), rule, "Call `simulate` or another analysis for this drive alone.")
    waiting, work = _longest_first(files), Work(analysis, options, overwrite, finish)
    stop = SPAWN.Event()

    def tell(running: Mapping[Path, float], ended: int) -> None:
        if progress is not None:
            progress(BatchProgress(len(endings) + ended, len(files), running))

    tell({}, 0)
    if waiting:
        _compile(_drive_of(waiting[0][1]), stop)
    while waiting and not stop.is_set():
        endings |= _run_pool(waiting, min(jobs or usable_cores(), len(waiting)), stop, tell, work)
        waiting = [(file, drive) for file, drive in waiting if file not in endings]
    return {file: endings.get(file, Ending("not started")) for file in files}


def _drive_of(given: Drive | Run) -> Drive:
    return given.drive if isinstance(given, Run) else given


def _longest_first(drives: Mapping[Path, Drive | Run]) -> list[tuple[Path, Drive | Run]]:
    """Order drives so that no long run is left to the end: by number of contact points and simulated time."""

    def size(item: tuple[Path, Drive | Run]) -> float:
        drive = _drive_of(item[1])
        return drive.elements * drive.contact.quadrature_points * drive.simulation.duration

    return sorted(drives.items(), key=size, reverse=True)


def _compile(drive: Drive, stop: SharedEvent) -> None:
    try:
        compile_ahead(drive)
    except KeyboardInterrupt:
        stop.set()


def _run_pool(
    drives: Sequence[tuple[Path, Drive | Run]],
    jobs: int,
    stop: SharedEvent,
    tell: Callable[[Mapping[Path, float], int], None],
    work: Work,
) -> dict[Path, Ending]:
    """Simulate in a pool of processes; if one of these is killed, what had not begun by then has no ending yet."""
    parts = SPAWN.RawArray("d", [math.nan] * len(drives))
    with ProcessPoolExecutor(jobs, SPAWN, start_worker, (stop, parts)) as pool:
        with bare_workers():
            futures = [pool.submit(analyse, place, *one, work) for place, one in enumerate(drives)]
        try:
            pending = set(futures)
            while pending:
                running = [place for place, future in enumerate(futures) if future in pending and parts[place] >= 0.0]
                tell({drives[place][0]: parts[place] for place in running}, len(drives) - len(pending))
                pending = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED).not_done
            tell({}, len(drives))
        except KeyboardInterrupt:
            stop.set()
    endings = {file: _ending(future) for (file, _), future in zip(drives, futures, strict=True)}
    begun = [part >= 0.0 for part in parts]
    if any(begun) and any(isinstance(future.exception(), BrokenProcessPool) for future in futures):
        return {file: ending for (file, ending), it_began in zip(endings.items(), begun, strict=True) if it_began}
    return endings


def _ending(future: Future[Ending]) -> Ending:
    error = future.exception()
    if isinstance(error, BrokenProcessPool):
        return Ending(
            "failed", "its process or another one was killed, possibly because memory ran out. Run fewer at once."
        )
    return future.result()

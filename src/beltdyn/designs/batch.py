"""Parallel simulations on all cores, each into its own file."""

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from pathlib import Path
from typing import Any

from beltdyn.analyses import ANALYSES, SIMULATE, Analysis
from beltdyn.designs.processes import SPAWN, Ending, LocalProcesses, Work, analyse, bare_workers, begin_batch
from beltdyn.model import Drive
from beltdyn.model.drive import refuse_functions, refuse_kinds_of_scripts
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
        refuse_kinds_of_scripts(_drive_of(drive))
    waiting, work = _longest_first(files), Work(analysis, options, overwrite, finish)
    going = True

    def tell(running: Mapping[Path, float], ended: int) -> None:
        if progress is not None:
            progress(BatchProgress(len(endings) + ended, len(files), running))

    tell({}, 0)
    if waiting:
        going = _compiled(_drive_of(waiting[0][1]))
    while waiting and going:
        found, going = _run_pool(waiting, min(jobs or usable_cores(), len(waiting)), tell, work)
        endings |= found
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


def _compiled(drive: Drive) -> bool:
    """Compile the kernels; False after Ctrl-C."""
    try:
        compile_ahead(drive)
    except KeyboardInterrupt:
        return False
    return True


def _run_pool(
    drives: Sequence[tuple[Path, Drive | Run]],
    jobs: int,
    tell: Callable[[Mapping[Path, float], int], None],
    work: Work,
) -> tuple[dict[Path, Ending], bool]:
    """Simulate in a pool of processes; also whether to go on, False after Ctrl-C.

    If one of the processes is killed, what had not begun by then has no ending yet.
    """
    parts = SPAWN.RawArray("d", [math.nan] * len(drives))
    workers, going = LocalProcesses(jobs, begin_batch, (parts,)), True
    with bare_workers():  # as a whole, so that Ctrl-C comes before or after
        futures = [workers.submit(analyse, place, *one, work) for place, one in enumerate(drives)]
    try:
        pending = set(futures)
        while pending:
            running = [place for place, future in enumerate(futures) if future in pending and parts[place] >= 0.0]
            tell({drives[place][0]: parts[place] for place in running}, len(drives) - len(pending))
            pending = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED).not_done
        tell({}, len(drives))
    except KeyboardInterrupt:
        going = False
    finally:
        workers.close(stop=not going)
    lost = [workers.lost(future.exception()) for future in futures]
    begun = [part >= 0.0 for part in parts]
    endings = {
        file: _KILLED if gone else future.result()
        for (file, _), future, gone in zip(drives, futures, lost, strict=True)
    }
    if any(begun) and any(lost):
        endings = {file: ending for (file, ending), it_began in zip(endings.items(), begun, strict=True) if it_began}
    return endings, going


_KILLED = Ending("failed", "its process or another one was killed, possibly because memory ran out. Run fewer at once.")

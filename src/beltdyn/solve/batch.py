"""Many simulations side by side on all cores, each into its own file."""

import math
import multiprocessing
import os
import signal
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass, replace
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from threading import Event, Lock, Thread, current_thread, main_thread
from time import sleep
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any

from beltdyn.analyses import ANALYSES, RUN, Analysis
from beltdyn.errors import BeltdynError, SimulationError
from beltdyn.model import Drive
from beltdyn.results import Result, Run, Summary, summarize
from beltdyn.signals import ENDING
from beltdyn.solve.compilation import compile_kernels, usable_cores
from beltdyn.solve.progress import BatchProgress, Progress
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

if TYPE_CHECKING:
    from ctypes import Array, c_double

_POLL = 0.2  # s
_GRACE = 2.0  # s
_SPAWN = multiprocessing.get_context("spawn")
_THREADS = "OMP_NUM_THREADS"
"""What OpenBLAS and MKL ask for their number of threads."""


@dataclass(frozen=True, slots=True)
class _Work:
    """What is asked of every drive: arguments of `analyse_all`."""

    analysis: Analysis
    options: Mapping[str, Any]
    overwrite: bool
    finish: Callable[[Run], None] | None


@dataclass(frozen=True, slots=True)
class Ending:
    """How the analysis of a drive ended.

    Attributes
    ----------
    status : str
        "completed", "interrupted" by Ctrl-C, "failed", or "not started" before Ctrl-C.
    error : str
        Why it failed; empty otherwise.
    summary : Summary or None
        The numbers that sum up a run; None where there is no output, and of other results than runs.
    warnings : tuple of str
        What makes the results doubtful.
    kept : bool
        Whether there are results in the file.
    """

    status: str
    error: str = ""
    summary: Summary | None = None
    warnings: tuple[str, ...] = ()
    kept: bool = False


def simulate_all(
    drives: Mapping[Path, Drive] | Mapping[str, Drive],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
) -> dict[Path, Ending]:
    """Simulate drives side by side, each by one thread of a process of its own, as `analyse_all` does.

    Kernels are compiled first, once, unless they are on the disk already.  A simulation that fails leaves the others
    alone.  Ctrl-C ends those on their way, which keep what they computed.  Processes do not run the caller's script
    again, so that it needs no ``if __name__ == "__main__"``.

    Parameters
    ----------
    drives : mapping
        Result file -> drive.
    progress : callable, optional
        Called at the beginning, and several times a second while simulations are on their way.
    jobs : int, optional
        How many at a time; by default as many as there are cores.
    overwrite : bool
        Replace any regular files by the results, and not only earlier results.
    finish : callable, optional
        A function of a module, called with each completed run in the process that made it; it may replace the file.

    Returns
    -------
    dict
        Result file -> how its simulation ended, in the order of `drives`.
    """
    return analyse_all(ANALYSES[RUN], drives, progress, jobs, overwrite, finish)


def analyse_all(
    analysis: Analysis,
    drives: Mapping[Path, Drive] | Mapping[str, Drive],
    progress: Callable[[BatchProgress], None] | None = None,
    jobs: int | None = None,
    overwrite: bool = False,
    finish: Callable[[Run], None] | None = None,
    **options: Any,
) -> dict[Path, Ending]:
    """Analyse drives side by side, each by one thread of a process of its own.

    Parameters
    ----------
    analysis : Analysis
        The analysis.
    drives, progress, jobs, overwrite, finish
        As for `simulate_all`.
    **options
        Those of the analysis.

    Returns
    -------
    dict
        Result file -> how its analysis ended, in the order of `drives`.
    """
    endings: dict[Path, Ending] = {}
    files = {Path(file): drive for file, drive in drives.items()}
    waiting, work = _longest_first(files), _Work(analysis, options, overwrite, finish)
    stop = _SPAWN.Event()

    def tell(running: Mapping[Path, float], ended: int) -> None:
        if progress is not None:
            progress(BatchProgress(len(endings) + ended, len(files), running))

    tell({}, 0)
    if waiting:
        _compile(waiting[0][1], stop)
    while waiting and not stop.is_set():
        endings |= _run_pool(waiting, min(jobs or usable_cores(), len(waiting)), stop, tell, work)
        waiting = [(file, drive) for file, drive in waiting if file not in endings]
    return {file: endings.get(file, Ending("not started")) for file in files}


def _longest_first(drives: Mapping[Path, Drive]) -> list[tuple[Path, Drive]]:
    """Order drives so that no long run is left to the end: by number of contact points and simulated time."""

    def size(item: tuple[Path, Drive]) -> float:
        drive = item[1]
        return drive.belt.elements * drive.contact.quadrature_points * drive.simulation.duration

    return sorted(drives.items(), key=size, reverse=True)


def _compile(drive: Drive, stop: SharedEvent) -> None:
    system = drive_system(drive)
    try:
        compile_kernels(system, laid(system, drive.path))
    except KeyboardInterrupt:
        stop.set()


def _run_pool(
    drives: Sequence[tuple[Path, Drive]],
    jobs: int,
    stop: SharedEvent,
    tell: Callable[[Mapping[Path, float], int], None],
    work: _Work,
) -> dict[Path, Ending]:
    """Simulate in a pool of processes; if one of these is killed, what had not begun by then has no ending yet."""
    parts = _SPAWN.RawArray("d", [math.nan] * len(drives))
    with ProcessPoolExecutor(jobs, _SPAWN, _start_worker, (stop, parts)) as pool:
        with _bare_workers():
            futures = [pool.submit(_simulate, place, *one, work) for place, one in enumerate(drives)]
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
        return Ending("failed", "its process or one beside it was killed, as when memory runs out. Run fewer at once.")
    return future.result()


@contextmanager
def _bare_workers() -> Iterator[None]:
    """Let processes that are started meanwhile inherit little.

    They ignore Ctrl-C, of which the parent tells them; use one thread for linear algebra unless the user chose a
    number; and see an empty script in place of the caller's, which each of them would run otherwise.
    """
    script, threads = sys.modules["__main__"], os.environ.get(_THREADS)
    in_main_thread = current_thread() is main_thread()
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN) if in_main_thread else None
    sys.modules["__main__"] = ModuleType("__main__")
    os.environ.setdefault(_THREADS, "1")
    try:
        yield
    finally:
        sys.modules["__main__"] = script
        if threads is None:
            del os.environ[_THREADS]
        if in_main_thread:
            signal.signal(signal.SIGINT, handler)


# In the processes

_stop: SharedEvent
_parts: "Array[c_double]"
_working = Lock()
_leaving = Event()


def _start_worker(stop: SharedEvent, parts: "Array[c_double]") -> None:
    """Keep what is shared with the parent.

    Parameters
    ----------
    stop
        Set when the parent is interrupted.
    parts
        The part of each simulation that is done, 0 to 1; NaN before it begins.
    """
    global _stop, _parts
    _stop, _parts = stop, parts
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _leave)
    warnings.simplefilter("ignore")
    Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    """End when the parent was killed, after the simulation on its way has closed its file."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        _stop.set()
        with _working:
            os._exit(1)


def _leave(number: int, frame: FrameType | None) -> None:
    """End the simulation on its way, and then the process."""
    _leaving.set()
    Thread(target=_exit_when_told, daemon=True).start()


def _exit_when_told() -> None:
    """End the process when the simulation has closed its file and the parent has had time to hear of it."""
    with _working:
        sleep(_GRACE)
        os._exit(1)


def _simulate(place: int, file: Path, drive: Drive, work: _Work) -> Ending:
    """Analyse a drive into a file, and finish what is complete."""
    if _stop.is_set():
        return Ending("not started")
    if _leaving.is_set():
        Event().wait()  # another process takes it
    _parts[place] = 0.0

    def heed(progress: Progress) -> None:
        """Tell the parent, and end the simulation when it says so."""
        _parts[place] = progress.time / progress.duration
        if _stop.is_set() or _leaving.is_set():
            raise KeyboardInterrupt

    try:
        with _working:
            result = work.analysis.write(drive, file, heed, work.overwrite, **work.options)
            ending = _ended(result)
            if work.finish is not None and result.status == "completed":
                work.finish(result)
            return ending
    except SimulationError as error:
        return _kept(drive, file, str(error)) if work.analysis.grows else Ending("failed", str(error))
    except BeltdynError as error:
        return Ending("failed", str(error))
    except Exception as error:
        return Ending("failed", f"{type(error).__name__}: {error}")


def _kept(drive: Drive, file: Path, error: str) -> Ending:
    """How a simulation ended that could not go on, with what it left."""
    try:
        return replace(_ended(Run(None, drive, file)), error=error)
    except (BeltdynError, OSError):  # its file was taken away
        return Ending("failed", error)


def _ended(result: Result) -> Ending:
    if isinstance(result, Run) and not result.outputs:
        return Ending(result.status)
    summary = summarize(result) if isinstance(result, Run) else None
    return Ending(result.status, summary=summary, warnings=tuple(result.warnings), kept=True)

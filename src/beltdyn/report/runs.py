"""Many runs in parallel processes, each into its own file."""

import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.synchronize import Event
from pathlib import Path
from threading import current_thread, main_thread

from beltdyn.model import Drive, loads
from beltdyn.model.toml_writer import dumps
from beltdyn.results import Run, open_run
from beltdyn.results.atomic import make_folder
from beltdyn.solve import simulate
from beltdyn.solve.compilation import compile_kernels
from beltdyn.solve.progress import Progress
from beltdyn.system.build import drive_system
from beltdyn.system.state import laid

_POLL = 0.2  # s


class RunMissingError(KeyError):
    """A run that failed was asked for."""

    def __str__(self) -> str:
        return str(self.args[0])


@dataclass(frozen=True, slots=True)
class Stage:
    """How far the runs have come.

    Attributes
    ----------
    done, total : int
        Runs that ended, and all.
    running : tuple of str
        Names of those on their way.
    """

    done: int
    total: int
    running: tuple[str, ...]


class Runs(Mapping[str, Run]):
    """Runs by name; asking for one that failed raises `RunMissingError`.

    Parameters
    ----------
    paths : mapping
        Name -> result file.
    failures : mapping
        Name -> why there is none.
    """

    def __init__(self, paths: Mapping[str, Path], failures: Mapping[str, str]) -> None:
        self._runs = {name: open_run(path) for name, path in paths.items()}
        self.failures = dict(failures)

    def __getitem__(self, name: str) -> Run:
        if name in self.failures:
            raise RunMissingError(f"the run {name} failed: {self.failures[name]}")
        return self._runs[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._runs)

    def __len__(self) -> int:
        return len(self._runs)

    def close(self) -> None:
        """Close the result files."""
        for run in self._runs.values():
            run.dataset.close()


def run_all(
    drives: Mapping[str, Drive],
    folder: Path,
    progress: Callable[[Stage], None] | None = None,
    workers: int | None = None,
) -> Runs:
    """Simulate drives in parallel processes.

    Kernels are compiled first, once, unless they are on the disk already.  Ctrl-C ends the runs on their way, which
    keep what they computed, and goes on to the caller.

    Parameters
    ----------
    drives : mapping
        Name -> drive.
    folder : Path
        Where to write the result files, named after the drives; made if need be.
    progress : callable, optional
        Called at the beginning, and several times a second while runs are on their way.
    workers : int, optional
        Number of processes; by default that of cores.

    Returns
    -------
    Runs
        Those that were completed, and why others were not.

    Raises
    ------
    ModelError
        If the folder cannot be made.
    """
    make_folder(folder)
    if not drives:
        return Runs({}, {})
    if progress is not None:
        progress(Stage(0, len(drives), ()))
    _compile(next(iter(drives.values())))
    paths = {name: folder / f"{name}.nc" for name in drives}
    context = multiprocessing.get_context("spawn")
    stop = context.Event()
    count = min(workers or os.cpu_count() or 1, len(drives))
    with ProcessPoolExecutor(count, mp_context=context, initializer=_start_worker, initargs=(stop,)) as pool:
        try:
            with _interruptions_ignored():
                futures = {name: pool.submit(_run, dumps(drive), paths[name]) for name, drive in _longest_first(drives)}
            _watch(futures, count, progress)
        except BaseException:
            stop.set()
            pool.shutdown(cancel_futures=True)
            raise
    reasons = {name: _reason(future) for name, future in futures.items()}
    failures = {name: reason for name, reason in reasons.items() if reason}
    return Runs({name: paths[name] for name in drives if name not in failures}, failures)


def _compile(drive: Drive) -> None:
    system = drive_system(drive)
    compile_kernels(system, laid(system, drive.path))


def _longest_first(drives: Mapping[str, Drive]) -> list[tuple[str, Drive]]:
    """Order drives so that no long run is left to the end: by number of contact points and simulated time."""

    def size(item: tuple[str, Drive]) -> float:
        drive = item[1]
        return drive.belt.elements * drive.contact.quadrature_points * drive.simulation.duration

    return sorted(drives.items(), key=size, reverse=True)


def _watch(futures: Mapping[str, Future[str]], workers: int, progress: Callable[[Stage], None] | None) -> None:
    """Tell of progress until all runs have ended; the pool takes them in their order."""
    pending = set(futures.values())
    while pending:
        if progress is not None:
            on_their_way = [name for name, future in futures.items() if future in pending]
            progress(Stage(len(futures) - len(pending), len(futures), tuple(on_their_way[:workers])))
        pending = wait(pending, timeout=_POLL, return_when=FIRST_COMPLETED).not_done
    if progress is not None:
        progress(Stage(len(futures), len(futures), ()))


def _reason(future: Future[str]) -> str:
    """Why a run failed, or nothing."""
    error = future.exception()
    return f"{type(error).__name__}: {error}" if error is not None else future.result()


# In the workers

_stop: Event | None = None


def _start_worker(stop: Event) -> None:
    """Leave interruptions to the parent, which tells of them by an event."""
    global _stop
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore")
    _stop = stop


def _run(drive: str, path: Path) -> str:
    """Simulate a drive, given as TOML, into a file; why it was not completed, or nothing."""
    if _stopped():
        return "not started"
    try:
        run = simulate(loads(drive), path, _heed)
        run.dataset.close()
    except Exception as error:
        return str(error) or type(error).__name__
    return "" if run.status == "completed" else run.status


def _heed(_: Progress) -> None:
    """End the simulation when the parent says so."""
    if _stopped():
        raise KeyboardInterrupt


def _stopped() -> bool:
    return _stop is not None and _stop.is_set()


@contextmanager
def _interruptions_ignored() -> Iterator[None]:
    """Ignore Ctrl-C for a moment, which processes that are started meanwhile inherit."""
    if current_thread() is not main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)

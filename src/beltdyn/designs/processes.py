"""Processes that compute beside this one: how they start, heed their parent, and end.

Batches, studies and the page share them. A process ends its work in order, with results closed, when its parent is
interrupted, tells it to end, or is gone.
"""

import asyncio
import multiprocessing
import os
import signal
import sys
import time
import warnings
from collections.abc import Awaitable, Callable, Iterator, Mapping
from concurrent.futures import CancelledError, Future, InvalidStateError, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass, replace
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as version_of
from multiprocessing import resource_tracker
from multiprocessing.context import SpawnContext, SpawnProcess
from multiprocessing.process import BaseProcess
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from threading import Event, Lock, Thread
from time import sleep
from types import FrameType, ModuleType
from typing import TYPE_CHECKING, Any, Protocol

from beltdyn.analyses import Analysis
from beltdyn.errors import BeltdynError, LostOutputError, ModelError, SimulationError, cause_of
from beltdyn.model import Drive
from beltdyn.observation.compilation import usable_cores
from beltdyn.results import Result, Run, Summary, open_result, summarize
from beltdyn.results.atomic import locked_output, stamp
from beltdyn.signals import ENDING, uninterrupted
from beltdyn.solvers.run_progress import Progress

if TYPE_CHECKING:
    from ctypes import Array, c_double


SPAWN = multiprocessing.get_context("spawn")
_THREADS = "OMP_NUM_THREADS"
"""What OpenBLAS and MKL ask for their number of threads."""


_SAFE_PATH = "PYTHONSAFEPATH"
"""What lets Python import nothing from the working folder, where modules of any names may lie."""


@contextmanager
def bare_workers() -> Iterator[None]:
    """Let processes that are started meanwhile inherit little.

    They import nothing from the working folder; hear no signals until they are prepared for them; use one thread for
    linear algebra unless the user chose a number; and see an empty script in place of the caller's, which each of them
    would run otherwise. Signals of this process wait.
    """
    script, before = sys.modules["__main__"], dict(os.environ)
    with uninterrupted():
        sys.modules["__main__"] = ModuleType("__main__")
        os.environ |= {_SAFE_PATH: "1", _THREADS: before.get(_THREADS, "1")}
        try:
            if os.name == "posix":
                resource_tracker.ensure_running()  # a process, too, which would start as it is first needed
            with _deaf():
                yield
        finally:
            sys.modules["__main__"] = script
            for name in (_SAFE_PATH, _THREADS):
                if name in before:
                    os.environ[name] = before[name]
                else:
                    del os.environ[name]


@contextmanager
def _deaf() -> Iterator[None]:
    """Block signals in this thread, which processes inherit."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, ENDING)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def new_event() -> SharedEvent:
    """An event that processes share."""
    with bare_workers():  # on POSIX a process keeps track of what is shared
        return SPAWN.Event()


_EXIT_DELAY = 2.0
"""Time from the end of an interrupted simulation to that of its process, s, in which the parent receives the
outcome."""

_stop: SharedEvent | None = None
_working = Lock()
_leaving = Event()


def start_worker(stop: SharedEvent) -> None:
    """Prepare a process: it ends when the event is set, when it is told to, and with its parent."""
    global _stop
    _stop = stop
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, _leave)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, ENDING)
    warnings.simplefilter("ignore")
    Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    """End when the parent was killed, after the simulation on its way has closed its file."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        if _stop is not None:
            _stop.set()
        with working():
            os._exit(1)


def _leave(number: int, frame: FrameType | None) -> None:
    """End the simulation on its way, and then the process."""
    _leaving.set()
    Thread(target=_exit_when_told, daemon=True).start()


def _exit_when_told() -> None:
    """End the process when the simulation has closed its file and the parent has had time to hear of it."""
    with working():
        sleep(_EXIT_DELAY)
        os._exit(1)


def working() -> Lock:
    """What is held while a file is written, so that the process does not end meanwhile."""
    return _working


def stopped() -> bool:
    """Whether the parent was interrupted, or is gone."""
    return _stop is not None and _stop.is_set()


def leaving() -> bool:
    """Whether this process was told to end; another one takes what it is given from now on."""
    return _leaving.is_set()


def wait_for_the_end() -> None:
    """Wait until this process ends, if it was told to."""
    if leaving():
        Event().wait()


def heeding(tell: Callable[[Progress], None] | None = None) -> Callable[[Progress], None]:
    """Progress of an analysis, which ends it on request of the parent."""

    def heed(progress: Progress) -> None:
        if tell is not None:
            tell(progress)
        if stopped() or leaving():
            raise KeyboardInterrupt

    return heed


def start_process(function: Callable[..., None], *arguments: Any) -> SpawnProcess:
    """Start a process for a function of a module alone, which ends with this one."""
    process = SPAWN.Process(target=function, args=arguments, daemon=True)
    with bare_workers():
        process.start()
    return process


class _Noting(SpawnContext):
    """Starts processes, and keeps them in a list."""

    def __init__(self) -> None:
        super().__init__()
        self.started = list[BaseProcess]()

    def Process(self, *arguments: Any, **keys: Any) -> SpawnProcess:  # type: ignore[override]
        process = SPAWN.Process(*arguments, **keys)
        self.started.append(process)
        return process


class LocalProcesses:
    """A pool of local processes of one thread each; one that is killed is replaced."""

    def __init__(
        self, jobs: int | None = None, begin: Callable[..., None] = start_worker, shared: tuple[Any, ...] = ()
    ) -> None:
        self.slots = jobs or usable_cores()
        self._stop = new_event()
        self._begin, self._shared = begin, shared
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        self._context = _Noting()
        return ProcessPoolExecutor(self.slots, self._context, self._begin, (self._stop, *self._shared))

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have a function of a module computed."""
        with bare_workers():
            try:
                return self._pool.submit(function, *arguments)
            except BrokenProcessPool:
                self._renew()
                return self._pool.submit(function, *arguments)

    def lost(self, error: BaseException | None) -> bool:
        """Whether an error means that a process was killed; of a pool all work is lost."""
        return isinstance(error, BrokenProcessPool)

    def _renew(self) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._pool = self._new()

    @property
    def processes(self) -> list[BaseProcess]:
        """Those that run now."""
        return [one for one in self._context.started if one.is_alive()]

    def close(self, *, abandon: bool = False, stop: bool = False) -> None:
        """Wait for the processes to end.

        With `stop` they end what is on its way as soon as they can, and answer what is waiting without computing it;
        with `abandon` what is waiting is cancelled, too.
        """
        if abandon or stop:
            self._stop.set()
        try:
            self._pool.shutdown(wait=True, cancel_futures=abandon)
        except KeyboardInterrupt:  # once more, as it takes long
            self.kill()
            raise

    def kill(self) -> None:
        """End the processes at once, whatever they do."""
        processes = self.processes
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()


@dataclass(frozen=True, slots=True)
class Work:
    """What is asked of every drive: arguments of `analyse_all`."""

    analysis: Analysis
    options: Mapping[str, Any]
    overwrite: bool
    finish: Callable[[Run], None] | None


@dataclass(frozen=True, slots=True)
class Ending:
    """How the analysis of a drive ended."""

    status: str
    """"completed", "interrupted" by Ctrl-C, "failed", or "not started" before Ctrl-C."""
    error: str = ""
    """Why it failed; empty otherwise."""
    summary: Summary | None = None
    """Summary of a run; None without output, or for other analyses."""
    warnings: tuple[str, ...] = ()
    """The warnings."""
    kept: bool = False
    """Whether the file holds results."""


_parts: "Array[c_double]"


def begin_batch(stop: SharedEvent, parts: "Array[c_double]") -> None:
    """Prepare a process of a batch, which tells how far each analysis is by its place in an array."""
    global _parts
    start_worker(stop)
    _parts = parts


def analyse(place: int, file: Path, drive: Drive | Run, work: Work) -> Ending:
    """Analyze a drive into a file, and finish what is complete."""
    if stopped():
        return Ending("not started")
    wait_for_the_end()
    _parts[place] = 0.0

    def note(progress: Progress) -> None:
        _parts[place] = progress.time / progress.duration

    before = stamp(file)
    try:
        with working(), locked_output(file):
            result = work.analysis.write(drive, file, heeding(note), work.overwrite, **work.options)
            kept = stamp(file) != before or result.status == "completed"
            ending = _ended(result) if kept else Ending(result.status)
            if work.finish is not None and result.status == "completed":
                work.finish(result)
            return ending
    except Exception as error:
        told = cause_of(error, call_of(work.analysis, "drive", work.options))
        keeps = not isinstance(error, LostOutputError | ModelError) and stamp(file) not in (before, None)
        return _kept(file, told) if keeps else Ending("failed", told)


def call_of(analysis: Analysis, drive: str, options: Mapping[str, Any]) -> str:
    """The call of an analysis in Python, in one line."""
    return f"bd.{analysis.name}({', '.join([drive, *(f'{name}={value!r}' for name, value in options.items())])})"


def _kept(file: Path, error: str) -> Ending:
    """How a failed analysis ended, with its partial results."""
    try:
        found = open_result(file)
        with closing(found.dataset):
            return replace(_ended(found), error=error)
    except (BeltdynError, OSError):  # its file was taken away
        return Ending("failed", error)


def _ended(result: Result) -> Ending:
    summary = summarize(result) if isinstance(result, Run) else None
    return Ending(result.status, summary=summary, warnings=tuple(result.warnings), kept=True)


# Who computes the points of a study: this process, a pool of processes on this machine, or a Dask cluster

GONE = "the scheduler was lost or has abandoned this study. Start the study again to resume it."
_CONNECT = "30s"
_ASK = 1.0
"""Time between two questions for the number of workers, s."""


class Workers(Protocol):
    """Who computes."""

    @property
    def slots(self) -> int:
        """How many points are computed at a time, now."""

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have a function of a module computed."""

    def lost(self, error: BaseException) -> bool:
        """Whether an error means that a process was killed; what comes next is given to others."""

    def close(self, *, abandon: bool = False) -> None:
        """End; with `abandon` what is on its way is given up as soon as it can be."""


class ThisProcess:
    """One point after another, in this process, at once when it is submitted."""

    slots = 1

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Compute; see `Workers.submit`."""
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments))
        except Exception as error:
            future.set_exception(error)
        return future

    def lost(self, error: BaseException) -> bool:
        """Never; see `Workers.lost`."""
        return False

    def close(self, *, abandon: bool = False) -> None:
        """Do nothing; see `Workers.close`."""


class _StrandedError(Exception):
    """The only workers that may take a task are gone."""


class DaskWorkers:
    """Workers of an existing Dask cluster, each of which computes one point at a time."""

    def __init__(self, scheduler: str) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            raise ModelError(
                f"scheduler = {scheduler!r} needs dask.distributed, which is not installed. Install beltdyn with its "
                "extra beltdyn[cluster]."
            ) from error
        try:
            self._client = Client(scheduler, timeout=_CONNECT, set_as_default=False)
        except (OSError, ValueError) as error:
            told = str(error) or type(error).__name__
            raise ModelError(
                f"scheduler = {scheduler!r} does not answer ({told}). Start one with `dask scheduler`, or correct it."
            ) from error
        self._asked = -_ASK
        self._versions = dict[str, str]()
        """Address of a worker that is there -> its version of beltdyn."""
        self._bound: list[tuple[frozenset[str], Any, Future[Any]]] = []
        """Tasks that only some workers may take, by their addresses, and what becomes of them."""

    @property
    def slots(self) -> int:
        """How many workers of this version there are now; see `Workers.slots`."""
        if time.monotonic() - self._asked > _ASK:
            try:
                self._look()
            except OSError as error:
                raise SimulationError(GONE) from error
            self._asked = time.monotonic()
        return len(self._suited)

    @property
    def _suited(self) -> list[str]:
        own = version_of("beltdyn")
        return [address for address, version in self._versions.items() if version == own]

    def _look(self) -> None:
        """Look which workers there are, and which version of beltdyn new ones have."""
        there = list(self._client.nthreads())
        new = [one for one in there if one not in self._versions]
        answers = self._client.run(version_of, "beltdyn", workers=new, on_error="return") if new else {}
        known = self._versions | {one: answer for one, answer in answers.items() if isinstance(answer, str)}
        without = [one for one, answer in answers.items() if isinstance(answer, PackageNotFoundError)]
        self._versions = {one: version for one, version in (known | dict.fromkeys(without, "")).items() if one in there}
        if self._versions and not self._suited:
            others = ", ".join(sorted({version or "none" for version in self._versions.values()}))
            raise ModelError(
                f"no worker has beltdyn {version_of('beltdyn')}, with which the study was started; workers have "
                f"{others}. Install the same version everywhere."
            )
        for bound, task, future in self._bound:
            if not future.done() and bound.isdisjoint(there):  # nobody else would take it
                with suppress(InvalidStateError):
                    future.set_exception(_StrandedError())
                task.cancel()
        self._bound = [one for one in self._bound if not one[2].done()]

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have it computed by a worker of this version; see `Workers.submit`."""
        future: Future[Any] = Future()
        bound = frozenset(self._suited) if len(self._suited) < len(self._versions) else None
        task = self._client.submit(function, *arguments, pure=False, workers=None if bound is None else list(bound))
        if bound is not None:
            self._bound.append((bound, task, future))
        self._client.loop.add_callback(hand_on, task, future)
        return future

    def lost(self, error: BaseException) -> bool:
        """See `Workers.lost`; the scheduler gives work of a killed worker to others a few times itself."""
        from distributed import KilledWorker

        return isinstance(error, KilledWorker | _StrandedError)

    def close(self, *, abandon: bool = False) -> None:
        """Leave the cluster; see `Workers.close`."""
        self._client.close()


async def hand_on(task: Awaitable[Any], future: Future[Any]) -> None:
    """Give what becomes of a task of Dask to a future, whatever it is.

    Dask's own executor never tells of a task whose result was lost with its worker, and that has failed since then.
    """
    with suppress(InvalidStateError):  # of a stranded task
        try:
            future.set_result(await task)
        except (CancelledError, asyncio.CancelledError):
            if future.cancel():
                future.set_running_or_notify_cancel()
        except Exception as error:
            future.set_exception(error)


def workers_of(jobs: int | None, scheduler: str | None) -> Workers:
    """Who computes."""
    if scheduler is None:
        return ThisProcess() if jobs == 1 else LocalProcesses(jobs)
    if jobs is not None:
        raise ModelError(
            f"jobs = {jobs} applies to processes on this machine, but scheduler = {scheduler!r} uses a cluster. Omit "
            "one of them."
        )
    return DaskWorkers(scheduler)

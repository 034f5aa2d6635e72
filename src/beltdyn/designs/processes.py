"""Processes that compute beside this one: how they start, heed their parent, and end.

Batches, studies and the page share them. A process ends its work in order, with results closed, when its parent is
interrupted, tells it to end, or is gone.
"""

import multiprocessing
import os
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing.context import SpawnProcess
from multiprocessing.process import BaseProcess
from multiprocessing.synchronize import Event as SharedEvent
from threading import Event, Lock, Thread, current_thread, main_thread
from time import sleep
from types import FrameType, ModuleType
from typing import Any

from beltdyn.observation.compilation import usable_cores
from beltdyn.signals import ENDING
from beltdyn.solvers.progress import Progress

SPAWN = multiprocessing.get_context("spawn")
_THREADS = "OMP_NUM_THREADS"
"""What OpenBLAS and MKL ask for their number of threads."""


@contextmanager
def bare_workers() -> Iterator[None]:
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


_GRACE = 2.0  # s

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
        sleep(_GRACE)
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


class LocalProcesses:
    """A pool of local processes of one thread each; one that is killed is replaced."""

    def __init__(
        self, jobs: int | None = None, begin: Callable[..., None] = start_worker, shared: tuple[Any, ...] = ()
    ) -> None:
        self.slots = jobs or usable_cores()
        self._stop = SPAWN.Event()
        self._begin, self._shared = begin, shared
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self.slots, SPAWN, self._begin, (self._stop, *self._shared))

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
        return list((self._pool._processes or {}).values())

    def close(self, *, abandon: bool = False, stop: bool = False) -> None:
        """Wait for the processes to end.

        With `stop` they end what is on its way as soon as they can, and answer what is waiting without computing it;
        with `abandon` what is waiting is cancelled, too.
        """
        if abandon or stop:
            self._stop.set()
        self._pool.shutdown(wait=True, cancel_futures=abandon)

    def kill(self) -> None:
        """End the processes at once, whatever they do."""
        processes = self.processes
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()

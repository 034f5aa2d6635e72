"""Who computes the points of a study: this process, a pool of processes on this machine, or a Dask cluster.

All are used alike: `submit` gives a `concurrent.futures.Future`, `slots` tells how many points are computed at a time,
and `lost` whether an error means that a process was killed, so that others have to do its work.
"""

import asyncio
import time
from collections.abc import Awaitable, Callable
from concurrent.futures import CancelledError, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Protocol

from beltdyn.errors import ModelError, SimulationError
from beltdyn.solve.compilation import usable_cores
from beltdyn.solve.spawning import SPAWN, bare_workers
from beltdyn.solve.worker import start_worker

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


class LocalProcesses:
    """Processes of this machine, of which each uses one thread; one that is killed is replaced.

    Parameters
    ----------
    jobs
        How many; by default as many as there are cores.
    """

    def __init__(self, jobs: int | None = None) -> None:
        self.slots = jobs or usable_cores()
        self._stop = SPAWN.Event()
        self._pool = self._new()

    def _new(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self.slots, SPAWN, start_worker, (self._stop,))

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have it computed; see `Workers.submit`."""
        with bare_workers():
            try:
                return self._pool.submit(function, *arguments)
            except BrokenProcessPool:
                self._renew()
                return self._pool.submit(function, *arguments)

    def lost(self, error: BaseException) -> bool:
        """See `Workers.lost`; of a pool all work is lost."""
        return isinstance(error, BrokenProcessPool)

    def _renew(self) -> None:
        self._pool.shutdown(wait=True, cancel_futures=True)
        self._pool = self._new()

    def close(self, *, abandon: bool = False) -> None:
        """End the processes; see `Workers.close`."""
        if abandon:
            self._stop.set()
        self._pool.shutdown(wait=True, cancel_futures=abandon)


class DaskWorkers:
    """Workers of a Dask cluster that is there already, of which each computes a point at a time.

    Parameters
    ----------
    scheduler
        Address of its scheduler, such as "tcp://host:8786".

    Raises
    ------
    ModelError
        If `dask.distributed` is not installed, or there is no scheduler.
    """

    def __init__(self, scheduler: str) -> None:
        try:
            from distributed import Client
        except ImportError as error:
            raise ModelError(
                f"scheduler = {scheduler!r} needs dask.distributed, which is not installed. Install it: pip install "
                "'beltdyn[cluster]'."
            ) from error
        try:
            self._client = Client(scheduler, timeout=_CONNECT, set_as_default=False)
        except (OSError, ValueError) as error:
            told = str(error) or type(error).__name__
            raise ModelError(
                f"scheduler = {scheduler!r} does not answer ({told}). Start one with `dask scheduler`, or correct it."
            ) from error
        self._asked, self._known = -_ASK, 0

    @property
    def slots(self) -> int:
        """How many workers there are now; see `Workers.slots`."""
        if time.monotonic() - self._asked > _ASK:
            try:
                self._known, self._asked = len(self._client.nthreads()), time.monotonic()
            except OSError as error:
                raise SimulationError(GONE) from error
        return self._known

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Have it computed; see `Workers.submit`."""
        future: Future[Any] = Future()
        task = self._client.submit(function, *arguments, pure=False)
        self._client.loop.add_callback(hand_on, task, future)
        return future

    def lost(self, error: BaseException) -> bool:
        """See `Workers.lost`; the scheduler gives work of a killed worker to others a few times itself."""
        from distributed import KilledWorker

        return isinstance(error, KilledWorker)

    def close(self, *, abandon: bool = False) -> None:
        """Leave the cluster; see `Workers.close`."""
        self._client.close()


async def hand_on(task: Awaitable[Any], future: Future[Any]) -> None:
    """Give what becomes of a task of Dask to a future, whatever it is.

    Dask's own executor never tells of a task whose result was lost with its worker, and that has failed since then.

    Parameters
    ----------
    task
        The task.
    future
        What is told.
    """
    try:
        future.set_result(await task)
    except (CancelledError, asyncio.CancelledError):
        future.cancel()
        future.set_running_or_notify_cancel()
    except Exception as error:
        future.set_exception(error)


def workers_of(jobs: int | None, scheduler: str | None) -> Workers:
    """Who computes.

    Parameters
    ----------
    jobs
        Number of processes of this machine; with one, this process.
    scheduler
        Address of a Dask scheduler, in place of processes of this machine.

    Raises
    ------
    ModelError
        If both are given, or there is no such scheduler.
    """
    if scheduler is None:
        return ThisProcess() if jobs == 1 else LocalProcesses(jobs)
    if jobs is not None:
        raise ModelError(
            f"jobs = {jobs} is for processes on this machine, but scheduler = {scheduler!r} is is for others. Give "
            "one of them. Give one of them."
        )
    return DaskWorkers(scheduler)

"""What a process of a batch does with a drive, and who computes the points of a study."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping
from concurrent.futures import CancelledError, Future
from contextlib import closing
from dataclasses import dataclass, replace
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from beltdyn.analyses import Analysis
from beltdyn.designs.processes import LocalProcesses, heeding, start_worker, stopped, wait_for_the_end, working
from beltdyn.errors import BeltdynError, LostOutputError, ModelError, SimulationError
from beltdyn.model import Drive
from beltdyn.results import Result, Run, Summary, open_result, summarize
from beltdyn.results.atomic import locked_output, stamp
from beltdyn.solvers.progress import Progress

if TYPE_CHECKING:
    from ctypes import Array, c_double


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
            ending = _ended(result) if stamp(file) != before else Ending(result.status)
            if work.finish is not None and result.status == "completed":
                work.finish(result)
            return ending
    except LostOutputError as error:
        return Ending("failed", str(error))
    except SimulationError as error:
        left = stamp(file) not in (before, None)
        return _kept(file, str(error)) if left else Ending("failed", str(error))
    except BeltdynError as error:
        return Ending("failed", str(error))
    except Exception as error:
        return Ending("failed", f"{type(error).__name__}: {error}")


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
    """
    try:
        future.set_result(await task)
    except (CancelledError, asyncio.CancelledError):
        future.cancel()
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

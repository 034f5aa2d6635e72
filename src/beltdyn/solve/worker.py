"""The processes of a batch: each analyses one drive after another, until its parent says so or is gone."""

import multiprocessing
import os
import signal
import warnings
from collections.abc import Callable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from threading import Event, Lock, Thread
from time import sleep
from types import FrameType
from typing import TYPE_CHECKING, Any

from beltdyn.analyses import Analysis
from beltdyn.errors import BeltdynError, LostOutputError, SimulationError
from beltdyn.model import Drive
from beltdyn.results import Result, Run, Summary, open_result, summarize
from beltdyn.results.atomic import locked_output, stamp
from beltdyn.signals import ENDING
from beltdyn.solve.progress import Progress

if TYPE_CHECKING:
    from ctypes import Array, c_double

_GRACE = 2.0  # s


@dataclass(frozen=True, slots=True)
class Work:
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
        Summary of a run; None without output, or for other analyses.
    warnings : tuple of str
        The warnings.
    kept : bool
        Whether the file holds results.
    """

    status: str
    error: str = ""
    summary: Summary | None = None
    warnings: tuple[str, ...] = ()
    kept: bool = False


_stop: SharedEvent | None = None
_parts: "Array[c_double]"
_working = Lock()
_leaving = Event()


def start_worker(stop: SharedEvent, parts: "Array[c_double] | tuple[()]" = ()) -> None:
    """Keep what is shared with the parent.

    Parameters
    ----------
    stop
        Set when the parent is interrupted.
    parts
        The part of each simulation of a batch that is done, 0 to 1; NaN before it begins.
    """
    global _stop, _parts
    _stop = stop
    if parts:
        _parts = parts
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
    """What an analysis tells of its progress, which is ended when the parent says so.

    Parameters
    ----------
    tell
        Is told too.
    """

    def heed(progress: Progress) -> None:
        if tell is not None:
            tell(progress)
        if stopped() or leaving():
            raise KeyboardInterrupt

    return heed


def analyse(place: int, file: Path, drive: Drive | Run, work: Work) -> Ending:
    """Analyse a drive into a file, and finish what is complete.

    Parameters
    ----------
    place
        Of the drive in the batch, from zero.
    file
        The result file.
    drive
        The drive, or a run in place of it.
    work
        What is asked of it.

    Returns
    -------
    Ending
        How it ended; no error is raised.
    """
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
    """How an analysis ended that could not go on, with what it left."""
    try:
        found = open_result(file)
        with closing(found.dataset):
            return replace(_ended(found), error=error)
    except (BeltdynError, OSError):  # its file was taken away
        return Ending("failed", error)


def _ended(result: Result) -> Ending:
    summary = summarize(result) if isinstance(result, Run) else None
    return Ending(result.status, summary=summary, warnings=tuple(result.warnings), kept=True)

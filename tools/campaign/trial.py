"""One trial in a copy of this process, with limits of its time, and what came of it."""

import json
import math
import os
import resource
import signal
import time
import traceback
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import NoReturn

from beltdyn.errors import BeltdynError, InternalError

EXIT_CODES = frozenset({0, 2, 3, 4})
"""Those of the command line, in the end of an analysis and in refusals."""
_LONGEST_MESSAGE = 30_000
_WALL = 20.0
"""Time on the clock over the processor time that a trial may take: a machine has other work."""


@dataclass(frozen=True)
class Outcome:
    """What came of a trial."""

    kind: str
    """"fine", "refused", "traceback", "too long", "died" or, where the trial tells one, a fault of its own."""
    text: str
    seconds: float
    """Processor time, s."""


def attempt(work: Callable[[], str], seconds: float, wall: float = 0.0) -> Outcome:
    """Do something in a copy of this process, which is silent.

    Parameters
    ----------
    work
        What to do; it returns a fault in words, or nothing. An error that beltdyn raises on purpose is a refusal.
    seconds
        Processor time after which it is ended.
    wall
        Time on the clock after which it is; by default 20 times that.
    """
    reader, writer = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(reader)
        _work_and_leave(work, seconds, wall or _WALL * seconds, writer)
    os.close(writer)
    with os.fdopen(reader, encoding="utf-8", errors="replace") as answer:
        told = answer.read()
    _, status, usage = os.wait4(process, 0)
    used = usage.ru_utime + usage.ru_stime
    if told:
        kind, text = json.loads(told)
        return Outcome(kind, text, used)
    ended = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
    if ended in (signal.SIGXCPU, signal.SIGALRM, signal.SIGKILL):
        return Outcome("too long", f"ended after {used:.1f} s", used)
    return Outcome("died", f"by signal {ended}" if ended else "without an answer", used)


class _TooLong(BaseException):
    """The processor time of a trial in this process is over."""


def attempt_here(work: Callable[[], str], seconds: float) -> Outcome:
    """Do something in this process, with what it has loaded; parameters as for `attempt`.

    A trial that ends the process ends all, and compiled code is not ended before it returns.
    """

    def end(*_: object) -> NoReturn:
        raise _TooLong

    used, before = time.process_time(), signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            kind, text = outcome(work)
    except _TooLong:
        kind, text = "too long", f"ended after {seconds:g} s"
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
    return Outcome(kind, text, time.process_time() - used)


def _work_and_leave(work: Callable[[], str], seconds: float, wall: float, writer: int) -> None:
    """Work in the copy of this process, tell what came of it, and end."""
    try:
        used = time.process_time()
        limit = math.ceil(used + seconds)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 1))
        signal.signal(signal.SIGXCPU, signal.SIG_DFL)
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, wall)
        nowhere = os.open(os.devnull, os.O_RDWR)
        for stream in range(3):
            os.dup2(nowhere, stream)
        os.write(writer, json.dumps(outcome(work)).encode())
    finally:
        os._exit(0)


def outcome(work: Callable[[], str]) -> tuple[str, str]:
    """Kind and text of what comes of some work."""
    try:
        fault = work()
    except InternalError as error:
        return "traceback", str(error)[:200]
    except BeltdynError as error:
        length = len(str(error))
        return ("refused", str(error)[:200]) if 0 < length < _LONGEST_MESSAGE else ("fault", f"a message of {length}")
    except SystemExit as end:
        return ("refused" if end.code else "fine", "") if end.code in EXIT_CODES else ("fault", f"exit code {end.code}")
    except (_TooLong, KeyboardInterrupt):
        raise
    except BaseException as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        return "traceback", f"{type(error).__name__}: {str(error)[:150]} ({Path(place.filename).name}:{place.lineno})"
    return ("fault", fault) if fault else ("fine", "")

"""Computation of the numbers beside the canvas in a separate process: rest, steady running and modes."""

import asyncio
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from multiprocessing.context import SpawnProcess
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from typing import NamedTuple

from beltdyn.app.findings import Findings, at_rest, in_running, of_modes
from beltdyn.designs.processes import SPAWN, LocalProcesses, new_event, start_process, start_worker
from beltdyn.errors import BeltdynError, TimeLimitError
from beltdyn.kernel import observe_compilation
from beltdyn.model import Drive, loads
from beltdyn.results import Run
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Facts, Table
from beltdyn.solvers.time_limit import time_limit

# Tell the page when Numba compiles kernels

Counted = tuple[int, int]
"""Kernels compiled, and kernels needed; equal where none is being compiled."""


COMPILING = "compiling kernels, once on this machine"


def in_words(counted: Counted) -> str:
    """The state shown meanwhile."""
    done, total = counted
    return f"{COMPILING}: {done} of {total}"


def tell_of_compilation(tell: Callable[[Counted], None]) -> None:
    """Report from now on how many kernels this process has compiled, and that it has ended to do so."""
    import beltdyn.kernel.compiler  # noqa: F401 (it listens to Numba)

    last: Counted = (0, 0)

    def report(done: int, total: int) -> None:
        nonlocal last
        if (done, total) != last and (done < total or last[0] < last[1]):
            tell((done, total))
        last = done, total

    observe_compilation(report)


class Counter:
    """Counts of kernels that a process tells of, as others read them."""

    def __init__(self) -> None:
        self._counts = SPAWN.Array("i", 2)

    def tell(self, counted: Counted) -> None:
        """Set them."""
        self._counts[:] = list(counted)

    @property
    def counted(self) -> Counted:
        """The present ones."""
        done, total = self._counts[:]
        return done, total

    def clear(self) -> None:
        """Tell that nothing is being compiled."""
        self.tell((0, 0))


_MODE_COUNT = 6
"""Number of the lowest modes that are computed of a draft: as many as the page draws at most."""
_MAX_TABS = 8
"""Number of tabs whose last steady running is kept: those longest unused are dropped, to limit memory."""


class Asked(NamedTuple):
    """The request of a tab."""

    what: str
    """"rest", "running" or "modes"."""
    tab: str
    """Which tab."""
    text: str
    """The drive file."""
    folder: Path
    """Where its relative paths start."""
    speed: float = 1.0
    """Factor on the speed of the driving pulley."""
    load: float = 1.0
    """Factor on all torques and loads."""


class Answer(NamedTuple):
    """Numbers of a drive."""

    parts: tuple[Table | Facts, ...]
    """What is shown."""
    warnings: tuple[str, ...]
    """What to know."""
    error: str
    """Why there are no numbers; empty otherwise."""
    seconds: float
    """How long it took."""
    findings: Findings = Findings()
    """What is shown as figures and charts."""


class _Known(NamedTuple):
    """Steady running that the next search begins from."""

    text: str
    held: Drive
    run: Run | None


_known: dict[str, _Known] = {}


_compiles: Counter | None = None
"""The kernels that this process compiles."""


def begin(stop: SharedEvent, compiles: Counter) -> None:
    """Prepare a computing process, which counts the kernels that it compiles."""
    global _compiles
    start_worker(stop)
    _compiles = compiles
    tell_of_compilation(compiles.tell)


def compile_ahead(asked: Asked, stop: SharedEvent, compiles: Counter) -> None:
    """Load or compile the kernels of steady running and modes in advance."""
    begin(stop, compiles)
    for what in ("running", "modes"):
        answer(asked._replace(what=what))


def answer(asked: Asked) -> Answer:
    """Compute the numbers of a tab; errors are returned as answers.

    Where the search for equilibrium takes too long, the answer is the drive at rest by closed forms.
    """
    begun = time.perf_counter()
    try:
        with time_limit(_LONGEST_SEARCH):
            parts, told, found = {"rest": _rest, "running": _running, "modes": _modes}[asked.what](asked)
        return Answer(parts, told, "", time.perf_counter() - begun, found)
    except TimeLimitError as error:
        return _by_closed_forms(asked, error, begun)
    except BeltdynError as error:
        return Answer((), (), str(error), time.perf_counter() - begun)
    finally:
        if _compiles is not None:
            _compiles.clear()


_LONGEST_SEARCH = 10.0
"""Processor time of a search for equilibrium, s, beyond which somebody who edits a drive does not wait."""


def _by_closed_forms(asked: Asked, error: TimeLimitError, begun: float) -> Answer:
    """The drive at rest by closed forms, with the reason."""
    from beltdyn.show.rest_sheet import check

    checked = check(loads(asked.text, asked.folder), equilibrium=False)
    told = f"no equilibrium is known: {error} These numbers are closed forms of the drive at rest."
    found = at_rest(checked.drive, checked.installation)
    return Answer(checked.sheet.parts, (told, *checked.warnings), "", time.perf_counter() - begun, found)


Shown = tuple[tuple[Table | Facts, ...], tuple[str, ...], Findings]


def _rest(asked: Asked) -> Shown:
    """The drive at rest, as `beltdyn check` finds it."""
    from beltdyn.show.rest_sheet import check

    checked = check(loads(asked.text, asked.folder))
    if checked.failure:
        raise checked.failure
    return checked.sheet.parts, tuple(checked.warnings), at_rest(checked.drive, checked.installation)


def _running(asked: Asked) -> Shown:
    run = _steady(asked)
    return sheet(run).parts, tuple(run.warnings), in_running(run)


def _modes(asked: Asked) -> Shown:
    from beltdyn.vibration.modes import modes

    found = modes(_steady(asked).drive, about=_steady(asked), count=_MODE_COUNT)
    return sheet(found).parts, tuple(found.warnings), of_modes(found)


def _steady(asked: Asked) -> Run:
    """Steady running under a speed and loads: from that before where there is one, which is quick."""
    from beltdyn.points.changed_drive import at_speed, driver_of, held_at, with_load
    from beltdyn.state.steady import steady_state

    known = _known.get(asked.tab)
    if known is None or known.text != asked.text:
        held = held_at(loads(asked.text, asked.folder), None)
        known = _Known(asked.text, held, None if known is None else known.run)
    drive = with_load(known.held, asked.load)
    if asked.speed != 1.0:
        number = driver_of(drive)
        drive = at_speed(drive, number, asked.speed * given_speed(drive, number))
    try:
        run = steady_state(drive, start=known.run)
    except BeltdynError:
        if known.run is None:
            raise
        run = steady_state(drive)
    _known.pop(asked.tab, None)
    _known[asked.tab] = known._replace(run=run)
    while len(_known) > _MAX_TABS:
        _known.pop(next(iter(_known)))
    return run


def given_speed(drive: Drive, number: int) -> float:
    """Driven speed of a pulley at the end of the simulation, prescribed or by a motor, rad/s."""
    pulley = drive.pulleys[number]
    if pulley.speed is not None:
        return float(pulley.speed.at([drive.simulation.end])[0])
    return pulley.driven_speed()


# The process that computes numbers for the tabs, so that the page does not block


class Calculator:
    """A process that answers requests one after another, started with the first."""

    def __init__(self) -> None:
        self._stop = new_event()
        self._compiles, self._compiles_ahead = Counter(), Counter()
        self._pool: LocalProcesses | None = None
        self._ahead: SpawnProcess | None = None
        self._starting = threading.Lock()

    @property
    def compiling(self) -> Counted | None:
        """Kernels compiled and needed while some are being compiled; None otherwise."""
        counted = [one.counted for one in (self._compiles, self._compiles_ahead)]
        going = [one for one in counted if one[0] < one[1]]
        return (sum(done for done, _ in going), sum(total for _, total in going)) if going else None

    def look_ahead(self, asked: Asked) -> None:
        """Load or compile kernels in advance.

        What a drive at rest needs is loaded by the process that answers; running and modes are left to one of their
        own, which begins when the drive is at rest.
        """
        pool = self._started()

        def go_on(found: Future[Answer]) -> None:
            with self._starting:
                if self._pool is pool and not found.cancelled() and found.exception() is None:
                    self._ahead = start_process(compile_ahead, asked, self._stop, self._compiles_ahead)

        pool.submit(answer, asked).add_done_callback(go_on)

    def _started(self) -> LocalProcesses:
        if self._pool is None:
            self._pool = LocalProcesses(1, begin, (self._compiles,))
        return self._pool

    async def ask(self, asked: Asked) -> Answer:
        """Compute the numbers of a tab."""
        pool = self._started()
        try:
            return await asyncio.wrap_future(pool.submit(answer, asked))
        except Exception as error:
            if not pool.lost(error):
                raise
            self.close()
            return Answer((), (), "the computing process ended unexpectedly. Any change of the drive restarts it.", 0.0)

    def close(self) -> None:
        """End the processes at once, before resources shared with them are released."""
        with self._starting:
            pool, self._pool = self._pool, None
            ahead, self._ahead = self._ahead, None
        if ahead is not None:
            ahead.kill()
            ahead.join()
        if pool is not None:
            pool.kill()
        self._compiles.clear()
        self._compiles_ahead.clear()

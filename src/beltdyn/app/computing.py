"""Computation of the numbers below the canvas in a separate process: rest, steady running and modes."""

import multiprocessing
import os
import signal
import threading
import time
import warnings
from multiprocessing.synchronize import Event as SharedEvent
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from beltdyn.app.preparing import tell_of_compilation
from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, advise, install, loads, unstable_balance
from beltdyn.results import Run
from beltdyn.results.rest_sheet import rest_sheet
from beltdyn.results.sheet import sheet
from beltdyn.results.sheet_parts import Facts, Table

if TYPE_CHECKING:
    from beltdyn.solve.progress import Progress

_MODES = 6
_MOST_TABS = 8
"""Number of tabs with a cached steady running."""


class Asked(NamedTuple):
    """The request of a tab.

    Attributes
    ----------
    what : str
        "rest", "running" or "modes".
    tab : str
        Which tab.
    text : str
        The drive file.
    folder : Path
        Where its relative paths start.
    speed, load : float
        Factors on the speed of the pulley that drives, and on all torques and loads.
    """

    what: str
    tab: str
    text: str
    folder: Path
    speed: float = 1.0
    load: float = 1.0


class Answer(NamedTuple):
    """Numbers of a drive.

    Attributes
    ----------
    parts : tuple of Table or Facts
        What is shown.
    warnings : tuple of str
        What to know.
    error : str
        Why there are no numbers; empty otherwise.
    seconds : float
        How long it took.
    """

    parts: tuple[Table | Facts, ...]
    warnings: tuple[str, ...]
    error: str
    seconds: float


class _Known(NamedTuple):
    """Steady running that the next search begins from."""

    text: str
    held: Drive
    run: Run | None


_known: dict[str, _Known] = {}


_compiles: SharedEvent | None = None
"""An event, set while this process compiles kernels."""


def prepare() -> None:
    """Initialise the process: the server handles Ctrl-C, and the process ends with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore")
    threading.Thread(target=_follow_parent, daemon=True).start()


def begin(compiles: SharedEvent) -> None:
    """Initialise the computing process.

    Parameters
    ----------
    compiles : multiprocessing Event
        Is set while it compiles kernels.
    """
    global _compiles
    prepare()
    _compiles = compiles
    _tell_by(compiles)


def _tell_by(flag: SharedEvent) -> None:
    tell_of_compilation(lambda compiles: flag.set() if compiles else flag.clear())


def compile_ahead(asked: Asked, compiles: SharedEvent) -> None:
    """Load or compile the kernels of steady running and modes in advance.

    Parameters
    ----------
    asked : Asked
        A question about a drive at rest.
    compiles : multiprocessing Event
        Is set while kernels are compiled.
    """
    prepare()
    _tell_by(compiles)
    for what in ("running", "modes"):
        answer(asked._replace(what=what))


def _follow_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def answer(asked: Asked) -> Answer:
    """Compute the numbers of a tab; errors are returned as answers."""
    begun = time.perf_counter()
    try:
        parts, told = {"rest": _rest, "running": _running, "modes": _modes}[asked.what](asked)
        return Answer(parts, told, "", time.perf_counter() - begun)
    except BeltdynError as error:
        return Answer((), (), str(error), time.perf_counter() - begun)
    finally:
        if _compiles is not None:
            _compiles.clear()


Shown = tuple[tuple[Table | Facts, ...], tuple[str, ...]]


def _rest(asked: Asked) -> Shown:
    """The drive at rest, as `beltdyn check` finds it."""
    from beltdyn.solve import bring_to_rest

    given = loads(asked.text, asked.folder)
    rest = bring_to_rest(given, _hear)
    unstable = [str(unstable_balance(rest.unstable))] if rest.unstable else []
    told = (*unstable, *advise(given, install(given)))
    return rest_sheet(given, rest.drive, rest.installation).parts, told


def _hear(progress: "Progress") -> None:
    """Tell of compilation in processes that the search for equilibrium starts, too."""
    if _compiles is not None:
        (_compiles.set if progress.phase == "compiling" else _compiles.clear)()


def _running(asked: Asked) -> Shown:
    run = _steady(asked)
    return sheet(run).parts, tuple(run.warnings)


def _modes(asked: Asked) -> Shown:
    from beltdyn.solve import modes

    found = modes(_steady(asked).drive, about=_steady(asked), count=_MODES)
    return sheet(found).parts, tuple(found.warnings)


def _steady(asked: Asked) -> Run:
    """Steady running under a speed and loads: from that before where there is one, which is quick."""
    from beltdyn.solve import steady_state
    from beltdyn.solve.steady_running.changed_drive import at_speed, driver_of, held_at, with_load

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
    while len(_known) > _MOST_TABS:
        _known.pop(next(iter(_known)))
    return run


def given_speed(drive: Drive, number: int) -> float:
    """Driven speed of a pulley at the end of the simulation, prescribed or by a motor, rad/s."""
    pulley = drive.pulleys[number]
    if pulley.speed is not None:
        return float(pulley.speed.at([drive.simulation.end])[0])
    return pulley.driven_speed()

"""How much of the page is done, from the processor times that runs are expected to take."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from time import perf_counter

import numpy as np

from beltdyn.model import Drive
from beltdyn.observation.compilation import usable_cores
from beltdyn.solvers.run_progress import BatchProgress

_OF_A_RUN, _OF_AN_ELEMENT, _AT_NODES = 0.7, 0.009, 1.6
"""Processor time of a run of the page, of an element over a simulated second, and of contact at nodes, s.

Fitted to all runs of the page. Nodes that enter and leave contact set the steps: there the mesh hardly matters.
"""
_TIMED_PART = 0.25
"""Part of the whole time that timed runs take on two cores, until they are known."""

Tell = Callable[[BatchProgress], None]


def expected_time(drive: Drive) -> float:
    """Processor time that a run is expected to take, s."""
    at_nodes = _AT_NODES if drive.contact.sampling == "nodal" else 0.0
    return _OF_A_RUN + at_nodes + _OF_AN_ELEMENT * drive.elements * drive.simulation.duration


class Forecast:
    """Adds the share of the whole page to the progress of its runs, and then of those that are timed.

    Parameters
    ----------
    drives : mapping
        Name -> drive of each run.
    report : callable or None
        Told of all progress.
    """

    def __init__(self, drives: Mapping[str, Drive], report: Tell | None) -> None:
        self._report = report
        self._times = {name: expected_time(drive) for name, drive in drives.items()}
        self._begun, self._start = set[str](), perf_counter()

    def runs(self, progress: BatchProgress) -> None:
        """Tell of the runs side by side."""
        self._tell(progress, (1.0 - _TIMED_PART) * _done(self._times, self._begun, progress.done, progress.running))

    def timed(self, times: Mapping[str, float], repeats: int) -> Tell:
        """What tells of runs in turns that take these processor times, s, by name."""
        before, turn = perf_counter() - self._start, sum(times.values()) / usable_cores()
        whole = before + repeats * turn
        begun = [set[str]() for _ in range(repeats + 1)]

        def tell(progress: BatchProgress) -> None:
            turns, ended = divmod(progress.done, max(len(times), 1))
            part = turns + _done(times, begun[turns], ended, progress.running)
            self._tell(progress, min((before + part * turn) / whole, 1.0))

        return tell

    def _tell(self, progress: BatchProgress, share: float) -> None:
        if self._report is not None:
            self._report(replace(progress, share=share))


def _done(times: Mapping[str, float], begun: set[str], ended: int, running: Mapping[Path, float]) -> float:
    """Part of the work of runs that is done, 0 to 1, from the names of those that have begun, which are added to."""
    parts = {file.stem: share for file, share in running.items()}
    begun |= parts.keys()
    known = [times[name] for name in begun - parts.keys()]
    waiting = [time for name, time in times.items() if name not in begun]
    unseen = max(ended - len(known), 0) * float(np.mean(waiting or [0.0]))  # shorter than a look at them
    done = sum(known) + unseen + sum(share * times[name] for name, share in parts.items())
    return min(done / max(sum(times.values()), 1e-9), 1.0)

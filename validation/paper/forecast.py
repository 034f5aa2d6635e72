"""How much of the page is done, from the processor times that runs are expected to take."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from beltdyn.model import Drive
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
        running = {file.stem: share for file, share in progress.running.items()}
        self._begun |= running.keys()
        ended = [self._times[name] for name in self._begun - running.keys()]
        waiting = [time for name, time in self._times.items() if name not in self._begun]
        unseen = max(progress.done - len(ended), 0) * float(np.mean(waiting or [0.0]))  # shorter than a look at them
        done = sum(ended) + unseen + sum(share * self._times[name] for name, share in running.items())
        self._tell(progress, (1.0 - _TIMED_PART) * min(done / max(sum(self._times.values()), 1e-9), 1.0))

    def timed(self, times: Sequence[float], repeats: int) -> Tell:
        """What tells of runs in turns, one at a time, that take these processor times, s."""
        before, turn = perf_counter() - self._start, sum(times)
        whole = before + repeats * turn

        def tell(progress: BatchProgress) -> None:
            turns, number = divmod(progress.done, max(len(times), 1))
            self._tell(progress, min((before + turns * turn + sum(times[:number])) / whole, 1.0))

        return tell

    def _tell(self, progress: BatchProgress, share: float) -> None:
        if self._report is not None:
            self._report(replace(progress, share=share))

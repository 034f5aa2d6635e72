"""Points of a study go to those who compute them, in chunks that take about a second, and come back in any order.

A few chunks are on their way for each process, so that none waits and neither memory nor a scheduler holds more of a
large study.  When a process is killed, as for want of memory, the points that were on their way are computed again,
each by itself; one that kills its process again is tried alone, and then has failed.
"""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, wait
from contextlib import suppress
from math import ceil
from typing import Any

from beltdyn.errors import SimulationError
from beltdyn.signals import uninterrupted
from beltdyn.solve.studies.executors import GONE, ThisProcess, Workers
from beltdyn.solve.studies.point_work import ChunkOutcome, Outcome, PointWork, compute_points

_CHUNK = 1.0
"""Computing time of a chunk that is aimed at, s."""
_LARGEST = 1000
"""Points in a chunk."""
_AHEAD = 2
"""Chunks on their way for each process."""
_SHARES = 4
"""Chunks for each process among which the last points are shared out at least."""
_LATEST = 0.5
"""Weight of the latest chunk in the mean time of a point."""
_ATTEMPTS = 3
"""How often a process may be killed while it computes a point."""
_POLL = 0.5

Chunk = tuple[int, ...]


class Dispatch:
    """Sends points out, and takes what comes back.

    Parameters
    ----------
    workers
        Who computes.
    work
        What is asked of every point.
    changes
        Gives what differs from the drive at a point.
    take
        Is given every outcome once, with units of results.
    tell
        Is called now and then.
    """

    def __init__(
        self,
        workers: Workers,
        work: PointWork,
        changes: Callable[[int], Mapping[str, Any]],
        take: Callable[[list[Outcome], Mapping[str, str]], None],
        tell: Callable[[], None],
    ) -> None:
        self._workers, self._work, self._changes, self._take, self._tell = workers, work, changes, take, tell
        self._waiting: deque[int] = deque()
        self._again: deque[int] = deque()
        self._attempts: dict[int, int] = {}
        self._flying: dict[Future[ChunkOutcome], Chunk] = {}
        self._seconds = 0.0

    def run(self, points: Iterable[int]) -> None:
        """Have points computed.

        Parameters
        ----------
        points
            Their numbers.

        Raises
        ------
        SimulationError
            If those who compute are gone; what came back until then was taken.
        """
        self._waiting.extend(points)
        try:
            while self._waiting or self._again or self._flying:
                self._fill()
                for future in wait(self._flying, timeout=_POLL, return_when=FIRST_COMPLETED).done:
                    with uninterrupted():
                        self._land(future)
                self._tell()
        except BaseException:
            self._workers.close(abandon=True)
            self._take_what_came()
            raise
        self._workers.close()

    def _fill(self) -> None:
        """Send chunks out, as many as may be on their way."""
        while len(self._flying) < _AHEAD * self._workers.slots and (chunk := self._next()):
            future = self._workers.submit(compute_points, self._work, [(one, self._changes(one)) for one in chunk])
            self._flying[future] = chunk
            if isinstance(self._workers, ThisProcess):
                return

    def _next(self) -> Chunk:
        """The next points to send together; none where others have to come back first."""
        if self._again:
            alone = self._attempts[self._again[0]] > 1
            return () if alone and self._flying else (self._again.popleft(),)
        if any(self._attempts.get(chunk[0], 0) > 1 for chunk in self._flying.values()):
            return ()
        fair = ceil(len(self._waiting) / (_SHARES * max(self._workers.slots, 1)))
        wanted = int(_CHUNK / self._seconds) if self._seconds > 0.0 else 1
        size = min(max(min(wanted, fair, _LARGEST), 1), len(self._waiting))
        return tuple(self._waiting.popleft() for _ in range(size))

    def _land(self, future: Future[ChunkOutcome]) -> None:
        """Take what a chunk has become."""
        chunk = self._flying.pop(future)
        if future.cancelled():
            raise SimulationError(GONE)
        error = future.exception()
        if error is not None and self._workers.lost(error):
            self._lose(chunk)
        elif error is not None:
            raise error
        else:
            found = future.result()
            self._take_outcomes(found)
            if found.interrupted and isinstance(self._workers, ThisProcess):
                raise KeyboardInterrupt
            done = {one.point for one in found.outcomes}
            self._waiting.extendleft(point for point in reversed(chunk) if point not in done)

    def _take_outcomes(self, found: ChunkOutcome) -> None:
        if found.outcomes:
            latest = sum(one.seconds for one in found.outcomes) / len(found.outcomes)
            self._seconds += (_LATEST if self._seconds > 0.0 else 1.0) * (latest - self._seconds)
            self._take(found.outcomes, found.units)

    def _lose(self, chunk: Chunk) -> None:
        """Have points computed again whose process was killed; one of which that happens too often has failed."""
        for point in chunk:
            self._attempts[point] = attempts = self._attempts.get(point, 0) + 1
            if attempts < _ATTEMPTS:
                self._again.append(point)
            else:
                failure = (
                    f"its process was killed {attempts} times, possibly because memory ran out. Run fewer at once."
                )
                self._take([Outcome(point, {}, failure, "", 0.0)], {})

    def _take_what_came(self) -> None:
        """Take what came back before the end."""
        for future in list(self._flying):
            with suppress(BaseException):
                if future.done() and not future.cancelled():
                    self._take_outcomes(future.result())

"""Designs of a study: drives that differ in some numbers, in steady running at all operating points."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.model.study import FreeNumber, Points
from beltdyn.parts.change import converted, unit_at, value_at
from beltdyn.solve.rest.staying import Standing, bring_to_stand
from beltdyn.solve.steady import steady_state
from beltdyn.solve.studies.found_state import FoundState, Resting, Running
from beltdyn.solve.studies.small_changes import CHANGE, SmallChanges
from beltdyn.solve.studies.study_points import OperatingPoint, held
from beltdyn.solve.studies.watched import Watched

_DIGITS = 6
"""Of numbers, over the distance of their bounds."""


@dataclass(frozen=True)
class Free:
    """A number that may change, in SI units."""

    path: str
    unit: str
    least: float
    largest: float
    start: float

    def at(self, part: float) -> float:
        """Its value at a part of the way from the least to the largest, rounded to what a drawing would say."""
        step = 10.0 ** np.floor(np.log10(self.largest - self.least) - _DIGITS)
        value = step * round((self.least + part * (self.largest - self.least)) / step)
        return float(min(max(float(f"{value:.12g}"), self.least), self.largest))


def free_number(drive: Drive, given: FreeNumber) -> Free:
    """A number of a study in SI units.

    Parameters
    ----------
    drive
        The drive, which has its start.
    given
        As the study gives it.

    Raises
    ------
    ModelError
        If the path leads to no number, or the bounds are none or do not hold the start between them.
    """
    path, start = given.path, value_at(drive, given.path)
    if isinstance(start, bool) or not isinstance(start, float):
        told = "is not given in the drive file" if start is None else f"= {start!r} is no number that changes gradually"
        raise ModelError(f"number {path} {told}. Give a number there, at which the study starts.")
    least, largest = (float(converted(drive, path, bound)) for bound in (given.least, given.largest))
    if not least < largest:
        raise ModelError(f"number {path}: least = {least:g} is not below largest = {largest:g}. Change one.")
    if not least <= start <= largest:
        raise ModelError(
            f"number {path}: the drive file has {start:g}, which is not between least = {least:g} and largest = "
            f"{largest:g}. Widen them, or change the drive file."
        )
    return Free(path, unit_at(drive, path), least, largest, start)


@dataclass(frozen=True)
class Design:
    """A drive with some numbers changed, and its results; of one that cannot run, why."""

    changes: Mapping[str, float]
    """Path -> number."""
    failure: str
    """Why there are no results; empty where there are."""
    values: FloatArray
    """Watched results, shape (points, results); NaN where one does not count."""
    given: Drive | None = None
    """With constant speeds and torques."""
    rest: Standing | None = None
    states: tuple[FoundState, ...] = ()


class Designs:
    """Finds watched results of designs, and their derivatives.

    Parameters
    ----------
    drive
        The drive at the start.
    numbers
        Those that may change.
    points
        The operating points.
    instant
        What the study says of them.
    watched
        Results.
    force_tolerance
        As for `steady_state`.
    tell
        Called with the part of a design that is done, 0 to 1.
    at_rest
        Whether results are those of the belt at rest, in place of steady running.
    """

    def __init__(
        self,
        drive: Drive,
        numbers: Sequence[Free],
        points: Sequence[OperatingPoint],
        instant: Points,
        watched: Sequence[Watched],
        force_tolerance: float | None,
        tell: Callable[[float], None],
        *,
        at_rest: bool = False,
    ) -> None:
        self._drive, self.numbers, self._points, self._instant = drive, numbers, points, instant
        self.watched, self._tolerance, self._tell = watched, force_tolerance, tell
        self._at_rest = at_rest
        self.failed: list[str] = []
        """Derivatives that were not found, and why."""

    def find(self, changes: Mapping[str, float], near: Design | None = None) -> Design:
        """Find a design in steady running at all operating points.

        Parameters
        ----------
        changes
            Path -> number.
        near
            A design from whose states the search begins; by default each operating point begins at that before it.
        """
        states: list[FoundState] = []
        where = ""
        try:
            given = held(self._drive.with_(changes), self._instant)
            rest = bring_to_stand(given)
            for number, point in enumerate(self._points):
                where = f"at {point.label}: " if len(self._points) > 1 else ""
                states.append(self._state(point, rest, near.states[number] if near and near.states else None, states))
                self._tell((number + 1) / len(self._points))
            values = np.array([self._read(one, number) for number, one in enumerate(states)])
        except (ConvergenceError, ModelError) as error:
            return Design(changes, f"{where}{error}", np.full((len(self._points), len(self.watched)), np.nan))
        return Design(changes, "", values, given, rest, tuple(states))

    def _state(
        self, point: OperatingPoint, rest: Standing, near: FoundState | None, before: Sequence[FoundState]
    ) -> FoundState:
        """The state of a drive at an operating point, found from one nearby or from that before it."""
        if self._at_rest:
            return Resting(rest)
        start = near or (before[-1] if before else None)
        run = start.run if isinstance(start, Running) else None
        return Running(steady_state(point.of(rest.drive), force_tolerance=self._tolerance, start=run))

    def derivatives(self, design: Design) -> FloatArray:
        """Derivatives of watched results by the numbers of a design, shape (points, results, numbers).

        Each number is changed a little up and down, and Newton's method follows from the steady states at hand, as for
        `sensitivity`.  A derivative that is not found counts as zero, and is noted.
        """
        assert design.given is not None
        assert design.rest is not None
        small = SmallChanges(design.given, design.rest)
        found = np.zeros((*design.values.shape, len(self.numbers)))
        for column, free in enumerate(self.numbers):
            value, step = design.changes[free.path], CHANGE * (free.largest - free.least)
            try:
                sides = [small.drive(free.path, value + sense * step) for sense in (1.0, -1.0)]
                for number, (point, one) in enumerate(zip(self._points, design.states, strict=True)):
                    up, down = (self._read(one.neighbour(point.of(side)), number) for side in sides)
                    found[number, :, column] = (up - down) / (2.0 * step)
            except (ConvergenceError, ModelError) as error:
                self.failed.append(f"no derivative with respect to {free.path}: {error}")
        return np.nan_to_num(found)

    def _read(self, state: FoundState, point: int) -> FloatArray:
        """The watched results at an operating point."""
        return np.array([one.read(state) if one.at[point] else np.nan for one in self.watched])

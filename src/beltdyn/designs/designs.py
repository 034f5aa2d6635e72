"""Designs of a study: drives that differ in some numbers, in steady running at all operating points."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.designs.batch import OperatingPoint, Watched, held
from beltdyn.designs.found_state import CHANGE, AtRest, FoundState, Resting, Running, bring_at_rest, rest_near
from beltdyn.designs.named_results import need_bands
from beltdyn.errors import ConvergenceError, ModelError, cause_of
from beltdyn.model import Drive, prepare
from beltdyn.model.parameter_study import FreeNumber, Points
from beltdyn.parts.change import converted, number_path, require_distinct, unit_at, value_at
from beltdyn.solvers.continuation import Solution, follow
from beltdyn.state.staying import bring_to_stand
from beltdyn.state.steady import Beside, steady_beside, steady_from

# Drives with one number changed a little, which keep the installed tension that was asked for


class SmallChanges:
    """Makes neighbors of a drive; with an installed tension the belt's length, or the take-up, follows."""

    def __init__(self, given: Drive, rest: AtRest) -> None:
        self._given, self._rest = given, rest
        self._tightening = np.inf
        self._nominal = prepare(given).installed_tension
        if self._nominal is not None:
            change = CHANGE * rest.prepared.belt_length
            shorter, longer = (self._tension(self._shortened(rest.drive, sense * change)) for sense in (1.0, -1.0))
            self._tightening = (shorter - longer) / (2.0 * change)

    def drive(self, path: str, value: float) -> Drive:
        """The drive with another value of a number."""
        wanted, drive = self._rest.tension, self._rest.drive
        if path == "belt.installed_tension":
            wanted *= value / float(self._given.belt.installed_tension or value)
        else:
            drive = drive.with_({path: value})
            if self._nominal is not None and self._given.belt.installed_tension is None:
                wanted *= (prepare(self._given.with_({path: value})).installed_tension or wanted) / self._nominal
        if np.isfinite(self._tightening):
            drive = self._shortened(drive, (wanted - self._tension(drive)) / self._tightening)
        return drive

    def _shortened(self, drive: Drive, distance: float) -> Drive:
        """A drive with a shorter belt or, where its length is given, with more take-up, m; see `Prepared.tightened`."""
        prepared = prepare(drive)
        if self._given.belt.length is None:
            return drive.with_({"belt.length": prepared.belt_length - distance})
        return drive.replace(tensioner=prepared.taken_up(distance))

    def _tension(self, drive: Drive) -> float:
        """At rest, on the same mesh."""
        return rest_near(prepare(drive), self._rest).tension


_DIGITS = 6
"""Of numbers, over the distance of their bounds."""
_BEHIND = 1e-2
"""Share of the way to another design over which the tangent extrapolates solutions backwards."""


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


def free_numbers(drive: Drive, given: Sequence[FreeNumber]) -> tuple[Free, ...]:
    """The numbers of a study in SI units, each of them another one."""
    require_distinct(drive, [one.path for one in given])
    return tuple(_free_number(drive, one) for one in given)


def _free_number(drive: Drive, given: FreeNumber) -> Free:
    """A number of a study in SI units."""
    path = number_path(drive, given.path)
    start = value_at(drive, path)
    if isinstance(start, bool) or not isinstance(start, float):
        told = "is not given in the drive file" if start is None else f"= {start!r} is not a continuous number"
        raise ModelError(f"number {path} {told}. Give a number as the starting value.")
    least, largest = (float(converted(drive, path, bound)) for bound in (given.least, given.largest))
    if not least < largest:
        raise ModelError(f"number {path}: least = {least:g} is not below largest = {largest:g}.")
    if not least <= start <= largest:
        raise ModelError(
            f"number {path}: the drive file has {start:g}, which is outside least = {least:g} and largest = "
            f"{largest:g}. Widen them, or change the drive file."
        )
    return Free(path, unit_at(drive, path).replace("*", " "), least, largest, start)


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
    rest: AtRest | None = None
    states: tuple[FoundState, ...] = ()
    tangents: tuple[dict[str, FloatArray], ...] = ()
    """Path -> change of the unknowns of each state by a unit of the number; filled where derivatives are found."""

    def ahead(self, point: int, changes: Mapping[str, float]) -> FloatArray:
        """By how much the unknowns of another design differ at an operating point, to first order."""
        tangents = self.tangents[point]
        ways = {path: value - self.changes[path] for path, value in changes.items() if path in tangents}
        return np.asarray(sum((way * tangents[path] for path, way in ways.items()), np.zeros(1)))


class Designs:
    """Finds watched results of designs and their derivatives, in steady running or at rest."""

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
        self._at_rest, self._bands = at_rest, need_bands(one.name for one in watched)
        self.failed: list[str] = []
        """Derivatives that were not found, and why."""

    def find(self, changes: Mapping[str, float], near: Design | None = None) -> Design:
        """Find a design in steady running at all operating points."""
        states: list[FoundState] = []
        where = ""

        @cache
        def between(part: float) -> AtRest:
            """A drive on the way from the other design, at rest."""
            begin = changes if near is None else near.changes
            there = {path: begin[path] + part * (end - begin[path]) for path, end in changes.items()}
            prepared = prepare(self._given(changes if part == 1.0 else there))
            return bring_at_rest(prepared) if self._at_rest else bring_to_stand(prepared)

        try:
            rest = between(1.0)
            for number, point in enumerate(self._points):
                where = f"at {point.label}: " if len(self._points) > 1 else ""
                found = self._on_way(near, changes, number, between) if near and near.states else None
                states.append(found or self._state(point, rest, states))
                self._tell((number + 1) / len(self._points))
            values = np.array([self._read(one, number) for number, one in enumerate(states)])
        except Exception as error:
            told = cause_of(error, f"the steady running of drive.with_({dict(changes)!r}) {where}".rstrip(": "))
            return Design(changes, f"{where}{told}", np.full((len(self._points), len(self.watched)), np.nan))
        blank = tuple(dict[str, FloatArray]() for _ in states)
        return Design(changes, "", values, self._given(changes), rest, tuple(states), blank)

    def refined(self, design: Design) -> Design:
        """The same design on meshes that are made for it, where those on which it was found are too coarse."""
        if self._at_rest:
            return design
        assert design.rest is not None
        try:
            pairs = list(zip(self._points, design.states, strict=True))
            states = [self._state(point, design.rest, [state]) for point, state in pairs]
        except ConvergenceError as error:
            self.failed.append(f"the best design could not be recomputed on its own mesh: {error}")
            return design
        values = np.array([self._read(one, number) for number, one in enumerate(states)])
        return replace(design, values=values, states=tuple(states))

    def _given(self, changes: Mapping[str, float]) -> Drive:
        """The drive of a design, with constant speeds and torques."""
        return held(self._drive.with_(changes), self._instant)

    def _on_way(
        self, near: Design, changes: Mapping[str, float], number: int, between: Callable[[float], AtRest]
    ) -> FoundState | None:
        """The state at an operating point, followed from that of another design; None where the way ends before.

        The first step is the whole way, along the tangent; others are shorter, and follow a parabola.
        """
        start, last = near.states[number], list[Beside]()
        if not isinstance(start, Running):
            return None

        def solve(part: float, guess: FloatArray) -> FloatArray | None:
            try:
                found = steady_beside(self._points[number].of(between(part).drive), start.run, guess)
            except (ConvergenceError, ModelError):
                return None
            last[:] = [] if found is None else [found]
            return None if found is None else found.change

        ahead = near.ahead(number, changes)
        known = [Solution(place, place * ahead) for place in (-2.0 * _BEHIND, -_BEHIND, 0.0)]
        return None if follow(solve, *known) is None else start.of(last[0], None)

    def _state(self, point: OperatingPoint, rest: AtRest, before: Sequence[FoundState]) -> FoundState:
        """The state of a drive at an operating point, found from that before it, or from rest."""
        if self._at_rest:
            return Resting(rest)
        run = before[-1].run if before and isinstance(before[-1], Running) else None
        return Running(steady_from(point.of(rest.drive), run, self._tolerance, bands=self._bands), bands=self._bands)

    def derivatives(self, design: Design) -> FloatArray:
        """Derivatives of watched results by the numbers of a design, shape (points, results, numbers).

        Each number is changed a little, inwards from its bounds, and Newton's method follows from the steady states at
        hand.  A derivative that is not found counts as zero, and is noted.
        """
        assert design.given is not None
        assert design.rest is not None
        small = SmallChanges(design.given, design.rest)
        found = np.zeros((*design.values.shape, len(self.numbers)))
        for column, free in enumerate(self.numbers):
            value = design.changes[free.path]
            step = design.states[0].change * (free.largest - free.least)
            step *= 1.0 if value + step <= free.largest else -1.0
            try:
                side = small.drive(free.path, value + step)
                for number, (point, one) in enumerate(zip(self._points, design.states, strict=True)):
                    beside = self._neighbour(one, point.of(side), design.tangents[number], free.path, step)
                    found[number, :, column] = (self._read(beside, number) - design.values[number]) / step
            except Exception as error:
                told = cause_of(error, f"a change of {free.path} at {dict(design.changes)!r}")
                self.failed.append(f"no derivative with respect to {free.path}: {told}")
        return np.nan_to_num(found)

    def _neighbour(
        self, state: FoundState, drive: Drive, tangents: dict[str, FloatArray], path: str, step: float
    ) -> FoundState:
        """The state of a drive with a number changed by a step; notes the tangent on the way there."""
        if not isinstance(state, Running):
            return state.neighbour(drive)
        beside = state.beside(drive)
        tangents[path] = beside.change / step
        return state.of(beside, state)

    def _read(self, state: FoundState, point: int) -> FloatArray:
        """The watched results at an operating point."""
        return np.array([one.read(state) if one.at[point] else np.nan for one in self.watched])

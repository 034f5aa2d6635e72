"""The length of a belt, or the take-up of its fixed tensioner, that gives the tension at rest that is asked for.

Tension over length is a curve that falls where pulleys are fixed. Where a spring presses one, it follows the leverage,
and may rise, or turn.
"""

from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Generic, NamedTuple, Protocol, TypeVar

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model.prepared import Prepared
from beltdyn.model.rest_estimate import tightening
from beltdyn.model.static_estimate import balance_tensioners
from beltdyn.system.observations import Observations

_ACCURACY = 1e-6
"""Tolerance of the installed tension, relative."""
_TIGHTER = 0.05, -0.05, 0.1, -0.1, 0.2, -0.2, 0.4
"""How much tighter a search may begin, by the estimate, over the tension that is asked for."""
_JUMP = 0.005
"""Largest relative error of the installed tension if it jumps over the length of the belt, or a spring sets it."""
_TURNED_CHANGE = 0.005
"""Change of the tension away from the one that is wanted, over that one, after which it has turned."""
_MAX_TRIALS = 60
"""Trial lengths of the belt; beyond, a tension that a spring nearly holds is accepted, and any other is out of
reach."""
_LONGEST_CHANGE = 0.02
"""Change of a belt's length from one trial to the next, over its length, at most."""
_LEAST_CHANGE = 1e-7
"""Least change of a belt's length from one trial to the next, over its length: where shorter ones would be needed, the
tension jumps, or there is no equilibrium beyond."""
_SCAN_STEP, _MAX_SCAN_STEPS = 0.005, 80
"""Change of the length on the way along all lengths, over the length, and how often it is made to each side."""
_LEAST_WRAP = np.radians(0.5)
"""Wrap angle of a pulley that the belt is about to leave, rad."""
_SHORTER = 1e-5
"""Part of its length by which a belt is shortened for the slope of its tension."""


class Tightened(Protocol):
    """A drive at rest, of whatever mesh."""

    @property
    def prepared(self) -> Prepared:
        """The drive."""

    @property
    def tension(self) -> float:
        """Mean of the span tensions, N."""

    @property
    def seen(self) -> Observations:
        """What is seen of it, one instant."""


At = TypeVar("At", bound=Tightened)


def begin(prepared: Prepared, at_rest: Callable[[Prepared], At]) -> tuple[At, float]:
    """The drive at rest, and by how much it is tighter than as given, m.

    It has the length of its estimate; else that of closed forms with bending; else one with which it is tighter or
    looser, so that the belt meets pulleys that it misses.
    """
    try:
        return at_rest(prepared), 0.0
    except ConvergenceError:
        for distance in _distances(prepared):
            with suppress(ConvergenceError, ModelError):
                return at_rest(prepared.tightened(distance)), distance
        raise


def _distances(prepared: Prepared) -> Iterator[float]:
    """By how much a search may begin tighter, m."""
    tension, bent = prepared.installed_tension, tightening(prepared)
    if bent is not None:
        yield bent.distance
    if tension is not None:
        yield from (part * tension / _tension_over_length(prepared) for part in _TIGHTER)


class _Start(NamedTuple):
    """Where a search begins: how much tighter the drive is, m, and the slope of its tension over that, N/m."""

    tighter: float
    slope: float


class Tightening(Generic[At]):
    """The search for the tension that is wanted, N, of a drive as given, from one at rest that is tighter by some way.

    `at_rest` finds the drive at rest with another length, near to one that was found.
    """

    def __init__(
        self, given: Prepared, wanted: float, at_rest: Callable[[Prepared, At], At], first: At, tighter: float
    ) -> None:
        self._given, self._wanted, self._at_rest = given, wanted, at_rest
        self._first, self._tighter = first, tighter
        self._length, self._nearest = given.belt_length, first

    def run(self) -> At:
        """The drive with the tension that is wanted.

        The search begins where closed forms with bending have that tension; where it fails from there, at the first
        drive at rest; and last, with springs, between two lengths of all that the belt can have.
        """
        bent = tightening(self._given)
        if bent is not None and abs(self._wanted / self._first.tension - 1.0) > _ACCURACY:
            with suppress(ConvergenceError):
                return self._from(_Start(*bent))
        try:
            return self._from(_Start(self._tighter, _tension_over_length(self._given)))
        except ConvergenceError:
            for between in self._brackets() if self._given.carriers else ():
                with suppress(ConvergenceError):
                    return self._from(between)
            raise

    def _from(self, start: _Start) -> At:
        """The drive with the tension that is wanted, by the secant method from a start."""
        rest, done, slope = self._first, self._tighter, start.slope
        self._nearest = rest
        if start.tighter != done:
            rest, change = self._ahead(rest, done, start.tighter - done)
            done += change
        sides: dict[bool, tuple[float, At]] = {}  # the nearest trials with too much and too little tension
        longest = _LONGEST_CHANGE * self._length
        for trial in range(_MAX_TRIALS):
            missing = self._wanted - rest.tension
            if abs(missing) <= _ACCURACY * self._wanted:
                return rest
            if abs(missing) < abs(self._wanted - self._nearest.tension):
                self._nearest = rest
            elif len(sides) == 1 and (turned := self._turned(rest)):
                raise self._out_of_reach(turned)
            sides[missing > 0.0] = done, rest
            change = float(np.clip(missing / slope, -longest, longest))
            if len(sides) == 2:
                (low, slack), (high, tight) = sides[True], sides[False]
                if abs(high - low) < _LEAST_CHANGE * self._length:
                    return self._beside_jump(slack, tight)
                if trial % 2 or not min(low, high) < done + change < max(low, high):
                    change = 0.5 * (low + high) - done
            ahead, change = self._ahead(rest, done, change)
            gained = ahead.tension - rest.tension
            slope, rest, done = gained / change if gained * change * slope > 0.0 else slope, ahead, done + change
        return self._held(rest)

    def _brackets(self) -> Iterator[_Start]:
        """Starts between lengths of which one has too much and the other too little tension, to both sides."""
        for step in (-_SCAN_STEP * self._length, _SCAN_STEP * self._length):
            here, done = self._first, self._tighter
            for _ in range(_MAX_SCAN_STEPS):
                try:
                    ahead = self._at_rest(self._given.tightened(done + step), here)
                except (ConvergenceError, ModelError):
                    break
                if _jumps(here, ahead):
                    break
                gained = ahead.tension - here.tension
                if (ahead.tension - self._wanted) * (here.tension - self._wanted) <= 0.0:
                    yield _Start(done + step, gained / step)
                here, done = ahead, done + step

    def _ahead(self, rest: At, done: float, change: float) -> tuple[At, float]:
        """Tighten a drive some more, or by a part of it where all of it leads to no equilibrium; by how much, m."""
        given = self._given
        while True:
            try:
                ahead = self._at_rest(given.tightened(done + change), rest)
                if _jumps(rest, ahead):
                    raise ConvergenceError(_jump_of(rest, ahead))
            except (ConvergenceError, ModelError) as error:
                change *= 0.5
                if abs(change) < _LEAST_CHANGE * given.belt_length:
                    slack = _as_long_as_its_path(rest, self._at_rest) if change < 0.0 else ""
                    reason = slack or self._lifting_off(rest) or self._turned(rest) or str(error)
                    raise self._out_of_reach(reason) from error
            else:
                return ahead, change

    def _held(self, rest: At) -> At:
        """The last of too many trials, if a spring holds nearly the tension that is wanted."""
        first, wanted, turned = self._first, self._wanted, self._turned(rest)
        if turned:
            raise self._out_of_reach(turned)
        if self._given.carriers and abs(rest.tension - first.tension) < abs(wanted - rest.tension):
            if abs(wanted - rest.tension) < _JUMP * wanted:  # a spring holds the tension that bending leaves of it
                return rest
            raise ConvergenceError(
                f"belt.installed_tension = {wanted:.5g} N cannot be set: the tensioner force gives "
                f"{first.tension:.5g} N at any belt length. Give belt.length instead, near "
                f"{self._length:.5g} m, and set the tension by tensioner.preload."
            )
        raise self._out_of_reach(
            f"the tension at rest is {rest.tension:.5g} N with a belt length of {rest.prepared.belt_length:.6g} m and "
            f"{first.tension:.5g} N with {first.prepared.belt_length:.6g} "
            f"m{', since tensioners hold it' if self._given.carriers else ''}."
        )

    def _beside_jump(self, slack: At, tight: At) -> At:
        """Of two states on both sides of a jump, as a node of the mesh meets a pulley, the nearer one."""
        nearer = min(slack, tight, key=lambda one: abs(one.tension - self._wanted))
        if abs(nearer.tension - self._wanted) > _JUMP * self._wanted:
            raise self._out_of_reach(
                f"at rest the tension jumps from {slack.tension:.5g} to {tight.tension:.5g} N at a length of "
                f"{nearer.prepared.belt_length:.6g} m, where nodes of the mesh meet pulleys. Increase belt.elements."
            )
        return nearer

    def _lifting_off(self, rest: At) -> str:
        """That the belt leaves a pulley before it has the tension that is wanted, if it does.

        The angle by which a belt turns on a pulley falls in proportion to the tension up to where it leaves.
        """
        least = int(np.argmin(rest.seen.wrap_angle[0]))
        leaves = rest.tension
        if rest.seen.wrap_angle[0, least] > _LEAST_WRAP:
            if rest.tension == self._first.tension:
                return ""
            now, before = _turns(rest), _turns(self._first)
            rate = (now - before) / (rest.tension - self._first.tension) * np.sign(self._wanted - rest.tension)
            ways = np.where(rate < 0.0, now / np.maximum(-rate, 1e-30), np.inf)
            least = int(np.argmin(ways))
            if ways[least] > abs(self._wanted - rest.tension):
                return ""
            leaves += float(np.sign(self._wanted - rest.tension) * ways[least])
        name = self._given.drive.pulleys[least].name
        return (
            f'at {leaves:.5g} N the belt leaves "{name}", which it must touch. Move "{name}" towards the belt, or '
            "make the tensioner stiffer."
        )

    def _turned(self, rest: At) -> str:
        """That the tension turns before it is the one that is wanted, if springs let it."""
        nearest, excess = self._nearest, self._nearest.tension - self._wanted
        if (
            not self._given.carriers
            or (rest.tension - nearest.tension) * np.sign(excess) <= _TURNED_CHANGE * self._wanted
        ):
            return ""
        return (
            f"the tensioner force gives {nearest.tension:.5g} N with a belt length of "
            f"{nearest.prepared.belt_length:.6g} m, and {'more' if excess > 0.0 else 'less'} with other lengths. "
            "Set the tension by tensioner.preload."
        )

    def _out_of_reach(self, reason: str) -> ConvergenceError:
        return ConvergenceError(
            f"belt.installed_tension = {self._wanted:.5g} N cannot be reached with {self._given.elements} "
            f"elements: {reason} Change the tension, or give belt.length instead."
        )


def _moved(rest: Tightened, ahead: Tightened) -> FloatArray:
    """How far the pulleys of tensioners are from where they were, m, shape (pulleys,)."""
    return np.asarray(np.hypot(*(ahead.seen.pulley_center[0] - rest.seen.pulley_center[0]).T))


def _jumps(rest: Tightened, ahead: Tightened) -> bool:
    """Whether a tensioner with another length of the belt is in another balance, far away."""
    return bool(np.any(_moved(rest, ahead) > rest.prepared.radii.min()))


def _jump_of(rest: Tightened, ahead: Tightened) -> str:
    """Say which tensioner jumps."""
    name = rest.prepared.pulleys[int(np.argmax(_moved(rest, ahead)))].name
    return (
        f"at {rest.tension:.5g} N, with a belt length of {rest.prepared.belt_length:.6g} m, the balance of the "
        f'tensioner of "{name}" ends. Change its pivot or direction, increase its spring rate, or give stops.'
    )


def _turns(rest: Tightened) -> FloatArray:
    """Angles by which the lines of the spans turn at the pulleys, by the forces on these, rad."""
    seen = rest.seen
    forces = np.hypot(*seen.hub_force[0].T) / rest.tension
    return np.asarray(2.0 * np.arcsin(np.minimum(0.5 * forces, 1.0)))


def _tension_over_length(prepared: Prepared) -> float:
    """By how much a belt gets tighter with each meter that it is shorter by, as estimated, N/m.

    Where tensioners yield, that is a small part of the belt's own stiffness over its length.
    """
    belt, length = prepared.loaded_belt, prepared.belt_length
    shorter = belt.replace(length=(1.0 - _SHORTER) * length)
    try:
        ahead = balance_tensioners(prepared.path, shorter, prepared.contact, prepared.carriers)[0].tension
    except ValueError:
        ahead = prepared.tension_at_rest
    slope = (ahead - prepared.tension_at_rest) / (_SHORTER * length)
    return slope if slope > 0.0 else belt.axial_stiffness / length


def _as_long_as_its_path(rest: At, at_rest: Callable[[Prepared, At], At]) -> str:
    """What tensions a belt that is as long as its path, or nothing if it is shorter.

    Off the pulleys its bending stiffness spreads it, and its weight lets it sag: its own way is longer than the path.
    """
    prepared, path = rest.prepared, rest.prepared.installation.path
    if prepared.belt_length < (1.0 - _SHORTER) * path.length:
        return ""
    cause, remedy = "bending stiffness", "reduce belt.bending_stiffness"
    if prepared.gravity != (0.0, 0.0):
        try:
            bent = at_rest(prepared.replace(gravity=(0.0, 0.0)), rest).tension
        except (ConvergenceError, ModelError):
            bent = 0.0  # nothing but its weight holds it against the pulleys
        if bent < 0.5 * rest.tension:
            cause, remedy = "weight", "take a lighter belt"
    return (
        f"a belt of {prepared.belt_length:.6g} m, as long as the path around the pulleys, still has "
        f"{rest.tension:.5g} N, by its {cause}: increase the tension, or {remedy}."
    )

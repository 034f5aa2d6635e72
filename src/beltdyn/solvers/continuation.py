"""Continuation: solutions u of R(u, p) = 0 followed along a parameter p, and around limit points.

A natural step gives p, and Newton's method starts from the polynomial through the last solutions, or from the tangent
du/dp where there are too few.  Where no solution lies ahead, p becomes an unknown, and the condition that closes the
equations is that of pseudo-arclength (Keller 1977): with J = dR/du factorized,

    J du + R_p dp = -R,    l . du + m dp = -g
    du = a + b dp,    a = -J^-1 R,    b = -J^-1 R_p,    dp = -(g + l . a) / (m + l . b),

where (l, m) is the direction of the curve at the last point and g the distance from the plane across it, which holds
the predicted point.  Along the curve p grows up to a limit point and falls behind it.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray

_POLYNOMIAL = 3
"""Solutions through which a polynomial is laid, a parabola."""
_SHORTEST = 1e-3
"""Step, over the whole way, below which no solution lies ahead, by default."""
_ARC_STEPS = 200
"""Steps around a limit point, at most."""
_ARC_ITERATIONS = 12
"""Newton iterations of a step around a limit point, at most."""
_QUICK = 4
"""Iterations up to which the next step is longer."""
_FIRST_ARC = 0.01
"""First step around a limit point, of the parameter where it grows as before."""
_SHORTEST_ARC = 1e-3
"""Step around a limit point, over the first one, below which the curve is lost."""
_FALLEN = 0.7
"""Parameter over that of the limit point, below which the curve does not come back to it."""


class Solution(NamedTuple):
    """A point of the curve."""

    place: float
    """Parameter p."""
    unknowns: FloatArray


Solve = Callable[[float, FloatArray], FloatArray | None]
"""Solution at a place from a guess; None if Newton's method does not get there."""


def follow(
    solve: Solve,
    *solutions: Solution,
    step: float = 1.0,
    shortest: float = _SHORTEST,
    tangent: Callable[[float], FloatArray | None] | None = None,
) -> FloatArray | None:
    """Follow solutions from the place of the last one given, 0, to 1; None where the way ends before.

    Parameters
    ----------
    solve
        The corrector.
    solutions
        Solutions that are known, the last one at 0.
    step
        Length of the first step.
    shortest
        Length of a step below which no solution lies ahead.
    tangent
        Derivative of the unknowns by the parameter at the solution found last; without it a guess from fewer than three
        solutions is the last one.
    """
    known, reached = list(solutions), 0.0
    slope: FloatArray | None = None
    while reached < 1.0:
        if len(known) < _POLYNOMIAL and slope is None and tangent is not None:
            slope = tangent(reached)
        ahead = min(1.0, reached + step)
        found = solve(ahead, _predicted(known, slope, ahead))
        if found is not None:
            known.append(Solution(ahead, found))
            grows = len(known) >= _POLYNOMIAL or slope is not None
            reached, step, slope = ahead, 2.0 * step if grows else step, None
            continue
        step = 0.5 * (ahead - reached)
        if step < shortest:
            return None
    return known[-1].unknowns


def _predicted(known: Sequence[Solution], slope: FloatArray | None, place: float) -> FloatArray:
    """Guess of the unknowns at a place."""
    if len(known) >= _POLYNOMIAL:
        return extrapolated(known[-_POLYNOMIAL:], place)
    last = known[-1]
    return last.unknowns if slope is None else last.unknowns + (place - last.place) * slope


def extrapolated(known: Sequence[Solution], place: float) -> FloatArray:
    """Value of the polynomial through solutions."""
    total = np.zeros_like(known[0].unknowns)
    for own, values in known:
        others = [other for other, _ in known if other != own]
        total += np.prod([(place - other) / (own - other) for other in others]) * values
    return total


class Linearized(NamedTuple):
    """Newton's method at a state, as increments of the unknowns."""

    correction: FloatArray
    """a."""
    tangent: FloatArray
    """b, of the parameter."""


class Equations(Protocol):
    """Equations whose state is changed in place."""

    @property
    def weights(self) -> FloatArray:
        """Lengths that increments count with, shape of an increment."""

    def unknowns(self) -> FloatArray:
        """The state."""

    def place(self, unknowns: FloatArray) -> None:
        """Change the state."""

    def linearize(self, place: float) -> Linearized | None:
        """Newton's method at the state and a parameter; None where the tangent is singular."""

    def add(self, increment: FloatArray) -> None:
        """Add an increment to the state."""


class _Direction(NamedTuple):
    """Direction of a curve, of length 1."""

    unknowns: FloatArray
    """As an increment, not weighted."""
    parameter: float

    def length(self, weights: FloatArray, scale: float, increment: FloatArray, change: float) -> float:
        """Way of a change of unknowns and parameter along the direction."""
        return float((weights * self.unknowns) @ (weights * increment)) + scale**2 * self.parameter * change


def turn(equations: Equations, place: float, tolerance: float, passed: Callable[[], bool]) -> list[Solution]:
    """Follow a curve by its length from the state, which is a solution, until it is back at 1 or leads nowhere.

    Parameters
    ----------
    equations
        Left at the last solution.
    place
        Parameter of the state.
    tolerance
        Weighted length of the last correction.
    passed
        Whether the state lies so far behind a limit point that it need not be followed any more.

    Returns
    -------
    list of Solution
        From the state on; that alone where its tangent is singular or no step is found.
    """
    start, weights, found = equations.linearize(place), equations.weights, [Solution(place, equations.unknowns())]
    if start is None:
        return found
    scale = float(np.linalg.norm(weights * start.tangent))
    along = _direction(start.tangent, weights, scale, None)
    step = first = _FIRST_ARC * scale
    for _ in range(_ARC_STEPS):
        before = found[-1]
        corrected = _corrected(equations, before.place, step, along, scale, tolerance)
        if corrected is None:
            equations.place(before.unknowns)
            step *= 0.25
            if step < _SHORTEST_ARC * first:
                break
            continue
        here, iterations, tangent = corrected
        along = _direction(tangent, weights, scale, along)
        found.append(Solution(here, equations.unknowns()))
        step *= 2.0 if iterations <= _QUICK else 1.0
        if here >= 1.0 or here < _FALLEN * max(one.place for one in found) or passed():
            break
    return found


def _direction(tangent: FloatArray, weights: FloatArray, scale: float, before: _Direction | None) -> _Direction:
    """Direction of the curve from a tangent, in the sense of that before."""
    length = float(np.hypot(np.linalg.norm(weights * tangent), scale))
    along = _Direction(tangent / length, 1.0 / length)
    if before is not None and before.length(weights, scale, along.unknowns, along.parameter) < 0.0:
        return _Direction(-along.unknowns, -along.parameter)
    return along


def _corrected(
    equations: Equations, place: float, step: float, along: _Direction, scale: float, tolerance: float
) -> tuple[float, int, FloatArray] | None:
    """Solution in the plane across a direction, a step ahead: place, iterations, tangent; None if it is not found."""
    weights, missing, size = equations.weights, 0.0, np.inf
    equations.add(step * along.unknowns)
    place += step * along.parameter
    for iteration in range(1, _ARC_ITERATIONS + 1):
        newton = equations.linearize(place)
        if newton is None:
            return None
        across = along.length(weights, scale, newton.tangent, 1.0)
        change = -(missing + along.length(weights, scale, newton.correction, 0.0)) / across
        increment = newton.correction + change * newton.tangent
        smaller = float(np.linalg.norm(weights * increment))
        if not smaller < 2.0 * size:
            return None
        equations.add(increment)
        place, size = place + change, smaller
        missing += along.length(weights, scale, increment, change)
        if size <= tolerance:
            return place, iteration, newton.tangent
    return None

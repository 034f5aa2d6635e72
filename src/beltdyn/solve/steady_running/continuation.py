"""Continuation: from a solution to that of another problem in steps, each from a guess by those before.

The guess is the parabola through the last three solutions, or the last of fewer: on a line through two of them nodes
would leave the circles that they follow, and the belt be stretched by half of the square of the angle.  A step that
fails is halved; after success the next one is doubled, once there is a parabola.
"""

from collections.abc import Callable, Sequence

import numpy as np

from beltdyn.arrays import FloatArray

_KNOWN = 3
"""Solutions through which a parabola is laid."""
_SHORTEST = 1e-3
"""Part of the way, below which there is no going on."""

Solution = tuple[float, FloatArray]
"""Where on the way, and the unknowns there."""


def go_on(
    solve: Callable[[float, FloatArray], FloatArray | None], *passed: Solution, step: float = 1.0
) -> FloatArray | None:
    """Go on from 0 to 1.

    Parameters
    ----------
    solve
        Gives the unknowns at a place of the way, from a guess; None if there is no solution.
    *passed
        Solutions in the order in which they serve a guess, at least that at 0; it may be the only one.
    step
        The first one.

    Returns
    -------
    ndarray or None
        The unknowns at 1; None if the way ends before.
    """
    known, reached = list(passed), 0.0
    while reached < 1.0:
        ahead = min(1.0, reached + step)
        found = solve(ahead, extrapolated(known[-_KNOWN:], ahead) if len(known) >= _KNOWN else known[-1][1])
        if found is not None:
            known.append((ahead, found))
            reached, step = ahead, 2.0 * step if len(known) >= _KNOWN else step
            continue
        step = 0.5 * (ahead - reached)
        if step < _SHORTEST:
            return None
    return known[-1][1]


def extrapolated(known: Sequence[Solution], place: float) -> FloatArray:
    """Value of the polynomial through solutions.

    Parameters
    ----------
    known
        Solutions at different places, as many as the polynomial has coefficients.
    place
        Where.
    """
    total = np.zeros_like(known[0][1])
    for own, values in known:
        others = [other for other, _ in known if other != own]
        total += np.prod([(place - other) / (own - other) for other in others]) * values
    return total

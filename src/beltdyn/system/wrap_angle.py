"""Wrap angle of the belt on a pulley, from the first place where it touches to the last.

A lift-off between two such places takes nothing from the angle on which friction acts: the belt turns there as much as
the pulley does, and presses on both places by that.
"""

from math import atan2, hypot, pi

import numpy as np

from beltdyn.contact.bezier import combine, fill_bernstein
from beltdyn.contact.law import PulleyState
from beltdyn.kernel import kernel
from beltdyn.records import record

TOUCH = record(
    pulley="i8",  # its number, -1 for none
    x="f8",  # m, from the pulley's center
    y="f8",
    along="f8",  # length of belt from the first node, m
)
"""A place where the belt touches a pulley."""
WALK = record(
    along="f8",  # length of belt from the first node to the curve, m
    length="f8",  # of the curve, m
    first=TOUCH,
    last=TOUCH,
)
"""A walk along the belt: the first place that touches, and the last one so far."""


@kernel(inline=True)
def begin_walk(walk: np.record) -> None:
    """Begin at the first node of the belt."""
    walk.along = walk.length = 0.0
    walk.first.pulley = walk.last.pulley = -1


@kernel(inline=True)
def next_curve(walk: np.record, length: float) -> None:
    """Go on to the next curve of the belt, of a length in m."""
    walk.along += walk.length
    walk.length = length


@kernel(inline=True)
def turned_at(walk: np.record, xi: float, number: int, pulley: PulleyState, work: np.record) -> float:
    """Walk on to the next place that touches.

    Parameters
    ----------
    walk
        Row of `WALK`; overwritten.
    xi
        The place on the curve, 0 to 1.
    number, pulley
        What it touches.
    work
        From `element_workspace`, with the control points of the curve.

    Returns
    -------
    float
        Angle around the pulley from the last place, rad; zero where that is on another pulley, or where half a turn of
        belt or more lies between.
    """
    fill_bernstein(xi, work.contact.weights)
    x, y = combine(work.control, work.contact.weights)
    x, y, along = x - pulley.center_x, y - pulley.center_y, walk.along + xi * walk.length
    if walk.first.pulley < 0:
        _set(walk.first, number, x, y, along)
    angle = _turned(walk.last, number, x, y, along)
    _set(walk.last, number, x, y, along)
    return angle


@kernel(inline=True)
def turned_at_the_end(walk: np.record) -> float:
    """Angle around the pulley from the last place of a closed belt to its first, as of `turned_at`, rad.

    Parameters
    ----------
    walk
        Row of `WALK`, at the end of the belt.
    """
    first = walk.first
    return _turned(walk.last, first.pulley, first.x, first.y, walk.along + walk.length + first.along)


@kernel(inline=True)
def _set(touch: np.record, number: int, x: float, y: float, along: float) -> None:
    """Write down a place."""
    touch.pulley, touch.x, touch.y, touch.along = number, x, y, along


@kernel(inline=True)
def _turned(before: np.record, number: int, x: float, y: float, along: float) -> float:
    """Angle at the pulley's center between two places, see `turned_at`."""
    if before.pulley != number or along - before.along >= pi * hypot(x, y):
        return 0.0
    return abs(atan2(before.x * y - before.y * x, before.x * x + before.y * y))

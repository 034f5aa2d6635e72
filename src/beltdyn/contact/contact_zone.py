"""Where an element touches a pulley: the intervals of its centreline with d >= 0.

The centreline of an element is a cubic Bezier curve given by its control points, whatever the discretisation.  The
squared distance to a pulley's centre is then a polynomial of degree six, and R^2 minus it, the overlap, has the sign
of the penetration.  In Bernstein form it changes sign at most as often as its coefficients do; where those change more
than once, the element is halved (Lane and Riesenfeld, Bounds on a polynomial, BIT 21 (1981) 112-117).
"""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import bernstein, bernstein_rates, combine
from beltdyn.contact.law import Wheel
from beltdyn.kernel import kernel

MAX_INTERVALS = 6
"""More touching intervals than a polynomial of degree six can have on one element."""

_HALVINGS = 12
"""A dip of an element over less than 2^-12 of its length is not seen; it is below a millionth of the radius deep."""
_END = 7
PIECES = (_HALVINGS + 1, _END + 1)
"""Shape of the scratch array of `touching_intervals`."""
_STEPS = 60
_RESOLUTION = 1e-13


@kernel
def out_of_reach(control: FloatArray, wheel: Wheel) -> bool:
    """Whether the convex hull of the control points lies beyond a line that the pulley does not cross.

    Parameters
    ----------
    control : ndarray, shape (4, 2)
        Control points, m.
    wheel
        The pulley.

    Returns
    -------
    bool
        True only if no point of the curve can touch.
    """
    dx = 0.25 * (control[0, 0] + control[1, 0] + control[2, 0] + control[3, 0]) - wheel.center_x
    dy = 0.25 * (control[0, 1] + control[1, 1] + control[2, 1] + control[3, 1]) - wheel.center_y
    reach = wheel.radius * (dx * dx + dy * dy) ** 0.5
    for k in range(4):
        if dx * (control[k, 0] - wheel.center_x) + dy * (control[k, 1] - wheel.center_y) <= reach:
            return False
    return True


@kernel
def touching_intervals(control: FloatArray, wheel: Wheel, pieces: FloatArray, intervals: FloatArray) -> int:
    """Find the intervals of the element on which the centreline is inside the pulley.

    Parameters
    ----------
    control : ndarray, shape (4, 2)
        Control points, m.
    wheel
        The pulley.
    pieces : ndarray
        Scratch, made by `zone_scratch`.
    intervals : ndarray, shape (MAX_INTERVALS, 2)
        The first rows are overwritten by the ends of the intervals, in the element coordinate 0 to 1.

    Returns
    -------
    int
        Number of intervals.
    """
    _fill_overlap(control, wheel, pieces)
    inside = pieces[0, 0] >= 0.0
    count, last, left, start = 0, 0, 0.0, 0.0
    while last >= 0:
        right = pieces[last, _END]
        changes = _sign_changes(pieces, last)
        if changes > 1 and last < _HALVINGS:
            _halve(pieces, last, 0.5 * (left + right))
            last += 1
            continue
        if changes % 2 == 1:
            root = _root(control, wheel, left, right, inside)
            if inside and count < MAX_INTERVALS:
                intervals[count, 0], intervals[count, 1] = start, root
                count += 1
            start, inside = root, not inside
        left = right
        last -= 1
    if inside and count < MAX_INTERVALS:
        intervals[count, 0], intervals[count, 1] = start, 1.0
        count += 1
    return count


def zone_scratch() -> FloatArray:
    """Make the scratch array of `touching_intervals`.

    Returns
    -------
    ndarray, shape (13, 8)
        A stack of pieces of the element that are not yet searched, the leftmost last: the Bernstein coefficients of the
        overlap, and where the piece ends.
    """
    return np.zeros(PIECES)


@kernel(inline=True)
def _fill_overlap(control: FloatArray, wheel: Wheel, pieces: FloatArray) -> None:
    """Write the whole element on the stack: Bernstein coefficients of R^2 - |r - O|^2."""
    x0, y0 = control[0, 0] - wheel.center_x, control[0, 1] - wheel.center_y
    x1, y1 = control[1, 0] - wheel.center_x, control[1, 1] - wheel.center_y
    x2, y2 = control[2, 0] - wheel.center_x, control[2, 1] - wheel.center_y
    x3, y3 = control[3, 0] - wheel.center_x, control[3, 1] - wheel.center_y
    rim = wheel.radius * wheel.radius
    pieces[0, 0] = rim - (x0 * x0 + y0 * y0)
    pieces[0, 1] = rim - (x0 * x1 + y0 * y1)
    pieces[0, 2] = rim - (0.4 * (x0 * x2 + y0 * y2) + 0.6 * (x1 * x1 + y1 * y1))
    pieces[0, 3] = rim - (0.1 * (x0 * x3 + y0 * y3) + 0.9 * (x1 * x2 + y1 * y2))
    pieces[0, 4] = rim - (0.4 * (x1 * x3 + y1 * y3) + 0.6 * (x2 * x2 + y2 * y2))
    pieces[0, 5] = rim - (x2 * x3 + y2 * y3)
    pieces[0, 6] = rim - (x3 * x3 + y3 * y3)
    pieces[0, _END] = 1.0


@kernel(inline=True)
def _sign_changes(pieces: FloatArray, piece: int) -> int:
    """How often the coefficients of a piece change sign; zero counts as positive."""
    changes = 0
    for k in range(_END - 1):
        changes += (pieces[piece, k] >= 0.0) != (pieces[piece, k + 1] >= 0.0)
    return changes


@kernel(inline=True)
def _halve(pieces: FloatArray, piece: int, middle: float) -> None:
    """Leave the right half of a piece, and put the left half behind it, by de Casteljau's algorithm."""
    for k in range(_END):
        pieces[piece + 1, k] = pieces[piece, 0]
        for i in range(_END - 1 - k):
            pieces[piece, i] = 0.5 * (pieces[piece, i] + pieces[piece, i + 1])
    pieces[piece + 1, _END] = middle


@kernel(inline=True)
def _root(control: FloatArray, wheel: Wheel, left: float, right: float, falling: bool) -> float:
    """The root of the overlap between two points at which it has opposite signs.

    Newton's method, and halving where that would leave the bracket.
    """
    xi = 0.5 * (left + right)
    for _ in range(_STEPS):
        x, y = combine(control, bernstein(xi))
        dx, dy = combine(control, bernstein_rates(xi))
        x, y = x - wheel.center_x, y - wheel.center_y
        value, slope = wheel.radius * wheel.radius - (x * x + y * y), -2.0 * (x * dx + y * dy)
        if (value >= 0.0) == falling:
            left = xi
        else:
            right = xi
        trial = xi - value / slope if slope != 0.0 else left
        if not left < trial < right:
            trial = 0.5 * (left + right)
        if abs(trial - xi) < _RESOLUTION:
            return trial
        xi = trial
    return xi

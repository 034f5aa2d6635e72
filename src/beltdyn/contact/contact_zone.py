"""Where an element touches a pulley: the intervals of its centreline with d >= 0.

The centreline of an element is a cubic Bezier curve given by its control points, whatever the discretisation.  The
squared distance to a pulley's centre is then a polynomial of degree six, and R^2 minus it has the sign of the
penetration.
"""

import numpy as np
from numpy.typing import NDArray

from beltdyn.contact.law import Wheel
from beltdyn.kernel import kernel

FloatArray = NDArray[np.float64]

MAX_INTERVALS = 6
"""More touching intervals than a polynomial of degree six can have on one element."""

_PIECES = 4
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
def touching_intervals(control: FloatArray, wheel: Wheel, overlap: FloatArray, intervals: FloatArray) -> int:
    """Find the intervals of the element on which the centreline is inside the pulley.

    Parameters
    ----------
    control : ndarray, shape (4, 2)
        Control points, m.
    wheel
        The pulley.
    overlap : ndarray, shape (3, 7)
        Scratch for the polynomial R^2 - |r - O|^2 and its derivatives.
    intervals : ndarray, shape (MAX_INTERVALS, 2)
        The first rows are overwritten by the ends of the intervals, in the element coordinate 0 to 1.

    Returns
    -------
    int
        Number of intervals.
    """
    if _all_inside(control, wheel):
        intervals[0, 0], intervals[0, 1] = 0.0, 1.0
        return 1
    _fill_overlap(control, wheel, overlap)
    count = 0
    left, value_left = 0.0, _value(overlap, 0, 0.0)
    slope_left = _value(overlap, 1, 0.0)
    inside = value_left >= 0.0
    start = 0.0
    for piece in range(_PIECES):
        right = (piece + 1.0) / _PIECES
        value_right, slope_right = _value(overlap, 0, right), _value(overlap, 1, right)
        turn, value_turn = right, value_right
        if (value_left >= 0.0) == (value_right >= 0.0) and slope_left * slope_right <= 0.0:
            turn = _root(overlap, 1, left, right, slope_left > slope_right)
            value_turn = _value(overlap, 0, turn)
        for end, value_end in ((turn, value_turn), (right, value_right)):
            if (value_end >= 0.0) != inside:
                root = _root(overlap, 0, left, end, inside)
                if inside and count < MAX_INTERVALS:
                    intervals[count, 0], intervals[count, 1] = start, root
                    count += 1
                start, inside = root, not inside
            left = end
        value_left, slope_left = value_right, slope_right
    if inside and count < MAX_INTERVALS:
        intervals[count, 0], intervals[count, 1] = start, 1.0
        count += 1
    return count


@kernel
def _all_inside(control: FloatArray, wheel: Wheel) -> bool:
    """Whether no Bernstein coefficient of the squared distance to the centre exceeds that of the rim."""
    x0, y0 = control[0, 0] - wheel.center_x, control[0, 1] - wheel.center_y
    x1, y1 = control[1, 0] - wheel.center_x, control[1, 1] - wheel.center_y
    x2, y2 = control[2, 0] - wheel.center_x, control[2, 1] - wheel.center_y
    x3, y3 = control[3, 0] - wheel.center_x, control[3, 1] - wheel.center_y
    largest = max(x0 * x0 + y0 * y0, x3 * x3 + y3 * y3, x0 * x1 + y0 * y1, x2 * x3 + y2 * y3)
    largest = max(largest, 0.4 * (x0 * x2 + y0 * y2) + 0.6 * (x1 * x1 + y1 * y1))
    largest = max(largest, 0.4 * (x1 * x3 + y1 * y3) + 0.6 * (x2 * x2 + y2 * y2))
    largest = max(largest, 0.1 * (x0 * x3 + y0 * y3) + 0.9 * (x1 * x2 + y1 * y2))
    return largest <= wheel.radius * wheel.radius


@kernel
def _fill_overlap(control: FloatArray, wheel: Wheel, overlap: FloatArray) -> None:
    """Coefficients of R^2 - |r(xi) - O|^2 and its first two derivatives, in powers of xi."""
    overlap[:] = 0.0
    overlap[0, 0] = wheel.radius * wheel.radius
    for axis in range(2):
        center = wheel.center_x if axis == 0 else wheel.center_y
        p0, p1 = control[0, axis] - center, control[1, axis] - center
        p2, p3 = control[2, axis] - center, control[3, axis] - center
        cubic = (p0, 3.0 * (p1 - p0), 3.0 * (p2 - 2.0 * p1 + p0), p3 - 3.0 * (p2 - p1) - p0)
        for i in range(4):
            for j in range(4):
                overlap[0, i + j] -= cubic[i] * cubic[j]
    for order in range(2):
        for power in range(6):
            overlap[order + 1, power] = (power + 1.0) * overlap[order, power + 1]


@kernel
def _value(overlap: FloatArray, order: int, xi: float) -> float:
    """The polynomial, or its derivative of the given order, at xi."""
    total = overlap[order, 6]
    for power in range(5, -1, -1):
        total = total * xi + overlap[order, power]
    return total


@kernel
def _root(overlap: FloatArray, order: int, left: float, right: float, falling: bool) -> float:
    """The root of the polynomial, or of its derivative, between two points at which it has opposite signs.

    Newton's method, and halving where that would leave the bracket.
    """
    xi = 0.5 * (left + right)
    for _ in range(_STEPS):
        value = _value(overlap, order, xi)
        if (value >= 0.0) == falling:
            left = xi
        else:
            right = xi
        slope = _value(overlap, order + 1, xi)
        trial = xi - value / slope if slope != 0.0 else left
        if not left < trial < right:
            trial = 0.5 * (left + right)
        if abs(trial - xi) < _RESOLUTION:
            return trial
        xi = trial
    return xi

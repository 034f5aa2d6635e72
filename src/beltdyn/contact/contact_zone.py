"""Contact zones of an element on a pulley: the intervals of its centerline with d >= 0.

The centerline of an element is a Bezier curve of degree p given by its control points, whatever the discretization.
The squared distance to a pulley's center is then a polynomial of degree 2 p, and R^2 minus it, the overlap, has the
sign of the penetration.  In Bernstein form it changes sign at most as often as its coefficients do; where those change
more than once, the element is halved (Lane and Riesenfeld, Bounds on a polynomial, BIT 21 (1981) 112-117).

Against a surface that is not a smooth circle the penetration is sampled along the element, and roots are found where
its sign changes between two samples.

The centerline of an element as a Bezier curve, common to all belt discretizations (Eq. 24).

The degree is one less than the number of control points.  Kernels read it from the length of the arrays in which they
keep weights.  Where these are fields of a record the compiler knows their lengths, and each degree gets code of its
own.
"""

from collections.abc import Callable
from math import comb
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, blank, record
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import Polygon, Round, Shaped, Toothed, outer_radius, shaped_gap
from beltdyn.kernel import by_type, kernel

MAX_DEGREE = 9
"""Highest degree of a curve."""

BINOMIALS = np.array(
    [[comb(n, k) for k in range(2 * MAX_DEGREE + 1)] for n in range(2 * MAX_DEGREE + 1)], dtype=np.float64
)
"""Binomial coefficients, up to twice the highest degree."""


class Curve(NamedTuple):
    """A Bezier curve of the centerline: n control points from v vectors of nodal coordinates."""

    control: FloatArray
    """Control points, m, shape (n, 2)."""
    velocity: FloatArray
    """Their velocities, m/s, shape (n, 2)."""
    basis: FloatArray
    """Control points (rows) from the vectors (columns), shape (n, v)."""
    length: float
    """Reference length of the piece of belt, m."""
    start: float = 0.0
    """Material coordinate at which it begins, m, which teeth ask for."""


@kernel(inline=True)
def fill_bernstein(xi: float, weights: FloatArray) -> None:
    """Weights of the control points at xi: the Bernstein polynomials C(p, k) xi^k (1 - xi)^(p - k).

    `xi`: place on the curve, 0 to 1; `weights`: overwritten; its length says the degree p, shape (p + 1,).
    """
    _fill_polynomials(xi, weights.size - 1, weights)


@kernel(inline=True)
def fill_bernstein_rates(xi: float, rates: FloatArray) -> None:
    """Derivatives of the weights with respect to xi: p times the differences of the polynomials of degree p - 1.

    `xi`: place on the curve, 0 to 1; `rates`: overwritten; its length says the degree p, shape (p + 1,).
    """
    degree = rates.size - 1
    _fill_polynomials(xi, degree - 1, rates)
    rates[degree] = degree * rates[degree - 1]
    for k in range(degree - 1, 0, -1):
        rates[k] = degree * (rates[k - 1] - rates[k])
    rates[0] *= -degree


@kernel(inline=True)
def second_rate(control: FloatArray, xi: float, scratch: FloatArray) -> tuple[float, float]:
    """Second derivative of a curve with respect to xi, m: p (p - 1) times the second differences of control points.

    `control`: control points, m, shape (p + 1, 2); `xi`: place on the curve, 0 to 1; `scratch`: overwritten; its
    length says the degree p, shape (p + 1,).
    """
    degree, x, y = scratch.size - 1, 0.0, 0.0
    if degree < 2:
        return x, y
    _fill_polynomials(xi, degree - 2, scratch)
    for k in range(degree - 1):
        x += scratch[k] * (control[k + 2, 0] - 2.0 * control[k + 1, 0] + control[k, 0])
        y += scratch[k] * (control[k + 2, 1] - 2.0 * control[k + 1, 1] + control[k, 1])
    factor = degree * (degree - 1.0)
    return factor * x, factor * y


@kernel(inline=True)
def _fill_polynomials(xi: float, degree: int, values: FloatArray) -> None:
    """Overwrite the first values by the Bernstein polynomials of a degree."""
    complement, power = 1.0 - xi, 1.0
    for k in range(degree + 1):
        values[k] = BINOMIALS[degree, k] * power
        power *= xi
    power = 1.0
    for k in range(degree + 1):
        values[degree - k] *= power
        power *= complement


@kernel(inline=True)
def combine(control: FloatArray, weights: FloatArray) -> tuple[float, float]:
    """Weighted sum of control points or of their velocities."""
    x = y = 0.0
    for k in range(weights.size):
        x += weights[k] * control[k, 0]
        y += weights[k] * control[k, 1]
    return x, y


@kernel(inline=True)
def fill_shape_functions(basis: FloatArray, weights: FloatArray, shape: FloatArray) -> None:
    """Overwrite `shape` by the shape functions S_b of the v vectors from the weights of the control points."""
    for b in range(shape.size):
        shape[b] = 0.0
        for k in range(weights.size):
            shape[b] += weights[k] * basis[k, b]


_HALVINGS = 12
"""A dip over less than 2^-12 of the element length is ignored; its depth is below a millionth of the radius."""
_SAMPLES = 16
"""Search intervals of an element for contact with a shaped surface; shorter contact may be missed."""
_MAX_ROOT_STEPS = 60
"""Steps of the search for an end of contact: more than the 44 in which halving alone reaches `_RESOLUTION`."""
_RESOLUTION = 1e-13
"""Error of an end of contact, over the length of the element: some hundred times the rounding of the coordinate."""


class Circle(NamedTuple):
    """The rim of a round pulley, m."""

    x: float
    y: float
    radius: float


def zone_record(count: int) -> np.dtype[np.void]:
    """Kind of the scratch record of `touching_intervals` for curves with a number of control points."""
    most = max(count, _SAMPLES // 2) + 1
    return record(
        pieces=f"({_HALVINGS + 1},{2 * count})f8",
        intervals=f"({most},2)f8",
        lifted=f"({2 * most},2)f8",
        weights=f"({count},)f8",
        rates=f"({count},)f8",
    )


def zone_scratch(count: int) -> np.record:
    """Make the scratch record of `touching_intervals` for curves with a number of control points."""
    return blank(zone_record(count))


@kernel
def out_of_reach(control: FloatArray, pulley: PulleyState) -> bool:
    """Whether a line separates the convex hull of the control points from the pulley.

    `control`: control points, m, shape (n, 2). Returns true only if no point of the curve can touch.
    """
    count = control.shape[0]
    dx = dy = 0.0
    for k in range(count):
        dx += control[k, 0]
        dy += control[k, 1]
    dx, dy = dx / count - pulley.center_x, dy / count - pulley.center_y
    reach = outer_radius(pulley.surface) * (dx * dx + dy * dy) ** 0.5
    for k in range(count):
        if dx * (control[k, 0] - pulley.center_x) + dy * (control[k, 1] - pulley.center_y) <= reach:
            return False
    return True


@kernel
def touching_intervals(control: FloatArray, pulley: PulleyState, zone: np.record) -> int:
    """Find the intervals of the element on which the centerline is inside the pulley.

    `control`: control points, m, shape (n, 2); `zone`: scratch, made by `zone_scratch`.  The first rows of its
    `intervals` are overwritten by the ends of the intervals, in the element coordinate 0 to 1. Returns number of
    intervals.
    """
    return _intervals(pulley.surface, control, pulley.center_x, pulley.center_y, zone)


@kernel(inline=True)
def _on_circle(surface: Any, control: FloatArray, center_x: float, center_y: float, zone: np.record) -> int:
    """Exact intervals on a smooth circle."""
    return _inside(control, Circle(center_x, center_y, surface.radius), zone.intervals, zone)


@kernel
def _inside(control: FloatArray, circle: Circle, intervals: FloatArray, zone: np.record) -> int:
    """Fill in the intervals inside a circle; returns their number."""
    pieces = zone.pieces
    end = pieces.shape[1] - 1
    _fill_overlap(control, circle, pieces)
    inside = pieces[0, 0] >= 0.0
    count, last, left, start = 0, 0, 0.0, 0.0
    while last >= 0:
        right = pieces[last, end]
        changes = _sign_changes(pieces, last)
        if changes > 1 and last < _HALVINGS:
            _halve(pieces, last, 0.5 * (left + right))
            last += 1
            continue
        if changes % 2 == 1:
            root = _root(control, circle, left, right, inside, zone)
            if inside and count < intervals.shape[0]:
                intervals[count, 0], intervals[count, 1] = start, root
                count += 1
            start, inside = root, not inside
        left = right
        last -= 1
    if inside and count < intervals.shape[0]:
        intervals[count, 0], intervals[count, 1] = start, 1.0
        count += 1
    return count


@kernel(inline=True)
def _fill_overlap(control: FloatArray, circle: Circle, pieces: FloatArray) -> None:
    """Write the whole element on the stack: Bernstein coefficients of R^2 - |r - O|^2."""
    degree, rim = control.shape[0] - 1, circle.radius * circle.radius
    for k in range(2 * degree + 1):
        square = 0.0
        for i in range(degree + 1):
            j = k - i
            if not 0 <= j <= degree:
                continue
            x = (control[i, 0] - circle.x) * (control[j, 0] - circle.x)
            y = (control[i, 1] - circle.y) * (control[j, 1] - circle.y)
            square += BINOMIALS[degree, i] * BINOMIALS[degree, j] * (x + y)
        pieces[0, k] = rim - square / BINOMIALS[2 * degree, k]
    pieces[0, 2 * degree + 1] = 1.0


@kernel(inline=True)
def _sign_changes(pieces: FloatArray, piece: int) -> int:
    """How often the coefficients of a piece change sign; zero counts as positive."""
    changes = 0
    for k in range(pieces.shape[1] - 2):
        changes += (pieces[piece, k] >= 0.0) != (pieces[piece, k + 1] >= 0.0)
    return changes


@kernel(inline=True)
def _halve(pieces: FloatArray, piece: int, middle: float) -> None:
    """Leave the right half of a piece, and put the left half behind it, by de Casteljau's algorithm."""
    end = pieces.shape[1] - 1
    for k in range(end):
        pieces[piece + 1, k] = pieces[piece, 0]
        for i in range(end - 1 - k):
            pieces[piece, i] = 0.5 * (pieces[piece, i] + pieces[piece, i + 1])
    pieces[piece + 1, end] = middle


@kernel(inline=True)
def _root(control: FloatArray, circle: Circle, left: float, right: float, falling: bool, zone: np.record) -> float:
    """The root of the overlap between two points at which it has opposite signs.

    Newton's method, and halving where that would leave the bracket.
    """
    xi = 0.5 * (left + right)
    for _ in range(_MAX_ROOT_STEPS):
        fill_bernstein(xi, zone.weights)
        fill_bernstein_rates(xi, zone.rates)
        x, y = combine(control, zone.weights)
        dx, dy = combine(control, zone.rates)
        x, y = x - circle.x, y - circle.y
        value, slope = circle.radius * circle.radius - (x * x + y * y), -2.0 * (x * dx + y * dy)
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


@kernel
def _on_shape(surface: Any, control: FloatArray, center_x: float, center_y: float, zone: np.record) -> int:
    """Intervals on a surface of any kind, between samples at which the penetration changes its sign."""
    intervals = zone.intervals
    count, start = 0, 0.0
    inside = _depth(surface, control, center_x, center_y, 0.0, zone) >= 0.0
    for sample in range(_SAMPLES):
        left, right = sample / _SAMPLES, (sample + 1) / _SAMPLES
        if (_depth(surface, control, center_x, center_y, right, zone) >= 0.0) == inside:
            continue
        while right - left > _RESOLUTION:
            middle = 0.5 * (left + right)
            if (_depth(surface, control, center_x, center_y, middle, zone) >= 0.0) == inside:
                left = middle
            else:
                right = middle
        if inside:
            intervals[count, 0], intervals[count, 1] = start, left
            count += 1
        start, inside = right, not inside
    if inside:
        intervals[count, 0], intervals[count, 1] = start, 1.0
        count += 1
    return count


@kernel
def _depth(surface: Any, control: FloatArray, center_x: float, center_y: float, xi: float, zone: np.record) -> float:
    """Penetration of a point of the curve, m."""
    fill_bernstein(xi, zone.weights)
    x, y = combine(control, zone.weights)
    return shaped_gap(surface, x - center_x, y - center_y).penetration


_intervals = by_type(
    {Round: _on_circle, Shaped: _on_shape, Toothed: _on_circle, Polygon: _on_shape}, "touching_intervals"
)
"""Touching intervals by the kind of the surface; see `touching_intervals`."""


@kernel(inline=True)
def _none_lifted(surface: Any, control: FloatArray, pulley: PulleyState, touching: int, zone: np.record) -> int:
    return 0


@kernel
def _lifted(surface: Toothed, control: FloatArray, pulley: PulleyState, touching: int, zone: np.record) -> int:
    """What the circle through the tops of teeth encloses beside the touching intervals, the first of `intervals`."""
    touched, found = zone.intervals, zone.lifted
    if surface.spacing > 0.0 or surface.height == 0.0 or surface.stiffness == 0.0:
        return 0
    if touching == 1 and touched[0, 0] == 0.0 and touched[0, 1] == 1.0:
        return 0
    circle = Circle(pulley.center_x, pulley.center_y, surface.radius + surface.height)
    most = touched.shape[0]
    reached = _inside(control, circle, found[most:], zone)
    count = 0
    for k in range(reached):
        start, end = found[most + k, 0], found[most + k, 1]
        for i in range(touching):
            if start <= touched[i, 0] <= end:
                if touched[i, 0] > start:
                    found[count, 0], found[count, 1] = start, touched[i, 0]
                    count += 1
                start = touched[i, 1]
        if end > start:
            found[count, 0], found[count, 1] = start, end
            count += 1
    return count


lifted_intervals: Callable[[Any, FloatArray, PulleyState, int, np.record], int] = by_type(
    {Round: _none_lifted, Shaped: _none_lifted, Toothed: _lifted, Polygon: _none_lifted}, "lifted_intervals"
)
"""Find the intervals on which spread teeth are in their grooves, though the belt has lifted off the rim.

From surface, control points, pulley, and the number of touching intervals in `zone`, of which the first rows of
`lifted` are overwritten; returns their number.
"""

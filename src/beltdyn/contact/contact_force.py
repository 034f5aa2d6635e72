"""Generalised contact forces of one element against one pulley and their exact tangent (Eq. 24).

The centreline is a cubic Bezier curve given by its control points, whatever the belt discretisation; the forces
belong to the four vectors of which the control points are combinations (the basis): Q_b = integral of S_b (f_n n +
f_t t) dx.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.contact.bezier import Four, bernstein, bernstein_rates, combine, shape_functions
from beltdyn.contact.contact_zone import MAX_INTERVALS, PIECES, touching_intervals
from beltdyn.contact.law import ContactLaw, Wheel
from beltdyn.contact.penetration import approach
from beltdyn.contact.point_force import PointForce, PointTangent, point_force, point_tangent
from beltdyn.contact.pulley_moment import pulley_moment
from beltdyn.kernel import kernel
from beltdyn.records import blank, record

CONTACT_WORKSPACE = record(
    force="8f8",  # forces on the four vectors, N: x and y in turn
    xx="(4,4)f8",  # derivative of the x force on vector a with respect to the x of vector b, N/m
    xy="(4,4)f8",
    yx="(4,4)f8",
    yy="(4,4)f8",
    by_speed="8f8",  # derivative of `force` with respect to the pulley's speed, N s
    moment="8f8",  # derivative of the moment on the pulley with respect to the four vectors, N
    intervals=f"({MAX_INTERVALS},2)f8",
    pieces=f"{PIECES}f8",  # scratch of `touching_intervals`
    by_end="(2,9)f8",  # derivative of force and moment with respect to start and end of an interval
)
"""Results and scratch arrays of `contact_force`, made once for many elements by `contact_workspace`."""


class ContactTotals(NamedTuple):
    """Sums over one element against one pulley."""

    moment: float
    """Moment on the pulley, N m (Eq. 23)."""
    moment_by_speed: float
    """Its derivative with respect to the pulley's speed, N m s."""
    hub_x: float
    """Force on the pulley, N."""
    hub_y: float
    penalty_energy: float
    """Energy stored in the penalty springs, k_p d^2 / 2 over the touching length, J."""
    damping_power: float
    """Power lost in the contact dampers, (f_n - k_p d) dd/dt over the touching length, W."""
    friction_power: float
    """Power that belt and pulley really lose in friction, -f_t (t . dr/dt - arm omega), W."""


def contact_workspace() -> np.record:
    """Make the arrays of `contact_force`."""
    return blank(CONTACT_WORKSPACE)


@kernel
def contact_force(
    control: FloatArray,
    velocity: FloatArray,
    basis: FloatArray,
    wheel: Wheel,
    law: ContactLaw,
    length: float,
    points: FloatArray,
    weights: FloatArray,
    by_position: float,
    by_velocity: float,
    work: np.record,
) -> ContactTotals:
    """Contact forces of an element against a pulley by Gauss quadrature, with their tangent (Eqs. 17-24).

    Parameters
    ----------
    control, velocity : ndarray, shape (4, 2)
        Control points of the centreline (m) and their velocities (m/s).
    basis : ndarray, shape (4, 4)
        Control points (rows) from the vectors that carry the centreline (columns).
    wheel
        The pulley.
    law
        Contact constants; `law.follow_zone` places the points on the touching intervals instead of the whole element.
    length
        Reference length of the element, m.
    points, weights : ndarray, shape (k,)
        Quadrature on [0, 1].
    by_position, by_velocity : float
        The tangent is by_position d/d(position) + by_velocity d/d(velocity); with both zero there is none.
    work
        Everything but the scratch arrays is overwritten.

    Returns
    -------
    ContactTotals
        Moment, hub force, energy and losses.
    """
    _clear(work)
    intervals = work.intervals
    if law.follow_zone:
        count = touching_intervals(control, wheel, work.pieces, intervals)
    else:
        count, intervals[0, 0], intervals[0, 1] = 1, 0.0, 1.0
    totals = ContactTotals(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    wanted = by_position != 0.0 or by_velocity != 0.0
    for interval in range(count):
        start, end = intervals[interval, 0], intervals[interval, 1]
        moving = wanted and (start > 0.0 or end < 1.0)
        work.by_end[:] = 0.0
        for point in range(points.size):
            xi = start + (end - start) * points[point]
            places = bernstein(xi)
            x, y = combine(control, places)
            vx, vy = combine(velocity, places)
            here = approach(x, y, vx, vy, wheel)
            if here.penetration < 0.0:
                continue
            force = point_force(here, wheel, law)
            share = length * weights[point]
            weight, shape = share * (end - start), shape_functions(basis, places)
            speed = -force.by_slip * wheel.radius
            _add_pairs(work.force, shape, weight * force.x, weight * force.y)
            if wanted:
                tangent = point_tangent(here, force, law, by_position, by_velocity)
                _spread(shape, weight, tangent, -speed * here.normal_y, speed * here.normal_x, work)
            spring = law.stiffness * here.penetration
            totals = ContactTotals(
                totals.moment + weight * pulley_moment(force.arm, force.friction),
                totals.moment_by_speed + weight * pulley_moment(force.arm, speed),
                totals.hub_x - weight * force.x,
                totals.hub_y - weight * force.y,
                totals.penalty_energy + 0.5 * weight * spring * here.penetration,
                totals.damping_power - weight * (force.normal - spring) * here.radial,
                totals.friction_power - weight * force.friction * (here.circumferential - force.arm * wheel.speed),
            )
            if moving:
                rate = bernstein_rates(xi)
                rx, ry = combine(control, rate)
                sx, sy = combine(velocity, rate)
                by_place = point_tangent(here, force, law, 1.0, 0.0)
                by_motion = point_tangent(here, force, law, 0.0, 1.0)
                drift = (
                    by_place.xx * rx + by_place.xy * ry + by_motion.xx * sx + by_motion.xy * sy,
                    by_place.yx * rx + by_place.yy * ry + by_motion.yx * sx + by_motion.yy * sy,
                    by_place.moment_x * rx + by_place.moment_y * ry + by_motion.moment_x * sx + by_motion.moment_y * sy,
                )
                moment = pulley_moment(force.arm, force.friction)
                shape_rate = shape_functions(basis, rate)
                grow = weight * (1.0 - points[point])
                _add_end(work.by_end, 0, shape, shape_rate, -share, grow, force, moment, drift)
                grow = weight * points[point]
                _add_end(work.by_end, 1, shape, shape_rate, share, grow, force, moment, drift)
        if moving:
            if start > 0.0:
                _move_end(control, basis, wheel, start, 0, by_position, work)
            if end < 1.0:
                _move_end(control, basis, wheel, end, 1, by_position, work)
    return totals


@kernel(inline=True)
def _clear(work: np.record) -> None:
    """Set the results to zero."""
    work.force[:] = 0.0
    work.xx[:] = 0.0
    work.xy[:] = 0.0
    work.yx[:] = 0.0
    work.yy[:] = 0.0
    work.by_speed[:] = 0.0
    work.moment[:] = 0.0


@kernel(inline=True)
def _spread(
    shape: Four,
    weight: float,
    tangent: PointTangent,
    speed_x: float,
    speed_y: float,
    work: np.record,
) -> None:
    """Give tangent and couplings of a point to the four vectors (Eq. 24)."""
    _add_pairs(work.by_speed, shape, weight * speed_x, weight * speed_y)
    _add_pairs(work.moment, shape, weight * tangent.moment_x, weight * tangent.moment_y)
    _add_block(work.xx, shape, weight * tangent.xx)
    _add_block(work.xy, shape, weight * tangent.xy)
    _add_block(work.yx, shape, weight * tangent.yx)
    _add_block(work.yy, shape, weight * tangent.yy)


@kernel(inline=True)
def _add_pairs(vector: FloatArray, shape: Four, x: float, y: float) -> None:
    """Add shape_a (x, y) to the pairs of a vector."""
    vector[0] += shape[0] * x
    vector[1] += shape[0] * y
    vector[2] += shape[1] * x
    vector[3] += shape[1] * y
    vector[4] += shape[2] * x
    vector[5] += shape[2] * y
    vector[6] += shape[3] * x
    vector[7] += shape[3] * y


@kernel(inline=True)
def _add_block(block: FloatArray, shape: Four, factor: float) -> None:
    """Add factor shape_a shape_b."""
    _add_row(block, 0, factor * shape[0], shape)
    _add_row(block, 1, factor * shape[1], shape)
    _add_row(block, 2, factor * shape[2], shape)
    _add_row(block, 3, factor * shape[3], shape)


@kernel(inline=True)
def _add_row(block: FloatArray, a: int, factor: float, values: Four) -> None:
    """Add factor times four values to row a."""
    block[a, 0] += factor * values[0]
    block[a, 1] += factor * values[1]
    block[a, 2] += factor * values[2]
    block[a, 3] += factor * values[3]


@kernel(inline=True)
def _add_end(
    by_end: FloatArray,
    end: int,
    shape: Four,
    shape_rate: Four,
    share: float,
    grow: float,
    force: PointForce,
    moment: float,
    drift: tuple[float, float, float],
) -> None:
    """Derivative of a point's contribution with respect to an end of its interval.

    The end changes the weight of the point by share and, through grow / weight, its place; drift is the change of
    the force and of the moment along the element.
    """
    fx, fy = share * force.x + grow * drift[0], share * force.y + grow * drift[1]
    gx, gy = grow * force.x, grow * force.y
    row = by_end[end]
    _add_pairs(row, shape, fx, fy)
    _add_pairs(row, shape_rate, gx, gy)
    row[8] += share * moment + grow * drift[2]


@kernel(inline=True)
def _move_end(
    control: FloatArray,
    basis: FloatArray,
    wheel: Wheel,
    xi: float,
    end: int,
    by_position: float,
    work: np.record,
) -> None:
    """Add what the motion of one end of the touching interval does to the tangent.

    The end is a root of d(xi) = 0, so it moves by -S_b n . dr_b / (n . dr/dxi).
    """
    places = bernstein(xi)
    x, y = combine(control, places)
    rx, ry = combine(control, bernstein_rates(xi))
    nx, ny = x - wheel.center_x, y - wheel.center_y
    along = nx * rx + ny * ry
    if along == 0.0:
        return
    shape, row = shape_functions(basis, places), work.by_end[end]
    mx, my = -by_position * nx / along, -by_position * ny / along
    for a in range(4):
        fx, fy = row[2 * a], row[2 * a + 1]
        _add_row(work.xx, a, fx * mx, shape)
        _add_row(work.xy, a, fx * my, shape)
        _add_row(work.yx, a, fy * mx, shape)
        _add_row(work.yy, a, fy * my, shape)
    _add_pairs(work.moment, shape, row[8] * mx, row[8] * my)

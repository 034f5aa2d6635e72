"""Generalized contact forces of one element against one pulley and their exact tangent (Eq. 24).

The centerline is a Bezier curve given by its control points, whatever the belt discretization; the forces belong to the
vectors of which the control points are combinations (the basis): Q_b = integral of S_b (f_n n + (f_t + f_r) t) dx.
"""

from math import ceil
from typing import Any, Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, blank, record
from beltdyn.contact.contact_zone import (
    Curve,
    combine,
    fill_bernstein,
    fill_bernstein_rates,
    fill_shape_functions,
    lifted_intervals,
    touching_intervals,
    zone_record,
)
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.penetration import Approach, approach, tooth_approach
from beltdyn.contact.point_force import (
    NO_FORCE,
    NO_TANGENT,
    NO_TURN,
    PointForce,
    PointTangent,
    PointTurn,
    point_force,
    point_tangent,
    point_turn,
)
from beltdyn.contact.surface import Polygon, Round, Shaped, Toothed
from beltdyn.contact.teeth import (
    NoTeeth,
    Tooth,
    by_coordinate,
    force_with,
    power_taken,
    speed_unknown,
    tangent_with,
    tooth_at,
    tooth_of,
    tooth_reach,
    tooth_traction,
    turn_with,
)
from beltdyn.kernel import by_type, kernel
from beltdyn.quadrature import Quadrature


class ContactTotals(NamedTuple):
    """Sums over one element against one pulley."""

    moment: float
    """Moment on the pulley, N m (Eq. 23)."""
    hub_x: float
    """Force on the pulley, N."""
    hub_y: float
    penalty_energy: float
    """Energy stored in the penalty springs over the touching length, J; k_p d^2 / 2 a meter of linear ones."""
    damping_power: float
    """Power lost in the contact dampers: f_n without its elastic part times dd/dt, over the touching length, W."""
    friction_power: float
    """Friction power loss of belt and pulley, -f_t (t . dr/dt - arm omega), W."""
    compression_power: float
    """Power lost by compression of the belt, -f_r (t . dr/dt), and what its teeth take, which they may give back, W."""


class ContactFactors(NamedTuple):
    """The tangent is the sum of these times derivatives; with all of them zero there is none."""

    by_position: float
    """By positions of the belt, and by the pulley's angle."""
    by_velocity: float
    """By velocities of the belt, whose change goes along with that of positions."""
    by_turning: float
    """By the pulley's speed."""
    by_slope: float
    """By velocities of the belt that change by the derivative of the change of positions along the belt: it flows
    through its mesh at this speed, m/s."""
    by_flow: float
    """By that speed of the flow."""
    secant: bool
    """Friction changes by its secant from no slip, in place of its slope."""


_BETWEEN: Final = 1e-9
"""Of a pitch: teeth that rounding puts on both sides of the end of a curve belong to the later one."""
NO_CONTACT_TANGENT: Final = ContactFactors(0.0, 0.0, 0.0, 0.0, 0.0, False)


def contact_record(count: int, vectors: int) -> np.dtype[np.void]:
    """Kind of the record of results and scratch arrays of `contact_force`."""
    return record(
        force=f"({vectors},2)f8",  # forces on the vectors, N
        xx=f"({vectors},{vectors})f8",  # derivative of the x force on vector a with respect to the x of vector b, N/m
        xy=f"({vectors},{vectors})f8",
        yx=f"({vectors},{vectors})f8",
        yy=f"({vectors},{vectors})f8",
        by_turn=f"({vectors},2)f8",  # derivative of `force` with respect to angle and speed of the pulley
        moment_by_turn="f8",  # the same of the moment on the pulley
        moment=f"({vectors},2)f8",  # derivative of the moment on the pulley with respect to the vectors, N
        by_flow=f"({vectors},2)f8",  # derivative of `force` with respect to the speed of the belt's flow
        moment_by_flow="f8",
        zone=zone_record(count),
        weights=f"({count},)f8",  # of the control points at a point, and their derivatives along the curve
        rates=f"({count},)f8",
        functions=f"({vectors},)f8",  # shape functions of the vectors at a point, and their derivatives
        function_rates=f"({vectors},)f8",
        force_by_end=f"(2,{vectors},2)f8",  # force and moment by start and end of an interval
        moment_by_end="(2,)f8",
    )


def contact_workspace(count: int, vectors: int) -> np.record:
    """Make the arrays of `contact_force`, once for many elements; arguments as for `contact_record`."""
    return blank(contact_record(count, vectors))


@kernel
def contact_force(
    curve: Curve,
    pulley: PulleyState,
    law: ContactLaw,
    rule: Quadrature,
    factors: ContactFactors,
    work: np.record,
) -> ContactTotals:
    """Contact forces of an element against a pulley by Gauss quadrature, with their tangent (Eqs. 17-24).

    Parameters
    ----------
    curve
        The centerline of the element.
    pulley
        The pulley.
    law
        Laws of contact; `law.follow_zone` places the points on the touching intervals instead of the whole element.
    rule
        Points and weights.
    factors
        Of the derivatives in the tangent.
    work
        Made by `contact_workspace`; overwritten.

    Returns
    -------
    ContactTotals
        Moment, hub force, energy and losses.
    """
    _clear(work)
    intervals, lifted, above = work.zone.intervals, work.zone.lifted, 0
    lowest = -tooth_reach(pulley.surface)
    if law.follow_zone:
        count = touching_intervals(curve.control, pulley, work.zone)
        above = lifted_intervals(pulley.surface, curve.control, pulley, count, work.zone)
    else:
        count, intervals[0, 0], intervals[0, 1] = 1, 0.0, 1.0
    totals = ContactTotals(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    wanted = factors.by_position != 0.0 or factors.by_velocity != 0.0
    flowing = wanted and (factors.by_slope != 0.0 or factors.by_flow != 0.0)
    totals = _add_single(pulley.surface, totals, curve, pulley, factors, work)
    for interval in range(count + above):
        row = intervals[interval] if interval < count else lifted[interval - count]
        start, stop = row[0], row[1]
        moving = wanted and (start > 0.0 or stop < 1.0)
        work.force_by_end[:] = 0.0
        work.moment_by_end[:] = 0.0
        for point in range(rule.points.size):
            place, share = rule.points[point], curve.length * rule.weights[point]
            xi, weight = start + (stop - start) * place, share * (stop - start)
            fill_bernstein(xi, work.weights)
            x, y = combine(curve.control, work.weights)
            vx, vy = combine(curve.velocity, work.weights)
            here = approach(x, y, vx, vy, pulley)
            if here.penetration < lowest:
                continue
            tooth = tooth_at(pulley.surface, here, pulley.speed, curve.start + xi * curve.length)
            pressed = point_force(here, pulley, law, factors.secant) if here.penetration >= 0.0 else NO_FORCE
            force = force_with(tooth, pressed, here)
            fill_shape_functions(curve.basis, work.weights, work.functions)
            _add_pairs(work.force, work.functions, weight * force.x, weight * force.y)
            totals = _add_point(totals, weight, here, force, power_taken(tooth), pulley)
            if wanted:
                _spread(weight, here, force, tooth, pulley, factors, work)
            if moving or flowing:
                fill_bernstein_rates(xi, work.rates)
                fill_shape_functions(curve.basis, work.rates, work.function_rates)
            if flowing:
                motion = tangent_with(tooth, point_tangent(here, force, pulley.speed, 0.0, 1.0), here, 0.0, 1.0)
                _flow(weight / curve.length, curve, motion, factors, work)
            if moving:
                drift = _drift(curve, here, force, tooth, pulley, work)
                _add_end(work, 0, -share, weight * (1.0 - place), force, drift)
                _add_end(work, 1, share, weight * place, force, drift)
        for end, xi in ((0, start), (1, stop)):
            if moving and 0.0 < xi < 1.0:
                _move_end(curve, pulley, xi, end, factors.by_position, work)
    return totals


@kernel(inline=True)
def _no_single(
    surface: Any, totals: ContactTotals, curve: Curve, pulley: PulleyState, factors: ContactFactors, work: np.record
) -> ContactTotals:
    """Leave all as it is: the belt has no teeth."""
    return totals


@kernel
def tooth_numbers(surface: Any, curve: Curve) -> tuple[int, int]:
    """First number of the single teeth on a curve, and that after the last; equal if there are none."""
    if surface.spacing == 0.0:
        return 0, 0
    start, end = curve.start / surface.spacing, (curve.start + curve.length) / surface.spacing
    return ceil(start - _BETWEEN), ceil(end - _BETWEEN)


@kernel
def _at_tooth(surface: Toothed, curve: Curve, pulley: PulleyState, number: int, work: np.record) -> Approach:
    """The middle of a tooth against a pulley; its weights are in `work`."""
    fill_bernstein((number * surface.spacing - curve.start) / curve.length, work.weights)
    x, y = combine(curve.control, work.weights)
    vx, vy = combine(curve.velocity, work.weights)
    return tooth_approach(x, y, vx, vy, pulley)


@kernel
def tooth_force(surface: Any, curve: Curve, pulley: PulleyState, number: int, work: np.record) -> float:
    """Force of a single tooth on the belt, N, positive along the belt."""
    here = _at_tooth(surface, curve, pulley, number, work)
    if here.penetration < -surface.height:
        return 0.0
    tooth = tooth_of(surface, here, pulley.speed, number * surface.spacing)
    along = surface.spacing * tooth_traction(tooth, here)
    return along if surface.rate > 0.0 else -along


@kernel
def _single_teeth(
    surface: Toothed, totals: ContactTotals, curve: Curve, pulley: PulleyState, factors: ContactFactors, work: np.record
) -> ContactTotals:
    """Add the forces of single teeth, which act at their middles, with their tangent."""
    pitch = surface.spacing
    first, last = tooth_numbers(surface, curve)
    wanted = factors.by_position != 0.0 or factors.by_velocity != 0.0
    for number in range(first, last):
        here = _at_tooth(surface, curve, pulley, number, work)
        if here.penetration < -surface.height:
            continue
        tooth = tooth_of(surface, here, pulley.speed, number * pitch)
        force = force_with(tooth, NO_FORCE, here)
        fill_shape_functions(curve.basis, work.weights, work.functions)
        _add_pairs(work.force, work.functions, pitch * force.x, pitch * force.y)
        totals = _add_point(totals, pitch, here, force, power_taken(tooth), pulley)
        if wanted:
            by_turning = speed_unknown(surface) * factors.by_turning
            tangent = tangent_with(tooth, NO_TANGENT, here, factors.by_position, factors.by_velocity)
            turn = turn_with(tooth, NO_TURN, here, factors.by_position, by_turning)
            _give(pitch, tangent, turn, work)
    return totals


_add_single = by_type(
    {Round: _no_single, Shaped: _no_single, Toothed: _single_teeth, Polygon: _single_teeth}, "add_single"
)


@kernel(inline=True)
def _clear(work: np.record) -> None:
    """Set the results to zero."""
    work.force[:] = 0.0
    work.xx[:] = 0.0
    work.xy[:] = 0.0
    work.yx[:] = 0.0
    work.yy[:] = 0.0
    work.by_turn[:] = 0.0
    work.moment_by_turn = 0.0
    work.moment[:] = 0.0
    work.by_flow[:] = 0.0
    work.moment_by_flow = 0.0


@kernel(inline=True)
def _add_point(
    totals: ContactTotals, weight: float, here: Approach, force: PointForce, taken: float, pulley: PulleyState
) -> ContactTotals:
    """Sums with those of one more point, which stands for a length of belt."""
    return ContactTotals(
        totals.moment + weight * force.moment,
        totals.hub_x - weight * force.x,
        totals.hub_y - weight * force.y,
        totals.penalty_energy + weight * force.normal.energy,
        totals.damping_power - weight * (force.normal.force - force.normal.elastic) * here.radial,
        totals.friction_power - weight * force.friction * (here.circumferential - force.arm * pulley.speed),
        totals.compression_power - weight * force.rolling.force * here.circumferential + weight * taken,
    )


@kernel(inline=True)
def _spread(
    weight: float,
    here: Approach,
    force: PointForce,
    tooth: Any,
    pulley: PulleyState,
    factors: ContactFactors,
    work: np.record,
) -> None:
    """Give tangent and couplings of a point to the vectors (Eq. 24)."""
    by_turning = speed_unknown(pulley.surface) * factors.by_turning
    tangent = point_tangent(here, force, pulley.speed, factors.by_position, factors.by_velocity)
    tangent = tangent_with(tooth, tangent, here, factors.by_position, factors.by_velocity)
    turn = point_turn(here, force, pulley.speed, factors.by_position, by_turning)
    turn = turn_with(tooth, turn, here, factors.by_position, by_turning)
    _give(weight, tangent, turn, work)
    _pass(tooth, weight * factors.by_position, here, work)


@kernel(inline=True)
def _give(weight: float, tangent: PointTangent, turn: PointTurn, work: np.record) -> None:
    """Give derivatives at a point to the vectors."""
    _add_pairs(work.by_turn, work.functions, weight * turn.x, weight * turn.y)
    _add_pairs(work.moment, work.functions, weight * tangent.moment_x, weight * tangent.moment_y)
    _add_blocks(work, work.functions, tangent, weight)
    work.moment_by_turn += weight * turn.moment


@kernel(inline=True)
def _nothing_passes(tooth: NoTeeth, weight: float, here: Approach, work: np.record) -> None:
    """Leave all as it is: forces do not depend on the length of belt that has passed."""


@kernel(inline=True)
def _teeth_pass(tooth: Tooth, weight: float, here: Approach, work: np.record) -> None:
    """Add what the length of belt that has passed changes of the place of teeth, with a weight."""
    x, y, moment = by_coordinate(tooth, here)
    part = -weight * tooth.by_flow
    _add_pairs(work.by_flow, work.functions, part * x, part * y)
    work.moment_by_flow += part * moment


_pass = by_type({NoTeeth: _nothing_passes, Tooth: _teeth_pass}, "pass")


@kernel(inline=True)
def _flow(share: float, curve: Curve, motion: PointTangent, factors: ContactFactors, work: np.record) -> None:
    """Add what changes of the velocity by the belt's flow do.

    The share is the weight of the point over the curve's length, motion the derivative by the velocity of the point.
    """
    part = share * factors.by_slope
    _add_blocks(work, work.function_rates, motion, part)
    _add_pairs(work.moment, work.function_rates, part * motion.moment_x, part * motion.moment_y)
    rx, ry = combine(curve.control, work.rates)
    part = share * factors.by_flow
    fx, fy = motion.xx * rx + motion.xy * ry, motion.yx * rx + motion.yy * ry
    _add_pairs(work.by_flow, work.functions, part * fx, part * fy)
    work.moment_by_flow += part * (motion.moment_x * rx + motion.moment_y * ry)


@kernel(inline=True)
def _add_pairs(pairs: FloatArray, shape: FloatArray, x: float, y: float) -> None:
    """Add shape_a (x, y) to the pairs."""
    for a in range(shape.size):
        pairs[a, 0] += shape[a] * x
        pairs[a, 1] += shape[a] * y


@kernel(inline=True)
def _add_blocks(work: np.record, shape: FloatArray, tangent: PointTangent, factor: float) -> None:
    """Add factor times the tangent of a point, S_a for the force on vector a, shape_b for the change of vector b."""
    for a in range(shape.size):
        part = factor * work.functions[a]
        xx, xy, yx, yy = part * tangent.xx, part * tangent.xy, part * tangent.yx, part * tangent.yy
        for b in range(shape.size):
            work.xx[a, b] += xx * shape[b]
            work.xy[a, b] += xy * shape[b]
            work.yx[a, b] += yx * shape[b]
            work.yy[a, b] += yy * shape[b]


@kernel(inline=True)
def _drift(
    curve: Curve, here: Approach, force: PointForce, tooth: Any, pulley: PulleyState, work: np.record
) -> tuple[float, float, float]:
    """Change of force and moment along the curve, with the rates of the weights of its control points at the point."""
    rx, ry = combine(curve.control, work.rates)
    sx, sy = combine(curve.velocity, work.rates)
    place = tangent_with(tooth, point_tangent(here, force, pulley.speed, 1.0, 0.0), here, 1.0, 0.0)
    motion = tangent_with(tooth, point_tangent(here, force, pulley.speed, 0.0, 1.0), here, 0.0, 1.0)
    own = by_coordinate(tooth, here)
    return (
        place.xx * rx + place.xy * ry + motion.xx * sx + motion.xy * sy + curve.length * own[0],
        place.yx * rx + place.yy * ry + motion.yx * sx + motion.yy * sy + curve.length * own[1],
        place.moment_x * rx + place.moment_y * ry + motion.moment_x * sx + motion.moment_y * sy + curve.length * own[2],
    )


@kernel(inline=True)
def _add_end(
    work: np.record, end: int, share: float, grow: float, force: PointForce, drift: tuple[float, float, float]
) -> None:
    """Derivative of a point's contribution with respect to an end of its interval.

    The end changes the weight of the point by share and, through grow / weight, its place; drift is the change of
    the force and of the moment along the element.
    """
    row = work.force_by_end[end]
    _add_pairs(row, work.functions, share * force.x + grow * drift[0], share * force.y + grow * drift[1])
    _add_pairs(row, work.function_rates, grow * force.x, grow * force.y)
    work.moment_by_end[end] += share * force.moment + grow * drift[2]


@kernel(inline=True)
def _move_end(curve: Curve, pulley: PulleyState, xi: float, end: int, by_position: float, work: np.record) -> None:
    """Add what the motion of one end of the touching interval does to the tangent.

    The end is a root of d(xi) = 0, so it moves by -(S_b n . dr_b + p_t d(theta)) / (n . dr/dxi).
    """
    fill_bernstein(xi, work.weights)
    fill_bernstein_rates(xi, work.rates)
    fill_shape_functions(curve.basis, work.weights, work.functions)
    x, y = combine(curve.control, work.weights)
    rx, ry = combine(curve.control, work.rates)
    here = approach(x, y, 0.0, 0.0, pulley)
    along = here.normal_x * rx + here.normal_y * ry
    if along == 0.0:
        return
    share = -by_position / along
    mx, my = share * here.normal_x, share * here.normal_y
    for a in range(work.functions.size):
        fx, fy = work.force_by_end[end, a, 0], work.force_by_end[end, a, 1]
        for b in range(work.functions.size):
            work.xx[a, b] += fx * mx * work.functions[b]
            work.xy[a, b] += fx * my * work.functions[b]
            work.yx[a, b] += fy * mx * work.functions[b]
            work.yy[a, b] += fy * my * work.functions[b]
        work.by_turn[a, 0] += fx * share * here.offset
        work.by_turn[a, 1] += fy * share * here.offset
    _add_pairs(work.moment, work.functions, work.moment_by_end[end] * mx, work.moment_by_end[end] * my)
    work.moment_by_turn += work.moment_by_end[end] * share * here.offset

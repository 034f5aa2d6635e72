"""Forces of a planar centerline whose energy density depends on G = q . q and c = q x w, with q = dr/dx, w = d2r/dx2.

The centerline is made of vectors of two components, in the order of the coordinates e: first those of node i, its place
before its derivatives, then as many of node j.

A point's force belongs to z = (q, w), and so does its tangent, which may have columns for u = d3r/dx3 too. Tangents are
summed in rows that are wider than the coordinates, so that inner loops run in whole vector registers.
"""

from math import sqrt
from typing import Final, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import DampingFactors
from beltdyn.kernel import kernel

# Rate-independent hysteresis: a stress against the strain rate, in proportion to the strain

CREEPING: Final = 0.1
"""v_0: belt speed below which hysteresis becomes viscous damping, m/s."""


class Hysteretic(NamedTuple):
    """A stress by hysteresis and its derivatives."""

    stress: float
    """N, or N m."""
    by_strain: float
    by_rate: float
    by_square: float
    """By the square of the belt's speed."""


@kernel(inline=True)
def hysteretic(modulus: float, strain: float, rate: float, square: float, length: float) -> Hysteretic:
    """Stress of rate-independent damping (Reid 1956), smoothed at slow rates.

    `modulus`: c, N or N m^2; `strain`, `rate`: x, and dx/dt (1/s times the unit of x); `square`: v^2, m^2/s^2;
    `length`: l, m.
    """
    if modulus == 0.0:
        return Hysteretic(0.0, 0.0, 0.0, 0.0)
    passing = square + CREEPING * CREEPING
    slow = passing / (length * length)
    root = sqrt(rate * rate + slow * strain * strain)
    if root == 0.0:
        return Hysteretic(0.0, 0.0, 0.0, 0.0)
    size, sign = abs(strain), 1.0 if strain >= 0.0 else -1.0
    share = rate / root
    fast = share * share
    return Hysteretic(
        modulus * size * share,
        modulus * sign * share * fast,
        modulus * size / root * (1.0 - fast),
        -0.5 * modulus * size * share * (1.0 - fast) / passing,
    )


# Damping of a planar centerline in the strains eps = sqrt(G) - 1 and kappa = c / sqrt(G), point by point

Two = tuple[float, float]


class CurveMotion(NamedTuple):
    """A point of the centerline and its rates."""

    q: Two
    """dr/dx."""
    w: Two
    """d2r/dx2, 1/m."""
    u: Two
    """d3r/dx3, 1/m^2."""
    q_rate: Two
    """1/s."""
    w_rate: Two
    """1/(m s)."""


class PointDamping(NamedTuple):
    """Factors of a point, dampings times the length of belt that it represents, and those of the tangent."""

    axial: float
    """A, N s m."""
    bending: float
    """B, N s m^3."""
    hysteresis: float
    """Modulus of the hysteresis of bending, N m^3."""
    passing_length: float
    """Length over which slow rates are smoothed in it, m."""
    square: float
    """Of the belt's speed, m^2/s^2."""
    tangent: DampingFactors


def curve_damping_scratch(vectors: int) -> dict[str, str]:
    """Fields of ``work`` for `add_curve_damping`.

    They are derivatives of strains and of their rates by z = (q, w), that of the force by the rate of z, and by the
    square of the speed.
    """
    return {
        "strain_slope": "(2,4)f8",
        "strain_drift": "(2,4)f8",
        "by_rate": "(4,4)f8",
        "by_square": f"{2 * vectors}f8",
    }


@kernel(inline=True)
def add_curve_damping(
    damping: PointDamping,
    slope: tuple[float, ...],
    bend: tuple[float, ...],
    third: tuple[float, ...],
    motion: CurveMotion,
    work: np.record,
) -> Two:
    """Add a point's part of the damping force, with the opposite sign, and of its exact tangent.

    `slope`, `bend`, `third`: factors of the vectors in q, w and u; `work`: `gradient`, `by_square`, the derivative of
    the force by the square of the speed, and, with a tangent, `rows` and `by_flow` are changed; fields of
    `curve_scratch` and `curve_damping_scratch`. Returns powers lost in stretch and in bending, W.
    """
    q, w, q_rate, w_rate = motion.q, motion.w, motion.q_rate, motion.w_rate
    fill_slopes(q, w, work)
    metric, cross = q[0] * q[0] + q[1] * q[1], q[0] * w[1] - q[1] * w[0]
    metric_rate = 2.0 * (q[0] * q_rate[0] + q[1] * q_rate[1])
    cross_rate = q_rate[0] * w[1] - q_rate[1] * w[0] + q[0] * w_rate[1] - q[1] * w_rate[0]
    by_c = 1.0 / sqrt(metric)
    cube = by_c * by_c * by_c
    by_g, by_gc, by_gg = -0.5 * cross * cube, -0.5 * cube, 0.75 * cross * cube * by_c * by_c
    stretch_g, stretch_gg = 0.5 * by_c, -0.25 * cube
    strain_rate, curvature_rate = stretch_g * metric_rate, by_g * metric_rate + by_c * cross_rate
    law = hysteretic(damping.hysteresis, cross * by_c, curvature_rate, damping.square, damping.passing_length)
    force, moment = damping.axial * strain_rate, damping.bending * curvature_rate + law.stress
    metric_drift = (2.0 * q_rate[0], 2.0 * q_rate[1], 0.0, 0.0)
    cross_drift = (w_rate[1], -w_rate[0], -q_rate[1], q_rate[0])
    by_metric = by_gg * metric_rate + by_gc * cross_rate
    for k in range(4):
        of_metric, of_cross = work.of_metric[k], work.of_cross[k]
        work.strain_slope[0, k] = stretch_g * of_metric
        work.strain_slope[1, k] = by_g * of_metric + by_c * of_cross
        work.strain_drift[0, k] = stretch_g * metric_drift[k] + stretch_gg * metric_rate * of_metric
        work.strain_drift[1, k] = (
            by_g * metric_drift[k] + by_c * cross_drift[k] + by_metric * of_metric + by_gc * metric_rate * of_cross
        )
        work.point_force[k] = force * work.strain_slope[0, k] + moment * work.strain_slope[1, k]
    add_point_force(slope, bend, work)
    if law.by_square != 0.0:
        _add_by_square(law.by_square, slope, bend, work)
    if damping.tangent.by_position != 0.0 or damping.tangent.by_velocity != 0.0:
        density = Density(
            force * stretch_g + moment * by_g, moment * by_c, force * stretch_gg + moment * by_gg, moment * by_gc, 0.0
        )
        fill_density_tangent(density, work)
        by_rate = law.stress / curvature_rate if damping.tangent.secant and curvature_rate != 0.0 else law.by_rate
        _add_products(damping, by_rate, law.by_strain, work)
        _spread(damping, slope, bend, third, motion, work)
    return force * strain_rate, moment * curvature_rate


@kernel(inline=True)
def _add_by_square(factor: float, slope: tuple[float, ...], bend: tuple[float, ...], work: np.record) -> None:
    """Add the derivative of the force by the square of the speed."""
    turned = work.strain_slope[1]
    for a in range(len(slope)):
        for axis in range(2):
            work.by_square[2 * a + axis] += factor * (slope[a] * turned[axis] + bend[a] * turned[2 + axis])


@kernel(inline=True)
def _add_products(damping: PointDamping, by_rate: float, by_strain: float, work: np.record) -> None:
    """Add what the strains and their rates contribute to the tangent of a point; overwrite that by the rate of z."""
    work.by_rate[:] = 0.0
    for k, factor, share in ((0, damping.axial, 0.0), (1, damping.bending + by_rate, by_strain)):
        if factor == 0.0:
            continue
        for column in range(4):
            drift, slope = work.strain_drift[k, column], work.strain_slope[k, column]
            change = factor * drift + share * slope
            for row in range(4):
                work.point_tangent[row, column] += work.strain_slope[k, row] * change
                work.by_rate[row, column] += work.strain_slope[k, row] * factor * slope


@kernel(inline=True)
def _spread(
    damping: PointDamping,
    slope: tuple[float, ...],
    bend: tuple[float, ...],
    third: tuple[float, ...],
    motion: CurveMotion,
    work: np.record,
) -> None:
    """Give the tangent of a point to the coordinates; the belt's flow changes q and w at the rates w and u."""
    by_place, by_rate, by_coordinates = work.point_tangent, work.by_rate, work.by_coordinates
    w, u, factors = motion.w, motion.u, damping.tangent
    for row in range(4):
        for axis in range(2):
            of_q, of_w = by_rate[row, axis], by_rate[row, 2 + axis]
            by_q = factors.by_position * by_place[row, axis] + factors.by_velocity * of_q
            by_w = factors.by_position * by_place[row, 2 + axis] + factors.by_velocity * of_w + factors.by_flow * of_q
            by_u = factors.by_flow * of_w
            for b in range(len(slope)):
                by_coordinates[row, 2 * b + axis] = slope[b] * by_q + bend[b] * by_w + third[b] * by_u
        flow = by_rate[row, 0] * w[0] + by_rate[row, 1] * w[1] + by_rate[row, 2] * u[0] + by_rate[row, 3] * u[1]
        shape = slope if row < 2 else bend
        for a in range(len(slope)):
            work.by_flow[2 * a + row % 2] += shape[a] * flow
    spread_rows(slope, bend, work)


_LANES = 16
"""Rows are padded to a multiple of this many numbers; loops over fewer are not taken by vector registers."""


class Density(NamedTuple):
    """First and second derivatives of an energy density, each times the length of belt that a point represents."""

    g: float
    c: float
    gg: float
    gc: float
    cc: float


def curve_scratch(vectors: int) -> dict[str, str]:
    """Fields of ``work`` for `add_density`, with the number of vectors.

    They are the derivatives of G and c by z, the force of a point on z and its derivative by q, w and u, that
    derivative by the coordinates, and the sum of tangents.
    """
    width = (2 * vectors + _LANES - 1) // _LANES * _LANES
    return {
        "of_metric": "4f8",
        "of_cross": "4f8",
        "point_force": "4f8",
        "point_tangent": "(4,6)f8",
        "by_coordinates": f"(4,{width})f8",
        "rows": f"({2 * vectors},{width})f8",
    }


@kernel(inline=True)
def combine(e: FloatArray, factors: tuple[float, ...]) -> tuple[float, float]:
    """Sum of the vectors times factors; places enter by their difference, which costs fewer digits."""
    half = len(factors) // 2
    x, y = factors[half] * (e[2 * half] - e[0]), factors[half] * (e[2 * half + 1] - e[1])
    for a in range(1, half):
        x += factors[a] * e[2 * a] + factors[half + a] * e[2 * (half + a)]
        y += factors[a] * e[2 * a + 1] + factors[half + a] * e[2 * (half + a) + 1]
    return x, y


@kernel(inline=True)
def add_density(
    density: Density,
    slope: tuple[float, ...],
    bend: tuple[float, ...],
    q: tuple[float, float],
    w: tuple[float, float],
    wanted: bool,
    work: np.record,
) -> None:
    """Add a point's part of the elastic force and of its exact tangent, between `begin_tangent` and `end_tangent`.

    `density`: derivatives at the point; `slope`, `bend`: factors of the vectors in q and w; `q`, `w`: their values;
    `wanted`: whether the tangent is wanted; `work`: `gradient` and `rows` are changed; fields of `curve_scratch`.
    """
    fill_slopes(q, w, work)
    for k in range(4):
        work.point_force[k] = density.g * work.of_metric[k] + density.c * work.of_cross[k]
    add_point_force(slope, bend, work)
    if wanted:
        fill_density_tangent(density, work)
        add_point_tangent(slope, bend, work)


@kernel(inline=True)
def begin_tangent(work: np.record) -> None:
    """Begin the sum of tangents; arguments as for `add_density`."""
    work.rows[:] = 0.0


@kernel(inline=True)
def end_tangent(work: np.record) -> None:
    """Add the sum to the tangent of the element; arguments as for `add_density`."""
    for row in range(work.tangent.shape[0]):
        for column in range(work.tangent.shape[1]):
            work.tangent[row, column] += work.rows[row, column]


@kernel(inline=True)
def fill_slopes(q: tuple[float, float], w: tuple[float, float], work: np.record) -> None:
    """Overwrite the derivatives of G and c by z; arguments as for `add_density`."""
    of_metric, of_cross = work.of_metric, work.of_cross
    of_metric[0], of_metric[1], of_metric[2], of_metric[3] = 2.0 * q[0], 2.0 * q[1], 0.0, 0.0
    of_cross[0], of_cross[1], of_cross[2], of_cross[3] = w[1], -w[0], -q[1], q[0]


@kernel(inline=True)
def fill_density_tangent(density: Density, work: np.record) -> None:
    """Overwrite the tangent of a point, with `fill_slopes` done before; arguments as for `add_density`."""
    of_metric, of_cross, tangent = work.of_metric, work.of_cross, work.point_tangent
    for row in range(4):
        by_metric = density.gg * of_metric[row] + density.gc * of_cross[row]
        by_cross = density.gc * of_metric[row] + density.cc * of_cross[row]
        for column in range(4):
            tangent[row, column] = by_metric * of_metric[column] + by_cross * of_cross[column]
    for axis in range(2):
        tangent[axis, axis] += 2.0 * density.g
        turned = density.c * (1.0 - 2.0 * axis)
        tangent[axis, 3 - axis] += turned
        tangent[3 - axis, axis] += turned


@kernel(inline=True)
def add_point_force(slope: tuple[float, ...], bend: tuple[float, ...], work: np.record) -> None:
    """Give the force of a point to the coordinates; arguments as for `add_density`."""
    force = work.point_force
    for a in range(len(slope)):
        for axis in range(2):
            work.gradient[2 * a + axis] += slope[a] * force[axis] + bend[a] * force[2 + axis]


@kernel(inline=True)
def add_point_tangent(slope: tuple[float, ...], bend: tuple[float, ...], work: np.record) -> None:
    """Give the tangent of a point to the coordinates; arguments as for `add_density`."""
    by_place, by_coordinates = work.point_tangent, work.by_coordinates
    for row in range(4):
        for b in range(len(slope)):
            for axis in range(2):
                by_coordinates[row, 2 * b + axis] = slope[b] * by_place[row, axis] + bend[b] * by_place[row, 2 + axis]
    spread_rows(slope, bend, work)


@kernel(inline=True)
def spread_rows(slope: tuple[float, ...], bend: tuple[float, ...], work: np.record) -> None:
    """Add the derivative of a point's force by the coordinates to the sum; arguments as for `add_density`."""
    by_coordinates, rows = work.by_coordinates, work.rows
    for a in range(len(slope)):
        along, across = slope[a], bend[a]
        for axis in range(2):
            for column in range(rows.shape[1]):
                change = along * by_coordinates[axis, column] + across * by_coordinates[2 + axis, column]
                rows[2 * a + axis, column] += change

"""Damping of a planar centreline in the strains eps = sqrt(G) - 1 and kappa = c / sqrt(G), point by point.

Of Kelvin-Voigt, with the rate potential A / 2 (deps/dt)^2 + B / 2 (dkappa/dt)^2 of a point, and by hysteresis of the
curvature (`hysteretic`); G and c as in `planar_curve`.  The strains are those that `ancf.material_damping` damps,
without shear.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from beltdyn.elements.hysteretic import hysteretic
from beltdyn.elements.kind import DampingFactors
from beltdyn.elements.planar_curve import (
    Density,
    add_point_force,
    fill_density_tangent,
    fill_slopes,
    spread_rows,
)
from beltdyn.kernel import kernel

Two = tuple[float, float]


class CurveMotion(NamedTuple):
    """A point of the centreline and its rates."""

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
    """Factors of a point, dampings times the length of belt that it stands for, and those of the tangent."""

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

    Parameters
    ----------
    damping
        Factors.
    slope, bend, third : tuple of float
        Factors of the vectors in q, w and u.
    motion
        The point.
    work
        `gradient`, `by_square`, the derivative of the force by the square of the speed, and, with a tangent, `rows` and
        `by_flow` are changed; fields of `curve_scratch` and `curve_damping_scratch`.

    Returns
    -------
    tuple of 2 floats
        Powers lost in stretch and in bending, W.
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

"""Forces of a planar centreline whose energy density depends on G = q . q and c = q x w, with q = dr/dx, w = d2r/dx2.

The centreline is made of vectors of two components, in the order of the coordinates e: first those of node i, its place
before its derivatives, then as many of node j.

A point's force belongs to z = (q, w), and so does its tangent, which may have columns for u = d3r/dx3 too. Tangents are
summed in rows that are wider than the coordinates, so that inner loops run in whole vector registers.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel

_LANES = 16
"""Rows are padded to a multiple of this many numbers; loops over fewer are not taken by vector registers."""


class Density(NamedTuple):
    """First and second derivatives of an energy density, each times the length of belt that a point stands for."""

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

    Parameters
    ----------
    density
        Derivatives at the point.
    slope, bend : tuple of float
        Factors of the vectors in q and w.
    q, w : tuple of 2 floats
        Their values.
    wanted
        Whether the tangent is.
    work
        `gradient` and `rows` are changed; fields of `curve_scratch`.
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

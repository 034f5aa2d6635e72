"""Forces of a planar centreline whose energy density depends on G = q . q and c = q x w, with q = dr/dx, w = d2r/dx2.

The centreline is made of vectors of two components, in the order of the coordinates e: first those of node i, its place
before its derivatives, then as many of node j.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel


class Density(NamedTuple):
    """First and second derivatives of an energy density, each times the length of belt that a point stands for."""

    g: float
    c: float
    gg: float
    gc: float
    cc: float


def curve_scratch(vectors: int) -> dict[str, str]:
    """Fields of ``work`` for `add_density`, with the number of vectors: derivatives of G and c in the coordinates."""
    return {"of_metric": f"{2 * vectors}f8", "of_cross": f"{2 * vectors}f8"}


@kernel(inline=True)
def combine(e: FloatArray, factors: tuple[float, ...]) -> tuple[float, float]:
    """Sum of the vectors times factors; places enter by their difference, which costs fewer digits."""
    half = len(factors) // 2
    x, y = factors[half] * (e[2 * half] - e[0]), factors[half] * (e[2 * half + 1] - e[1])
    for a in range(1, half):
        x += factors[a] * e[2 * a] + factors[half + a] * e[2 * (half + a)]
        y += factors[a] * e[2 * a + 1] + factors[half + a] * e[2 * (half + a) + 1]
    return x, y


@kernel
def add_density(
    density: Density,
    slope: tuple[float, ...],
    bend: tuple[float, ...],
    q: tuple[float, float],
    w: tuple[float, float],
    wanted: bool,
    work: np.record,
) -> None:
    """Add a point's part of the elastic force and of its exact tangent.

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
        `gradient` and `tangent` are changed; fields of `curve_scratch`.
    """
    fill_slopes(slope, bend, q, w, work)
    for c in range(2 * len(slope)):
        work.gradient[c] += density.g * work.of_metric[c] + density.c * work.of_cross[c]
    if wanted:
        add_density_tangent(density, slope, bend, work)


@kernel(inline=True)
def fill_slopes(
    slope: tuple[float, ...], bend: tuple[float, ...], q: tuple[float, float], w: tuple[float, float], work: np.record
) -> None:
    """Overwrite the derivatives of G and c; arguments as for `add_density`."""
    of_metric, of_cross = work.of_metric, work.of_cross
    for a in range(len(slope)):
        of_metric[2 * a], of_metric[2 * a + 1] = 2.0 * slope[a] * q[0], 2.0 * slope[a] * q[1]
        of_cross[2 * a] = slope[a] * w[1] - bend[a] * q[1]
        of_cross[2 * a + 1] = bend[a] * q[0] - slope[a] * w[0]


@kernel
def add_density_tangent(density: Density, slope: tuple[float, ...], bend: tuple[float, ...], work: np.record) -> None:
    """Add a point's part of the tangent, with `fill_slopes` done before; arguments as for `add_density`."""
    of_metric, of_cross = work.of_metric, work.of_cross
    for row in range(2 * len(slope)):
        by_metric = density.gg * of_metric[row] + density.gc * of_cross[row]
        by_cross = density.gc * of_metric[row] + density.cc * of_cross[row]
        for column in range(2 * len(slope)):
            work.tangent[row, column] += by_metric * of_metric[column] + by_cross * of_cross[column]
    for a in range(len(slope)):
        for b in range(len(slope)):
            same = 2.0 * density.g * slope[a] * slope[b]
            turned = density.c * (slope[a] * bend[b] - bend[a] * slope[b])
            work.tangent[2 * a, 2 * b] += same
            work.tangent[2 * a, 2 * b + 1] += turned
            work.tangent[2 * a + 1, 2 * b] -= turned
            work.tangent[2 * a + 1, 2 * b + 1] += same

"""Quintic element: r, dr/dx and d2r/dx2 at the nodes, and sections that stay normal to the centerline (Eqs. 13, 14).

With q = dr/dx, w = d2r/dx2, G = q . q, c = q x w and the rate theta' = c / G at which the belt turns, the strain energy
is that of the paper's element without shear,

    U = integral of W(G) + EI alpha2 / 2 (3 G - 1) / 2 theta'^2 + E I4 alpha2 / 8 theta'^4 over the reference length,

with the energy W of the law of stretch.  The curvature is continuous from element to element.
"""

from functools import cache
from math import comb
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf import ANCF
from beltdyn.elements.kind import DampingFactors, ElementKind, Section
from beltdyn.elements.planar_curve import (
    CurveMotion,
    Density,
    PointDamping,
    add_curve_damping,
    add_density,
    begin_tangent,
    combine,
    curve_damping_scratch,
    curve_scratch,
    end_tangent,
)
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.quadrature import Quadrature, gauss_points
from beltdyn.stretch import stretching

Six = tuple[float, float, float, float, float, float]
_DEGREE = 5
"""Degree of the shape functions: three vectors at each end determine a polynomial of six coefficients."""
_ORDERS = np.array([0.0, 1.0, 2.0, 0.0, 1.0, 2.0])
"""Of the derivatives that the six vectors are."""
_COORDINATE_ORDERS = np.repeat(_ORDERS, 2)
"""Those of the twelve coordinates."""
_UNIT_CONTROL = np.array(
    [
        [1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.2, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.4, 0.05, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0, -0.4, 0.05],
        [0.0, 0.0, 0.0, 1.0, -0.2, 0.0],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    ]
)
"""Control points from the six vectors of an element of length 1."""


class Quintic(NamedTuple):
    """What the kernels get; e is r (m), r' and r'' (1/m) of node i, then of node j."""

    section: Section
    elastic: Quadrature


@kernel(inline=True)
def slopes(xi: float, length: float) -> Six:
    """Factors of the six vectors in q, at xi = x / L."""
    inverse = 1.0 / length
    chord = 30.0 * xi * xi * (1.0 - xi) * (1.0 - xi) * inverse
    return (
        -chord,
        1.0 - xi * xi * (18.0 - xi * (32.0 - 15.0 * xi)),
        length * xi * (1.0 - xi * (4.5 - xi * (6.0 - 2.5 * xi))),
        chord,
        -xi * xi * (12.0 - xi * (28.0 - 15.0 * xi)),
        length * xi * xi * (1.5 - xi * (4.0 - 2.5 * xi)),
    )


@kernel(inline=True)
def bends(xi: float, length: float) -> Six:
    """Factors of the six vectors in w, at xi = x / L."""
    inverse = 1.0 / length
    chord = 60.0 * xi * (1.0 - xi) * (1.0 - 2.0 * xi) * inverse * inverse
    return (
        -chord,
        -xi * (36.0 - xi * (96.0 - 60.0 * xi)) * inverse,
        1.0 - xi * (9.0 - xi * (18.0 - 10.0 * xi)),
        chord,
        -xi * (24.0 - xi * (84.0 - 60.0 * xi)) * inverse,
        xi * (3.0 - xi * (12.0 - 10.0 * xi)),
    )


@kernel(inline=True)
def thirds(xi: float, length: float) -> Six:
    """Factors of the six vectors in u = d3r/dx3, at xi = x / L."""
    inverse = 1.0 / length
    squared = inverse * inverse
    chord = 60.0 * (1.0 - xi * (6.0 - 6.0 * xi)) * inverse * squared
    return (
        -chord,
        -(36.0 - xi * (192.0 - 180.0 * xi)) * squared,
        -(9.0 - xi * (36.0 - 30.0 * xi)) * inverse,
        chord,
        -(24.0 - xi * (168.0 - 180.0 * xi)) * squared,
        (3.0 - xi * (24.0 - 30.0 * xi)) * inverse,
    )


class Bending(NamedTuple):
    """Energy of bending per reference length, J/m, and its derivatives in G and c."""

    energy: float
    g: float
    c: float
    gg: float
    gc: float
    cc: float


@kernel(inline=True)
def bending_of(section: Section, metric: float, cross: float) -> Bending:
    """Give (EI alpha2 / 2) (3 G - 1) / 2 theta'^2 + (E I4 alpha2 / 8) theta'^4 with theta' = c / G."""
    inverse = 1.0 / metric
    first, second, turning = section.bending, section.quartic, cross * inverse
    square, stiffer = turning * turning, 1.5 * metric - 0.5
    squared = inverse * inverse
    return Bending(
        square * (0.5 * first * stiffer + 0.125 * second * square),
        square * inverse * (first * (0.5 - 0.75 * metric) - 0.5 * second * square),
        turning * inverse * (first * stiffer + 0.5 * second * square),
        square * squared * (first * 1.5 * (metric - 1.0) + 2.5 * second * square),
        turning * squared * (first * (1.0 - 1.5 * metric) - 2.0 * second * square),
        squared * (first * stiffer + 1.5 * second * square),
    )


@kernel
def quintic_energy(element: Quintic, e: FloatArray, length: float) -> float:
    """Strain energy of an element; see `ElementKind.energy`."""
    total, points, weights = 0.0, element.elastic.points, element.elastic.weights
    for k in range(points.size):
        qx, qy = combine(e, slopes(points[k], length))
        wx, wy = combine(e, bends(points[k], length))
        metric, cross = qx * qx + qy * qy, qx * wy - qy * wx
        along = stretching(element.section.stretch, metric).energy
        total += weights[k] * length * (along + bending_of(element.section, metric, cross).energy)
    return total


@kernel
def quintic_force(element: Quintic, e: FloatArray, length: float, wanted: bool, work: np.record) -> None:
    """Elastic force of an element with its tangent; see `ElementKind.force`."""
    points, weights = element.elastic.points, element.elastic.weights
    work.gradient[:] = 0.0
    if wanted:
        work.tangent[:] = 0.0
        begin_tangent(work)
    for k in range(points.size):
        slope, bend = slopes(points[k], length), bends(points[k], length)
        q, w = combine(e, slope), combine(e, bend)
        weight, metric = weights[k] * length, q[0] * q[0] + q[1] * q[1]
        along = stretching(element.section.stretch, metric)
        across = bending_of(element.section, metric, q[0] * w[1] - q[1] * w[0])
        density = Density(
            weight * (along.slope + across.g),
            weight * across.c,
            weight * (along.curvature + across.gg),
            weight * across.gc,
            weight * across.cc,
        )
        add_density(density, slope, bend, q, w, wanted, work)
    if wanted:
        end_tangent(work)


def quintic_control(length: FloatArray | float) -> FloatArray:
    """Control points of the Bezier curve from the six vectors, shape (..., 1, 6, 6)."""
    return np.asarray(_UNIT_CONTROL * np.asarray(length)[..., None, None, None] ** _ORDERS)


def quintic_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrix, the integral of rho A S^T S, shape (..., 12, 12)."""
    each = np.asarray(length)[..., None]
    scale = each**_COORDINATE_ORDERS
    return np.asarray((section.mass * each * scale)[..., :, None] * scale[..., None, :] * _unit_mass())


@cache
def _unit_mass() -> FloatArray:
    """Integral of S^T S over an element of length 1, which six Gauss points take exactly, shape (12, 12)."""
    xi, weights = gauss_points(_DEGREE + 1)
    bernstein = np.array([comb(_DEGREE, k) * xi**k * (1.0 - xi) ** (_DEGREE - k) for k in range(_DEGREE + 1)])
    shape = np.sqrt(weights)[:, None] * (bernstein.T @ _UNIT_CONTROL)
    return np.kron(shape.T @ shape, np.eye(2))


@kernel
def quintic_damping(
    element: Quintic,
    e: FloatArray,
    velocity: FloatArray,
    length: float,
    factors: DampingFactors,
    work: np.record,
) -> tuple[float, float]:
    """Damping of the strains sqrt(G) - 1 and c / sqrt(G), as that of the paper's element; see `ElementKind.damping`.

    Hysteresis of bending takes the mean velocity of both ends for that of the belt.
    """
    section, points, weights = element.section, element.elastic.points, element.elastic.weights
    speed = 0.5 * (velocity[0] + velocity[6]), 0.5 * (velocity[1] + velocity[7])
    stretching, turning, square = 0.0, 0.0, speed[0] * speed[0] + speed[1] * speed[1]
    work.by_square[:] = 0.0
    wanted = factors.by_position != 0.0 or factors.by_velocity != 0.0
    if wanted:
        begin_tangent(work)
    for k in range(points.size):
        slope, bend, third = slopes(points[k], length), bends(points[k], length), thirds(points[k], length)
        q, w, u, weight = combine(e, slope), combine(e, bend), combine(e, third), weights[k] * length
        motion = CurveMotion(q, w, u, combine(velocity, slope), combine(velocity, bend))
        damping = PointDamping(
            weight * section.axial_damping,
            weight * section.bending_damping,
            weight * section.bending_hysteresis,
            section.passing_length,
            square,
            factors,
        )
        stretch, turn = add_curve_damping(damping, slope, bend, third, motion, work)
        stretching += stretch
        turning += turn
    if wanted:
        end_tangent(work)
        flow = speed[0] * (e[2] + e[8]) + speed[1] * (e[3] + e[9])
        for row in range(e.size):
            by_square = work.by_square[row]
            work.by_flow[row] += by_square * flow
            for axis in range(2):
                for node in range(2):
                    work.tangent[row, 6 * node + axis] += factors.by_velocity * by_square * speed[axis]
                    work.tangent[row, 6 * node + 2 + axis] += factors.by_flow * by_square * speed[axis]
    return stretching, turning


QUINTIC = register(
    ElementKind(
        name="quintic",
        meaning="a quintic centerline without shear, for smooth contact",
        element=Quintic,
        coordinates=("r_x", "r_y", "dr_x/dx", "dr_y/dx", "d2r_x/dx2", "d2r_y/dx2"),
        vectors=(0, 2, 4, 6, 8, 10),
        shift=(1.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        control=quintic_control,
        scale=lambda length: (1.0, 1.0, length, length, length**2, length**2),
        mass=quintic_mass,
        nodal=lambda place, slope, bend: np.hstack([place, slope, bend]),
        energy=quintic_energy,
        force=quintic_force,
        damping=quintic_damping,
        scratch=curve_scratch(6) | curve_damping_scratch(6),
        turned=2,
        bent_strain=ANCF.bent_strain,
    )
)

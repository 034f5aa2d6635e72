"""Cable element: a cubic centerline that stretches by the law of its belt and is bent by its curvature."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf import ANCF
from beltdyn.elements.ancf.element import bends, slopes
from beltdyn.elements.kind import ElementKind, Section
from beltdyn.elements.planar_curve import Density, add_density, begin_tangent, combine, curve_scratch, end_tangent
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.quadrature import Quadrature
from beltdyn.stretch import stretching


class Cable(NamedTuple):
    """What the kernels get; e is r (m) and r' of node i, then of node j."""

    section: Section
    elastic: Quadrature


@kernel
def cable_energy(element: Cable, e: FloatArray, length: float) -> float:
    """Strain energy of an element, J."""
    total, section, points = 0.0, element.section, element.elastic.points
    for k in range(points.size):
        qx, qy = combine(e, slopes(points[k], length))
        wx, wy = combine(e, bends(points[k], length))
        metric = qx * qx + qy * qy
        curvature = (qx * wy - qy * wx) / metric
        density = stretching(section.stretch, metric).energy + 0.5 * section.bending * curvature * curvature
        total += element.elastic.weights[k] * length * density
    return total


@kernel
def cable_force(element: Cable, e: FloatArray, length: float, wanted: bool, work: np.record) -> None:
    """Elastic force of an element with its tangent."""
    points, weights = element.elastic.points, element.elastic.weights
    work.gradient[:] = 0.0
    if wanted:
        work.tangent[:] = 0.0
        begin_tangent(work)
    for k in range(points.size):
        slope, bend = slopes(points[k], length), bends(points[k], length)
        q, w = combine(e, slope), combine(e, bend)
        weight, bending = weights[k] * length, weights[k] * length * element.section.bending
        metric = q[0] * q[0] + q[1] * q[1]
        curvature = (q[0] * w[1] - q[1] * w[0]) / metric
        along = stretching(element.section.stretch, metric)
        density = Density(
            weight * along.slope - bending * curvature * curvature / metric,
            bending * curvature / metric,
            weight * along.curvature + 3.0 * bending * (curvature / metric) ** 2,
            -2.0 * bending * curvature / metric**2,
            bending / metric**2,
        )
        add_density(density, slope, bend, q, w, wanted, work)
    if wanted:
        end_tangent(work)


def cable_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrices of the centerline, shape (..., 8, 8): those of the paper's element without sections."""
    centreline = np.array([0, 1, 2, 3, 6, 7, 8, 9])
    return ANCF.mass(section, length)[..., centreline[:, None], centreline]


CABLE = register(
    ElementKind(
        name="cable",
        meaning="for comparison a cubic centerline without shear",
        element=Cable,
        coordinates=("r_x", "r_y", "dr_x/dx", "dr_y/dx"),
        vectors=(0, 2, 4, 6),
        shift=(1.0, 0.0, 1.0, 0.0),
        control=ANCF.control,
        scale=lambda length: (1.0, 1.0, length, length),
        mass=cable_mass,
        nodal=lambda place, slope, _bend: np.hstack([place, slope]),
        energy=cable_energy,
        force=cable_force,
        scratch=curve_scratch(4),
        turned=2,
    )
)

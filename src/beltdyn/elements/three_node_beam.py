"""Three-node beam element of Leamy and Wasfy: two straight links, and torsional springs between links.

A node has the places of two points. The element between the points p0, p1 of a node and p2, p3 of the next consists of
the links p0-p1 and p1-p2 and of the springs at p1 and p2, so that elements put together make the whole belt.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import ElementKind
from beltdyn.elements.section import Section
from beltdyn.elements.torsional_spring import add_spring, spring_energy
from beltdyn.elements.truss import add_link, link_cubic_angle, link_energy
from beltdyn.kernel import kernel
from beltdyn.quadrature import Quadrature

LINKS = 2
"""Links of an element."""


class ThreeNodeBeam(NamedTuple):
    """What the kernels of three-node beam elements get."""

    section: Section
    elastic: Quadrature


@kernel
def beam_energy(beam: ThreeNodeBeam, e: FloatArray, length: float) -> float:
    """Strain energy of an element; see `ElementKind.energy`."""
    link, total = length / LINKS, 0.0
    for k in range(LINKS):
        total += link_energy(e, 2 * k, beam.section.stretch, link)
        total += spring_energy(e, 2 * k, beam.section.bending / link)
    return total


@kernel
def beam_force(beam: ThreeNodeBeam, e: FloatArray, length: float, _wanted: bool, work: np.record) -> None:
    """Elastic force of an element with its tangent; see `ElementKind.force`."""
    work.gradient[:] = 0.0
    work.tangent[:] = 0.0
    link = length / LINKS
    for k in range(LINKS):
        add_link(e, 2 * k, beam.section.stretch, link, work.gradient, work.tangent)
        add_spring(e, 2 * k, beam.section.bending / link, work.gradient, work.tangent)


def lumped_mass(section: Section, length: FloatArray | float) -> FloatArray:
    """Mass matrix of two links, half of the mass of each at its ends and none at p3, shape (..., 8, 8), kg."""
    at_points = np.diag(np.repeat([0.5, 1.0, 0.5, 0.0], 2))
    return np.asarray(section.mass / LINKS * np.asarray(length)[..., None, None] * at_points)


def _control(length: FloatArray | float) -> FloatArray:
    """Control points of both links from p0, p1 and p2, shape (..., 2, 2, 3)."""
    both = np.array([[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]])
    return np.broadcast_to(both, (*np.shape(length), *both.shape))


THREE_NODE_BEAM = ElementKind(
    name="three-node-beam",
    meaning="pairs of links with torsional springs, for comparison",
    element=ThreeNodeBeam,
    coordinates=("r_x", "r_y"),
    points=LINKS,
    vectors=(0, 2, 4),
    shift=(1.0, 1.0, 1.0),
    control=_control,
    scale=lambda _length: (1.0,) * (2 * LINKS),
    mass=lumped_mass,
    nodal=lambda place, _slope, _bend: place.reshape(-1, 2 * LINKS),
    energy=beam_energy,
    force=beam_force,
    has_ends=False,
    cubic_angle=lambda angle: link_cubic_angle(angle / LINKS),
)

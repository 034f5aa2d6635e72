"""How a belt is cut into elements: the paper's element, or pieces of three links of a chain."""

from typing import NamedTuple

import numpy as np

from beltdyn.ancf.inertia import element_mass
from beltdyn.ancf.section import Section
from beltdyn.arrays import FloatArray
from beltdyn.chain.chain_force import LINKS
from beltdyn.chain.inertia import lumped_mass
from beltdyn.model import Belt
from beltdyn.system.arrays import System


class Discretization(NamedTuple):
    """Fields of `System` that depend on the discretisation; see there."""

    chain: bool
    points: int
    scale: tuple[float, ...]
    length: FloatArray
    mass: FloatArray
    vectors: tuple[int, int, int, int]
    shift: tuple[float, float, float, float]
    control: FloatArray


def discretize(belt: Belt, section: Section) -> Discretization:
    """Cut a belt into equal elements.

    Parameters
    ----------
    belt
        The belt.
    section
        Its section.

    Returns
    -------
    Discretization
        The element of section 2 of the paper, or pieces of chain: links are grouped by three, since the places of three
        points are as many coordinates as those of a node of the paper.
    """
    if belt.discretization == "ancf":
        length = belt.length / belt.elements
        return Discretization(
            chain=False,
            points=1,
            scale=(1.0, 1.0, length, length, length, length),
            length=np.full(belt.elements, length),
            mass=np.tile(element_mass(section, length), (belt.elements, 1, 1)),
            vectors=(0, 2, 6, 8),
            shift=(1.0, 0.0, 1.0, 0.0),
            control=np.tile(_hermite_control(length), (belt.elements, 1, 1, 1)),
        )
    pieces = belt.links // LINKS
    length = belt.length / pieces
    return Discretization(
        chain=True,
        points=LINKS,
        scale=(1.0,) * 6,
        length=np.full(pieces, length),
        mass=np.tile(lumped_mass(section.mass, length), (pieces, 1, 1)),
        vectors=(0, 2, 4, 6),
        shift=(1.0, 1.0, 1.0, 1.0),
        control=np.tile(_straight_control(), (pieces, 1, 1, 1)),
    )


def curve_lengths(system: System) -> FloatArray:
    """Reference lengths of the curves of the centreline along the belt, m, shape (elements * curves,)."""
    curves = system.control.shape[1]
    return np.repeat(system.length / curves, curves)


def point_coordinates(system: System) -> FloatArray:
    """Belt coordinates of the material points of all nodes in the unstretched belt, m, shape (N * points,)."""
    ends = np.concatenate([[0.0], np.cumsum(curve_lengths(system))])
    return ends[: system.nodes * system.points]


def nodal_coordinates(system: System, place: FloatArray, slope: FloatArray) -> FloatArray:
    """Nodal coordinates of a centreline whose sections stand upright on it.

    Parameters
    ----------
    system
        The system.
    place : ndarray, shape (N * points, 2)
        Places of the material points, m.
    slope : ndarray, shape (N * points, 2)
        dr/dx there.

    Returns
    -------
    ndarray, shape (N, 6)
    """
    if system.chain:
        return place.reshape(system.nodes, -1)
    normal = np.stack([-slope[:, 1], slope[:, 0]], axis=1)
    return np.hstack([place, slope, normal / np.linalg.norm(slope, axis=1, keepdims=True)])


def _hermite_control(length: float) -> FloatArray:
    """Control points of a cubic Hermite curve from r_i, r_x,i, r_j, r_x,j, shape (1, 4, 4)."""
    third = length / 3.0
    return np.array([[[1, 0, 0, 0], [1, third, 0, 0], [0, 0, 1, -third], [0, 0, 1, 0]]], dtype=float)


def _straight_control() -> FloatArray:
    """Control points of three straight links from the places of their four ends, shape (3, 4, 4)."""
    along = np.linspace(0.0, 1.0, 4)
    control = np.zeros((LINKS, 4, 4))
    for link in range(LINKS):
        control[link, :, link], control[link, :, link + 1] = 1.0 - along, along
    return control

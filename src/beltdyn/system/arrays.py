"""What the kernels of the system work on: named tuples of arrays and scalars, nothing else.

The state of a system with N nodes and P pulleys is the vector of 6 N nodal coordinates followed by P pulley angles;
velocities and accelerations are ordered alike.  Elements couple a node with the next one only, and the centreline of
an element is made of one or several curves; beyond that the system does not ask how a belt is discretised.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltdyn.ancf.section import Section
from beltdyn.contact.law import ContactLaw

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

NODE = 6
"""Coordinates of a node: r, r_x, r_y (Eq. 6), or the places of three points of a chain of links."""


class Quadrature(NamedTuple):
    """Points and weights on [0, 1]."""

    points: FloatArray
    weights: FloatArray


class Pulleys(NamedTuple):
    """The P pulleys as arrays."""

    center: FloatArray
    """m, shape (P, 2)."""
    radius: FloatArray
    """m, shape (P,)."""
    inertia: FloatArray
    """kg m^2, shape (P,)."""
    unknown: IntArray
    """Place among the free pulleys, -1 where the speed is prescribed; shape (P,)."""
    profile_first: IntArray
    """First segment of each pulley's profile (speed if prescribed, torque if free), shape (P + 1,)."""
    profile_start: FloatArray
    """Instants from which the segments hold, s, shape (S,)."""
    profile: FloatArray
    """c0, c1, amplitude, omega, phase of each segment, shape (S, 5)."""


class Supports(NamedTuple):
    """What holds and loads the nodes of a belt beside its pulleys."""

    fixed: NDArray[np.bool_]
    """Coordinates that do not move, shape (6 N,)."""
    any_fixed: bool
    force: FloatArray
    """Constant generalised forces on the nodal coordinates, shape (6 N,)."""
    moment: FloatArray
    """Constant moments that turn the section r_y of a node, N m, shape (N,)."""


class System(NamedTuple):
    """A belt, its pulleys and what acts on them."""

    nodes: int
    closed: bool
    """Whether the last element ends at the first node (Eq. 27)."""
    joint: bool
    """Whether the last node is tied to the first by Lagrange multipliers (Eq. 25)."""
    chain: bool
    """Whether an element is a piece of chain (`beltdyn.chain`), or the paper's (`beltdyn.ancf`)."""
    points: int
    """Material points whose places are the first coordinates of a node: 1, or 3 of a chain."""
    scale: FloatArray
    """Lengths that turn changes of the coordinates of a node into m, shape (6,)."""
    length: FloatArray
    """Reference lengths of the elements, m, shape (elements,)."""
    mass: FloatArray
    """Mass matrices of the elements, shape (elements, 12, 12)."""
    vectors: tuple[int, int, int, int]
    """Where among the 12 coordinates of an element the four vectors begin that carry its centreline."""
    control: FloatArray
    """Control points of the curves of the centreline from these vectors, shape (elements, curves, 4, 4)."""
    section: Section
    elastic: Quadrature
    law: ContactLaw
    contact: Quadrature
    pulleys: Pulleys
    supports: Supports


class RingScratch(NamedTuple):
    """Arrays in which `solve_ring` works; b is the border with the node that a closed ring moves there."""

    rows: FloatArray
    """Rows of the node in hand, shape (6, width)."""
    panels: FloatArray
    """Eliminated rows of every node: block towards the next node, columns of the border, right-hand side, padding;
    shape (N, 6, width)."""
    dense: FloatArray
    """What elimination leaves of the border, shape (b, b)."""
    answer: FloatArray
    """Its right-hand side, then its solution, shape (b, 1)."""


class RingMatrix(NamedTuple):
    """A block-tridiagonal matrix, cyclic for a closed belt, with a border of m unknowns, and a right-hand side."""

    diagonal: FloatArray
    """Shape (N, 6, 6)."""
    upper: FloatArray
    """Row k, column k + 1 (cyclic), shape (N, 6, 6)."""
    lower: FloatArray
    """Row k + 1 (cyclic), column k, shape (N, 6, 6)."""
    column: FloatArray
    """Rows of the nodes, columns of the border, shape (N, 6, m)."""
    row: FloatArray
    """Rows of the border, columns of the nodes, shape (N, m, 6)."""
    corner: FloatArray
    """Shape (m, m)."""
    node_side: FloatArray
    """Right-hand side of the nodes, shape (N, 6)."""
    border_side: FloatArray
    """Right-hand side of the border, shape (m,)."""
    scratch: RingScratch


class Loads(NamedTuple):
    """What the pulleys feel and what the energy account needs, at one state."""

    moment: FloatArray
    """Moment of the belt on each pulley, N m, shape (P,)."""
    hub: FloatArray
    """Force of the belt on each pulley, N, shape (P, 2)."""
    shaft: FloatArray
    """Torque on each pulley from outside: the load, or the driver's reaction, N m, shape (P,)."""
    power: FloatArray
    """Powers in the order of `POWERS`, W, shape (4,)."""
    penalty: FloatArray
    """Energy in the penalty springs, J, shape (1,)."""


POWERS = ("driver_work", "torque_work", "friction_loss", "damping_loss")
"""Powers integrated over time by a run, by the name of their integral."""

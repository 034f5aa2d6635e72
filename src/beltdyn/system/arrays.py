"""What the kernels of the system work on: named tuples of arrays and scalars, nothing else.

The state of a system with N nodes is the vector of n N nodal coordinates, n to a node (six of the paper's element),
followed by D coordinates of bodies: the angles of the P rims, those of the bodies behind the rims in hub chains, the
states of controllers, and the places of a carriage or of tensioners.  Velocities and accelerations are ordered alike.
Elements couple a node with the next one only, and the centerline of an element is made of one or several curves; beyond
that the system does not ask how a belt is discretized.
"""

from typing import Any, Final, NamedTuple

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray, IntArray, Records, record
from beltdyn.contact.law import ContactLaw
from beltdyn.contact.surface import MeshingRims, PolygonRims, RoundRims, ShapedRims, ToothedRims
from beltdyn.elements import Element
from beltdyn.machines.loads.shaft import ShaftLoads
from beltdyn.machines.profiles.functions import Profiles
from beltdyn.quadrature import Quadrature

PULLEY = record(
    center="2f8",  # m; where a tensioner carries the pulley, its place at coordinate zero
    radius="f8",  # effective radius, at which the belt's centerline runs, m
    friction="f8",  # coefficient of friction
    rolling="f8",  # coefficient of rolling resistance
    shaft="i8",  # body that drivers and loads act on: the rim, or the last body of its hub chain
    carrier="i8",  # tensioner that carries the pulley, -1 where its center is fixed
    foundation="f8",  # stiffness of contact over that without a cover
    damping="f8",  # damping over stiffness of contact against that of the law
    lossy="i8",  # whether the damper stands for hysteresis of covers and belt
    rim_ratio="f8",  # radius at which the tension line rolls off over the effective radius
    cord="f8",  # 1 where slip is taken at the radius of the cord, else 0
    hertz="f8",  # penetration of solid rollers of a nip over the square of the line force, m^3/N^2
    lasting="f8",  # compression of the belt that stays behind a nip, m
    unloading="f8",  # stiffness of contact where the belt leaves a nip over that where it is pressed
    beside="i8",  # 1 of the roller of a nip, on which the belt does not lie, else 0
)
"""A pulley."""

BODY = record(
    inertia="f8",  # kg m^2, or kg of a sliding tensioner; the lag of a controller's state, s
    kinetic="f8",  # inertia that has kinetic energy: the same, but zero of a controller's state
    unknown="i8",  # place in the border of the ring's matrix, -1 where the motion is prescribed
    reach="f8",  # what turns a change of the coordinate into a length of belt: a radius or an arm in m, or 1
)
"""A body beside the belt: first come the rims, then bodies of hub chains, states of controllers, tensioners."""


class Supports(NamedTuple):
    """What holds and loads the nodes of a belt beside its pulleys."""

    fixed: BoolArray
    """Coordinates that do not move, shape (n N,)."""
    any_fixed: bool
    force: FloatArray
    """Constant generalized forces on the nodal coordinates, weight among them, shape (n N,)."""
    moment: FloatArray
    """Constant moments that turn the section r_y of a node, N m, shape (N,)."""


class NoCarriage(NamedTuple):
    """No carriage holds the ends of the belt."""

    none: float = 0.0
    """Zero."""


class Bare(NamedTuple):
    """A belt that nothing carries between its pulleys."""

    rows: int = 0


class Carrying(NamedTuple):
    """Supports along spans, and goods on them, of a belt on a staying mesh."""

    supports: Records
    """Rows of `SUPPORT`."""
    goods: Records
    """Rows of `GOODS`."""
    first_support: IntArray
    """Where the supports of an element begin in `support`, shape (elements + 1,)."""
    support: IntArray
    """Numbers of the supports of one element after the other."""
    first_goods: IntArray
    """As for supports."""
    on_element: IntArray
    """Numbers of the goods of one element after the other."""
    gravity: FloatArray
    """m/s^2, shape (2,)."""
    rule: Quadrature


class System(NamedTuple):
    """A belt, its pulleys and what acts on them."""

    nodes: int
    closed: bool
    """Whether the last element ends at the first node (Eq. 27)."""
    joint: bool
    """Whether the last node is tied to the first by Lagrange multipliers (Eq. 25)."""
    element: Element
    """Section and quadrature; its class is the kind of elements, `ElementKind.element`."""
    points: int
    """Material points of a node."""
    scale: tuple[float, ...]
    """Lengths that turn changes of the n coordinates of a node into m; of a tuple the compiler knows how many."""
    first_body: int
    """Place of the first body in a state, after the nodes: n N."""
    length: FloatArray
    """Reference lengths of the elements, m, shape (elements,)."""
    mass: FloatArray
    """Mass matrices of the elements, shape (elements, 2 n, 2 n)."""
    vectors: tuple[int, ...]
    """Where among the 2 n coordinates of an element the v vectors begin that carry its centerline."""
    shift: tuple[float, ...]
    """What a shift of the whole belt does to these vectors: 1 for places, 0 for derivatives."""
    control: FloatArray
    """Control points of the curves of the centerline from these vectors, shape (elements, curves, degree + 1, v)."""
    turned: int
    """Coordinate of a node with which the vector begins that a moment on the node turns; -1 if none does."""
    hysteresis: Records
    """Rows of `hysteresis_record`, shape (elements,); none without loss factors."""
    law: ContactLaw
    contact: Quadrature
    pulleys: Records
    """Rows of `PULLEY`, shape (P,)."""
    rims: RoundRims | ShapedRims | ToothedRims | PolygonRims | MeshingRims
    """Surfaces of the pulleys; the type says whether all of them are round, and whether some have teeth."""
    bodies: Records
    """Rows of `BODY`, shape (D,)."""
    profiles: Profiles
    shaft_loads: ShaftLoads
    links: Records
    """Rows of `LINK`, shape (L,)."""
    tensioners: Records
    """Rows of `TENSIONER`, shape (K,)."""
    supports: Supports
    frame: Any
    """How the mesh stands to the belt: `frame.Travelling` or `frame.Staying`."""
    carriage: Any = NoCarriage()
    """What holds both ends of an open belt: `NoCarriage` or `guide.Guided`."""
    carrying: Bare | Carrying = Bare()
    """What carries the belt between pulleys, and what it carries; the type says whether there is any."""


class Motion(NamedTuple):
    """A state of a system at an instant, and its rates; each vector has shape (n N + D,)."""

    time: float
    """s."""
    position: FloatArray
    """Nodal coordinates (m and 1), then coordinates of bodies (rad and m)."""
    velocity: FloatArray
    acceleration: FloatArray


class TangentFactors(NamedTuple):
    """A tangent is the sum of these times the derivatives with respect to position, velocity and acceleration.

    That is what an integrator needs whose unknown moves all three; with all of them zero no tangent is wanted.
    """

    by_position: float = 0.0
    """1."""
    by_velocity: float = 0.0
    """1/s."""
    by_acceleration: float = 0.0
    """1/s^2."""
    secant: bool = False
    """Friction changes by its secant from no slip, in place of its slope: as a first guess may slide where the solution
    sticks."""


NO_TANGENT: Final = TangentFactors()


class RingFactors(NamedTuple):
    """Factors of a `RingMatrix`; b is the border with the node that a closed ring moves there."""

    rows: FloatArray
    """Rows of the node in hand, shape (n, width)."""
    panels: FloatArray
    """What the inner nodes answer to each column of the border, after n columns that are worked in; padded, shape
    (N, n, width)."""
    squares: FloatArray
    """Triangular factors of the nodes' blocks, shape (N, n, n)."""
    pivots: IntArray
    """Rows exchanged in them, shape (N, n)."""
    links: FloatArray
    """Part of the next node's unknowns in those of a node, shape (N, n, n)."""
    dense: FloatArray
    """Triangular factors of what elimination leaves of the border, shape (b, b)."""
    dense_pivots: IntArray
    """Shape (b,)."""
    no_columns: FloatArray
    """Shape (b, 0): nothing is solved for along with the border."""
    answer: FloatArray
    """Right-hand side, then solution of the border, shape (b,)."""


class RingMatrix(NamedTuple):
    """A block-tridiagonal matrix, cyclic for a closed belt, with a border of m unknowns, and a right-hand side."""

    unknowns: tuple[int, ...]
    """Numbers of the n unknowns of a node, 0 to n - 1; of a tuple the compiler knows how many."""
    diagonal: FloatArray
    """Shape (N, n, n)."""
    upper: FloatArray
    """Row k, column k + 1 (cyclic), shape (N, n, n)."""
    lower: FloatArray
    """Row k + 1 (cyclic), column k, shape (N, n, n)."""
    column: FloatArray
    """Rows of the nodes, columns of the border, shape (N, n, m)."""
    row: FloatArray
    """Rows of the border, columns of the nodes, shape (N, m, n)."""
    corner: FloatArray
    """Shape (m, m)."""
    node_side: FloatArray
    """Right-hand side of the nodes, shape (N, n)."""
    border_side: FloatArray
    """Right-hand side of the border, shape (m,)."""
    factors: RingFactors


class BodyForces(NamedTuple):
    """What the bodies feel and what the energy account needs, at one state.

    A history of k states has one row for each in every array: see `body_forces.body_forces_history`.
    """

    moment: FloatArray
    """Moment of the belt on each pulley, N m, shape (P,)."""
    hub: FloatArray
    """Force of the belt on each pulley, N, shape (P, 2)."""
    friction: FloatArray
    """Power lost in friction on each pulley, W, shape (P,)."""
    damping: FloatArray
    """Power lost in the contact dampers of each pulley, W, shape (P,)."""
    shaft: FloatArray
    """Torque on each shaft from outside: the load, or the driver's reaction, N m, shape (P,)."""
    force: FloatArray
    """Generalized force on each body, but the driver's reaction; N m, or N on a sliding tensioner; shape (D,)."""
    power: FloatArray
    """Powers in the order of `POWERS`, W, shape (10,)."""
    stored: FloatArray
    """Energy in the penalty springs, and in the springs of hub chains and tensioners, J, shape (2,)."""


class Equations(NamedTuple):
    """Linearized equations of motion with their solution, and the body forces of the state that they belong to."""

    matrix: RingMatrix
    """Tangent, and the residual as right-hand side."""
    node_part: FloatArray
    """Solution for the nodes, shape (N, n)."""
    border_part: FloatArray
    """Solution for the free bodies and the multipliers, shape (m,)."""
    forces: BodyForces
    work: np.record
    """Scratch arrays, from `element_workspace`."""


POWERS = (
    "driver_work",
    "torque_work",
    "friction_loss",
    "damping_loss",
    "stretch_loss",
    "bending_loss",
    "compression_loss",
    "tensioner_loss",
    "coupling_loss",
    "carrying_loss",
)
"""Powers integrated over time by a run, by the name of their integral."""

ENERGY_WORKS = (*POWERS, "numerical_loss")
"""Their integrals, and what the damping of the time integrator takes."""

DRIVER_WORK, TORQUE_WORK, FRICTION_LOSS, DAMPING_LOSS, STRETCH_LOSS, BENDING_LOSS = range(6)
COMPRESSION_LOSS, TENSIONER_LOSS, COUPLING_LOSS, CARRYING_LOSS = range(6, len(POWERS))
NUMERICAL_LOSS = len(POWERS)
"""Places of the works in these orders, and of their powers."""

PENALTY_ENERGY, SPRING_ENERGY = range(2)
"""Places in `BodyForces.stored`."""

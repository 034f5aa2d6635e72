"""One element at a state: coordinates, centerline, losses, and what it adds to its nodes; supports of nodes."""

import numpy as np

from beltdyn.arrays import FloatArray, blank, record
from beltdyn.contact.contact_force import contact_record
from beltdyn.contact.contact_zone import Curve, out_of_reach
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import element_start
from beltdyn.elements import damping_force
from beltdyn.elements.kind import DampingFactors, is_damped
from beltdyn.kernel import kernel
from beltdyn.system.arrays import BENDING_LOSS, STRETCH_LOSS, Bare, BodyForces, RingMatrix, System, TangentFactors
from beltdyn.system.frame import Travelling, add_flow, flow_record
from beltdyn.system.material_loss import add_hysteresis, hysteresis_scratch
from beltdyn.system.moving_center import drift_record
from beltdyn.system.state import element_kind


def element_workspace(system: System) -> np.record:
    """Make the scratch arrays for one element after the other of a system."""
    count, vectors = system.control.shape[2:]
    own = flow_record(system.frame, vectors, 2 * len(system.scale))
    flow = {} if isinstance(system.frame, Travelling) else {"flow": own}
    carrying = {} if isinstance(system.carrying, Bare) else {"carrying": carrying_record(count, vectors)}
    return blank(
        record(
            **flow,
            element=element_kind(system).workspace,  # residual and tangent of one element
            contact=contact_record(count, vectors),
            coordinates=f"(3,{2 * len(system.scale)})f8",  # position, velocity and acceleration of one element
            control=f"({count},2)f8",  # control points of a curve of the centerline
            control_velocity=f"({count},2)f8",
            hysteresis=hysteresis_scratch(vectors),
            drift=drift_record(vectors),  # by a change of the velocity of a pulley's center
            **carrying,
        )
    )


def carrying_record(count: int, vectors: int) -> np.dtype[np.void]:
    """Kind of the scratch arrays of supports and goods."""
    return record(
        weights=f"({count},)f8",  # of control points
        functions=f"({vectors},)f8",  # shape functions and their derivatives over the belt coordinate
        rates=f"({vectors},)f8",
        bends=f"({vectors},)f8",
        force="(2,)f8",  # of a meter of span, N/m
        by_place="(2,2)f8",
        by_rate="(2,2)f8",  # by the velocity of the mesh
        by_speed="f8",  # of the resistance, by the velocity along the span
    )


@kernel(inline=True)
def gather(system: System, element: int, vector: FloatArray, coordinates: FloatArray) -> None:
    """Coordinates of an element from those of its nodes.

    `vector`: positions, velocities or accelerations, shape (n N + D,); `coordinates`: shape (2 n,).
    """
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for c in range(dof):
        coordinates[c] = vector[dof * element + c]
        coordinates[dof + c] = vector[dof * node_j + c]


@kernel(inline=True)
def gather_motion(
    system: System, element: int, position: FloatArray, velocity: FloatArray, coordinates: FloatArray
) -> None:
    """Coordinates of an element and their rates, those of its material points.

    `position`, `velocity`: shape (n N + D,); `coordinates`: the first two rows are overwritten, shape (3, 2 n).
    """
    gather(system, element, position, coordinates[0])
    gather(system, element, velocity, coordinates[1])
    add_flow(system.frame, element, system.vectors, velocity, coordinates[0], coordinates[1])


@kernel(inline=True)
def add_material_damping(
    system: System, element: int, factors: TangentFactors, work: np.record, forces: BodyForces
) -> None:
    """Add damping and hysteresis of the belt to the residual and tangent of an element, and their losses to the powers.

    `factors`: of the derivatives in the tangent; `work`: from `element_workspace`, with the coordinates of the element
    and their rates; `forces`: changed in place.
    """
    if loses_in_belt(system):
        by = DampingFactors(factors.by_position, factors.by_velocity, 0.0, factors.secant)
        stretch, bending = material_forces(system, element, by, work)
        forces.power[STRETCH_LOSS] += stretch
        forces.power[BENDING_LOSS] += bending


@kernel(inline=True)
def loses_in_belt(system: System) -> bool:
    """Whether the belt's material has damping or hysteresis."""
    return is_damped(system.element.section) or system.hysteresis.size > 0


@kernel
def material_forces(system: System, element: int, factors: DampingFactors, work: np.record) -> tuple[float, float]:
    """Add damping and hysteresis of the belt to the residual of an element, and their tangent.

    `factors`: of the tangent; hysteresis of the whole element has its part by the flow from `add_hysteresis_flow`;
    `work`: from `element_workspace`, with the coordinates of the element and their rates. Returns powers lost in
    stretch and in bending, W.
    """
    stretch, bending = 0.0, 0.0
    if is_damped(system.element.section):
        e, velocity, length = work.coordinates[0], work.coordinates[1], system.length[element]
        stretch, bending = damping_force(system.element, e, velocity, length, factors, work.element)
    if system.hysteresis.size > 0:
        own, by_position, by_velocity = system.hysteresis[element], factors.by_position, factors.by_velocity
        more = add_hysteresis(own, system.vectors, by_position, by_velocity, work)
        stretch, bending = stretch + more[0], bending + more[1]
    return stretch, bending


@kernel(inline=True)
def centreline(system: System, element: int, curve: int, work: np.record) -> Curve:
    """A curve of the centerline of an element.

    `element`, `curve`: which curve of which element; `work`: from `element_workspace`, with the coordinates of the
    element; the control points are written into it, and their velocities by `move_centreline` or `reaches`. Returns
    valid until `work` is used for the next curve.
    """
    fill_control(system, element, curve, work.coordinates[0], work.control)
    length = system.length[element] / system.control.shape[1]
    start = element_start(system.rims, element) + curve * length
    return Curve(work.control, work.control_velocity, system.control[element, curve], length, start)


@kernel(inline=True)
def move_centreline(system: System, element: int, curve: int, work: np.record) -> None:
    """Velocities of the control points of a curve from `centreline`, whose element has its rates in `work`."""
    fill_control(system, element, curve, work.coordinates[1], work.control_velocity)


@kernel(inline=True)
def reaches(system: System, element: int, curve: int, pulley: PulleyState, work: np.record) -> bool:
    """Whether a curve from `centreline` may touch a pulley; then its control points have their velocities too."""
    if out_of_reach(work.control, pulley):
        return False
    move_centreline(system, element, curve, work)
    return True


@kernel
def fill_control(system: System, element: int, curve: int, coordinates: FloatArray, points: FloatArray) -> None:
    """Control points of a curve of the centerline from the coordinates of its element.

    `element`, `curve`: which curve of which element; `coordinates`: nodal coordinates (or velocities) of the element,
    shape (2 n,); `points`: shape (n, 2).
    """
    control, vectors = system.control[element, curve], system.vectors
    for a in range(points.shape[0]):
        x = y = 0.0
        for b in range(len(vectors)):
            x += control[a, b] * coordinates[vectors[b]]
            y += control[a, b] * coordinates[vectors[b] + 1]
        points[a, 0], points[a, 1] = x, y


# What an element adds to the equations of its nodes, and of the pulleys that it touches


@kernel(inline=True)
def take_contact(system: System, wanted: bool, work: np.record) -> None:
    """Take contact force and tangent off the residual and tangent of the element."""
    contact, gradient, tangent = work.contact, work.element.gradient, work.element.tangent
    for a in range(len(system.vectors)):
        row = system.vectors[a]
        gradient[row] -= contact.force[a, 0]
        gradient[row + 1] -= contact.force[a, 1]
        if not wanted:
            continue
        for b in range(len(system.vectors)):
            column = system.vectors[b]
            tangent[row, column] -= contact.xx[a, b]
            tangent[row, column + 1] -= contact.xy[a, b]
            tangent[row + 1, column] -= contact.yx[a, b]
            tangent[row + 1, column + 1] -= contact.yy[a, b]


@kernel(inline=True)
def couple_rim(system: System, element: int, unknown: int, contact: np.record, matrix: RingMatrix) -> None:
    """Coupling of the element with angle and speed of a free pulley."""
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    for a in range(len(system.vectors)):
        first = system.vectors[a]
        node, c = (element, first) if first < dof else (node_j, first - dof)
        for axis in range(2):
            matrix.column[node, c + axis, unknown] -= contact.by_turn[a, axis]
            matrix.row[node, unknown, c + axis] -= contact.moment[a, axis]


@kernel(inline=True)
def scatter(system: System, element: int, wanted: bool, work: np.record, matrix: RingMatrix) -> None:
    """Add residual and tangent of the element to those of its nodes i and j."""
    i, j = element, (element + 1) % system.nodes
    dof, gradient, tangent = len(matrix.unknowns), work.element.gradient, work.element.tangent
    for row in range(dof):
        matrix.node_side[i, row] += gradient[row]
        matrix.node_side[j, row] += gradient[dof + row]
        if not wanted:
            continue
        for column in range(dof):
            matrix.diagonal[i, row, column] += tangent[row, column]
            matrix.upper[i, row, column] += tangent[row, dof + column]
            matrix.lower[i, row, column] += tangent[dof + row, column]
            matrix.diagonal[j, row, column] += tangent[dof + row, dof + column]


@kernel
def add_nodal_loads(system: System, position: FloatArray, by_position: float, matrix: RingMatrix) -> None:
    """Take constant forces and moments off the residual.

    A moment m turns a vector d of its node, r_y of the paper's element: its work is m dphi with phi the direction of
    d, so that it acts on d with m n / |d|, n normal to d.  (On r_x it would be a couple of opposite shears within one
    element, which grows with every refinement of the mesh, since the energy holds s but not its jumps.)

    `system`: with its supports; `position`: nodal coordinates first, shape (n N + D,); `by_position`: factor of the
    derivative with respect to position in the tangent; `matrix`: right-hand side and tangent, changed in place.
    """
    supports, dof = system.supports, len(system.scale)
    for node in range(system.nodes):
        for c in range(dof):
            matrix.node_side[node, c] -= supports.force[dof * node + c]
        moment = supports.moment[node]
        if moment != 0.0:
            c, first = system.turned, dof * node + system.turned
            x, y = position[first], position[first + 1]
            square = x * x + y * y
            matrix.node_side[node, c] += moment * y / square
            matrix.node_side[node, c + 1] -= moment * x / square
            factor = by_position * moment / (square * square)
            matrix.diagonal[node, c, c] -= 2.0 * factor * x * y
            matrix.diagonal[node, c, c + 1] += factor * (x * x - y * y)
            matrix.diagonal[node, c + 1, c] += factor * (x * x - y * y)
            matrix.diagonal[node, c + 1, c + 1] += 2.0 * factor * x * y


@kernel
def hold_fixed(system: System, matrix: RingMatrix) -> None:
    """Replace the equations of fixed coordinates by "no change".

    `system`: with its supports; `matrix`: rows and columns of fixed coordinates become those of the identity, their
    right-hand side zero.
    """
    dof = len(system.scale)
    for node in range(system.nodes):
        before = (node - 1) % system.nodes
        for c in range(dof):
            if system.supports.fixed[dof * node + c]:
                matrix.diagonal[node, c, :] = 0.0
                matrix.diagonal[node, :, c] = 0.0
                matrix.diagonal[node, c, c] = 1.0
                matrix.upper[node, c, :] = 0.0
                matrix.lower[node, :, c] = 0.0
                matrix.upper[before, :, c] = 0.0
                matrix.lower[before, c, :] = 0.0
                matrix.column[node, c, :] = 0.0
                matrix.row[node, :, c] = 0.0
                matrix.node_side[node, c] = 0.0

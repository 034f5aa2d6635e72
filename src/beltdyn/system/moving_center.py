"""Contact with a pulley that a tensioner carries: what the motion of its center adds to the tangent.

Contact depends on where the belt is and how it moves against the center.  With the center c(q), a change of the
tensioner's coordinate acts like the opposite shift of the whole curve by c' dq, and like a change of its velocity by
-(c' dq/dt + c'' dq/dt dq).  With T the tangent of the forces F on the vectors, w what a shift does to these
vectors, and hub force -sum_a w_a F_a:

    dF_a/dq = -sum_b T_ab w_b c' - D_a,    D_a = sum_b dF_a/dv_b w_b c'' dq/dt.
"""

from math import hypot
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, record, records
from beltdyn.contact.law import PulleyState
from beltdyn.contact.surface import rim_unknown, surface_at
from beltdyn.kernel import interpreted, kernel
from beltdyn.machines.tensioners import TENSIONER, free_slide, tensioner_center
from beltdyn.system.arrays import BODY, RingMatrix, System
from beltdyn.system.frame import passed_length
from beltdyn.system.state import State

# Pulleys as contact meets them at a state: turning, and moving where a tensioner carries them


@kernel
def tensioner_coordinate(system: System, tensioner: int) -> int:
    """Place of a tensioner's coordinate in the state."""
    return system.first_body + system.bodies.size - system.tensioners.size + tensioner


@kernel
def pulley_state(system: System, pulley: int, position: FloatArray, velocity: FloatArray) -> PulleyState:
    """A pulley at a state.

    `position`, `velocity`: shape (n N + D,).
    """
    item, body = system.pulleys[pulley], system.first_body + pulley
    carrier, speed = item.carrier, velocity[body]
    surface = surface_at(system.rims, pulley, position[body], passed_length(system.frame, position))
    x, y, vx, vy = item.center[0], item.center[1], 0.0, 0.0
    if carrier >= 0:
        at = tensioner_coordinate(system, carrier)
        center = tensioner_center(system.tensioners[carrier], position[at])
        x, y, vx, vy = center.x, center.y, velocity[at] * center.dx, velocity[at] * center.dy
    return PulleyState(
        x,
        y,
        surface,
        speed,
        item.friction,
        vx,
        vy,
        item.rolling,
        item.foundation,
        item.damping,
        item.rim_ratio,
        item.cord,
        item.hertz,
        item.lasting,
        item.unloading,
    )


def pulley_center(system: System, pulley: int, position: FloatArray) -> tuple[float, float]:
    """Where the shaft of a pulley is at a position of shape (n N + D,), m."""
    item = system.pulleys[pulley]
    if item.carrier < 0:
        return float(item.center[0]), float(item.center[1])
    place = position[interpreted(tensioner_coordinate)(system, item.carrier)]
    center = interpreted(tensioner_center)(system.tensioners[item.carrier], place)
    return float(center.x), float(center.y)


def pulley_centers(system: System, position: FloatArray) -> FloatArray:
    """Where the shafts of all pulleys are at a position of shape (n N + D,), m, shape (P, 2)."""
    centers = np.array(system.pulleys.center)
    for carried in np.flatnonzero(system.pulleys.carrier >= 0).tolist():
        centers[carried] = pulley_center(system, carried, position)
    return centers


def pulley_speeds(system: System, velocity: FloatArray) -> FloatArray:
    """Speeds of all rims, rad/s, shape (..., pulleys), from the rates of states, shape (..., n N + D)."""
    return velocity[..., system.first_body : system.first_body + len(system.pulleys)]


class MovingCenter(NamedTuple):
    """How the center of a pulley moves with the coordinate of the tensioner that carries it."""

    unknown: int
    """Place of the coordinate in the border, -1 where the center is fixed."""
    rim: int
    """Place of the pulley's angle in the border, -1 where it is prescribed."""
    x: float
    """c', derivative of the center."""
    y: float
    drift_x: float
    """c'' dq/dt, rate of c'."""
    drift_y: float
    turning: bool
    """Whether c' changes."""


def drift_record(vectors: int) -> np.dtype[np.void]:
    """Kind of what a drift of the center's velocity does: forces on the vectors (N) and moment on the pulley (N m)."""
    return record(force=f"({vectors},2)f8", moment="f8")


@kernel
def moving_center(system: System, pulley: int, position: FloatArray, velocity: FloatArray) -> MovingCenter:
    """The motion of a pulley's center at a state of shape (n N + D,)."""
    carrier, rim = system.pulleys[pulley].carrier, rim_unknown(system.rims, pulley, system.bodies[pulley].unknown)
    if carrier < 0:
        return MovingCenter(-1, rim, 0.0, 0.0, 0.0, 0.0, False)
    at = tensioner_coordinate(system, carrier)
    center = tensioner_center(system.tensioners[carrier], position[at])
    drift_x, drift_y = center.ddx * velocity[at], center.ddy * velocity[at]
    unknown = system.bodies[at - system.first_body].unknown
    return MovingCenter(unknown, rim, center.dx, center.dy, drift_x, drift_y, drift_x != 0.0 or drift_y != 0.0)


@kernel
def keep_drift(system: System, center: MovingCenter, contact: np.record, drift: np.record) -> None:
    """Overwrite drift by D and by its counterpart for the moment on the pulley.

    `system`, `center`: the system, and how the center moves; `contact`: with the derivatives of force and moment with
    respect to the velocity; `drift`: a row of the kind `drift_record`.
    """
    x, y = center.drift_x, center.drift_y
    drift.moment = 0.0
    for a in range(len(system.shift)):
        drift.force[a, 0], drift.force[a, 1] = _along(system, contact, a, x, y)
        drift.moment += system.shift[a] * (contact.moment[a, 0] * x + contact.moment[a, 1] * y)


@kernel(inline=True)
def _along(system: System, contact: np.record, a: int, x: float, y: float) -> tuple[float, float]:
    """Sum over b of T_ab w_b (x, y): what a shift of the curve does to the force on a vector."""
    fx = fy = 0.0
    for b in range(len(system.shift)):
        weight = system.shift[b]
        fx += weight * (contact.xx[a, b] * x + contact.xy[a, b] * y)
        fy += weight * (contact.yx[a, b] * x + contact.yy[a, b] * y)
    return fx, fy


@kernel
def couple_center(
    system: System,
    element: int,
    center: MovingCenter,
    drifting: float,
    contact: np.record,
    drift: np.record,
    matrix: RingMatrix,
) -> None:
    """Couple the tensioner's coordinate to the nodes of an element and to the rim that they touch.

    `element`: which one touches; `center`: how the center moves; `drifting`: factor of the drift: that of the
    derivative with respect to position, zero where there is none; `contact`: forces with the tangent; `drift`: from
    `keep_drift`; `matrix`: changed in place.
    """
    dof, node_j = len(system.scale), (element + 1) % system.nodes
    own, rim, x, y = center.unknown, center.rim, center.x, center.y
    for a in range(len(system.vectors)):
        first, weight = system.vectors[a], system.shift[a]
        node, c = (element, first) if first < dof else (node_j, first - dof)
        fx, fy = _along(system, contact, a, x, y)
        if drifting != 0.0:
            fx, fy = fx + drifting * drift.force[a, 0], fy + drifting * drift.force[a, 1]
        matrix.column[node, c, own] += fx
        matrix.column[node, c + 1, own] += fy
        matrix.corner[own, own] -= weight * (fx * x + fy * y)
        for b in range(len(system.shift)):
            if system.shift[b] != 0.0:
                matrix.row[node, own, c] += system.shift[b] * (contact.xx[b, a] * x + contact.yx[b, a] * y)
                matrix.row[node, own, c + 1] += system.shift[b] * (contact.xy[b, a] * x + contact.yy[b, a] * y)
        if rim >= 0:
            push = x * contact.by_turn[a, 0] + y * contact.by_turn[a, 1]
            matrix.corner[own, rim] += weight * push
            matrix.corner[rim, own] += weight * (x * contact.moment[a, 0] + y * contact.moment[a, 1])
    if rim >= 0 and drifting != 0.0:
        matrix.corner[rim, own] += drifting * drift.moment


# Pulleys whose centers are moved: each slides on a carrier of prescribed speed along a line, without a spring


def with_movers(system: System, pulleys: list[int]) -> System:
    """Put pulleys on carriers whose motion is prescribed, behind the tensioners."""
    table, count = system.pulleys.copy(), len(system.tensioners)
    carriers = np.resize(system.tensioners, count + len(pulleys)) if count else records(TENSIONER, pulley=pulleys)
    for number, pulley in enumerate(pulleys, count):
        carriers[number] = free_slide(carriers.dtype, pulley, tuple(system.pulleys.center[pulley]))
        table.carrier[pulley] = number
    own = records(BODY, inertia=np.zeros(len(pulleys)), kinetic=0.0, unknown=-1, reach=1.0)
    return system._replace(
        pulleys=table,
        tensioners=carriers.view(np.recarray),
        bodies=np.concatenate([system.bodies, own]).view(np.recarray),
    )


def moving_to(
    system: System, state: State, first: int, centers: dict[int, tuple[float, float]], time: float
) -> tuple[System, State]:
    """Let carriers begin to move at constant speed, so that centers are reached after a time."""
    table, position, velocity = system.tensioners.copy(), state.position.copy(), state.velocity.copy()
    for carrier in range(first, len(table)):
        pulley, place = int(table.pulley[carrier]), position.size - len(table) + carrier
        x, y = pulley_center(system, pulley, position)
        to_x, to_y = centers.get(pulley, (x, y))
        way = hypot(to_x - x, to_y - y)
        slide = table["sliding"][carrier]
        slide["center"] = x, y
        if way > 0.0:
            slide["direction"] = (to_x - x) / way, (to_y - y) / way
        position[place], velocity[place] = 0.0, way / time
    return system._replace(tensioners=table), State(position, velocity, state.acceleration)

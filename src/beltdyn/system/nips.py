"""The nips of a belt between two rollers: what the roller beside the path does, and tensions before and after it."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.contact.contact_zone import Curve, combine, fill_bernstein, touching_intervals
from beltdyn.contact.law import PulleyState
from beltdyn.contact.penetration import approach, slip_velocity
from beltdyn.contact.point_force import point_force
from beltdyn.kernel import kernel
from beltdyn.model import Prepared
from beltdyn.model.nip import Pair
from beltdyn.system.arc_mesh import fit_mesh
from beltdyn.system.arrays import System
from beltdyn.system.element_state import centreline, element_workspace, gather_motion, reaches
from beltdyn.system.material_loss import hysteresis_tension
from beltdyn.system.moving_center import pulley_state
from beltdyn.system.observe import stretch_at


class Nips(NamedTuple):
    """What is seen in R nips at k states; the names are those of the results."""

    nip_width: FloatArray
    """Length of belt within the roller, m, shape (k, R); one that stays compressed lets go before its end."""
    nip_tension_before: FloatArray
    """Tension where the running belt enters, N, shape (k, R)."""
    nip_tension_after: FloatArray
    """The same where it leaves."""
    nip_normal_force: FloatArray
    """Of the roller at the contact points, N/m, shape (k, R, points)."""
    nip_friction_force: FloatArray
    nip_slip_velocity: FloatArray
    """m/s."""


class Part(NamedTuple):
    """A curve of the belt in a state, as a nip sees it."""

    state: int
    nip: int
    first: int
    """Number of its first contact point."""
    pull: float
    """Tension by hysteresis, N."""


def seen_nips(system: System, position: FloatArray, velocity: FloatArray) -> Nips | None:
    """Look at nips in k states; None without any."""
    rollers: IntArray = np.flatnonzero(system.pulleys.beside).astype(np.int64)
    if not rollers.size:
        return None
    points = system.length.size * system.control.shape[1] * system.contact.points.size
    states = position.shape[0]
    found = Nips(
        np.zeros((states, rollers.size)),
        *(np.full((states, rollers.size), np.nan) for _ in range(2)),
        *(np.zeros((states, rollers.size, points)) for _ in range(3)),
    )
    place, rate = np.ascontiguousarray(position), np.ascontiguousarray(velocity)
    fill_nips(system, place, rate, rollers, element_workspace(system), found)
    return found


@kernel
def fill_nips(
    system: System, position: FloatArray, velocity: FloatArray, rollers: IntArray, work: np.record, found: Nips
) -> None:
    """Fill what is zero or not a number; see `seen_nips`.

    `system`: with nips; `position`, `velocity`: the states, shape (k, n N + D); `rollers`: numbers of the rollers
    beside the path; `work`: from `element_workspace`; `found`: changed in place.
    """
    curves, count = system.control.shape[1], system.contact.points.size
    for k in range(position.shape[0]):
        fit_mesh(system.frame, system, position[k])
        for element in range(system.length.size):
            gather_motion(system, element, position[k], velocity[k], work.coordinates)
            pull = 0.0
            if system.hysteresis.size > 0:
                pull = hysteresis_tension(system.hysteresis[element], system.vectors, work)
            for curve in range(curves):
                piece, first = centreline(system, element, curve, work), (element * curves + curve) * count
                for r in range(rollers.size):
                    pulley = pulley_state(system, rollers[r], position[k], velocity[k])
                    if reaches(system, element, curve, pulley, work):
                        part = Part(k, r, first, pull)
                        _press(system, piece, pulley, part, work, found)
                        _enter(system, piece, pulley, part, work, found)


@kernel
def _press(system: System, piece: Curve, pulley: PulleyState, part: Part, work: np.record, found: Nips) -> None:
    """Forces of a roller at the points of a curve."""
    weights, k, r = work.contact.weights, part.state, part.nip
    for point in range(system.contact.points.size):
        fill_bernstein(system.contact.points[point], weights)
        x, y = combine(piece.control, weights)
        vx, vy = combine(piece.velocity, weights)
        here = approach(x, y, vx, vy, pulley)
        if here.penetration >= 0.0:
            force, row = point_force(here, pulley, system.law, False), part.first + point
            found.nip_normal_force[k, r, row] = force.normal.force
            found.nip_friction_force[k, r, row] = force.friction
            found.nip_slip_velocity[k, r, row] = slip_velocity(here, pulley)


@kernel
def _enter(system: System, piece: Curve, pulley: PulleyState, part: Part, work: np.record, found: Nips) -> None:
    """Add the part of a nip on a curve, and take the tensions at its ends, of which later curves have the last one."""
    zone, rates, k, r = work.contact.zone, work.contact.rates, part.state, part.nip
    for interval in range(touching_intervals(piece.control, pulley, zone)):
        start, end = zone.intervals[interval]
        qx, qy, first = stretch_at(system, piece, start, part.pull, rates)
        _, _, last = stretch_at(system, piece, end, part.pull, rates)
        fill_bernstein(start, work.contact.weights)
        vx, vy = combine(piece.velocity, work.contact.weights)
        before, after = found.nip_tension_before, found.nip_tension_after
        if qx * vx + qy * vy < 0.0:
            before, after = after, before
        if found.nip_width[k, r] == 0.0:
            before[k, r] = first
        after[k, r] = last
        found.nip_width[k, r] += (end - start) * piece.length


_ACCURACY = 1e-9
"""Of a move that ends the search, over the smallest radius."""


class NipLoad(NamedTuple):
    """A nip that is loaded by a force."""

    roller: int
    pulley: int
    force: float
    """N."""
    stiffness: float
    """Growth of the force over the way of the roller, N/m."""
    pair: Pair
    """Of which the lasting compression of the belt follows from the overlap."""


def nip_loads(prepared: Prepared) -> list[NipLoad]:
    """The nips of a drive that are loaded by forces."""
    found, path, contact = list[NipLoad](), prepared.path, prepared.contact_stiffness
    for nip, (roller, pulley), depth in zip(prepared.drive.nips, path.nips, path.indentations.tolist(), strict=True):
        if nip.force is not None:
            pair = Pair.of(prepared.pulleys[roller], prepared.pulleys[pulley], prepared.belt, contact)
            found.append(NipLoad(roller, pulley, nip.force, pair.slope(depth), pair))
    return found


def with_own_rollers(system: System) -> System:
    """The same system, with an array of its own for the centers of rollers that move."""
    return system._replace(pulleys=system.pulleys.copy()) if np.any(system.pulleys.beside) else system


def pressed_on(system: System, loads: list[NipLoad], hub: FloatArray, size: float) -> bool:
    """Move rollers by what forces of the belt on hubs, shape (P, 2), miss; False if all moves are small."""
    centers, radii, far = system.pulleys.center, system.pulleys.radius, False
    for one in loads:
        way = centers[one.pulley] - centers[one.roller]
        way /= np.hypot(*way)
        step = (one.force + float(hub[one.roller] @ way)) / one.stiffness
        centers[one.roller] += step * way
        depth = radii[one.roller] + radii[one.pulley] - np.hypot(*(centers[one.pulley] - centers[one.roller]))
        system.pulleys.lasting[one.roller] = one.pair.lasting * one.pair.peak(float(depth))
        far = far or abs(step) > _ACCURACY * size
    return far

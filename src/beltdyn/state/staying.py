"""A belt at rest on a staying mesh, and from one such mesh to another."""

from functools import partial
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Prepared
from beltdyn.model.heavy_parts import naming_heavy_parts
from beltdyn.model.resolution import Arc, Laid
from beltdyn.observation.compilation import ahead, compile_observing
from beltdyn.solvers.time_limit import spend_time
from beltdyn.state.installation import drawn_in, follow, from_starts, looked_at, with_stiffer_contact
from beltdyn.state.newton import FOUND, find_steady, steady_work
from beltdyn.state.static import only_tensioners
from beltdyn.state.tightening import Tightening, begin
from beltdyn.system.arc_mesh import base_lengths, fitted, shifts_of
from beltdyn.system.arrays import System
from beltdyn.system.build import staying_system
from beltdyn.system.build_machines import with_clamping_supports, with_resistance
from beltdyn.system.constant_drive import without_motion
from beltdyn.system.frame import centreline_places, centreline_points
from beltdyn.system.meshing import fit_phases, has_teeth, phases, unloaded, with_softer_teeth
from beltdyn.system.observations import Observations
from beltdyn.system.state import State, at_rest, nodal_coordinates, point_coordinates
from beltdyn.system.steady_assembly import Anchor, anchor_at

TOLERANCE = 1e-9
"""Of the last step of a search, over the smallest radius."""
FIRST_FINENESS = 0.6
"""Of the first mesh."""
_LEAST_STEP = 1.01
"""Least factor on the fineness of a mesh with fewer elements than specified."""
FINER = 1.4
"""Elements of a mesh over those of the one before."""
MOST_ELEMENTS = 1500
"""Nodes of a mesh, as many as elements in a closed belt, from which on it is not refined: a limit of computing time."""
_MOST_MESHES = 4
"""Meshes on which equilibrium is sought."""
_SETTLED = 1e-3
"""Change of the tension at rest from one mesh to the next, relative, with which a mesh is fine enough for it."""
_MAX_NEWTON_STEPS = 60
"""Steps of Newton's method for equilibrium without friction; beyond, the search counts as failed."""
_SOFTER_TEETH = 1e-3, 1e-2, 0.1, 1.0
"""Stiffness of teeth over their own on the way to equilibrium, where the way from the laid belt is too long."""
_CURVATURE = slice(4, 6)
"""Second derivatives among the coordinates of a node."""
_SAMPLES = 16
"""Points of an element at which the ends of arcs are looked for."""


class Standing(NamedTuple):
    """A drive at rest, without friction, on a staying mesh."""

    prepared: Prepared
    system: System
    state: State
    place: FloatArray
    """Position of that state, which may move on."""
    tension: float
    """Mean of the span tensions, N."""
    layer: float
    """Length of the layers at the ends of arcs, m."""
    fineness: float
    """Of its graded mesh."""

    @property
    def drive(self) -> Drive:
        """The drive, with the length, or the take-up, that gives the tension asked for."""
        return self.prepared.drive

    @property
    def seen(self) -> Observations:
        """What is seen there, one instant."""
        return looked_at(self.prepared, self.system, self.state).seen


def laid_state(laid: Laid, system: System, tensioners: FloatArray) -> State:
    """The state of a system whose belt is laid on its path, with its tensioners (m or rad) where they are."""
    along = laid.start + laid.stretch * point_coordinates(system)
    slope, bend = laid.stretch * laid.path.tangent(along), laid.stretch**2 * laid.path.bend(along)
    state = at_rest(system, nodal_coordinates(system, laid.path.position(along), slope, bend))
    state.position[state.position.size - tensioners.size :] = tensioners
    return state


def require_passing(drive: Drive) -> None:
    """Make sure that the belt may pass a mesh that stays: it is closed, or a web, and asks for no other elements."""
    if drive.ends and not drive.is_web:
        modes = "; `beltdyn stroke` has stiffness and modes of the axis at rest" if drive.carriage else ""
        raise ModelError(f"an open belt has no steady running. Simulate it with `beltdyn simulate`{modes}.")
    if drive.belt.other_elements is not None:
        raise ModelError(
            f'belt.discretization = "{drive.belt.other_elements}" would have no effect: this analysis is on a staying '
            "mesh, whose elements are quintic. Omit it, or simulate the drive with `beltdyn simulate`."
        )


def on_quintics(drive: Drive) -> Drive:
    """The drive without elements that a staying mesh does not have."""
    if drive.belt.other_elements is None:
        return drive
    return drive.replace(belt=drive.belt.replace(discretization=None))


def bring_to_stand(prepared: Prepared, elements: int | None = None) -> Standing:
    """Find the equilibrium at rest, with the installed tension that was asked for if one was.

    The length for that tension is found on a mesh that is fine enough for it.
    """
    require_passing(prepared.drive)
    fineness, wanted = first_fineness(prepared), prepared.installed_tension
    with naming_heavy_parts(prepared):
        rest, tighter = begin(prepared, partial(_on_some_mesh, elements=elements, fineness=fineness))
        if wanted is not None:
            rest = _at_tension(prepared, wanted, (rest, tighter), refined=elements is None)
    return _as_specified(rest, prepared)


def first_fineness(prepared: Prepared) -> float:
    """Fineness of the first mesh, which has at least the specified number of elements."""
    specified, fineness = prepared.drive.belt.elements, FIRST_FINENESS
    while specified and (count := prepared.graded_lengths(fineness).size) < specified:
        fineness *= max(specified / count, _LEAST_STEP)
    return fineness


def _as_specified(rest: Standing, prepared: Prepared) -> Standing:
    """The same at rest, whose drive leaves open the number of elements if it was not specified."""
    specified, belt = prepared.drive.belt.elements, rest.drive.belt
    if belt.elements == specified:
        return rest
    return rest._replace(prepared=rest.prepared.replace(belt=belt.replace(elements=specified)))


def _at_tension(prepared: Prepared, wanted: float, begun: tuple[Standing, float], *, refined: bool) -> Standing:
    """The drive with the tension that was asked for, N, from one at rest that is tighter by some way, m."""
    rest, tighter = begun
    change = np.inf
    while refined and change > _SETTLED and rest.system.nodes < MOST_ELEMENTS:
        finer = _on_finer_mesh(rest)
        change, rest = abs(finer.tension / rest.tension - 1.0), finer
    return Tightening(prepared, wanted, partial(_stand_like, first=rest), rest, tighter).run()


def _stand_like(prepared: Prepared, near: Standing, first: Standing) -> Standing:
    """Find the equilibrium of a drive from that on the first mesh, or else from one nearer to it."""
    try:
        return stand_like(prepared, first)
    except ConvergenceError:
        if near is first:
            raise
        return stand_like(prepared, near)


def _on_some_mesh(prepared: Prepared, elements: int | None, fineness: float) -> Standing:
    """Equilibrium on the coarsest mesh on which it is found; the reason of the finest where there is none."""
    for trial in range(_MOST_MESHES if elements is None else 1):
        try:
            return stand(prepared, elements, fineness=fineness * FINER**trial)
        except ConvergenceError as error:
            failure = error
    raise failure


def _on_finer_mesh(rest: Standing) -> Standing:
    """The equilibrium on a finer mesh, near that on the coarser one, or else from the laid belt."""
    prepared, fineness = rest.prepared, FINER * rest.fineness
    system = staying_system(prepared, prepared.graded_lengths(fineness))
    state = transfer(rest.system, rest.state, system)
    try:
        state, tension = _balanced(prepared, system, state)
    except ConvergenceError:
        return stand(prepared, fineness=fineness)
    return Standing(prepared, system, state, state.position.copy(), tension, prepared.layer, fineness)


def stand(prepared: Prepared, elements: int | None = None, *, fineness: float = FIRST_FINENESS) -> Standing:
    """Find the equilibrium at rest, without friction, of a drive with the length that it has.

    Where Newton's method does not get there from the laid belt, it follows the equilibria of stiffer or softer contact.
    """
    lengths = prepared.graded_lengths(fineness) if elements is None else prepared.equal_lengths(elements)
    system = staying_system(prepared, lengths)
    with ahead(compile_observing, system):
        state, tension = _from_laid(prepared, system)
    return Standing(prepared, system, state, state.position.copy(), tension, prepared.layer, fineness)


def _from_laid(prepared: Prepared, system: System) -> tuple[State, float]:
    """Equilibrium from the belt laid on its path; see `_balanced`.

    That path may lie above its idlers, by the penetration of the pulleys: goods that nothing carries there leave
    Newton's method no way, so that supports first hold the belt on both sides.
    """
    clamping = system._replace(carrying=with_clamping_supports(system.carrying))

    def begun(start: float) -> tuple[State, float]:
        state = _lying(prepared, system, start)
        if clamping.carrying is not system.carrying:
            _balance(prepared, clamping, state, anchor_at(state, True), start)
        return _balanced(prepared, system, state, start)

    return from_starts(prepared, begun)


def _balanced(prepared: Prepared, system: System, state: State, start: float = 1.0) -> tuple[State, float]:
    """Equilibrium from a state nearby, in contact stiffer by a factor; also the mean tension of its spans, N."""
    if not follow(start, partial(_balance, prepared, system, state, anchor_at(state, True))):
        raise _no_rest(prepared, system)
    return state, looked_at(prepared, system, state).tension


def stand_like(prepared: Prepared, like: Standing) -> Standing:
    """Find the equilibrium of a drive that differs a little, in the length of its belt, from that of the other."""
    nodes, bodies = np.split(like.place, [like.system.first_body])
    system, state = carried(prepared, like.prepared, base_lengths(like.system), nodes)
    shifts_of(system.frame)[:] = shifts_of(like.system.frame)
    state.position[system.first_body :] += bodies
    try:
        state, tension = _balanced(prepared, system, state)
    except ConvergenceError:
        state, tension = _from_laid(prepared, system)
    return like._replace(prepared=prepared, system=system, state=state, place=state.position.copy(), tension=tension)


def _no_rest(prepared: Prepared, system: System) -> ConvergenceError:
    return ConvergenceError(
        f"no static equilibrium found with {system.nodes} elements, near a tension of "
        f"{prepared.installation.tension:.4g} N. Check tension and penetration with `beltdyn check`; change "
        "the belt tension or length, or omit contact.stiffness so that it is chosen."
    )


def carried(prepared: Prepared, other: Prepared, lengths: FloatArray, nodes: FloatArray) -> tuple[System, State]:
    """The mesh of a drive that differs a little from another one, and a state near to that of the other one.

    Arcs keep their nodes: the mesh changes as the path does, and places and slopes as those of a belt laid on it. The
    state has no speeds; its bodies move from zero by as much as tensioners move at rest.
    """
    before, after = other.installation, prepared.installation
    here, there = other.laid, Laid.on(after.path, prepared.belt_length, before.path.longest_span)
    moved = np.interp(np.append(0.0, np.cumsum(lengths)), here.marks(), there.marks())
    new = staying_system(prepared, np.diff(moved))
    state = laid_state(there, new, after.tensioner_positions)
    state.position[:] -= laid_state(here, new._replace(length=lengths), before.tensioner_positions).position
    state.nodes(new)[:, _CURVATURE] = 0.0  # it jumps at the ends of arcs, where nodes may be
    state.position[: nodes.size] += nodes
    return new, state


def _balance(prepared: Prepared, system: System, state: State, anchor: Anchor, factor: float) -> bool:
    """Bring a state to equilibrium with contact stiffer by a factor; if that fails, False, and the state as it was."""
    still, begun = without_friction(with_stiffer_contact(system, factor)), state.position.copy()
    fit_phases(still, state)
    if _found(prepared, still, state, anchor):
        return True
    state.position[:] = begun
    if not has_teeth(still):
        return False
    fit_phases(still, state)
    found = all(_found(prepared, with_softer_teeth(still, part), state, anchor) for part in _SOFTER_TEETH)
    if not found:
        state.position[:] = begun
    return found


def _found(prepared: Prepared, still: System, state: State, anchor: Anchor) -> bool:
    """Bring a state to equilibrium without friction, if Newton's method converges."""
    tolerance = TOLERANCE * float(np.min(prepared.radii))
    spend_time()
    shifts, begun = shifts_of(still.frame), shifts_of(still.frame).copy()
    found = (
        find_steady(still, state.at(0.0), anchor, tolerance, _MAX_NEWTON_STEPS, False, steady_work(still))[0] == FOUND
    )
    if not found:
        shifts[:] = begun
    fitted(still, state.position)
    return found


def under_torques(prepared: Prepared, system: System, state: State, torque: FloatArray) -> bool:
    """Bring a toothed belt from equilibrium to that under torques on its pulleys (N m, shape (P,)), in place.

    If that fails, False, and the state and its grooves as they were.
    """
    begun, phase = state.position.copy(), phases(system).copy()
    if _found(prepared, without_friction(system, torque), state, anchor_at(state, True)):
        return True
    state.position[:], phases(system)[:] = begun, phase
    return False


def without_friction(system: System, torque: FloatArray | None = None) -> System:
    """The same system with a belt that slides without friction on pulleys that stand still, as do tensioners."""
    pulleys = system.pulleys.copy()
    pulleys["friction"] = 0.0
    tensioners = without_motion(system.tensioners)
    carrying = with_resistance(system.carrying, 0.0)
    still = system._replace(pulleys=pulleys, bodies=only_tensioners(system), tensioners=tensioners, carrying=carrying)
    return unloaded(still, torque)


def _lying(prepared: Prepared, system: System, factor: float) -> State:
    """A belt that lies in its pulleys instead of on their rims, as deep as in contact stiffer by a factor."""
    laid = prepared.laid_on(drawn_in(prepared, factor))
    return laid_state(laid, system, prepared.installation.tensioner_positions)


class Sampled(NamedTuple):
    """Places along the belt, closer than its nodes."""

    along: FloatArray
    """Along the belt, m, shape (k,)."""
    depth: FloatArray
    """How deep they lie within each pulley, m, shape (P, k)."""


def sampled(system: System, position: FloatArray, centers: FloatArray) -> Sampled:
    """Where a belt lies at a position, with centers (P, 2) of pulleys, m."""
    ends = np.cumsum(system.length)
    parts = np.arange(_SAMPLES) / _SAMPLES
    along = ((ends - system.length)[:, None] + system.length[:, None] * parts).ravel()
    return Sampled(along, depths(system, centers, centreline_places(system, position, along)))


def found_arcs(system: System, places: Sampled) -> list[Arc]:
    """Where the belt touches pulleys, in the order in which they follow each other along the belt."""
    along, away = places
    found, nips = list[Arc](), list[tuple[float, float]]()
    for depth, radius, beside in zip(away, system.rims.radius, system.pulleys.beside, strict=True):
        touching = np.flatnonzero(depth >= 0.0)
        if touching.size:
            first, last = int(touching[0]), int(touching[-1])
            start = float(along[first] - _beyond(along, depth, first, first - 1))
            end = float(along[last] - _beyond(along, depth, last, last + 1))
            if beside:
                nips.append((start, end))
            else:
                found.append(Arc(start, end, float(radius)))
    return sorted(arc._replace(nips=tuple(one for one in nips if arc.start < one[0] < arc.end)) for arc in found)


def require_one_pulley_at_a_time(prepared: Prepared, system: System, places: Sampled) -> None:
    """Refuse a state in which the belt around one pulley touches another one."""
    touched = ((places.depth >= 0.0) & (system.pulleys.beside == 0)[:, None]).astype(int)
    pairs = np.argwhere(np.triu(touched @ touched.T, 1))
    if pairs.size:
        first, second = (prepared.pulleys[number].name for number in pairs[0].tolist())
        raise ConvergenceError(
            f'the belt touches "{first}" and "{second}" at the same place: the forces move them together. Move them '
            "apart, reduce the load, or limit the travel of the tensioner by stops."
        )


def depths(system: System, centers: FloatArray, places: FloatArray) -> FloatArray:
    """How deep places (k, 2) lie within each pulley, of centers (P, 2), m, negative outside, shape (P, k)."""
    away = np.hypot(*(places[:, axis] - centers[:, axis, None] for axis in range(2)))
    return np.asarray(system.rims.radius[:, None] - away)


def _beyond(along: FloatArray, depth: FloatArray, inner: int, outer: int) -> float:
    """Way from a point inside a pulley to its rim against the way to a neighbor outside, m."""
    return float((along[inner] - along[outer]) * depth[inner] / (depth[inner] - depth[outer]))


def on_nodes(system: System, state: State, other: System) -> State:
    """The same curve at rest on the nodes of another mesh, with bodies where they are."""
    place, slope, bend = centreline_points(system, state.position, point_coordinates(other))
    moved = at_rest(other, nodal_coordinates(other, place, slope, bend))
    moved.position[other.first_body :] = state.position[system.first_body :]
    return moved


def transfer(system: System, state: State, other: System) -> State:
    """The same curve and motion on another mesh."""
    shifts_of(other.frame)[:] = shifts_of(system.frame)
    for one in (system, other):
        fitted(one, state.position)
    moved = on_nodes(system, state, other)
    moved.velocity[other.first_body :] = state.velocity[system.first_body :]
    other.frame.speed[:] = system.frame.speed
    return moved

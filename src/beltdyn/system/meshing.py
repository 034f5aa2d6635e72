"""Belts with teeth: grooves as arrays, unknowns of toothed pulleys in steady running, and single teeth in motion.

The speed c of the belt is known there from the pulley that drives it, and gives toothed pulleys their speeds, r c with
r of `TEETH`.  The phases of their grooves are unknown in place of these, and that of the leading pulley in place of c.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from beltdyn.arrays import FloatArray, IntArray, Records, records
from beltdyn.contact.contact_force import tooth_force, tooth_numbers
from beltdyn.contact.surface import TEETH, MeshingRims, PolygonRims, RoundRims, ShapedRims, ToothedRims
from beltdyn.contact.surface.toothed import FOLLOWS, PHASE, SPEED
from beltdyn.kernel import by_type, kernel
from beltdyn.model import Prepared
from beltdyn.model.toothing import DISCRETE
from beltdyn.system.arrays import BodyForces, Motion, NoCarriage, RingMatrix, System, TangentFactors
from beltdyn.system.body_forces import add_machines
from beltdyn.system.constant_drive import constant_drive, without_actions
from beltdyn.system.element_state import centreline, element_workspace, gather_motion, reaches
from beltdyn.system.frame import Travelling, centreline_places, passed_lengths
from beltdyn.system.moving_center import pulley_center, pulley_state
from beltdyn.system.state import State

_SAMPLES = 8
"""Points of an element at which teeth are looked for in their grooves."""


def has_teeth(system: System) -> bool:
    """Whether the belt of a system has teeth that its pulleys hold."""
    return isinstance(system.rims, ToothedRims | MeshingRims)


def tooth_rows(prepared: Prepared, single: bool = False) -> Records:
    """Rows of `TEETH` of the pulleys of a drive, shape (P,), of spread teeth or of single ones."""
    belt, teeth = prepared.belt, np.array([float(one.teeth or 0) for one in prepared.pulleys])
    toothing, pitch = belt.toothing, belt.given_pitch
    assert toothing is not None
    held, sense = teeth > 0.0, np.array([one.turning for one in prepared.pulleys])
    groove = 2.0 * np.pi / np.where(held, teeth, 1.0)
    return records(
        TEETH,
        stiffness=np.where(held, toothing.tooth_stiffness / pitch, 0.0),
        damping=np.where(held, toothing.tooth_damping / pitch, 0.0),
        half_gap=np.full(teeth.size, 0.5 * toothing.backlash),
        pitch_radius=prepared.radii,
        rate=np.where(held, sense * groove / pitch, 0.0),
        groove=groove,
        flank=np.full(teeth.size, np.tan(toothing.flank_angle)),
        spacing=np.full(teeth.size, pitch if single else 0.0),
        height=np.full(teeth.size, toothing.reach),
        land=np.full(teeth.size, toothing.land_radius or 0.0),
    )


def with_teeth(prepared: Prepared, system: System) -> System:
    """The arrays of a drive on a mesh that travels, with the teeth of its belt, if it has any."""
    return turned_by(prepared, system, np.zeros(system.pulleys.size))


def without_teeth(system: System) -> System:
    """The same arrays of a belt that slides on smooth pulleys."""
    return system._replace(rims=RoundRims(system.rims.radius)) if has_teeth(system) else system


def starts_of(lengths: FloatArray) -> FloatArray:
    """Material coordinates at which elements of lengths (m) begin."""
    return np.asarray(np.cumsum(lengths) - lengths)


def meshing(prepared: Prepared, system: System) -> System:
    """The arrays of a drive in steady running; those given, if its belt has no teeth."""
    if prepared.belt.teeth is None:
        return system
    count = system.bodies.size
    rims = MeshingRims(
        system.rims.radius,
        tooth_rows(prepared),
        starts_of(system.length),
        np.zeros(system.pulleys.size),
        np.zeros(count, dtype=np.int64),
        -1,
        np.zeros((1, 1)),
    )
    return system._replace(rims=rims)


def on_lengths(rims: Any, lengths: FloatArray) -> Any:
    """The same rims for a mesh with elements of other lengths (m), with phases of their own."""
    if isinstance(rims, MeshingRims):
        return rims._replace(start=starts_of(lengths), phase=rims.phase.copy())
    return rims._replace(start=starts_of(lengths)) if isinstance(rims, ToothedRims) else rims


def led_by(system: System, leader: int) -> System:
    """The same system with what is unknown of its bodies where the speed of a toothed pulley is known."""
    rims, bodies = system.rims, system.bodies
    if not isinstance(rims, MeshingRims):
        return system
    kinds, unknown = np.full(bodies.size, SPEED), np.asarray(bodies.unknown)
    for p in np.flatnonzero(rims.table.stiffness > 0.0):
        if unknown[p] >= 0:
            kinds[unknown == unknown[p]] = FOLLOWS
            kinds[p] = PHASE
    border = int(np.max(unknown, initial=-1)) + 2
    return system._replace(rims=rims._replace(unknown=kinds, leader=leader, kept=np.zeros((border, border))))


def mesh_speeds(system: System, velocity: FloatArray) -> None:
    """Give the belt and its toothed pulleys the speeds that follow from that of the leading one, in `velocity`."""
    rims, first = system.rims, system.first_body
    if not isinstance(rims, MeshingRims) or rims.leader < 0:
        return
    speed = velocity[first + rims.leader] / rims.table.rate[rims.leader]
    system.frame.speed[0] = speed
    unknown = np.asarray(system.bodies.unknown)
    for p in np.flatnonzero(rims.unknown == PHASE):
        velocity[first + np.flatnonzero(unknown == unknown[p])] = rims.table.rate[p] * speed


def unloaded(system: System, torque: FloatArray | None = None) -> System:
    """The same system without loads, with grooves that turn to where teeth do not turn the pulley, if it has teeth.

    With torques on pulleys (N m, shape (P,)) that balance each other, grooves turn to where teeth hold these. On a mesh
    that travels, where no fixed end holds it along the belt, the grooves of the first pulley with teeth stay.
    """
    rims = system.rims
    if not has_teeth(system):
        return system
    held = constant_drive(system, 0.0)
    without_actions(held)
    if torque is not None:
        held.profiles.segment.offset[: torque.size] = torque
        pulleys = held.pulleys.copy()
        pulleys["shaft"] = np.arange(torque.size)
        held = held._replace(pulleys=pulleys)
    turning, bodies = turning_grooves(system), held.bodies.copy()
    if isinstance(rims, ToothedRims):
        held = held._replace(rims=rims._replace(table=rims.table.copy()))
    bodies["unknown"][turning] = int(np.max(bodies.unknown, initial=-1)) + 1 + np.arange(turning.size)
    return led_by(held._replace(bodies=bodies, tensioners=system.tensioners), -1)


def turning_grooves(system: System) -> IntArray:
    """Numbers of the pulleys whose grooves turn at rest to where teeth do not turn the pulley; see `unloaded`."""
    found = toothed_pulleys(system)
    held = system.supports.any_fixed or not isinstance(system.carriage, NoCarriage)
    return found if held or isinstance(system.rims, MeshingRims) else found[1:]


def toothed_pulleys(system: System) -> IntArray:
    """Numbers of the pulleys with teeth."""
    rims = system.rims
    if isinstance(rims, MeshingRims | ToothedRims):
        return np.flatnonzero(rims.table.stiffness > 0.0)
    return np.zeros(0, dtype=np.int64)


def with_softer_teeth(system: System, factor: float) -> System:
    """The same system with the stiffness of its teeth times a factor; phases are those of the given one."""
    rims = system.rims
    assert isinstance(rims, MeshingRims | ToothedRims)
    table = rims.table.copy()
    table["stiffness"] *= factor
    return system._replace(rims=rims._replace(table=table))


def phases(system: System) -> FloatArray:
    """Phases of grooves, rad: of every pulley of a belt with teeth, or none; unknown in steady running and at rest."""
    rims = system.rims
    if isinstance(rims, ToothedRims):
        return np.asarray(rims.table.phase)
    return rims.phase if isinstance(rims, MeshingRims) else np.zeros(0)


def fit_phases(system: System, state: State) -> None:
    """Turn the grooves of each toothed pulley under the teeth of its arc, on average; pulleys have the angle zero."""
    rims = system.rims
    if not isinstance(rims, MeshingRims | ToothedRims):
        return
    phase = phases(system)
    parts = (np.arange(_SAMPLES) + 0.5) / _SAMPLES
    along = (rims.start[:, None] + system.length[:, None] * parts).ravel()
    share = np.repeat(system.length / _SAMPLES, _SAMPLES)
    places = centreline_places(system, state.position, along)
    for p in toothed_pulleys(system):
        x, y = (places - np.array(pulley_center(system, int(p), state.position))).T
        touching = np.hypot(x, y) <= rims.radius[p]
        if touching.any():
            row = rims.table[p]
            ahead = (np.arctan2(y, x) - row.rate * along)[touching] / row.groove
            turned = np.angle(np.sum(share[touching] * np.exp(2j * np.pi * ahead)))
            phase[p] = row.groove * turned / (2.0 * np.pi)


# From steady running to equations over time, and back

TOOTH_PHASES = "tooth_phases"
"""Attribute of results: angles of grooves where pulleys have the angle zero, rad, of the belt that has not passed."""


def turning(system: System, state: State) -> System:
    """The arrays of a drive in a state with phases, for equations over time, in which grooves turn with pulleys."""
    rims = system.rims
    if not isinstance(rims, MeshingRims):
        return system
    table = rims.table.copy()
    table["phase"] = rims.phase - state.position[system.first_body :][: rims.phase.size]
    return system._replace(rims=ToothedRims(rims.radius, table, rims.start))


def turned_by(prepared: Prepared, system: System, phase: FloatArray | None) -> System:
    """The arrays of a drive with grooves at phases (rad), over time; those given of a belt without teeth."""
    if phase is None or prepared.belt.teeth is None:
        return system
    toothing, travels = prepared.belt.toothing, isinstance(system.frame, Travelling)
    rows = tooth_rows(prepared, travels and toothing is not None and toothing.law == DISCRETE)
    kind = PolygonRims if toothing is not None and toothing.land_radius and rows.spacing.any() else ToothedRims
    rims = kind(system.rims.radius, rows, starts_of(system.length))
    return at_phases(system._replace(rims=rims), phase)


def turned_as(system: System, other: System) -> System:
    """The same arrays over time with grooves at the phases of those on another mesh, if the belt has teeth."""
    return at_phases(system, phases(other)) if has_teeth(system) else system


def tooth_phases(system: System) -> dict[str, FloatArray]:
    """The phases of grooves as an attribute of results; nothing of a belt without teeth."""
    return {TOOTH_PHASES: phases(system).copy()} if has_teeth(system) else {}


def at_phases(system: System, phase: FloatArray) -> System:
    """The same arrays over time, of a belt with teeth, with grooves at other phases (rad)."""
    rims = system.rims
    assert isinstance(rims, ToothedRims)
    table = rims.table.copy()
    table["phase"] = np.atleast_1d(phase)
    return system._replace(rims=rims._replace(table=table))


def stopped(system: System, angles: FloatArray, passed: float) -> System:
    """The arrays of a drive over time as those of steady running, at angles (rad) with a length passed (m)."""
    rims = system.rims
    if not isinstance(rims, ToothedRims):
        return system
    phase = rims.table.phase + angles - rims.table.rate * passed
    nothing = np.zeros(system.bodies.size, dtype=np.int64)
    return system._replace(rims=MeshingRims(rims.radius, rims.table, rims.start, phase, nothing, -1, np.zeros((1, 1))))


# Kernels of steady running


@kernel(inline=True)
def _one(rims: Any) -> float:
    return 1.0


@kernel(inline=True)
def _zero(rims: MeshingRims) -> float:
    return 0.0


flow_unknown: Callable[[Any], float] = by_type({RoundRims: _one, ShapedRims: _one, MeshingRims: _zero}, "flow_unknown")
"""1 where the speed of the belt is unknown, 0 where a toothed pulley gives it."""


@kernel(inline=True)
def _machines(
    rims: Any, system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces
) -> None:
    add_machines(system, motion, factors, corner, forces)


@kernel
def _meshing_machines(
    rims: MeshingRims, system: System, motion: Motion, factors: TangentFactors, corner: FloatArray, forces: BodyForces
) -> None:
    """Add machines; they do not depend on phases."""
    size = corner.shape[0]
    for i in range(size):
        for j in range(size):
            rims.kept[i, j] = corner[i, j]
    add_machines(system, motion, factors, corner, forces)
    for body in range(system.bodies.size):
        unknown = system.bodies[body].unknown
        if unknown >= 0 and rims.unknown[body] != SPEED:
            for i in range(size):
                corner[i, unknown] = rims.kept[i, unknown]


add_steady_machines: Callable[..., None] = by_type(
    {RoundRims: _machines, ShapedRims: _machines, MeshingRims: _meshing_machines}, "add_steady_machines"
)
"""Forces on the bodies, as `add_machines` with the rims in front, and their derivatives by what is unknown."""


@kernel(inline=True)
def _keep_row(rims: Any, matrix: RingMatrix) -> None:
    """The last row is free for what holds the mesh."""


@kernel(inline=True)
def _clear_row(rims: MeshingRims, matrix: RingMatrix) -> None:
    """Clear the last row, in which the moment on the leading pulley is, whose speed is known."""
    last = matrix.corner.shape[0] - 1
    matrix.corner[last, :] = 0.0
    matrix.row[:, last, :] = 0.0


clear_last_row: Callable[[Any, RingMatrix], None] = by_type(
    {RoundRims: _keep_row, ShapedRims: _keep_row, MeshingRims: _clear_row}, "clear_last_row"
)
"""Make the last row of the matrix that of the mesh alone."""


@kernel(inline=True)
def _change_speed(rims: Any, velocity: FloatArray, first: int, body: int, change: float) -> None:
    velocity[first + body] += change


@kernel(inline=True)
def _change_phase(rims: MeshingRims, velocity: FloatArray, first: int, body: int, change: float) -> None:
    if rims.unknown[body] == PHASE:
        rims.phase[body] += change
    elif rims.unknown[body] == SPEED:
        velocity[first + body] += change


change_body: Callable[[Any, FloatArray, int, int, float], None] = by_type(
    {RoundRims: _change_speed, ShapedRims: _change_speed, MeshingRims: _change_phase}, "change_body"
)
"""Change the unknown of a body that turns: of velocities of which the first body has place `first`."""


@kernel(inline=True)
def _change_flow(rims: Any, speed: FloatArray, change: float) -> None:
    speed[0] += change


@kernel(inline=True)
def _change_leader(rims: MeshingRims, speed: FloatArray, change: float) -> None:
    rims.phase[rims.leader] += change


change_flow: Callable[[Any, FloatArray, float], None] = by_type(
    {RoundRims: _change_flow, ShapedRims: _change_flow, MeshingRims: _change_leader}, "change_flow"
)
"""Change the last unknown: the speed of the belt, shape (1,), or the phase of the leading pulley."""


@kernel(inline=True)
def _reach_of_speed(rims: Any, body: int, reach: float, speed: float) -> float:
    return reach * reach / speed


@kernel(inline=True)
def _reach_of_phase(rims: MeshingRims, body: int, reach: float, speed: float) -> float:
    if rims.unknown[body] == SPEED:
        return reach * reach / speed
    return reach if rims.unknown[body] == PHASE else 0.0


reach_of: Callable[[Any, int, float, float], float] = by_type(
    {RoundRims: _reach_of_speed, ShapedRims: _reach_of_speed, MeshingRims: _reach_of_phase}, "reach_of"
)
"""What turns a change of the unknown of a body into a length, from its radius (m) and the belt's speed (m/s)."""


_TURNS = 2.0 * np.pi
"""Angle of a turn, rad: places in a groove, 0 to 1, are averaged as angles."""
_BESIDE = 1.01
"""Distance from the shaft, over that of the nearest point, of points that stand for a belt that has left a pulley."""
_STICKS = 0.7
"""Pitches by which teeth are off the grooves that hold them before they count as held by the next ones."""


def tooth_coordinates(system: System) -> FloatArray:
    """Material coordinates of single teeth, m, shape (teeth,); none of spread ones."""
    pitch = float(system.rims.table.spacing[0]) if isinstance(system.rims, ToothedRims) else 0.0
    if pitch == 0.0:
        return np.zeros(0)
    return pitch * np.arange(round(float(np.sum(system.length)) / pitch), dtype=float)


def tooth_forces(system: System, position: FloatArray, velocity: FloatArray) -> FloatArray:
    """Forces of single teeth on the belt in k states, N, shape (k, teeth), positive along the belt."""
    found = np.zeros((position.shape[0], tooth_coordinates(system).size))
    if found.size:
        fill_tooth_forces(system, position, velocity, element_workspace(system), found)
    return found


@kernel
def fill_tooth_forces(
    system: System, position: FloatArray, velocity: FloatArray, work: np.record, found: FloatArray
) -> None:
    """Add the forces of teeth to zeros; see `tooth_forces`.

    `system`: with single teeth on a mesh that travels; `position`, `velocity`: the states, shape (k, n N + D); `work`:
    from `element_workspace`; `found`: changed in place, N, shape (k, teeth).
    """
    for k in range(position.shape[0]):
        for element in range(system.length.size):
            gather_motion(system, element, position[k], velocity[k], work.coordinates)
            for curve in range(system.control.shape[1]):
                piece = centreline(system, element, curve, work)
                for p in range(system.pulleys.size):
                    pulley = pulley_state(system, p, position[k], velocity[k])
                    if not reaches(system, element, curve, pulley, work):
                        continue
                    first, last = tooth_numbers(pulley.surface, piece)
                    for number in range(first, last):
                        if number < found.shape[1]:
                            found[k, number] += tooth_force(pulley.surface, piece, pulley, number, work.contact)


# Jumps: teeth on a pulley that change their grooves


class JumpWatch:
    """Watches the mean way of the teeth in mesh off the grooves in which they began, over successive states."""

    def __init__(self, system: System, along: FloatArray) -> None:
        assert isinstance(system.rims, ToothedRims)
        self._system, self._along, self._table = system, along, system.rims.table
        self._pulleys = toothed_pulleys(system)
        self._last = np.zeros(self._pulleys.size)
        self._held = np.zeros(self._pulleys.size, dtype=np.int64)
        self.events = list[tuple[float, int, int]]()
        """Times (s), numbers of pulleys, and grooves by which the belt went ahead or, negative, fell back."""

    def take(self, time: FloatArray, position: FloatArray, centers: FloatArray, places: FloatArray) -> None:
        """Look at k further states: centers of pulleys (k, P, 2) and places of contact points (k, points, 2), m."""
        passed = passed_lengths(self._system.frame, position, self._system.length.size)
        for row, pulley in enumerate(self._pulleys.tolist()):
            self._follow(row, time, self._off(pulley, position, passed, places - centers[:, None, pulley]))

    def _off(self, pulley: int, position: FloatArray, passed: FloatArray, places: FloatArray) -> FloatArray:
        """Mean misfit of the teeth in grooves, or of the nearest ones, in pitches, -1/2 to 1/2; shape (k,)."""
        system, row = self._system, self._table[pulley]
        away = places[:, :, 0] ** 2 + places[:, :, 1] ** 2
        reach = system.rims.radius[pulley] + row.height
        nearest = np.min(away, axis=1, keepdims=True)
        state, point = np.nonzero(away <= np.maximum(reach**2, _BESIDE**2 * nearest))
        angle = row.phase + position[:, system.first_body + pulley]
        along = self._along[point] - passed[state, point * system.length.size // self._along.size]
        direction = np.arctan2(places[state, point, 1], places[state, point, 0])
        ahead = (angle[state] - direction + row.rate * along) / row.groove
        size = len(position)
        mean = [np.bincount(state, one(_TURNS * ahead), size) for one in (np.cos, np.sin)]
        return np.asarray(np.arctan2(mean[1], mean[0]) / _TURNS)

    def _follow(self, row: int, time: FloatArray, off: FloatArray) -> None:
        """Go on with the misfits of a pulley."""
        sense = 1 if self._table.rate[self._pulleys[row]] > 0.0 else -1
        for number, here in enumerate(off.tolist()):
            self._last[row] += (here - self._last[row] + 0.5) % 1.0 - 0.5
            if abs(self._last[row] - self._held[row]) > _STICKS:
                change = int(np.sign(self._last[row] - self._held[row]))
                self._held[row] += change
                self.events.append((float(time[number]), int(self._pulleys[row]), -sense * change))

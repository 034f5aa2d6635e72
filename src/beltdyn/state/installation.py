"""The belt at rest in its drive, and its length for the installed tension.

The tension at rest is the mean of the span tensions in static equilibrium, on a mesh of equal elements: with contact,
bending, weight and spring-loaded tensioners, without friction.
"""

from collections.abc import Callable
from typing import NamedTuple, TypeVar

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive, Installation
from beltdyn.model import Path as BeltPath
from beltdyn.model.heavy_parts import naming_heavy_parts
from beltdyn.model.prepared import Prepared, prepare
from beltdyn.observation.compilation import compile_for_rest, rest_is_compiled
from beltdyn.parts.messages import beyond, listing
from beltdyn.solvers.run_progress import Phase, Progress, Report
from beltdyn.state.newton import steady_work
from beltdyn.state.static import find_equilibrium, standing, tensioner_compliance
from beltdyn.state.tightening import Tightening, begin
from beltdyn.system.arrays import Motion, System
from beltdyn.system.build import drive_system
from beltdyn.system.build_machines import with_stiffer_supports
from beltdyn.system.frame import StayingByArcs
from beltdyn.system.meshing import at_phases, fit_phases, has_teeth, without_teeth
from beltdyn.system.observations import Observations
from beltdyn.system.observe import observe
from beltdyn.system.state import State, laid
from beltdyn.system.steady_assembly import anchor_at, assemble_steady

_DEEPEST_START = 0.1
"""Depth of a belt from which equilibrium is sought, at most, over the smallest radius."""
_STARTS = 1.0, 64.0, 1 / 64
"""Stiffness of contact over the drive's own, from which equilibrium is followed, one after the other."""
_LONGEST_RATIO, _SHORTEST_RATIO = 4.0, 1.1
"""Of one stiffness on the way to the next."""
_DEEPEST = 0.5
"""Depth over radius, beyond which contact pushes a belt back the less the deeper it sinks: no balance is stable."""
_SOUND = 0.1
"""Depth over radius up to which contact may be soft."""


class Rest(NamedTuple):
    """A drive at rest."""

    prepared: Prepared
    """The drive, with the length, or the take-up, that gives the tension asked for."""
    system: System
    """Its arrays."""
    state: State
    """Static equilibrium."""
    seen: Observations
    """What is seen there, one instant."""
    unstable: tuple[str, ...] = ()
    """Pulleys whose tensioners are in unstable equilibrium."""

    @property
    def drive(self) -> Drive:
        """The drive, with the length, or the take-up, that gives the tension asked for."""
        return self.prepared.drive

    @property
    def tension(self) -> float:
        """Mean of the span tensions, N."""
        return float(self.seen.span_tension[0].mean())

    @property
    def wraps(self) -> FloatArray:
        """Wrap angles of the pulleys, rad."""
        return np.asarray(self.seen.wrap_angle[0])

    @property
    def installation(self) -> Installation:
        """The computed values in place of the estimates of `beltdyn.model.install`."""
        seen = self.seen
        positions = self.state.position[self.state.position.size - self.system.tensioners.size :]
        depths = np.array([np.median(depth) for depth in _depths(self.prepared, seen)])
        ends = np.stack([seen.span_tension_at_start[0], seen.span_tension_at_end[0]], axis=1)
        extremes = np.stack([seen.least_span_tension[0], seen.largest_span_tension[0]], axis=1)
        return self.prepared.installed(seen.span_tension[0], depths, seen.hub_force[0], positions, ends, extremes)


Found = TypeVar("Found")


def bring_to_rest(drive: Drive, progress: Report | None = None) -> Rest:
    """Find the static equilibrium of a drive with its installed tension, if given.

    The closed form of `beltdyn.model.static_estimate`, which gives the initial length, neglects bending and weight. The
    length, or the take-up if the length is given, follows from the tension at rest by the secant method.
    ConvergenceError if there is no equilibrium in which the belt touches every pulley, or none with the required
    tension.
    """
    moved = on_equal_elements(drive, chosen=drive.carriage is not None)
    found = rest_of(prepare(moved), progress)
    if moved is drive:
        return found
    belt = found.drive.belt.replace(elements=drive.belt.elements)
    return found._replace(prepared=found.prepared.replace(belt=belt, simulation=drive.simulation))


def rest_of(prepared: Prepared, progress: Report | None = None) -> Rest:
    """Static equilibrium of a drive on equal elements, with its installed tension, if given; see `bring_to_rest`."""
    system = drive_system(prepared)
    _tell(prepared, progress, "compiling")
    compile_for_rest(system, laid(system, prepared.path))
    _tell(prepared, progress, "equilibrium")
    with naming_heavy_parts(prepared):
        (rest, tighter), wanted = begin(prepared, _at_rest), prepared.installed_tension
        if wanted is not None:
            rest = Tightening(prepared, wanted, lambda ahead, _: _at_rest(ahead), rest, tighter).run()
    return rest._replace(unstable=_unstable(rest))


def rest_like(drive: Drive, like: Rest) -> Rest:
    """Static equilibrium of a drive that differs a little from another one, with as many equal elements."""
    belt = drive.belt.replace(elements=like.prepared.belt.given_elements)
    prepared = prepare(on_equal_elements(drive.replace(belt=belt)))
    if has_teeth(like.system):
        return _at_rest(prepared)
    system = drive_system(prepared)
    begin = laid(system, prepared.path, prepared.installation.tensioner_positions)
    away = like.state.position - laid(like.system, like.prepared.path, _positions(like)).position
    begin.position[:] += away
    try:
        return looked_at(prepared, system, find_equilibrium(system, begin).state)
    except ConvergenceError:
        return _at_rest(prepared)


def _positions(rest: Rest) -> FloatArray:
    """Positions of tensioners as they are estimated, m or rad."""
    return np.asarray(rest.prepared.installation.tensioner_positions)


def is_compiled(drive: Drive) -> bool:
    """Whether `bring_to_rest` needs no compilation."""
    prepared = prepare(on_equal_elements(drive, chosen=drive.carriage is not None))
    system = drive_system(prepared)
    return rest_is_compiled(system, laid(system, prepared.path))


def on_equal_elements(drive: Drive, *, chosen: bool = False) -> Drive:
    """Give the drive on the travelling mesh, on which equilibrium is found.

    With a chosen number of elements if the specified one is that of a graded mesh: as many equal ones are too few.
    """
    if not drive.frame.stays:
        return drive
    belt = drive.belt.replace(elements=None) if chosen else drive.belt
    return drive.replace(belt=belt, simulation=drive.simulation.replace(frame="travelling", force_tolerance=None))


def _tell(prepared: Prepared, progress: Report | None, phase: Phase) -> None:
    if progress is not None:
        progress(Progress(0.0, prepared.simulation.duration, 0.0, 0, phase))


def _unstable(rest: Rest) -> tuple[str, ...]:
    """Pulleys whose tensioners move against a force, or move most where several do so together."""
    compliance = tensioner_compliance(rest.system, rest.state)
    if not np.all(np.isfinite(compliance)):
        return ()
    arms = rest.system.bodies.reach[rest.system.bodies.size - len(compliance) :]
    values, ways = np.linalg.eigh(compliance * np.outer(arms, arms))
    most = [int(np.argmax(np.abs(way))) for value, way in zip(values, ways.T, strict=True) if value < 0.0]
    return tuple(rest.prepared.pulleys[rest.system.tensioners.pulley[number]].name for number in sorted(set(most)))


def _at_rest(prepared: Prepared) -> Rest:
    """Static equilibrium of a drive with the length that it has.

    Where Newton's method does not get there from the laid belt, it follows the equilibria of stiffer or softer contact.
    """
    given = drive_system(prepared)
    system = without_teeth(given)

    def begun(start: float) -> Rest:
        state, failures = _lying(prepared, system, start), list[ConvergenceError]()

        def balance(factor: float) -> bool:
            nonlocal state
            try:
                state = find_equilibrium(with_stiffer_contact(system, factor), state).state
            except ConvergenceError as error:
                failures.append(error)
                return False
            return True

        if not follow(start, balance):
            raise failures[0]
        return looked_at(prepared, *_in_grooves(given, state))

    return from_starts(prepared, begun)


def _in_grooves(system: System, state: State) -> tuple[System, State]:
    """A belt that has found its place on smooth pulleys in their grooves, if it has teeth."""
    if not has_teeth(system):
        return system, state
    fit_phases(system, state)
    found = find_equilibrium(system, state)
    return at_phases(system, found.phases), found.state


def from_starts(prepared: Prepared, begun: Callable[[float], Found]) -> Found:
    """Find a drive at rest by way of contact as stiff as its own, or else of stiffer or softer contact."""
    failures = list[ConvergenceError]()
    for start in _STARTS:
        try:
            return begun(start)
        except ConvergenceError as error:
            failures.append(error)
    raise _sunk(prepared) or failures[0]


def follow(start: float, balance: Callable[[float], bool]) -> bool:
    """Follow equilibria from a stiffness of contact to the drive's own, in shorter steps where long ones fail."""
    found, ratio = start, _LONGEST_RATIO
    if not balance(start):
        return False
    while found != 1.0 and ratio > _SHORTEST_RATIO:
        ahead = max(found / ratio, 1.0) if found > 1.0 else min(found * ratio, 1.0)
        if balance(ahead):
            found = ahead
        else:
            ratio **= 0.5
    return found == 1.0


def _lying(prepared: Prepared, system: System, factor: float) -> State:
    """A belt that lies in its pulleys, as deep as in contact stiffer by a factor."""
    return laid(system, drawn_in(prepared, factor), prepared.installation.tensioner_positions)


def with_stiffer_contact(system: System, factor: float) -> System:
    """The same system with contact and supports stiffer by a factor."""
    normal, carrying = system.law.normal, with_stiffer_supports(system.carrying, factor)
    law = system.law._replace(normal=normal._replace(stiffness=factor * normal.stiffness))
    return system._replace(law=law, carrying=carrying)


def drawn_in(prepared: Prepared, factor: float) -> BeltPath:
    """The path of a belt that lies in its pulleys instead of on their rims, as deep as in contact stiffer by a factor.

    On the rims themselves rounding decides which nodes touch, and on coarse meshes with contact at nodes the search
    then finds no step that helps.  Rims drawn in by one depth leave spans and wrap angles as they are.
    """
    installation = prepared.installation
    path = installation.path
    depth = min(np.min(installation.penetrations) / factor, _DEEPEST_START * np.min(prepared.radii))
    return BeltPath(path.centers, path.radii - depth * np.sign(path.radii), path.ends, path.nips)


def looked_at(prepared: Prepared, system: System, state: State) -> Rest:
    """An equilibrium in which the belt touches every pulley."""
    seen = observe(standing(system), np.zeros(1), state.position[None], state.velocity[None])
    seen.hub_force[0, prepared.reference] -= holding_force(system, state)
    depths = _depths(prepared, seen)
    for pulley, radius, wrap, depth, beside in zip(
        prepared.pulleys, prepared.radii, seen.wrap_angle[0], map(np.max, depths), system.pulleys.beside, strict=True
    ):
        if not (wrap > 0.0 or beside):
            raise ConvergenceError(
                f'at rest the belt does not touch "{pulley.name}", but it must touch all pulleys. Move '
                f'"{pulley.name}" towards the belt, or raise the tension.'
            )
        if depth > _DEEPEST * radius:
            raise ConvergenceError(
                f'at rest the belt sinks into "{pulley.name}" by {1e3 * depth:.2g} mm, more than {_DEEPEST:.0%} '
                "of its radius. Omit contact.stiffness so that it is chosen, or increase it, or reduce the "
                "tension."
            )
    known = np.isfinite(seen.span_tension[0])
    short = [f"{start} to {end}" for (start, end), one in zip(prepared.spans, known, strict=True) if not one]
    if short:
        raise ConvergenceError(
            f"the span {listing(short)} is shorter than one element, so its tension is unknown. Increase "
            "belt.elements, or move the pulleys apart."
        )
    return Rest(prepared, system, state, seen)


def holding_force(system: System, state: State) -> FloatArray:
    """Force on a belt at rest, at the arc of the driver, that holds goods on slopes, N, shape (2,)."""
    if not isinstance(system.frame, StayingByArcs):
        return np.zeros(2)
    equations = steady_work(system).equations
    still = Motion(0.0, state.position, np.zeros_like(state.position), np.zeros_like(state.position))
    assemble_steady(standing(system), still, anchor_at(state, True), False, equations)
    return np.asarray(equations.matrix.node_side[:, :2].sum(axis=0))


def _depths(prepared: Prepared, seen: Observations) -> list[FloatArray]:
    """Penetrations of contact points on each pulley, m; zero where it is touched between points alone."""
    places, touched, centers = seen.contact_position[0], seen.contact_pulley[0], seen.pulley_center[0]
    depths = [
        radius - np.linalg.norm(places[touched == number] - centers[number], axis=1)
        for number, radius in enumerate(prepared.radii)
    ]
    return [depth if depth.size else np.zeros(1) for depth in depths]


def _sunk(prepared: Prepared) -> ConvergenceError | None:
    """Contact so soft that the belt sinks through a pulley, or away from others, if it is."""
    parts = prepared.installation.penetrations / prepared.radii
    worst = int(np.argmax(parts))
    if not parts[worst] > _SOUND:
        return None
    enough = beyond(prepared.contact_stiffness, prepared.contact_stiffness * float(parts[worst]) / _SOUND)
    return ConvergenceError(
        f'no static equilibrium found. The contact is too soft: on "{prepared.pulleys[worst].name}" the belt would '
        f"sink by {parts[worst]:.0%} of the radius. Increase contact.stiffness from {prepared.contact_stiffness:.2g} "
        f"to {enough:.2g} N/m^2, reduce the tension, or use a larger pulley."
    )

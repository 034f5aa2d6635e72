"""What goes before a run and is not recorded: the drive runs at constant speeds, and its transients die."""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.kernel import interpreted
from beltdyn.machines.profiles.functions import go_on, profile_integral
from beltdyn.model import Drive, Prepared, Pulley
from beltdyn.model.defaults import MOST
from beltdyn.model.simulation import Instants
from beltdyn.results import mesh_error_attribute
from beltdyn.results.checks.ending import LEAST_WINDOWS, SETTLED, least_window
from beltdyn.results.energy_balance import WEB_LINE
from beltdyn.results.mechanics import MESH_BESIDE
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.solvers.trajectory import Chunk, Integrator, Statistics, Task, drive_task
from beltdyn.state.installation import Rest, bring_to_rest
from beltdyn.state.loaded_teeth import with_loads_on_teeth
from beltdyn.state.refinement import MeshRule, errors_at_rest, errors_between, refine_at_rest, steady_from_rest
from beltdyn.state.search import SteadySearch
from beltdyn.state.static import find_equilibrium
from beltdyn.state.staying import FINER, Standing, bring_to_stand, on_nodes, stand
from beltdyn.system.arc_mesh import base_lengths, mesh_attributes, shifts_of
from beltdyn.system.arrays import System
from beltdyn.system.build import axis_by_arcs, axis_system, flow_place, flowing_system, on_other_mesh, open_ended
from beltdyn.system.build_machines import profile_arrays
from beltdyn.system.frame import FlowingByArcs
from beltdyn.system.meshing import at_phases, has_teeth, tooth_phases, turned_as, turning
from beltdyn.system.observe import observe_motion
from beltdyn.system.state import State
from beltdyn.system.steady_assembly import anchor_at

_WINDOWS = 20
"""Windows in the longest time, at most."""
_LAST = LEAST_WINDOWS - 1
"""Changes from window to window that tell how transients die."""
_SLOWEST = 0.9
"""Largest part of a change that is taken to be left in the next one."""


class Start(NamedTuple):
    """Where a run begins."""

    system: System
    """Its arrays; the angles of prescribed pulleys go on from those that they have."""
    state: State
    attributes: dict[str, float | str]
    """What is said of it, global attributes of the dataset."""


class Settled(NamedTuple):
    """What settling took."""

    time: float
    """s."""
    left: float
    """What is left of the start in the span tensions, over the largest mean one."""

    @property
    def attributes(self) -> dict[str, float | str]:
        """What is said of it."""
        return {"settling_time": self.time, "settling_left": self.left}


@dataclass(frozen=True)
class Settling:
    """A run from rest to the first speed of a pulley, and there until the transients have died.

    Means and standard deviations of the span tensions are taken over windows. How they change from window to
    window, and how fast these changes get smaller, tells what is left of the start.
    """

    pulley: int
    """Number of the pulley."""
    speed: float
    """Its first speed, rad/s."""
    lead: float
    """Time in which it is reached, s."""
    longest: float
    """Longest time at this speed, s."""

    def __call__(
        self, prepared: Prepared, system: System, state: State, integrator: Integrator, progress: Report | None, /
    ) -> Start:
        """Settle."""
        before = self._before(prepared.drive)
        slower = system._replace(profiles=profile_arrays(before.counter_clockwise_pulleys, before.goods))
        task = drive_task(prepared, slower, state, Statistics())
        window = self._window(prepared.pulleys[self.pulley])
        stops = self.lead + window * np.arange(1, np.ceil(self.longest / window) + 1)
        instants = Instants(prepared.simulation.output_interval, float(stops[-1]))
        task = replace(task, instants=instants, breakpoints=(*before.breakpoints, *stops.tolist()))
        end, said = settle(task, integrator, stops, prepared.simulation.duration, progress)
        return Start(with_angles(prepared, system, slower, said.time), end, said.attributes)

    def _before(self, drive: Drive) -> Drive:
        """The drive that reaches the first speed and stays there."""
        pulleys = list(drive.pulleys)
        speed = {"kind": "cosine_ramp", "start": 0.0, "end": self.lead, "value": self.speed}
        pulleys[self.pulley] = pulleys[self.pulley].replace(speed=speed)
        return drive.replace(pulley=pulleys)

    def _window(self, pulley: Pulley) -> float:
        """Time over which means are taken, s."""
        return float(min(max(least_window(pulley, self.speed), self.longest / _WINDOWS), self.longest))


class _Left:
    """What is left of the start, from the changes of the tensions."""

    def __init__(self) -> None:
        self._windows: list[FloatArray] = []

    def take(self, time: FloatArray, tension: FloatArray) -> None:
        """Add a window: times of states, shape (k,), s, and the tensions, shape (k, spans), N."""
        weight = np.gradient(time) * np.sin(np.pi * (time - time[0]) / np.ptp(time)) ** 2
        weight = (weight / weight.sum())[:, None]
        tension = np.nan_to_num(tension)
        mean = np.sum(weight * tension, axis=0)
        deviation = np.sqrt(np.sum(weight * (tension - mean) ** 2, axis=0))
        self._windows.append(np.stack([mean, deviation]))

    @property
    def known(self) -> bool:
        """Whether there are windows enough to tell."""
        return len(self._windows) > _LAST

    @property
    def part(self) -> float:
        """What is left, over the largest mean tension; NaN of too few windows, or without tension.

        Changes that fall by the factor r from window to window leave the sum r^2 + r^3 + ... = r^2 / (1 - r) of the
        last but one.
        """
        scale = float(np.max(self._windows[-1][0])) if self.known else 0.0
        if not scale > 0.0:
            return float("nan")
        changes = np.abs(np.diff(self._windows[-_LAST - 1 :], axis=0)).max(axis=(1, 2)) / scale
        earlier, late = (float(np.max(half)) for half in np.split(changes, 2))
        ratio = min((late / earlier) ** (2.0 / _LAST), _SLOWEST) if earlier > 0.0 else 0.0
        return late * ratio**2 / (1.0 - ratio)


def settle(
    task: Task, integrator: Integrator, stops: FloatArray, duration: float, progress: Report | None
) -> tuple[State, Settled]:
    """Run until transients have died; the state at the last stop, or at the first one by which they have died.

    Means are taken over windows that end on the stops (s).
    """
    left = _Left()
    for states in _between(integrator(task), stops):
        if progress is not None:
            progress(Progress(0.0, duration, 0.0, 0, "settling"))
        last, shown = states.only(slice(-1, None)), np.arange(len(states.time)) == 0
        seen = observe_motion(task.system, states.position, states.velocity, states.forces, shown)
        left.take(states.time, seen.span_tension)
        if left.known and left.part < SETTLED:
            break
    end = State(last.position[0], last.velocity[0], np.zeros_like(last.velocity[0]))
    return end, Settled(float(last.time[0]), left.part)


def with_angles(prepared: Prepared, system: System, before: System | None = None, time: float = 0.0) -> System:
    """Arrays of a drive whose prescribed angles go on from what they were in another system."""
    profiles = profile_arrays(prepared.pulleys, prepared.goods)
    prescribed = [number for number, pulley in enumerate(prepared.pulleys) if pulley.prescribed]
    integral = interpreted(profile_integral)
    angles = [0.0 if before is None else integral(before.profiles, number, time) for number in prescribed]
    go_on(profiles, prescribed, prepared.simulation.begin, angles)
    return system._replace(profiles=profiles)


def _between(chunks: Iterator[Chunk], stops: FloatArray) -> Iterator[Chunk]:
    """The states from one of the stops to the next; the last one of each begins the next."""
    waiting = list[Chunk]()
    for chunk in chunks:
        waiting += [chunk] if len(chunk.time) else []
        at = float(stops[np.argmin(np.abs(stops - chunk.reached))])
        if abs(at - chunk.reached) < 1e-9 * at:
            yield Chunk.join(waiting)
            waiting = [waiting[-1].only(slice(-1, None))]


# Where a run on a staying mesh begins: at rest, or in the steady running of its first instant

DIRECTION = "mesh_direction"
"""Attribute of results on a staying mesh: the direction along which node 0 does not move, a unit vector."""


class Beginning(NamedTuple):
    """Where a run begins."""

    prepared: Prepared
    """With the length, or the take-up, that gives the installed tension."""
    system: System
    state: State
    unstable: tuple[str, ...] = ()
    """Names of the pulleys whose tensioners are not in stable balance at rest."""
    attributes: Mapping[str, Any] = MappingProxyType({})
    """What is said of it, global attributes of the dataset."""


def begin_flowing(prepared: Prepared, progress: Report | None) -> Beginning:
    """Find the state in which a run on a staying mesh begins, and the mesh."""
    if progress is not None:
        progress(Progress(0.0, prepared.simulation.duration, 0.0, 0, "equilibrium"))
    meshed = _meshed(prepared) if prepared.carriage is None else _axis(prepared)
    if prepared.simulation.start == "steady":
        meshed = _running(meshed, prepared.simulation.force_tolerance)
    elif prepared.belt.teeth and prepared.carriage is None:
        loaded, state = with_loads_on_teeth(meshed.rest.prepared, meshed.system, meshed.state)
        meshed = meshed._replace(system=loaded, state=state)
    system, direction = open_ended(meshed.rest.prepared, meshed.system), anchor_at(meshed.state, True).direction
    toothed = turning(system, meshed.state)
    flowing = with_angles(meshed.rest.prepared, flowing_system(toothed, direction))
    errors = meshed.errors or {"peak pressure": float("nan")}  # not known
    said: dict[str, Any] = {mesh_error_attribute(name): error for name, error in errors.items()}
    said[DIRECTION] = direction
    if isinstance(flowing.frame, FlowingByArcs):
        arcs = flowing.frame.arcs
        said |= dict(zip(MESH_BESIDE, (arcs.before, arcs.after, arcs.share), strict=True))
    said |= tooth_phases(toothed) | mesh_attributes(system) | ({WEB_LINE: 1} if prepared.drive.is_web else {})
    return Beginning(meshed.rest.prepared, flowing, with_passage(system, meshed.state, meshed.speed), attributes=said)


class _Meshed(NamedTuple):
    """A state on a staying mesh."""

    rest: Standing
    """The belt at rest on that mesh, or on one from which it was refined."""
    system: System
    state: State
    speed: float
    """Of the belt, m/s."""
    errors: Mapping[str, float]
    """Of the mesh, relative, as far as they are known."""


def _meshed(prepared: Prepared) -> _Meshed:
    """The drive at rest, on a mesh as it asks for."""
    settings, given = prepared.simulation, prepared.drive.belt.elements
    if settings.mesh == "uniform":
        rest = bring_to_stand(prepared, prepared.elements)
        errors = errors_at_rest(rest, prepared.elements)
    elif settings.force_tolerance is not None:
        rest, errors = refine_at_rest(prepared, settings.force_tolerance)
    else:
        rest = bring_to_stand(prepared)
        fineness = rest.fineness * (given or MOST) / rest.system.nodes
        rest = stand(rest.prepared, fineness=fineness if given else min(prepared.drive.fineness, fineness))
        errors = errors_at_rest(rest)
    return _Meshed(rest, rest.system, rest.state, 0.0, errors)


def _axis(prepared: Prepared) -> _Meshed:
    """An axis at rest, whose belt has its length, or its take-up, and its tension on elements that travel."""
    found = bring_to_rest(prepared.drive)
    own, given, fineness = found.prepared, prepared.drive.belt.elements, prepared.drive.fineness
    if fineness:
        count = own.graded_lengths(fineness).size
        fineness *= (given or min(count, MOST)) / count

    def finer_by(ratio: float) -> Standing:
        equal = own.equal_lengths(round(ratio * prepared.elements))
        return _axis_on(found, own.graded_lengths(ratio * fineness) if fineness else equal, ratio * fineness)

    rest = finer_by(1.0)
    with suppress(ConvergenceError):
        return _Meshed(rest, rest.system, rest.state, 0.0, errors_between(rest, finer_by(FINER)))
    return _Meshed(rest, rest.system, rest.state, 0.0, {})


def _axis_on(found: Rest, lengths: FloatArray, fineness: float) -> Standing:
    """The same axis at rest on elements of other lengths (m), on a mesh that stays at its arcs."""
    own = found.prepared
    system = axis_system(own, lengths)
    state = on_nodes(found.system, found.state, system)
    balance = find_equilibrium(turned_as(system, found.system), state)
    state = balance.state
    if has_teeth(system):
        system, state = with_loads_on_teeth(own, at_phases(system, balance.phases), state)
    return Standing(own, axis_by_arcs(own, system), state, state.position.copy(), found.tension, own.layer, fineness)


def _running(meshed: _Meshed, force_tolerance: float | None) -> _Meshed:
    """Steady running at the beginning, on the same mesh, or on one that is refined up to a tolerance."""
    rest, prepared, time = meshed.rest, meshed.rest.prepared, meshed.rest.prepared.simulation.begin
    if force_tolerance is None:
        search, system, errors = SteadySearch(rest.prepared, rest.system, rest.state, time), rest.system, meshed.errors
        search.run(rest)
    else:
        search, rest, _, errors, _ = steady_from_rest(rest, time, _same_mesh, force_tolerance, bands=False)
        system = on_other_mesh(rest.prepared, rest.system, base_lengths(search.constant))
        shifts_of(system.frame)[:] = shifts_of(search.constant.frame)
    if prepared.drive.is_web:
        rest = rest._replace(prepared=search.prepared)
        system = on_other_mesh(search.prepared, system, search.constant.length)
    system = system._replace(rims=search.constant.rims)
    return meshed._replace(rest=rest, system=system, state=search.running(), speed=search.belt_parameter, errors=errors)


def _same_mesh(rest: Standing) -> MeshRule:
    """The rule of which the next finer mesh is that at rest, refined already."""
    return MeshRule(rest.layer, rest.fineness / FINER)


def with_passage(system: System, state: State, speed: float) -> State:
    """Add the length of belt that has passed, zero, and its speed (m/s) to a state on a staying mesh."""
    at = system.first_body + flow_place(system)
    shifts = shifts_of(system.frame)
    still = np.zeros_like(shifts)
    passed = (np.append(shifts, 0.0), np.append(still, speed), np.append(still, 0.0))
    vectors = zip((state.position, state.velocity, state.acceleration), passed, strict=True)
    return State(*(np.insert(vector, np.full(value.size, at), value) for vector, value in vectors))

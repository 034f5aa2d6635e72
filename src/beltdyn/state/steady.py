"""Steady running of a drive on a staying mesh."""

import time
from collections.abc import Mapping
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.machines.loads.trim import Trim
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.heavy_parts import naming_heavy_parts
from beltdyn.observation.recording import Recording
from beltdyn.parts.messages import listing
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.parts.quantity import Count, number_in
from beltdyn.results import Run, mesh_error_attribute
from beltdyn.results.checks.machines import GROWTH
from beltdyn.results.energy_balance import WEB_LINE
from beltdyn.results.provenance import STAYING, mesh_used
from beltdyn.results.schema import runs_steadily
from beltdyn.solvers.run_progress import Progress, Report
from beltdyn.solvers.trajectory import Chunk
from beltdyn.state.linearized import growing, in_motion
from beltdyn.state.newton import SteadyWork
from beltdyn.state.refinement import MeshRule, against_coarser, is_fine, refine, steady_from_rest
from beltdyn.state.search import SteadySearch
from beltdyn.state.staying import FINER, Standing, bring_to_stand, carried, on_quintics, require_passing
from beltdyn.system.arc_mesh import MESH_SHIFTS, lengths_of, mesh_attributes, shifts_of
from beltdyn.system.arrays import System
from beltdyn.system.body_forces import body_forces_at
from beltdyn.system.constant_drive import controllers, rigid_links
from beltdyn.system.meshing import TOOTH_PHASES, has_teeth, phases
from beltdyn.system.state import State

# The instant at which an analysis takes a drive that changes over time


def instant_given(drive: Drive, at: float | str | None) -> float:
    """The requested instant, s; by default the end of the simulation."""
    return drive.simulation.end if at is None else number_in("at", at, "s")


# Steady running from that of a neighbor: the same drive under other speeds, torques or loads, or one much like


def require_neighbour(drive: Drive, start: Run, elements: int | None) -> None:
    """Make sure that steady running of a drive can begin with that of another one."""
    if elements is not None:
        raise ModelError(f"elements = {elements} cannot be given with start, which has its own mesh. Omit one of them.")
    if not runs_steadily(start.dataset):
        raise ModelError("start is a run over time, not steady running. Give a result of `steady_state`.")
    mine, other = ([pulley.name for pulley in one.pulleys] for one in (drive, start.drive))
    if mine != other or len(drive.moving_tensioners) != len(start.drive.moving_tensioners):
        raise ModelError(
            f"start has the pulleys {', '.join(other)} and {len(start.drive.moving_tensioners)} moving "
            f"tensioners; the drive has {', '.join(mine)} and {len(drive.moving_tensioners)}. Give the steady "
            "running of a drive that differs only in values, or omit start."
        )


def with_length_of(prepared: Prepared, start: Run) -> Prepared | None:
    """The drive with the length of the belt, or the take-up, that is known; None if it must be found."""
    if prepared.installed_tension is None:
        return prepared
    return start.prepared if start.dataset.attrs["drive_as_given"] == prepared.drive.text else None


def search_from(prepared: Prepared, start: Run, time: float) -> SteadySearch:
    """A search for steady running that begins with that of a neighbor, on its mesh.

    Its speeds are changed in proportion to those that are prescribed.
    """
    found = start.dataset
    lengths = lengths_of(found, start.prepared)
    system, state = carried(prepared, start.prepared, lengths, found.nodal_coordinates.values[-1].ravel())
    for number, one in enumerate(reversed(prepared.moving_tensioners), 1):
        if one.pulley in found.get("tensioner", ()):  # the roller of a nip that was held stands where its slide begins
            state.position[-number] += float(found.tensioner_position.sel(tensioner=one.pulley)[-1])
    held = system.first_body + controllers(system)
    if held.size:
        state.position[held] = found.body_position.values[-1][held - system.first_body]
    bodies, speeds = state.velocity[system.first_body :], found.pulley_speed.values[-1]
    bodies[: speeds.size] = speeds
    take_along(system, bodies, found.shaft_speed.values[-1])
    shifts_of(system.frame)[:] = found.attrs.get(MESH_SHIFTS, 0.0)
    search = SteadySearch(prepared, system, state, time)
    if TOOTH_PHASES in found.attrs:
        phases(search.constant)[:] = np.atleast_1d(found.attrs[TOOTH_PHASES])
    faster = _faster(search.constant, bodies)
    bodies *= faster
    system.frame.speed[0] = faster * found.attrs["belt_parameter"]
    return search


def take_along(system: System, bodies: FloatArray, shafts: FloatArray) -> None:
    """Give the bodies of hub chains their speeds, from those of the rims, which are in place, and of the shafts."""
    for link in system.links:
        bodies[link.back] = bodies[link.front]
    bodies[system.pulleys.shaft] = shafts
    for link, rigid in zip(system.links[::-1], rigid_links(system)[::-1], strict=True):
        if rigid:
            bodies[link.front] = bodies[link.back]


def _faster(system: System, bodies: FloatArray) -> float:
    """Speeds of prescribed shafts over those that they have; 1 without such shafts."""
    shafts, wanted = system.pulleys.shaft, system.profiles.segment.offset
    for p in np.flatnonzero(system.bodies.unknown[shafts] < 0):
        if wanted[p] * bodies[shafts[p]] > 0.0:
            return float(wanted[p] / bodies[shafts[p]])
    return 1.0


_TOLERANCE = 0.01
"""Default tolerance of contact forces."""
_TURNS = 2.2
"""Turns of the belt in the results; means are taken over the last one."""


@takes_options
def steady_state(
    drive: Drive,
    *,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    elements: Annotated[Count, Field(ge=3)] | None = None,
    start: Run | None = None,
    progress: Report | None = None,
) -> Run:
    """Compute the steady running of a drive without a simulation over time.

    Speeds, torques and schedules are those of one instant; harmonics of speeds are ignored, and loads that depend on
    shaft angles are averaged. The mesh is graded towards the ends of arcs, and refined until contact forces no longer
    depend on it.

    Parameters
    ----------
    drive
        The drive.
    at
        Instant at which speeds, torques and schedules are evaluated, such as "0.5 s", or in s; by default the end of
        the simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    elements
        Number of equal elements instead of the graded mesh; by default that of ``drive.steady``.
    start
        Steady running of the same drive under other speeds, torques or loads, or of a drive with other parameters. The
        search starts there on its mesh, which is rebuilt if its error exceeds `force_tolerance`; if that fails, it
        starts at rest. It is fast if the belt length is known: for the same drive at another instant, or copies of
        ``start.drive``.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    Run
        Two turns of the belt in steady running. Its drive has the length, or the take-up, that gives the installed
        tension.

    Raises
    ------
    ModelError
        If steady running is not defined: the belt is open, nothing drives it, or a pulley is not a smooth circle.
    ConvergenceError
        If there is no steady running; the message names the slipping pulley and the largest torque it transmits.

    Examples
    --------
    >>> run = bd.steady_state(drive)
    >>> round(float(run.dataset.pulley_speed.isel(time=-1, pulley=1)), 4)  # rad/s
    12.0
    """
    require_steady(drive)
    if start is not None:
        require_neighbour(drive, start, elements)
    prepared = prepare(drive)
    if force_tolerance is None and elements is None:
        elements = _equal_elements(prepared)
    tolerance = _tolerance(drive, force_tolerance)
    instant = instant_given(drive, at)
    if progress is not None:
        progress(Progress(0.0, drive.simulation.duration, 0.0, 0, "equilibrium"))
    found = _continued(prepared, start, instant, tolerance, bands=True) if start is not None else None
    return _as_run(prepared, instant, found or _from_rest(prepared, instant, tolerance, elements, bands=True))


def steady_from(drive: Drive, start: Run | None, force_tolerance: float | None, *, bands: bool) -> Run:
    """Find the steady running of a drive from that of another one, or from rest, as `steady_state` does."""
    prepared, instant, tolerance = prepare(drive), drive.simulation.end, _tolerance(drive, force_tolerance)
    equal = None if force_tolerance is not None else _equal_elements(prepared)
    found = None if start is None else _continued(prepared, start, instant, tolerance, bands=bands)
    return _as_run(prepared, instant, found or _from_rest(prepared, instant, tolerance, equal, bands=bands))


def _equal_elements(prepared: Prepared) -> int | None:
    """Number of equal elements of steady running, if the drive asks for these."""
    return prepared.elements if prepared.drive.steady.mesh == "uniform" else None


class Beside(NamedTuple):
    """Steady running that was found on the mesh of that of a drive that differs a little."""

    prepared: Prepared
    search: SteadySearch
    start: Run
    """Of the other drive; the errors of its mesh, and whether it is stable, are taken over."""
    change: FloatArray
    """By how much its unknowns differ from those that were carried over."""
    seconds: float
    """Of the search, s."""

    def run(self, *, bands: bool) -> Run:
        """Its results; `bands` as for `steady_from`."""
        errors = {name: error for name, error in self.start.resolution.errors.items() if np.isfinite(error)}
        band = self.search.friction_band(self.start.dataset.attrs) if bands else {}
        grows = {name: value for name, value in self.start.dataset.attrs.items() if name == GROWTH}
        found = _Found(self.search, band, errors, _rule_of(self.start), self.seconds, grows)
        return _as_run(self.prepared, self.prepared.simulation.end, found)


def steady_beside(
    drive: Drive, start: Run, guess: FloatArray | None = None, tangent: SteadyWork | None = None
) -> Beside | None:
    """Look for the steady running of a drive on the mesh of another one; None if it is not found from there."""
    require_neighbour(drive, start, None)
    prepared = prepare(drive)
    search, begun = _begin(prepared, start, drive.simulation.end), time.perf_counter()
    carried = search.unknowns()
    if guess is not None:
        search.place(carried + guess)
    if not search.resume(tangent):
        return None
    return Beside(prepared, search, start, search.unknowns() - carried, time.perf_counter() - begun)


def tangent_of(run: Run) -> SteadyWork:
    """The factorized tangent of steady running, from `steady_state`."""
    return _begin(run.prepared, run, float(run.dataset.attrs["steady_at"])).factorised()


def steady_on_mesh(drive: Drive, start: Run) -> Run:
    """Find the steady running of a drive on the mesh of another one, of which the errors are taken over."""
    return require_found(steady_beside(drive, start)).run(bands=True)


def require_found(found: Beside | None) -> Beside:
    """Make sure that steady running was found."""
    if found is None:
        raise ConvergenceError("Newton's method does not converge for so large a change.")
    return found


def _tolerance(drive: Drive, force_tolerance: float | None) -> float:
    """The given tolerance of contact forces, or that of the drive, or the default."""
    return next(one for one in (force_tolerance, drive.steady.force_tolerance, _TOLERANCE) if one is not None)


class _Found(NamedTuple):
    """Steady running, and how it was found."""

    search: SteadySearch
    band: Mapping[str, FloatArray]
    """Where dry friction holds tensioners; from rest that of the first mesh, on which forces as a whole are known."""
    errors: Mapping[str, float]
    """Of the mesh, relative."""
    rule: MeshRule
    seconds: float
    """Of the search, s."""
    growth: Mapping[str, FloatArray] | None = None
    """Of a controlled drive, if it is known; see `_growth`."""


def _from_rest(
    prepared: Prepared, instant: float, force_tolerance: float, elements: int | None, *, bands: bool
) -> _Found:
    """Find steady running from rest, retrying from a finer mesh if the search fails."""
    rest, begun = bring_to_stand(prepared, elements), time.perf_counter()

    def rule(standing: Standing) -> MeshRule:
        return MeshRule(0.0, elements=elements) if elements else MeshRule(standing.layer, standing.fineness)

    with naming_heavy_parts(prepared):
        found = steady_from_rest(rest, instant, rule, force_tolerance, bands=bands)
    return _Found(found.search, found.band, found.errors, found.rule, time.perf_counter() - begun)


def _continued(prepared: Prepared, start: Run, instant: float, force_tolerance: float, *, bands: bool) -> _Found | None:
    """Find steady running from that of a neighbor, on its mesh, or on another one where that is too coarse.

    None if that fails.
    """
    search, begun = _begin(prepared, start, instant), time.perf_counter()
    if not search.resume():
        return None
    rule = _rule_of(start)
    try:
        errors, coarser = against_coarser(search, rule)
        if not (is_fine(errors, force_tolerance) or rule.elements):
            errors, rule = refine(coarser, rule.finer(1.0 / FINER), force_tolerance)
            search = coarser
    except ConvergenceError:
        return None
    band = search.friction_band(start.dataset.attrs) if bands else {}
    return _Found(search, band, errors, rule, time.perf_counter() - begun)


def _begin(prepared: Prepared, start: Run, instant: float) -> SteadySearch:
    """A search that begins with the steady running of a neighbor."""
    return search_from(with_length_of(prepared, start) or bring_to_stand(prepared).prepared, start, instant)


def _rule_of(start: Run) -> MeshRule:
    """How the mesh of steady running was made."""
    return MeshRule(*start.dataset.attrs["mesh_rule"].tolist())


def _as_run(prepared: Prepared, instant: float, found: _Found) -> Run:
    """What was found, as the results of a run of two turns of the belt."""
    search, drive = found.search, prepared.drive
    _require_trims(search)
    growth = found.growth
    if growth is None:
        growth = _growth(search) if drive.is_controlled else {}
    duration = _TURNS * search.prepared.belt_length / abs(search.belt_parameter)
    turns = drive.simulation.replace(
        duration=duration, output_interval=duration, field_interval=None, start="equilibrium", start_at=None
    )
    title = f"{drive.title} in steady running, as at {instant:g} s"
    mesh = mesh_used(drive, STAYING, search.constant.length.size)
    with Recording(search.prepared.over(turns), search.constant, None, title, None, **mesh) as recording:
        recording.start(search.prepared, search.constant, ())
        recording.take(_running(search.constant, search.running(), duration))
        recording.note(
            drive_as_given=drive.text,
            steady_at=instant,
            wall_time=found.seconds,
            **found.band,
            belt_parameter=search.belt_parameter,
            **({TOOTH_PHASES: phases(search.constant)} if has_teeth(search.constant) else {}),
            **({WEB_LINE: 1} if drive.is_web else {}),
            **growth,
            **mesh_attributes(search.constant),
            newton_iterations_of_search=search.iterations,
            mesh_rule=np.array(found.rule),
            **{mesh_error_attribute(name): error for name, error in found.errors.items()},
        )
    return recording.run()


def _require_trims(search: SteadySearch) -> None:
    """Make sure that controllers trim within their limits."""
    states, rows = search.state.position[search.constant.first_body :], iter(search.constant.shaft_loads.table)
    for pulley in search.prepared.pulleys:
        for load, row in zip(pulley.load, rows, strict=False):
            if not isinstance(load, Trim):
                continue
            state = states[row.state] if row.state >= 0 else 0.0
            trim = load.trim_at(row.sensor_rate * states[-row.sensor] + row.sensor_zero, state)
            if abs(trim) > load.largest_trim:
                raise ConvergenceError(
                    f'the controller of "{pulley.name}" holds its set value with a trim of {trim:.3g}, but has '
                    f"largest_trim = {load.largest_trim:g}. Increase it, or change what is trimmed or the set value."
                )


def _growth(search: SteadySearch) -> dict[str, FloatArray]:
    """The fastest growing motion of a controlled drive about steady running, as an attribute; none if all decay."""
    found = growing(in_motion(search.prepared, search.constant, search.running(), search.belt_parameter))
    return {GROWTH: np.array([found[0].real, found[0].imag])} if found.size else {}


def require_steady(drive: Drive) -> None:
    """Make sure that a drive may run steadily."""
    require_passing(drive)
    shaped = [pulley.name for pulley in drive.pulleys if pulley.surface and pulley.surface.kind != "circle"]
    if shaped:
        raise ModelError(
            f"{', '.join(shaped)} is not a smooth circle, so there is no steady running. Simulate the drive "
            "with `beltdyn simulate`, or remove `surface`."
        )
    if drive.belt.teeth is not None:
        _require_toothed_driver(drive)
    other = [(pulley.name, load.kind) for pulley in drive.pulleys for load in pulley.load if not load.has_mean]
    if other:
        raise ModelError(
            f'{other[0][0]} has a load of kind "{other[0][1]}", whose mean over the shaft angle is unknown; '
            "steady running needs it. Give the mean as a table over speed, or the set speed of a controlled "
            "motor as `speed`, or simulate the drive with `beltdyn simulate`."
        )


def _require_toothed_driver(drive: Drive) -> None:
    """Make sure that one toothed pulley gives a belt with teeth its speed."""
    driver, prescribed = drive.driver, [one.name for one in drive.pulleys if one.prescribed and one.teeth]
    if driver is not None and not drive.pulleys[driver].teeth:
        raise ModelError(
            f"{drive.pulleys[driver].name} drives a belt with teeth, but has none, so there is no steady running. Give "
            "it teeth, or simulate the drive with `beltdyn simulate`."
        )
    if len(prescribed) > 1:
        raise ModelError(
            f"{listing(prescribed)} have prescribed speeds and teeth: the forces between them depend on how they were "
            "turned, so there is no steady running. Prescribe one of them, and give the other a torque."
        )


def require_steady_start(drive: Drive) -> None:
    """Make sure that a drive whose run is to begin in steady running may do so."""
    try:
        require_steady(on_quintics(drive))
    except ModelError as error:
        raise ModelError(
            f'simulation.start = "steady" needs steady running, and {error} Or set simulation.start = "equilibrium".'
        ) from error


def _running(system: System, state: State, duration: float) -> Chunk:
    """A while of steady running: the shape of the belt stays, and shafts turn on."""
    rims = slice(system.first_body, state.position.size - system.tensioners.size)
    instants = np.array([0.0, duration])
    position, velocity = np.stack([state.position] * 2), np.stack([state.velocity] * 2)
    position[1, rims] += duration * state.velocity[rims]
    forces = body_forces_at(system, instants, position, velocity)
    work = np.zeros((2, forces.power.shape[1] + 1))
    work[1, :-1] = duration * forces.power[1]
    return Chunk(instants, instants, position, velocity, work, forces, duration)

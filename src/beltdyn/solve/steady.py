"""An analysis: the steady running of a drive, on a mesh that stays while the belt flows through it."""

import time

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, mesh_error_attribute
from beltdyn.solve.progress import Progress, Report
from beltdyn.solve.recording import Recording
from beltdyn.solve.staying import bring_to_stand
from beltdyn.solve.steady_refinement import refine
from beltdyn.solve.steady_search import SteadySearch
from beltdyn.solve.trajectory import Chunk
from beltdyn.system.arrays import System
from beltdyn.system.constant_drive import twists
from beltdyn.system.state import State
from beltdyn.system.state_forces import body_forces_at

_TURNS = 2.2
"""Turns of the belt in the results; means are taken over the last one."""


def steady_state(
    drive: Drive,
    *,
    at: float | None = None,
    force_tolerance: float = 0.01,
    elements: int | None = None,
    progress: Report | None = None,
) -> Run:
    """Find the steady running of a drive, without a simulation over time.

    Speeds, torques and schedules are taken at one instant and held; harmonics, and whatever else changes with the
    angles of shafts, are left out. The mesh is one of its own, graded towards the ends of arcs, and refined until
    contact forces no longer depend on it.

    Parameters
    ----------
    drive
        The drive.
    at
        At which instant speeds, torques and schedules are taken, s; by default at the end of the simulation.
    force_tolerance
        Error of contact forces, over the largest of a pulley, up to which the mesh is refined.
    elements
        Number of equal elements, in place of the graded mesh.
    progress
        Called now and then with a `Progress`.

    Returns
    -------
    Run
        Two turns of the belt in steady running. Its drive has the length, or the take-up, that gives the installed
        tension.

    Raises
    ------
    ModelError
        If the drive cannot run steadily: its belt is open, nothing drives, or a pulley is not a smooth circle.
    ConvergenceError
        If there is no steady running; it says which pulley slips through, and what it transmits at most.

    Examples
    --------
    >>> run = bd.steady_state(drive)
    >>> round(float(run.dataset.pulley_speed.isel(time=-1, pulley=1)), 4)  # rad/s
    12.0
    """
    instant = drive.simulation.duration if at is None else at
    _require_steady(drive, force_tolerance, elements)
    if progress is not None:
        progress(Progress(0.0, drive.simulation.duration, 0.0, 0, "equilibrium"))
    rest = bring_to_stand(drive, elements)
    search, begun = SteadySearch(rest, instant), time.perf_counter()
    search.run()
    errors = refine(search, rest, force_tolerance, elements)
    duration = _TURNS * rest.drive.belt_length / abs(search.belt_parameter)
    shown = rest.drive.replace(
        simulation=drive.simulation.replace(duration=duration, output_interval=duration, field_interval=None)
    )
    title = f"Belt drive in steady running, as at {instant:g} s"
    with Recording(shown, search.constant, None, title, None) as recording:
        recording.start(rest.drive, search.constant, ())
        recording.take(_running(search.constant, search.state, duration))
        recording.note(
            drive_as_given=drive.text,
            steady_at=instant,
            wall_time=time.perf_counter() - begun,
            **search.friction_band(rest.system.tensioners),
            belt_parameter=search.belt_parameter,
            newton_iterations_of_search=search.iterations,
            **{mesh_error_attribute(name): error for name, error in errors.items()},
        )
    return recording.run()


def _require_steady(drive: Drive, force_tolerance: float, elements: int | None) -> None:
    """Make sure that a drive may run steadily, and that the options make sense.

    Raises
    ------
    ModelError
        If not.
    """
    if drive.ends:
        raise ModelError(
            "an open belt has no steady running: its ends do not run around. Simulate it with `beltdyn run`."
        )
    shaped = [pulley.name for pulley in drive.pulleys if pulley.surface and pulley.surface.kind != "circle"]
    if shaped:
        raise ModelError(
            f"{', '.join(shaped)} is no smooth circle, so that nothing is steady around it. Simulate the drive with "
            "`beltdyn run`, or remove `surface`."
        )
    other = [(pulley.name, load.kind) for pulley in drive.pulleys for load in pulley.load if not load.of_speed_alone]
    if other:
        raise ModelError(
            f'{other[0][0]} has a load of kind "{other[0][1]}", whose torque does not depend on the speed alone, as '
            "steady running needs it. Give its mean as a table over the speed, the set speed of a controlled motor as "
            "`speed`, or simulate the drive with `beltdyn run`."
        )
    if not 0.0 < force_tolerance < 1.0:
        raise ModelError(f"force_tolerance = {force_tolerance:g} must lie between 0 and 1, such as 0.01 for 1 %.")
    if elements is not None and elements < 3:
        raise ModelError(f"elements = {elements} must be 3 or more. Leave it out for a graded mesh.")


def _running(system: System, state: State, duration: float) -> Chunk:
    """A while of steady running: the shape of the belt stays, and shafts turn on."""
    place = state.position.copy()
    rims = slice(system.first_body, place.size - system.tensioners.size)
    moments = body_forces_at(system, np.zeros(1), place[None].copy(), state.velocity[None].copy()).moment[0]
    place[rims] = twists(system, moments)
    instants = np.array([0.0, duration])
    position, velocity = np.stack([place, place]), np.stack([state.velocity, state.velocity])
    position[1, rims] += duration * state.velocity[rims]
    forces = body_forces_at(system, instants, position, velocity)
    work = np.zeros((2, forces.power.shape[1] + 1))
    work[1, :-1] = duration * forces.power[1]
    return Chunk(instants, instants, position, velocity, work, forces, duration)

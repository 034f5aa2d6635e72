"""From a drive to a run: start, integrate, observe, record."""

from pathlib import Path

import numpy as np

from beltdyn.model import Drive, install
from beltdyn.model import Path as BeltPath
from beltdyn.results import Run, require_room
from beltdyn.solve.alpha_march import GeneralizedAlpha
from beltdyn.solve.progress import Report
from beltdyn.solve.recording import Recording
from beltdyn.solve.standard import StandardIntegrator
from beltdyn.solve.static import find_equilibrium
from beltdyn.solve.trajectory import Chunk, Integrator, drive_task
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.state import State, laid

_DEEPEST_START = 0.1
"""Depth of a belt from which equilibrium is sought, at most, over the smallest radius."""


def simulate(
    drive: Drive, output: Path | str | None = None, progress: Report | None = None, overwrite: bool = False
) -> Run:
    """Simulate a drive over time.

    Parameters
    ----------
    drive
        The drive.
    output
        Result file (NetCDF4), written as the simulation goes; without one the results stay in memory.
    progress
        Called now and then with a `Progress`.
    overwrite
        Replace any regular file by the results, and not only earlier results.

    Returns
    -------
    Run
        Its status is "completed", or "interrupted" after Ctrl-C.

    Raises
    ------
    ModelError
        If the result file cannot be written, is being written by another run, or would replace a file that is no
        result; there is no room for it; or an integrator is not installed.
    SimulationError
        If the simulation cannot go on (`ConvergenceError`) or the disk is full (`OutputError`); what was computed is
        kept in the file, with the status "failed".

    Examples
    --------
    >>> short = drive.replace(simulation=drive.simulation.replace(duration=0.01))
    >>> run = bd.simulate(short)
    >>> run.status, run.outputs
    ('completed', 11)
    """
    require_room(drive, Path(output) if output is not None else None)
    system, settings = drive_system(drive), drive.simulation
    with Recording(drive, system, output, f"Belt drive, {settings.duration:g} s", progress, overwrite) as recording:
        recording.prepare()
        state = laid(system, drive.path)
        if settings.start == "equilibrium":
            recording.tell(0.0, "equilibrium")
            state = _at_rest(drive, system)
        recording.start()
        task = drive_task(drive, system, state, recording.statistics)
        for chunk in choose_integrator(drive)(task):
            recording.take(chunk)
        recording.check()
    return recording.run()


def equilibrium(drive: Drive, progress: Report | None = None) -> Run:
    """Find the static equilibrium of a drive at rest, with pulleys that do not turn.

    Parameters
    ----------
    drive
        The drive.
    progress
        Called now and then with a `Progress`.

    Returns
    -------
    Run
        With one output, at time zero.

    Raises
    ------
    ConvergenceError
        If no equilibrium is found.

    Examples
    --------
    >>> run = bd.equilibrium(drive)
    >>> run.dataset.span_tension.values.round().tolist()  # N
    [[27.0, 27.0]]
    """
    system = drive_system(drive)
    with Recording(drive, system, None, "Belt drive in static equilibrium", progress) as recording:
        recording.prepare()
        recording.tell(0.0, "equilibrium")
        state = _at_rest(drive, system)
        recording.take(Chunk.start(state), "equilibrium")
    return recording.run()


def _at_rest(drive: Drive, system: System) -> State:
    """Static equilibrium, sought from a belt that lies in its pulleys instead of on their rims.

    On the rims themselves rounding decides which nodes touch, and on coarse meshes with contact at nodes the search
    then finds no step that helps.  Rims drawn in by one depth leave spans and wrap angles as they are.
    """
    installation = install(drive)
    path = installation.path
    depth = min(np.min(installation.penetrations), _DEEPEST_START * np.min(drive.radii))
    drawn_in = BeltPath(path.centers, path.radii - depth * np.sign(path.radii))
    return find_equilibrium(system, laid(system, drawn_in, installation.tensioner_positions)).state


def choose_integrator(drive: Drive) -> Integrator:
    """The integrator that a drive file asks for.

    Parameters
    ----------
    drive
        The drive.

    Returns
    -------
    Integrator
        `GeneralizedAlpha` or a `StandardIntegrator`.
    """
    settings = drive.simulation
    if settings.integrator == "generalized_alpha":
        return GeneralizedAlpha(settings.spectral_radius, settings.rtol, settings.max_step)
    return StandardIntegrator(settings.integrator, settings.rtol, settings.max_step)

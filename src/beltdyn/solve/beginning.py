"""Initial state of a run: at rest, laid, in steady running, or from an earlier run."""

from collections.abc import Callable

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.earlier_run import EarlierRun
from beltdyn.model.frame import Frame
from beltdyn.solve.compilation import compile_kernels
from beltdyn.solve.earlier_run import begin_from, with_instant
from beltdyn.solve.integrators.generalized_alpha import GeneralizedAlpha
from beltdyn.solve.integrators.settling import Start
from beltdyn.solve.integrators.trajectory import Integrator
from beltdyn.solve.progress import Report
from beltdyn.solve.rest.installation import bring_to_rest
from beltdyn.solve.steady import require_steady_start
from beltdyn.solve.steady_running.flowing_start import Beginning, begin_flowing
from beltdyn.solve.steady_running.travelling_start import Held, steady_state_on
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.build_staying import flowing_system, staying_system
from beltdyn.system.state import State, laid

Begin = Callable[[Drive, System, State, Integrator, Report | None], Start]
"""``begin(drive, system, state, integrator, progress) -> Start``, from the drive and its state at rest."""


def settled(drive: Drive, integrator: Integrator) -> tuple[Drive, Frame]:
    """The drive with the instant and the mesh of the earlier run in which it begins, and its mesh with the reason.

    Where the drive leaves the mesh open, it is that of an earlier run, and travels where the integrator needs it.

    Raises
    ------
    ModelError
        If there is no such run, or it has no such state.
    """
    begun = with_instant(drive)
    if begun.simulation.frame != drive.simulation.frame:
        return begun, begun.frame._replace(reason="as in the run it continues")
    if drive.simulation.frame is None and drive.frame.stays and not isinstance(integrator, GeneralizedAlpha):
        moved = begun.replace(simulation=begun.simulation.replace(frame="travelling"))
        return moved, moved.frame._replace(reason=f"since the integrator is {integrator.name}")
    return begun, begun.frame


def compile_ahead(drive: Drive) -> None:
    """Compile the kernels of a run once, before several processes need them."""
    if drive.frame.stays:
        lengths = np.full(drive.elements, drive.belt_length / drive.elements)
        system = flowing_system(staying_system(drive, lengths), np.array([1.0, 0.0]))
    else:
        system = drive_system(drive)
    compile_kernels(system, laid(system, drive.path))


def mesh_of(drive: Drive, integrator: Integrator, progress: Report | None = None) -> Beginning:
    """The mesh of a run, with the state on it where the mesh is found by that.

    Parameters
    ----------
    drive, integrator, progress
        As for `simulate`; from `settled`.

    Raises
    ------
    ModelError, ConvergenceError
        As `simulate`.
    """
    settings = drive.simulation
    staying = drive.frame.stays
    if staying and not isinstance(integrator, GeneralizedAlpha):
        raise ModelError(
            f'the integrator "{integrator.name}" does not support simulation.frame = "staying". Omit the '
            'integrator, or set simulation.frame = "travelling".'
        )
    if settings.start == "steady":
        require_steady_start(drive)
    if isinstance(settings.start, EarlierRun):
        return begin_from(drive)
    if staying:
        return begin_flowing(drive, progress)
    system = drive_system(drive)
    return Beginning(drive, system, laid(system, drive.path))


def begin_on(
    mesh: Beginning, integrator: Integrator, progress: Report | None = None, begin: Begin | None = None
) -> Beginning:
    """The state in which a run begins.

    Parameters
    ----------
    mesh
        From `mesh_of`.
    integrator, progress
        As for `simulate`.
    begin
        Goes on from there to the state with which an analysis begins; by default, a travelling mesh settles in
        steady running if it begins so.

    Raises
    ------
    ModelError, ConvergenceError
        As `simulate`.
    """
    settings = mesh.drive.simulation
    if mesh.drive.frame.stays or isinstance(settings.start, EarlierRun):
        found = mesh
    else:
        found = _travelling(mesh, progress)
        begin = begin or (Held() if settings.start == "steady" else None)
    if begin is None:
        return found
    system, state, said = begin(found.drive, found.system, found.state, integrator, progress)
    return found._replace(system=system, state=state, attributes={**found.attributes, **said})


def _travelling(mesh: Beginning, progress: Report | None) -> Beginning:
    """The state in which a run on the travelling mesh begins."""
    drive = mesh.drive
    start = drive.simulation.start
    if drive.belt.installed_tension is None and start == "laid":
        return mesh
    rest = bring_to_rest(drive, progress)
    if start == "steady":
        state = steady_state_on(rest)
    else:
        state = rest.state if start == "equilibrium" else laid(rest.system, rest.drive.path)
    return Beginning(rest.drive, rest.system, state, rest.unstable)

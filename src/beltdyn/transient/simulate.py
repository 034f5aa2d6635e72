"""Simulation of a drive over time."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import cast

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, Simulation, prepare
from beltdyn.model.pulley import has_functions
from beltdyn.model.simulation import INTEGRATORS
from beltdyn.observation.compilation import compile_kernels
from beltdyn.observation.observer import Arrays
from beltdyn.observation.recording import Recording
from beltdyn.parts.messages import listing
from beltdyn.parts.options import takes_options
from beltdyn.parts.quantity import Flag, number_in
from beltdyn.results import Run, open_run, require_room
from beltdyn.results.checks.mesh import COARSE_SETTINGS
from beltdyn.results.dataset import is_result
from beltdyn.results.summary import FAILURE, VALUES, coarse_settings, ends_steadily, steady_losses, steady_values
from beltdyn.solvers.generalized_alpha import AlphaIntegration, GeneralizedAlpha
from beltdyn.solvers.run_progress import Report
from beltdyn.solvers.standard import Name, StandardIntegrator
from beltdyn.solvers.trajectory import Integrator, drive_task
from beltdyn.state.staying import on_quintics
from beltdyn.state.steady import require_steady, steady_state
from beltdyn.transient.beginning import Begin, begin_on, mesh_of, settled, with_instant
from beltdyn.transient.checkpoint import CheckpointWarning, Keeper, checkpoint_file, read_checkpoint

CHECKPOINT = 60.0
"""Computing time between two checkpoints of a run, s."""


@takes_options
def simulate(
    drive: Drive,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
    integrator: Integrator | None = None,
    *,
    compare_steady: Flag = False,
    checkpoint: float | str = CHECKPOINT,
    resume: Flag = False,
) -> Run:
    """Simulate a drive over time.

    Parameters
    ----------
    drive
        The drive.
    output
        Result file (NetCDF4), written during the simulation; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.
    integrator
        Method of time integration; by default `simulation.integrator` of the drive. `Stepwise` makes an integrator from
        a one-step method.
    compare_steady
        Also compute the steady running under the speeds and loads at the end, and compare the run with it.
    checkpoint
        Computing time between two checkpoints, such as "10 min", or in s: an interrupted or killed run can resume from
        the last one. They are stored beside the result file with the ending ``.checkpoint``, and removed at the end.
    resume
        Resume the run in the result file, with the same steps and results as without the interruption. A complete run
        is returned as it is; one that has kept nothing, or keeps no checkpoints, begins anew. On the command line the
        result file may be given instead of the drive file.

    Returns
    -------
    Run
        Its status is "completed", or "interrupted" after Ctrl-C. Its drive has the length, or the take-up, that gives
        the installed tension.

    Raises
    ------
    ModelError
        If the result file cannot be written, is being written by another run, or would replace a file that is not a
        result; the disk is too small; or an integrator is not installed.
    SimulationError
        If the simulation fails (`ConvergenceError`) or the disk is full (`OutputError`); the results so far are kept in
        the file, with the status "failed".

    Examples
    --------
    >>> short = drive.replace(simulation=drive.simulation.replace(duration=0.01))
    >>> run = bd.simulate(short)
    >>> run.status, run.outputs
    ('completed', 11)
    """
    every = number_in("checkpoint", checkpoint, "s")
    if not every > 0.0:
        raise ModelError(f"checkpoint = {every:g} s must be above zero. Increase it, or omit it.")
    if resume:
        found = _resume(drive, output, progress, integrator, every)
        if found is not None:
            return found
    return record_run(drive, output, progress, overwrite, integrator, compare_steady=compare_steady, checkpoint=every)


def record_run(
    drive: Drive,
    output: Path | str | None,
    progress: Report | None,
    overwrite: bool,
    integrator: Integrator | None = None,
    *,
    begin: Begin | None = None,
    watch: Callable[[Arrays], None] | None = None,
    compare_steady: bool = False,
    checkpoint: float = CHECKPOINT,
    **attributes: str,
) -> Run:
    """Simulate a drive over time, for an analysis that says something of its own about the run."""
    given = drive
    if drive.simulation.given_duration is None:
        raise ModelError('simulation.duration is missing, the time to be simulated. Give it, such as "1 s".')
    if compare_steady:
        require_steady(on_quintics(drive))
    integrator = integrator or choose_integrator(drive)
    drive, frame = settled(drive, integrator)
    prepared = prepare(drive)
    require_room(prepared, Path(output) if output is not None else None)
    mesh = mesh_of(prepared, integrator, progress)
    title = f"{drive.title}, {drive.simulation.duration:g} s"
    about = {**attributes, **mesh.attributes, "mesh_frame_reason": frame.reason}
    with Recording(prepared, mesh.system, output, title, progress, overwrite, **about) as recording:
        recording.prepare()
        found = begin_on(mesh, integrator, progress, begin)
        recording.integrator, recording.watch = integrator.name, watch
        recording.start(found.prepared, found.system, found.unstable)
        recording.note(**found.attributes)
        task = drive_task(found.prepared, found.system, found.state, recording.statistics)
        if isinstance(integrator, GeneralizedAlpha) and not has_functions(given.pulleys):
            keeper = Keeper(Path(output) if output is not None else None, checkpoint, given, compare_steady)
            _integrate(integrator.begin(task), recording, keeper)
        else:
            for chunk in integrator(task):
                recording.take(chunk)
        _end(recording, given, compare_steady)
    return recording.run()


def _integrate(integration: AlphaIntegration, recording: Recording, keeper: Keeper) -> None:
    """Record an integration to its end, with checkpoints on the way."""
    for chunk in integration.chunks():
        recording.take(chunk)
        keeper.look(recording, integration)
    keeper.remove()


def _end(recording: Recording, given: Drive, compare_steady: bool) -> None:
    """What is looked for when a run is complete."""
    recording.check()
    if compare_steady:
        recording.note(**_steady_running(given))
    coarse = coarse_settings(given)
    if coarse and not given.ends and ends_steadily(recording.run()):
        recording.note(**_steady_losses(given), **{COARSE_SETTINGS: listing(coarse)})


def _resume(
    drive: Drive, output: Path | str | None, progress: Report | None, integrator: Integrator | None, checkpoint: float
) -> Run | None:
    """Resume a run from its checkpoint; None, with a warning, where it has to begin anew."""
    if output is None:
        raise ModelError("resume continues a run in its result file, but none is given. Give it as output.")
    path = Path(output)
    kept = _kept_run(drive, path)
    if kept is not None and kept.status == "completed":
        return kept
    if why := _without_checkpoints(drive, integrator):
        begun = f"the run {why}, so it writes no checkpoints"
    elif not checkpoint_file(path).exists():
        begun = "no run of this drive has begun there" if kept is None else "its run ended before its first checkpoint"
    else:
        begun = ""
    if begun:
        warnings.warn(f"{path} has nothing to resume: {begun}. It begins anew.", CheckpointWarning, stacklevel=4)
        return None
    point = read_checkpoint(checkpoint_file(path))
    if drive not in (point.drive, point.recording["_prepared"].drive):
        raise ModelError(
            f"{checkpoint_file(path)} belongs to another drive than the given one. Give the drive file with "
            "which the run started, or run this one from the beginning, without resume."
        )
    with Recording.resumed(point.recording, path, progress) as recording:
        compile_kernels(point.integration.task.system, point.integration.task.start)
        keeper = Keeper(path, checkpoint, point.drive, point.compare_steady, resumes=True)
        _integrate(point.integration, recording, keeper)
        _end(recording, point.drive, point.compare_steady)
    return recording.run()


def _kept_run(drive: Drive, path: Path) -> Run | None:
    """The run of a drive in a result file; None without one."""
    if not is_result(path):
        return None
    run = open_run(path)
    told = run.dataset.attrs
    if drive.text == told["drive"]:
        return run
    laid = prepare(settled(drive, choose_integrator(drive))[0]).drive
    if laid.text != told.get("drive_as_given", told["drive"]):
        run.dataset.close()
        raise ModelError(
            f"{path} holds the run of another drive, which would be lost. Give the drive file with which that run "
            "started, or run this one from the beginning, without resume."
        )
    return run


def _without_checkpoints(drive: Drive, integrator: Integrator | None) -> str:
    """Why an interrupted run cannot be resumed; empty where it can."""
    if has_functions(drive.pulleys):
        return 'has a load of kind "function", which cannot be stored in a file'
    chosen = choose_integrator(drive) if integrator is None else integrator
    if not isinstance(chosen, GeneralizedAlpha):
        return f'has integrator = "{chosen.name}", whose state is not stored'
    return ""


def _steadily(drive: Drive) -> Run:
    """Steady running at the end of the run of a drive, whatever its elements."""
    return steady_state(with_instant(on_quintics(drive)))


def _steady_running(drive: Drive) -> dict[str, object]:
    """Attributes with the steady running at the speeds and loads of the end, or why there is none."""
    try:
        return {VALUES: steady_values(_steadily(drive))}
    except (ConvergenceError, ModelError) as error:
        return {FAILURE: str(error)}


def _steady_losses(drive: Drive) -> dict[str, object]:
    """Attributes with losses and slip in steady running at the end; empty if there is no steady running."""
    try:
        return dict(steady_losses(_steadily(drive)))
    except (ConvergenceError, ModelError):
        return {}


def choose_integrator(drive: Drive) -> Integrator:
    """The integrator that a drive file asks for."""
    made: Integrator = INTEGRATORS[drive.simulation.integrator].made(drive.simulation)
    return made


def generalized_alpha(settings: Simulation) -> Integrator:
    """The method of this package with the settings of a drive."""
    return GeneralizedAlpha(settings.spectral_radius, settings.rtol, settings.max_step)


def standard(settings: Simulation) -> Integrator:
    """A method of SUNDIALS or SciPy with the settings of a drive."""
    return StandardIntegrator(cast(Name, settings.integrator), settings.rtol, settings.max_step)

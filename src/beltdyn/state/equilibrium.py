"""Static equilibrium of a drive at rest."""

from collections.abc import Mapping
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.observation.recording import Recording
from beltdyn.parts.options import ForceTolerance, takes_options
from beltdyn.results import StaticResult, mesh_error_attribute, static_result
from beltdyn.solvers.run_progress import Report
from beltdyn.solvers.trajectory import Chunk
from beltdyn.state.installation import bring_to_rest, holding_force, on_equal_elements, rest_of
from beltdyn.state.refinement import refine_at_rest
from beltdyn.state.static import standing
from beltdyn.system.arrays import System
from beltdyn.system.state import State

_TOLERANCE = 0.01
"""Default tolerance of contact forces of a belt that needs a graded mesh at rest."""


@takes_options
def equilibrium(
    drive: Drive, *, force_tolerance: ForceTolerance | None = None, progress: Report | None = None
) -> StaticResult:
    """Compute the static equilibrium of a drive at rest.

    Parameters
    ----------
    drive
        The drive.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which a mesh graded towards the ends of
        arcs is refined; by default simulation.force_tolerance. Without either the mesh has equal elements, as many as
        the drive; of a closed belt with teeth, supports or goods the mesh is graded, to a tolerance of 0.01.
    progress
        Called repeatedly with a `Progress`.

    Returns
    -------
    StaticResult
        Shape of the belt, tensions, contact forces and hub loads. Its drive has the length, or the take-up, that gives
        the installed tension.

    Raises
    ------
    ModelError
        If the tolerance is not between 0 and 1, or is given for an open belt.
    ConvergenceError
        If no equilibrium is found in which the belt touches every pulley.

    Examples
    --------
    >>> rest = bd.equilibrium(drive)
    >>> rest.dataset.span_tension.values.round().tolist()  # N
    [27.0, 27.0]
    """
    tolerance = drive.simulation.force_tolerance if force_tolerance is None else force_tolerance
    if tolerance is not None or (drive.stays_at_rest and drive.carriage is None):
        return _refined(drive, _TOLERANCE if tolerance is None else tolerance, progress)
    prepared = prepare(on_equal_elements(drive))
    rest = rest_of(prepared, progress)
    said = {"drive_as_given": drive.text}
    return _seen(prepared, rest.prepared, standing(rest.system), rest.state, rest.unstable, progress, said)


def _refined(drive: Drive, tolerance: float, progress: Report | None) -> StaticResult:
    """The equilibrium on a graded mesh, as fine as contact forces need it."""
    if drive.ends and not drive.is_web:
        raise ModelError(
            "force_tolerance does not apply to an open belt, whose elements are equally long. Omit it, and "
            "increase belt.elements."
        )
    prepared, unstable = prepare(drive), tuple[str, ...]()
    if not drive.stays_at_rest:
        unstable = bring_to_rest(drive, progress).unstable
    rest, errors = refine_at_rest(prepared, tolerance)
    said = {"drive_as_given": drive.text} | {mesh_error_attribute(name): error for name, error in errors.items()}
    return _seen(prepared, rest.prepared, standing(rest.system), rest.state, unstable, progress, said)


def _seen(
    prepared: Prepared,
    found: Prepared,
    system: System,
    state: State,
    unstable: tuple[str, ...],
    progress: Report | None,
    said: Mapping[str, Any],
) -> StaticResult:
    """A state as results, of a drive and of the one with the length that was found, with what is said of it."""
    title, reason = f"{prepared.drive.title} at rest, in static equilibrium", "as at rest"
    with Recording(prepared, system, None, title, progress, mesh_frame_reason=reason) as recording:
        recording.start(found, system, unstable)
        recording.note(**said)
        there = Chunk.start(system, state)
        there.forces.hub[0, found.reference] -= holding_force(system, state)
        recording.take(there, "equilibrium")
    return static_result(recording.run())

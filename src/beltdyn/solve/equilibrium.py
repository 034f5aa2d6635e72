"""An analysis: the static equilibrium of a drive at rest."""

from beltdyn.model import Drive
from beltdyn.results import StaticResult, static_result
from beltdyn.solve.integrators.trajectory import Chunk
from beltdyn.solve.observation.recording import Recording
from beltdyn.solve.progress import Report
from beltdyn.solve.rest.installation import bring_to_rest, on_equal_elements
from beltdyn.solve.rest.static import standing


def equilibrium(drive: Drive, *, progress: Report | None = None) -> StaticResult:
    """Find the static equilibrium of a drive at rest, with pulleys that do not turn.

    Parameters
    ----------
    drive
        The drive.
    progress
        Called now and then with a `Progress`.

    Returns
    -------
    StaticResult
        Shape of the belt, tensions, contact forces and hub loads. Its drive has the length, or the take-up, that gives
        the installed tension, and the mesh of equal elements that travels.

    Raises
    ------
    ConvergenceError
        If no equilibrium is found in which the belt touches every pulley.

    Examples
    --------
    >>> rest = bd.equilibrium(drive)
    >>> rest.dataset.span_tension.values.round().tolist()  # N
    [27.0, 27.0]
    """
    given, drive = drive.text, on_equal_elements(drive)
    rest = bring_to_rest(drive, progress)
    system = standing(rest.system)
    recording = Recording(drive, system, None, f"{drive.title} at rest, in static equilibrium", progress)
    recording.start(rest.drive, system, rest.unstable)
    recording.note(drive_as_given=given)
    recording.take(Chunk.start(system, rest.state), "equilibrium")
    recording.end("completed")
    return static_result(recording.run())

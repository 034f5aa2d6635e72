"""The errors that beltdyn raises, with their exit codes on the command line, and what it says of unexpected ones."""

import os
import traceback
from pathlib import Path


class BeltdynError(Exception):
    """Base class of all errors that beltdyn raises on purpose.

    The message gives the value, the rule and the remedy, and can be shown to users as it is.

    Examples
    --------
    >>> try:
    ...     bd.loads("belt = 3")
    ... except bd.BeltdynError as error:
    ...     print(type(error).__name__, error.exit_code)
    ModelError 2
    """

    exit_code = 2


class ModelError(BeltdynError, ValueError):
    """Invalid input: a drive file, a result file or an output path.

    Examples
    --------
    >>> try:
    ...     bd.model.Step(time="1 kg", value=2.0)
    ... except bd.ModelError as error:
    ...     print(error)
    step.time = "1 kg" must be in units of s, not "kg". Give the instant of the step, in s.
    """

    exit_code = 2


class SimulationError(BeltdynError, RuntimeError):
    """A simulation cannot continue; results up to then are kept."""

    exit_code = 3


class ConvergenceError(SimulationError):
    """The equations have no solution, or none was found; the message says when, where and what to try.

    Examples
    --------
    >>> try:
    ...     bd.steady_state(drive.with_({"pulley[driven].torque.value": -50.0}))
    ... except bd.ConvergenceError as error:
    ...     print(str(error).split(", which ")[1].split(" at this")[0])
    transmits at most 5.655 N m of the 50 N m required
    """


class TimeLimitError(SimulationError):
    """A search took longer than its limit of processor time; nothing is said of whether there is a solution."""


class OutputError(SimulationError):
    """Results can no longer be written, for example on a full disk; results written before remain readable."""


class LostOutputError(OutputError):
    """The result file was removed or replaced while it was being written; no results are kept."""


class SlipError(SimulationError):
    """Gross slip of a pulley that ends the analysis."""

    def __init__(self, fault: str, remedy: str) -> None:
        super().__init__(f"{fault} {remedy}")
        self.fault = fault


INTERNAL = "internal error"
"""How the text of an `InternalError` begins."""
TRACEBACKS = "BELTDYN_TRACEBACKS"
"""Environment variable: a file to which tracebacks of internal errors are appended."""

_PACKAGE = Path(__file__).parent
_INSTALLED = {"site-packages", "dist-packages"}


class InternalError(BeltdynError):
    """A fault of beltdyn itself, not of its input; the message names its place, and what repeats it.

    Examples
    --------
    >>> bd.InternalError.exit_code
    5
    """

    exit_code = 5


def classified(error: Exception, repeat: str = "") -> BeltdynError:
    """An error as beltdyn tells it: an unexpected one is an `InternalError`, unless a kind of the user raised it.

    Parameters
    ----------
    error : Exception
        The error, as it was caught.
    repeat : str
        The input that repeats it, in one line.
    """
    if isinstance(error, BeltdynError):
        return error
    what = f"{type(error).__name__}: {' '.join(str(error).split())}".removesuffix(": ")
    if isinstance(error, OSError | MemoryError):
        return SimulationError(f"{what}. The system refused it: free memory or disk space, or check the file.")
    place, is_ours = _place_of(error)
    if not is_ours:
        return SimulationError(f"{place} raised {what}. It is not part of beltdyn: correct it there.")
    _keep_traceback(error)
    remedy = f" Please report it with what repeats it: {repeat}" if repeat else " Please report it."
    return InternalError(f"{INTERNAL} in {place} ({what}): a fault of beltdyn, not of the drive.{remedy}")


def cause_of(error: Exception, repeat: str = "") -> str:
    """The message of an error; parameters as of `classified`."""
    return str(classified(error, repeat))


def is_internal(text: str) -> bool:
    """Whether a message, such as why a point failed, is that of an `InternalError`, or quotes one."""
    return f"{INTERNAL} in " in text


def _place_of(error: Exception) -> tuple[str, bool]:
    """Where an error was raised, libraries left aside, and whether that is in beltdyn."""
    frames = [(Path(frame.filename), frame) for frame in traceback.extract_tb(error.__traceback__)]
    ours = [one for one in frames if one[0].is_relative_to(_PACKAGE) or not _is_library(one[0])]
    if not ours:
        return "a library", True
    path, frame = ours[-1]
    is_ours = path.is_relative_to(_PACKAGE)
    name = path.relative_to(_PACKAGE).as_posix() if is_ours else path
    return f"{name}:{frame.lineno}", is_ours


def _is_library(path: Path) -> bool:
    from sysconfig import get_path

    return path.is_relative_to(get_path("stdlib")) or not _INSTALLED.isdisjoint(path.parts) or str(path).startswith("<")


def _keep_traceback(error: Exception) -> None:
    """Append the traceback of an error to the file that the user named, if any."""
    if file := os.environ.get(TRACEBACKS):
        with Path(file).open("a", encoding="utf-8") as kept:
            kept.writelines(traceback.format_exception(error))

"""The errors that beltdyn raises, with their exit codes on the command line, and what it says of unexpected ones."""

import os
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TypeVar

T = TypeVar("T")


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
    completed: tuple[Any, ...] = ()
    """What was completed nevertheless, such as the paths of other figures; see `Parts`."""


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


class Parts:
    """Does the parts of a whole, such as the figures of a result, each whatever becomes of the others.

    As a context it ends with `end`.

    Parameters
    ----------
    refuses : bool
        Whether a refusal (`ModelError`) of a part before any other was done refuses the whole at once.
    """

    def __init__(self, *, refuses: bool = False) -> None:
        self._refuses = refuses
        self.completed: list[Any] = []
        """What parts have completed, such as paths of files."""
        self.errors: list[BeltdynError] = []
        """What parts have raised."""

    def __enter__(self) -> Self:
        """Begin."""
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        """Raise what parts have raised, unless an error between parts goes before."""
        if error is None:
            self.end()

    def end(self) -> None:
        """Raise what parts have raised: a line for each, with the exit code of the gravest, and `completed`."""
        if self.errors:
            gravest = max(self.errors, key=lambda one: one.exit_code)
            lines = "\n".join(dict.fromkeys(map(str, self.errors)))
            raised = gravest if lines == str(gravest) else _with_exit_code(gravest.exit_code)(lines)
            raised.completed = tuple(self.completed)
            raise raised

    @contextmanager
    def part(self, repeat: str = "") -> Iterator[None]:
        """Do a part; what it raises is kept for the end, with the input that repeats it."""
        try:
            yield
        except Exception as error:
            self.fail(classified(error, repeat))

    def done(self, work: Callable[[], T], otherwise: T, repeat: str = "") -> T:
        """Do a part that gives something; `otherwise` if it fails."""
        with self.part(repeat):
            return work()
        return otherwise

    def fail(self, error: BeltdynError) -> None:
        """Keep the error of a part for the end."""
        self.completed += error.completed
        if self._refuses and isinstance(error, ModelError) and not (self.completed or self.errors):
            raise error
        self.errors.append(error)


def _with_exit_code(code: int) -> type[BeltdynError]:
    return next(one for one in (InternalError, SimulationError, ModelError) if one.exit_code == code)


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

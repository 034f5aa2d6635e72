"""The errors that beltdyn raises, with their exit codes on the command line."""


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
    transmits at most 5.654 N m of the 50 N m required
    """


class OutputError(SimulationError):
    """Results can no longer be written, for example on a full disk; results written before remain readable."""


class LostOutputError(OutputError):
    """The result file was removed or replaced while it was being written; no results are kept."""


class SlipError(SimulationError):
    """Gross slip of a pulley that ends the analysis."""

    def __init__(self, fault: str, remedy: str) -> None:
        super().__init__(f"{fault} {remedy}")
        self.fault = fault


def cause_of(error: Exception) -> str:
    """The message of an error; for unexpected errors also their type."""
    return str(error) if isinstance(error, BeltdynError) else f"{type(error).__name__}: {error}"

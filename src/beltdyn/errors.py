"""What can go wrong, each with the exit code of the command line."""


class BeltdynError(Exception):
    """Base of every error that beltdyn raises on purpose.

    The message says the value, the rule and the remedy, and is meant to be shown as it is.

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
    """The input cannot be used: a drive file, a result file or an output path.

    Examples
    --------
    >>> try:
    ...     bd.Step(time="1 kg", value=2.0)
    ... except bd.ModelError as error:
    ...     print(error)
    step.time = "1 kg" must be in units of s, not "kg". Give the instant of the step, in s.
    """

    exit_code = 2


class SimulationError(BeltdynError, RuntimeError):
    """A simulation cannot go on; what was computed is kept."""

    exit_code = 3


class ConvergenceError(SimulationError):
    """The equations find no solution: the message says when, where and what to try.

    Examples
    --------
    >>> try:
    ...     bd.steady_state(drive.with_({"pulley[driven].torque.value": -50.0}))
    ... except bd.ConvergenceError as error:
    ...     print(str(error).split(", which ")[1].split(" at this")[0])
    transmits at most 5.654 N m of the 50 N m asked
    """


class OutputError(SimulationError):
    """Results can no longer be written, as on a full disk; what was written before stays readable."""


class LostOutputError(OutputError):
    """The result file was removed or replaced while it was written; nothing is kept."""


class SlipError(SimulationError):
    """A pulley slips through where that ends the analysis.

    Parameters
    ----------
    fault : str
        Which, when and why.
    remedy : str
        What to do.
    """

    def __init__(self, fault: str, remedy: str) -> None:
        super().__init__(f"{fault} {remedy}")
        self.fault = fault


def cause_of(error: Exception) -> str:
    """What an error says of its cause; of one that is not raised on purpose its type too."""
    return str(error) if isinstance(error, BeltdynError) else f"{type(error).__name__}: {error}"

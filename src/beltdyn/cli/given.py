"""The input file of a command: a drive, or a run whose drive is used."""

from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, get_args

from beltdyn.analyses import Analysis
from beltdyn.errors import ModelError

if TYPE_CHECKING:
    from beltdyn.model import Drive
    from beltdyn.results import Run


def takes_runs(analysis: Analysis) -> bool:
    """Whether a run can replace the drive: the first parameter of the function may be one."""
    from beltdyn.results import Run

    first = next(iter(signature(analysis.function, eval_str=True).parameters.values()))
    return Run in get_args(first.annotation)


def read_given(analysis: Analysis, file: Path) -> "Drive | Run":
    """Read a drive file, or a result file if the analysis accepts runs.

    Parameters
    ----------
    analysis
        What is asked for.
    file
        The file.

    Raises
    ------
    ModelError
        If it is neither, or the drive cannot be used, or the results are those of another analysis.
    """
    from beltdyn.model import load
    from beltdyn.results import Run, open_result
    from beltdyn.results.dataset import is_result

    if not (takes_runs(analysis) and is_result(file)):
        return load(file)
    found = open_result(file)
    if not isinstance(found, Run):
        raise ModelError(
            f"{file} holds results of {found.kind}, not of a run. Give the result file of `beltdyn run` or "
            "`beltdyn steady`, or a drive file."
        )
    return found

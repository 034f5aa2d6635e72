"""Drives to TOML."""

import tomli_w

from beltdyn.errors import ModelError
from beltdyn.machines import FunctionLoad
from beltdyn.model.drive import Drive


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units and with every default spelled out.

    Parameters
    ----------
    drive : Drive
        The drive: what is given is written. That of a run has the length, or the take-up, that was found for it.

    Returns
    -------
    str
        A text from which `loads` makes the same drive.

    Raises
    ------
    ModelError
        If a load is a function of Python.

    Examples
    --------
    >>> bd.loads(bd.dumps(drive)) == drive
    True
    """
    refuse_functions(drive, "a drive file cannot hold a function of Python", "keep the drive in a script")
    return tomli_w.dumps(drive.data, multiline_strings=False)


def has_functions(drive: Drive) -> bool:
    """Tell whether a load of a drive is a function of Python, which no file holds and no other process has."""
    return any(isinstance(load, FunctionLoad) for pulley in drive.pulleys for load in pulley.load)


def refuse_functions(drive: Drive, rule: str, remedy: str) -> None:
    """Make sure that all of a drive can be written as text.

    Parameters
    ----------
    drive : Drive
        The drive.
    rule, remedy : str
        Why it must be, and what to do beside giving a table.

    Raises
    ------
    ModelError
        If a load is a function of Python.
    """
    for pulley in drive.pulleys:
        if any(isinstance(load, FunctionLoad) for load in pulley.load):
            raise ModelError(
                f'pulley "{pulley.name}" has a load of kind "function": {rule}. Give the load as a table, or {remedy}'
            )

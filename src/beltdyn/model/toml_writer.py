"""Drives to TOML."""

from collections.abc import Mapping
from typing import Any

import tomli_w

from beltdyn.model.drive import Drive, refuse_functions
from beltdyn.model.tolerances import tolerances_of
from beltdyn.parts.change import steps_of, unit_at
from beltdyn.parts.error_location import entry_name
from beltdyn.parts.toml_edits import Location


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units, with all defaults and tolerances.

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
    return spelled_out(drive, tolerances_of(drive))


def spelled_out(drive: Drive, tolerances: Mapping[str, float]) -> str:
    """Write a drive as `dumps` does, with given tolerances.

    Parameters
    ----------
    drive : Drive
        The drive.
    tolerances : mapping
        Path -> tolerance in SI units, of numbers that stand in the drive.

    Raises
    ------
    ModelError
        If a load is a function of Python.
    """
    refuse_functions(drive, "a drive file cannot hold a Python function", "keep the drive in a script")
    data = drive.data
    for path, size in tolerances.items():
        holder: Any = data
        *outer, last = location_of(data, path)
        for key in outer:
            holder = holder[key]
        holder[last] = f"{float(holder[last])!r} ± {size:.10g} {unit_at(drive, path)}".strip()
    return tomli_w.dumps(data, multiline_strings=False)


def location_of(data: Mapping[str, Any], path: str) -> Location:
    """The location of a path of `Drive.with_` in the plain data of a drive file.

    Parameters
    ----------
    data : mapping
        Groups and keys.
    path : str
        The path.

    Raises
    ------
    KeyError, IndexError
        If a group or a list on the way is not there; a last key may be missing.
    """
    given: Any = data
    location: Location = ()
    for step in steps_of(path):
        if location:
            given = given[location[-1]]
        location = (*location, _key(given, step))
    return location


def _key(holder: Any, step: str) -> str | int:
    """A step of a path as a key, or the position in a list."""
    if isinstance(holder, Mapping | str | float | int):  # a number may stand for a constant profile
        return step
    names = [entry_name(one) or str(number) for number, one in enumerate(holder, 1)]
    return names.index(step) if step in names else int(step) - 1

"""Drives to TOML."""

import math
from collections.abc import Mapping
from typing import Any

import tomli_w

from beltdyn.model.drive import Drive, refuse_functions
from beltdyn.model.toml_reader import loads
from beltdyn.parts.change import unit_at
from beltdyn.parts.quantity import written_like
from beltdyn.parts.text_file import parse_toml
from beltdyn.parts.tolerances import location_of, tolerances_of, with_tolerances
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text


def dumps(drive: Drive) -> str:
    """Write a drive as TOML, in SI units, with all defaults and tolerances.

    Parameters
    ----------
    drive : Drive
        The drive; only given values are written. The drive of a run has its computed length or take-up.

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
    """Write a drive as `dumps` does, with given tolerances."""
    refuse_functions(drive, "a drive file cannot hold a Python function", "keep the drive in a script")
    return tomli_w.dumps(with_tolerances(drive, drive.data, tolerances), multiline_strings=False)


# Change numbers in the text of a drive file and keep its comments, order and units

_DIGITS = 10


def edited(drive: Drive, changes: Mapping[str, float]) -> str:
    """The text of a drive with some numbers changed, and the rest as its author wrote it.

    Examples
    --------
    >>> from beltdyn.model.toml_writer import edited
    >>> text = edited(drive, {"belt.width": 0.012})
    >>> bd.loads(text).belt.width
    0.012
    """
    changed, data = drive.with_(changes), parse_toml(drive.text)
    try:
        edits = [_edit(data, path, value, unit_at(drive, path)) for path, value in changes.items()]
        text = changed_text(drive.text, edits, changed_data(data, edits))
        if text is not None and _near(loads(text).data, changed.data):
            return text
    except (LookupError, ValueError):
        pass
    return spelled_out(changed, tolerances_of(drive))


def _edit(data: dict[str, Any], path: str, value: float, unit: str) -> Edit:
    """The edit that gives a number its value in a drive file, where a default or a belt's profile may have given it."""
    *outer, last = location = location_of(data, path)
    holder: Any = data
    for key in outer:
        holder = holder[key]
    if isinstance(holder, str | int | float):  # a number that stands for a constant profile
        return Edit("set", tuple(outer), written_like(value, holder, unit, _DIGITS))
    given = holder.get(last) if isinstance(holder, dict) else holder[last]
    return Edit("set", location, written_like(value, given, unit, _DIGITS))


def _near(one: Any, other: Any) -> bool:
    """Whether data are the same, numbers to about ten digits."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_near(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_near, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=10.0 ** (1 - _DIGITS))
    return bool(one == other)

"""Change numbers in the text of a drive file and keep its comments, order and units."""

import math
from collections.abc import Mapping
from typing import Any

from beltdyn.model.drive import Drive
from beltdyn.model.tolerances import tolerances_of
from beltdyn.model.toml_reader import loads
from beltdyn.model.toml_writer import location_of, spelled_out
from beltdyn.parts.change import unit_at
from beltdyn.parts.quantity import written_like
from beltdyn.parts.text_file import parse_toml
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

_DIGITS = 10


def edited(drive: Drive, changes: Mapping[str, float]) -> str:
    """The text of a drive with some numbers changed, and the rest as its author wrote it.

    Parameters
    ----------
    drive : Drive
        The drive, as read from a file.
    changes : mapping
        Path -> number in SI units, as `Drive.with_` takes them.

    Returns
    -------
    str
        TOML, from which `loads` makes the changed drive to ten digits. A number that a default or the profile of a belt
        gave is a line more. Where the text cannot be changed so, as when a pulley has a diameter in place of the
        radius, every number is spelled out.

    Raises
    ------
    ModelError
        If a path leads nowhere, or the changed drive is not valid.

    Examples
    --------
    >>> from beltdyn.model.toml_editor import edited
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
    """The edit that gives a number its value in a drive file, where a default or a belt's profile may have given it.

    Raises
    ------
    KeyError, IndexError
        If its group does not stand there.
    """
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

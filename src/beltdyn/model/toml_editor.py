"""Numbers changed in the text of a drive file, which keeps its comments, its order and its units."""

import math
import re
from collections.abc import Mapping
from typing import Any

import tomlkit

from beltdyn.model.drive import Drive
from beltdyn.model.toml_reader import loads
from beltdyn.model.toml_writer import dumps
from beltdyn.parts.change import steps_of, unit_at
from beltdyn.parts.error_location import entry_name
from beltdyn.parts.quantity import to_si

_WITH_UNIT = re.compile(r"\s*[+-]?[\d.]+(?:[eE][+-]?\d+)?\s*(\S.*?)\s*")
_DIGITS = 10


def edited(drive: Drive, changes: Mapping[str, float]) -> str:
    """The text of a drive with some numbers changed, as its author wrote the rest.

    Parameters
    ----------
    drive : Drive
        The drive, as read from a file.
    changes : mapping
        Path -> number in SI units, as `Drive.with_` takes them.

    Returns
    -------
    str
        TOML, from which `loads` makes the changed drive to ten digits. Where its text cannot be changed so, as when
        a pulley has a diameter in place of the radius, every number is spelled out.

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
    changed, document = drive.with_(changes), tomlkit.parse(drive.text)
    try:
        for path, value in changes.items():
            _set(document, path, value, unit_at(drive, path))
        text = tomlkit.dumps(document)
        if _near(loads(text).data, changed.data):
            return text
    except (LookupError, ValueError):
        pass
    return dumps(changed)


def _set(document: Any, path: str, value: float, unit: str) -> None:
    """Set a number that stands in a document.

    Raises
    ------
    KeyError, IndexError
        If nothing stands there.
    """
    holder, (*steps, last) = document, steps_of(path)
    for step in steps:
        holder = holder[_key(holder, step)]
    key = _key(holder, last)
    holder[key] = _as_given(holder[key], value, unit)


def _key(holder: Any, step: str) -> str | int:
    """A step of a path as a key, or the position in a list."""
    if isinstance(holder, Mapping):
        return step
    names = [entry_name(one) or str(number) for number, one in enumerate(holder, 1)]
    return names.index(step) if step in names else int(step) - 1


def _as_given(given: object, value: float, unit: str) -> float | str:
    """A number in the unit that stands there."""
    match = _WITH_UNIT.fullmatch(given) if isinstance(given, str) else None
    if match is None:
        return float(f"{value:.{_DIGITS}g}")
    return f"{value / to_si(f'1 {match[1]}', unit):.{_DIGITS}g} {match[1]}"


def _near(one: Any, other: Any) -> bool:
    """Whether data are the same, numbers to about ten digits."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_near(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_near, one, other))
    if isinstance(one, float) and isinstance(other, float):
        return math.isclose(one, other, rel_tol=10.0 ** (1 - _DIGITS))
    return bool(one == other)

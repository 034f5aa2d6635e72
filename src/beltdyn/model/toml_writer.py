"""Drives to TOML."""

import math
from collections.abc import Iterator, Mapping
from typing import Any

import tomli_w

from beltdyn.errors import ModelError
from beltdyn.machines.profiles.profile import Profile
from beltdyn.model.drive import Drive, refuse_functions
from beltdyn.model.toml_reader import loads
from beltdyn.parts.change import as_argument, steps_of, unit_at, value_at
from beltdyn.parts.quantity import tolerance_in, written_like
from beltdyn.parts.text_file import entry_name, parse_toml
from beltdyn.parts.toml_edits import Edit, Location, changed_data, changed_text

# Tolerances of the numbers of a drive file, as in ``width = "12.5 ± 0.1 mm"``


def tolerances_of(drive: Drive) -> dict[str, float]:
    """Tolerances of the numbers of a drive, in SI units, by their paths.

    Examples
    --------
    >>> from beltdyn.model.toml_writer import tolerances_of
    >>> text = bd.example("two_pulley").text.replace('width = 0.01', 'width = "10 ± 0.2 mm"')
    >>> tolerances_of(bd.loads(text))
    {'belt.width': 0.0002}
    """
    found = dict[str, float]()
    for path, text in _texts(parse_toml(drive.text), ""):
        try:
            if isinstance(value_at(drive, path), Profile):
                path += ".value"
            tolerance = tolerance_in(text, unit_at(drive, path))
        except (ModelError, ValueError):
            continue  # no number: a name
        if tolerance is not None:
            number, size = as_argument(drive, path, tolerance)
            found[number] = size
    return found


def _texts(value: Any, path: str) -> Iterator[tuple[str, str]]:
    """All texts of a drive file, with the paths at which they stand."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _texts(inner, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for number, inner in enumerate(value, 1):
            yield from _texts(inner, f"{path}[{entry_name(inner) or number}]")


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
    data = drive.data
    for path, size in tolerances.items():
        holder: Any = data
        *outer, last = location_of(data, path)
        for key in outer:
            holder = holder[key]
        holder[last] = f"{float(holder[last])!r} ± {size:.10g} {unit_at(drive, path)}".strip()
    return tomli_w.dumps(data, multiline_strings=False)


def location_of(data: Mapping[str, Any], path: str) -> Location:
    """The location of a path of `Drive.with_` in the plain data of a drive file."""
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

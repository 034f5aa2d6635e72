"""Tolerances of the numbers of a part, given as texts such as ``"12.5 ± 0.1 mm"``."""

from collections.abc import Mapping
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.parts.change import as_argument, steps_of, unit_at, value_at
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import tolerance_in
from beltdyn.parts.text_file import entry_name
from beltdyn.parts.toml_edits import Location


def tolerances_of(part: Part) -> dict[str, float]:
    """Tolerances of the numbers of a part, in SI units, by their paths.

    Examples
    --------
    >>> from beltdyn.parts.tolerances import tolerances_of
    >>> tolerances_of(drive.with_({"belt.width": "10 ± 0.2 mm"}))
    {'belt.width': 0.0002}
    """
    found = dict[str, float]()
    for path, text in part.toleranced.items():
        try:
            if isinstance(value_at(part, path), Part):  # a constant profile
                path += ".value"
            tolerance = tolerance_in(text, unit_at(part, path))
        except (ModelError, ValueError):
            continue  # no number: a name
        if tolerance is not None:
            number, size = as_argument(part, path, tolerance)
            found[number] = size
    return found


def carry_tolerances(old: Part, new: Part) -> None:
    """Give a changed copy the tolerances of the numbers that it has in common with the original."""
    new.take_over({path: text for path, text in old.toleranced.items() if _found(old, path) == _found(new, path)})


def _found(part: Part, path: str) -> Any:
    """The value at a path; None if there is none."""
    try:
        return value_at(part, path)
    except ModelError:
        return None


def with_tolerances(part: Part, data: dict[str, Any], tolerances: Mapping[str, float]) -> dict[str, Any]:
    """The plain data of a part, as of a drive file, with its numbers written with tolerances."""
    for path, size in tolerances.items():
        holder: Any = data
        *outer, last = location_of(data, path)
        for key in outer:
            holder = holder[key]
        holder[last] = f"{float(holder[last])!r} ± {size:.10g} {unit_at(part, path)}".strip()
    return data


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

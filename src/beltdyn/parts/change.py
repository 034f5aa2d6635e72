"""Changes of nested values of a drive by paths such as ``pulley[driven].load[1].torque``, and their tolerances."""

import re
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn, get_args

from beltdyn.errors import ModelError
from beltdyn.parts.kind_fields import OneOf
from beltdyn.parts.messages import suggest
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import tolerance_in, unit_of
from beltdyn.parts.text_file import entry_name, shorten
from beltdyn.parts.toml_edits import Location

_STEP = re.compile(r"\.?([^.\[\]]+)|\[([^\[\]]+)\]")

Steps = tuple[str, ...]
"""A path as steps: keys, and names or numbers of list entries."""


def changed_arguments(part: Part, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Constructor arguments of a part with some values changed at once."""
    if not isinstance(changes, Mapping):
        raise ModelError(f'changes = {shorten(repr(changes))} must be a mapping, such as {{"belt.length": 1.2}}.')
    arguments = _changed(part, {steps_of(path): value for path, value in changes.items()}, "")
    assert isinstance(arguments, dict)
    return arguments


def value_at(part: Part, path: str) -> Any:
    """The value at a path."""
    return _followed(part, path)[-1][1]


def converted(part: Part, path: str, value: Any) -> Any:
    """A value converted as at a path, such as ``"25 mm"`` in m, validated by the innermost part alone."""
    inner, steps = _innermost(part, path)
    rest = f"{steps[0]}{''.join(f'[{one}]' for one in steps[1:])}"
    return value_at(type(inner)(**changed_arguments(inner, {rest: value})), rest)


def unit_at(part: Part, path: str) -> str:
    """The SI unit of the number at a path; empty for a dimensionless number."""
    inner, steps = _innermost(part, path)
    fields = {field.alias or name: field for name, field in type(inner).model_fields.items()}
    field = (fields | dict(type(inner).alternatives()))[steps[0]]
    unit = next((unit for one in (*field.metadata, field.annotation) if (unit := unit_of(one)) is not None), None)
    if unit is None:
        raise ModelError(f"{path} is not a number. Choose a number of the drive file.")
    return unit


def number_path(part: Part, path: str) -> str:
    """The path of a number that a study varies: that of a constant in place of a profile is the path of its value."""
    value = value_at(part, path)
    if value is None and _takes_group(part, path):
        raise ModelError(f"{path} is not given, so it has no number to vary. Give it, or the path of another number.")
    if not isinstance(value, Part):
        return path
    if getattr(value, "kind", "") == "constant":
        return f"{path}.value"
    numbers = [f"{path}.{key}" for key, one in value.arguments.items() if isinstance(one, float)]
    remedy = f"Give the path of a number in it: {', '.join(numbers)}." if numbers else "Give the path of a number."
    raise ModelError(f"{path} is a group of keys, not a number. {remedy}")


def _takes_group(part: Part, path: str) -> bool:
    """Whether a path leads to a group of keys, such as a profile, given or not."""
    inner, steps = _innermost(part, path)
    field = type(inner).model_fields.get(steps[0])
    choices = get_args(field.annotation) if field and len(steps) == 1 else ()
    return any(isinstance(entry, OneOf) for choice in choices for entry in getattr(choice, "__metadata__", ()))


def as_argument(part: Part, path: str, size: float) -> tuple[str, float]:
    """A toleranced number as the argument that replaces it: for a diameter, the radius with half the tolerance."""
    inner, steps = _innermost(part, path)
    other = inner.in_place_of.get(steps[0])
    if other is None or steps[0] in inner.arguments:
        return path, size
    value = inner.value_of(steps[0])
    least, largest = (inner.replace(**{steps[0]: value + sense * size}).value_of(other) for sense in (-1.0, 1.0))
    return f"{path.removesuffix(steps[0])}{other}", 0.5 * abs(largest - least)


def _innermost(part: Part, path: str) -> tuple[Part, Steps]:
    """The innermost part on a path, and the steps from there."""
    followed = _followed(part, path)
    number, inner = next((k, one) for k, (_, one) in reversed(list(enumerate(followed[:-1]))) if isinstance(one, Part))
    return inner, steps_of(path)[number:]


def _followed(part: Part, path: str) -> list[tuple[str, Any]]:
    """The part, and what each step of a path leads to, with the path up to there."""
    found: list[tuple[str, Any]] = [("", part)]
    for step in steps_of(path):
        place, value = found[-1]
        if isinstance(value, Part):
            known = value.keys()
            if step not in known:
                raise ModelError(f"{_joined(place, step)} is not a known key. {_sentence(suggest(step, known))}")
            found.append((_joined(place, step), value.value_of(step)))
        elif isinstance(value, Sequence) and not isinstance(value, str):
            number = _place_of(value, step, place)
            found.append((f"{place}[{entry_name(value[number]) or number + 1}]", value[number]))
        else:
            _refuse_inside(value, step, place)
    return found


def meaning_of(part: Part, path: str) -> Steps:
    """What a path leads to, the same for all its paths: entries by their numbers, arguments by those they replace."""
    found = list[str]()
    for step, (place, value) in zip(steps_of(path), _followed(part, path), strict=False):
        is_key = isinstance(value, Part)
        found.append(value.in_place_of.get(step, step) if is_key else f"{_place_of(value, step, place) + 1}")
    return tuple(found)


def require_distinct(part: Part, paths: Sequence[str], key: str = "number") -> None:
    """Make sure that paths lead to different values, of which none is a part of another."""
    known = [(path, meaning_of(part, path)) for path in paths]
    for place, (path, meaning) in enumerate(known):
        for other, same in known[:place]:
            if path == other:
                raise ModelError(f'{key} "{path}" is given twice. Remove one.')
            if meaning == same:
                raise ModelError(f'{key} "{path}" and "{other}" are the same value. Remove one.')
            if meaning[: len(same)] == same or same[: len(meaning)] == meaning:
                raise ModelError(f'{key} "{path}" and "{other}" overlap: one is a part of the other. Remove one.')


def steps_of(path: str) -> Steps:
    """The steps of a path: keys, and names or numbers of entries."""
    found = list(_STEP.finditer(str(path)))
    if not found or "".join(match[0] for match in found) != path or path.startswith((".", "[")):
        raise ModelError(f'"{path}" is not a path. Write for example "belt.length" or "pulley[driven].load[1].torque".')
    return tuple(match[1] or match[2] for match in found)


def _changed(value: Any, changes: Mapping[Steps, Any], path: str) -> Any:
    """What takes the place of a value: new values at the ends of paths, and copies on the way to them."""
    if () in changes:
        if len(changes) > 1:
            raise ModelError(f"{path} is changed both as a whole and in parts. Change one or the other.")
        return changes[()]
    groups: dict[str, dict[Steps, Any]] = {}
    for (first, *rest), new in changes.items():
        groups.setdefault(first, {})[tuple(rest)] = new
    if isinstance(value, Part):
        return _in_part(value, groups, path)
    if isinstance(value, Sequence) and not isinstance(value, str):
        return _in_list(value, groups, path)
    return _refuse_inside(value, next(iter(groups)), path)


def _refuse_inside(value: Any, step: str, path: str) -> NoReturn:
    """Say that there is nothing in a value."""
    if value is None:
        raise ModelError(f"{path} is not given, so nothing inside it can be changed. Give it as a whole.")
    raise ModelError(f"{path} = {value!r} has no part .{step}. Change it as a whole.")


def _in_part(part: Part, groups: Mapping[str, Mapping[Steps, Any]], path: str) -> dict[str, Any]:
    known, arguments = part.keys(), part.arguments
    for key in groups:
        if key not in known:
            raise ModelError(f"{_joined(path, key)} is not a known key. {_sentence(suggest(key, known))}")
    return part.merged({key: _changed(arguments.get(key), inner, _joined(path, key)) for key, inner in groups.items()})


def _in_list(entries: Sequence[Any], groups: Mapping[str, Mapping[Steps, Any]], path: str) -> list[Any]:
    changed, places = list(entries), dict[int, dict[Steps, Any]]()
    for step, inner in groups.items():  # an entry may be called by its name and by its number
        merged = places.setdefault(_place_of(entries, step, path), {})
        if twice := merged.keys() & inner.keys():
            rest = "".join(f".{one}" for one in next(iter(twice)))
            raise ModelError(f"{path}[{step}]{rest} is changed twice, by two names of the entry. Give it once.")
        merged |= inner
    for place, inner in places.items():
        changed[place] = _changed(entries[place], inner, f"{path}[{entry_name(entries[place]) or place + 1}]")
    return changed


def _place_of(entries: Sequence[Any], step: str, path: str) -> int:
    """Where an entry of a list is, by its name or its number counted from 1."""
    names = [entry_name(entry) or str(number) for number, entry in enumerate(entries, 1)]
    place = names.index(step) if step in names else int(step) - 1 if step.isdecimal() else -1
    if not 0 <= place < len(entries):
        known = suggest(step, names) if names else "The list is empty"
        counted = "; entries count from 1" if step.isdecimal() else ""
        raise ModelError(f"{path}[{step}] does not exist{counted}. {_sentence(known)}")
    return place


def _joined(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _sentence(text: str) -> str:
    return text if text.endswith("?") else f"{text}."


def tolerances_of(part: Part) -> dict[str, float]:
    """Tolerances of the numbers of a part, in SI units, by their paths.

    Examples
    --------
    >>> from beltdyn.parts.change import tolerances_of
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

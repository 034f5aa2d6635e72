"""Changes of numbers deep inside a drive, by the paths that error messages write: ``pulley[driven].load[1].torque``."""

import re
from collections.abc import Mapping, Sequence
from typing import Any

from beltdyn.errors import ModelError
from beltdyn.parts.error_location import entry_name
from beltdyn.parts.messages import suggest
from beltdyn.parts.part import Part

_STEP = re.compile(r"\.?([^.\[\]]+)|\[([^\[\]]+)\]")

Steps = tuple[str, ...]
"""A path, step by step: keys, and names or numbers of entries of lists."""


def changed_arguments(part: Part, changes: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments that make a part with some values changed, all at once.

    Parameters
    ----------
    part
        The part; it stays as it is.
    changes
        Path -> new value, None to leave the argument open.

    Returns
    -------
    dict
        Arguments of the constructor, which validates them.

    Raises
    ------
    ModelError
        If a path leads nowhere, or one leads into what another one replaces.
    """
    arguments = _changed(part, {_steps(path): value for path, value in changes.items()}, "")
    assert isinstance(arguments, dict)
    return arguments


def _steps(path: str) -> Steps:
    """The steps of a path."""
    found = list(_STEP.finditer(path))
    if "".join(match[0] for match in found) != path or path.startswith((".", "[")) or not path:
        raise ModelError(f'"{path}" is no path. Write for example "belt.length" or "pulley[driven].load[1].torque".')
    return tuple(match[1] or match[2] for match in found)


def _changed(value: Any, changes: Mapping[Steps, Any], path: str) -> Any:
    """What takes the place of a value: new values at the ends of paths, and copies on the way to them."""
    if () in changes:
        if len(changes) > 1:
            raise ModelError(f"{path} is replaced as a whole, and in parts. Change one or the other.")
        return changes[()]
    groups: dict[str, dict[Steps, Any]] = {}
    for (first, *rest), new in changes.items():
        groups.setdefault(first, {})[tuple(rest)] = new
    if isinstance(value, Part):
        return _in_part(value, groups, path)
    if isinstance(value, Sequence) and not isinstance(value, str):
        return _in_list(value, groups, path)
    if value is None:
        raise ModelError(f"{path} is not given, so that there is nothing in it to change. Give it as a whole.")
    raise ModelError(f"{path} = {value!r} holds nothing to change by .{next(iter(groups))}. Change it as a whole.")


def _in_part(part: Part, groups: Mapping[str, Mapping[Steps, Any]], path: str) -> dict[str, Any]:
    known, arguments = part.keys(), part.arguments
    for key in groups:
        if key not in known:
            raise ModelError(f"{_joined(path, key)} is not a known key. {_sentence(suggest(key, known))}")
    return part.merged({key: _changed(arguments.get(key), inner, _joined(path, key)) for key, inner in groups.items()})


def _in_list(entries: Sequence[Any], groups: Mapping[str, Mapping[Steps, Any]], path: str) -> list[Any]:
    names = [entry_name(entry) or str(number) for number, entry in enumerate(entries, 1)]
    changed = list(entries)
    for step, inner in groups.items():
        place = names.index(step) if step in names else int(step) - 1 if step.isdecimal() else -1
        if not 0 <= place < len(entries):
            known = suggest(step, names) if names else "There is none"
            counted = "; entries count from 1" if step.isdecimal() else ""
            raise ModelError(f"{path}[{step}] is not there{counted}. {_sentence(known)}")
        changed[place] = _changed(entries[place], inner, f"{path}[{names[place]}]")
    return changed


def _joined(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _sentence(text: str) -> str:
    return text if text.endswith("?") else f"{text}."

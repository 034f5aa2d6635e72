"""Edit TOML text and keep its comments, order and units."""

import copy
import re
import tomllib
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable, Table

Location = tuple[int | str, ...]
"""The keys and list positions of a value."""

_GROUP_WITHOUT_ROOM = re.compile(r"^([^#\n].*)\n(\[\[?[a-z_.]+\]\]?)$", re.MULTILINE)
_GROUPS = ("load", "hub")
"""Nested lists of groups written as `[[pulley.load]]`; others are written inline."""
_SINGLE_GROUPS = ("belt", "contact", "simulation", "limits", "sheet", "stretch_curve")
"""Groups written in brackets; others are written inline."""


class Edit(NamedTuple):
    """A change of one value."""

    action: Literal["set", "remove", "insert"]
    """Give a key its value, and the groups on the way to it; take a key or an entry away; or put an entry into a
    list."""
    location: Location
    """Where; of "insert" the last step is the position in the list, and the list is made if it is not there."""
    value: Any = None
    """Plain data of TOML; nothing for "remove"."""


def changed_data(data: dict[str, Any], edits: Sequence[Edit]) -> dict[str, Any]:
    """Return plain data with some edits; the input is unchanged."""
    changed = copy.deepcopy(data)
    for edit in edits:
        _apply(changed, edit, plain=True)
    return changed


def changed_text(text: str, edits: Sequence[Edit], data: dict[str, Any]) -> str | None:
    """Return a text with some edits, and the rest as its author wrote it."""
    try:
        written = tomlkit.parse(text)
        for edit in edits:
            _apply(written, edit, plain=False)
        changed = _GROUP_WITHOUT_ROOM.sub(r"\1\n\n\2", tomlkit.dumps(written))
        return changed if tomllib.loads(changed) == data else None
    except (TOMLKitError, tomllib.TOMLDecodeError, LookupError, TypeError, ValueError, AttributeError):
        return None


def _apply(container: Any, edit: Edit, plain: bool) -> None:
    """Change plain data, or a document of tomlkit, in place."""
    *way, last = edit.location
    for depth, step in enumerate(way):
        if isinstance(container, dict) and step not in container:
            if edit.action == "remove":
                return
            inside = isinstance(edit.location[depth + 1], int)
            empty: Any = [] if inside else {}
            container[step] = empty if plain else _written(empty, str(step), isinstance(container, InlineTable))
        if not isinstance(container[step], dict | list):  # a number that stands for a constant profile
            constant = {"kind": "constant", "value": container[step]}
            container[step] = constant if plain else _inline(constant)
        container = container[step]
    value = copy.deepcopy(edit.value)
    if not plain and edit.action != "remove":
        # the place of a group decides how it is written: in brackets, or in one line
        value = (
            _entry(value, container)
            if isinstance(last, int)
            else _written(value, str(last), isinstance(container, InlineTable))
        )
    if edit.action == "set":
        _set(container, last, value)
    elif edit.action == "insert":
        container.insert(last, value)
    elif isinstance(last, int) or last in container:
        del container[last]


def _set(container: Any, key: str | int, value: Any) -> None:
    """Give a key its value; a new one of a group stands before the blank lines and remarks at its end.

    There stands what the author says of the next group.
    """
    new = isinstance(container, Table) and key not in container
    body = container.value.body if new else []
    end = max((number + 1 for number, (one, _) in enumerate(body) if one is not None), default=len(body))
    after = body[end:]
    del body[end:]
    container[key] = value
    body.extend(after)


def _entry(value: Any, container: Any) -> Any:
    """An entry of a list as tomlkit writes it."""
    if isinstance(value, dict) and isinstance(container, AoT):
        return _table(value)
    return _inline(value)


def _written(value: Any, key: str, inline: bool) -> Any:
    """A value of a key as tomlkit writes it: lists of groups in brackets, other groups in one line."""
    if not inline and isinstance(value, list) and (not value or isinstance(value[0], dict)):
        if key in ("pulley", "tensioner", "end", *_GROUPS):
            written = tomlkit.aot()
            for one in value:
                written.append(_table(one))
            return written
    elif not inline and isinstance(value, dict) and key in _SINGLE_GROUPS:
        return _table(value)
    return _inline(value)


def _table(values: dict[str, Any]) -> Any:
    """A group in brackets."""
    table = tomlkit.table()
    for key, value in sorted(values.items(), key=lambda item: item[0] in _GROUPS):
        table[key] = _written(value, key, inline=False)
    return table


def _inline(value: Any) -> Any:
    """A value in one line."""
    if isinstance(value, dict):
        table = tomlkit.inline_table()
        for key, one in value.items():
            table[key] = _inline(one)
        return table
    if isinstance(value, list):
        array = tomlkit.array()
        for one in value:
            array.append(_inline(one))
        return array
    return tomlkit.item(value)

"""The drive file while it is edited: what it holds, its text with the comments, and what was there before."""

import copy
import re
import tomllib
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import tomli_w
import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, InlineTable

from beltdyn.parts.text_file import parse_toml

Location = tuple[int | str, ...]
"""Keys and positions in lists that lead to a value."""

_MOST_STATES = 200
_GROUP_WITHOUT_ROOM = re.compile(r"^([^#\n].*)\n(\[\[?[a-z_.]+\]\]?)$", re.MULTILINE)
_GROUPS = ("load", "hub")
"""Lists of groups inside a group, which are written as `[[pulley.load]]`; others are written in one line."""


class Edit(NamedTuple):
    """A change of one value.

    Attributes
    ----------
    action : {"set", "remove", "insert"}
        Give a key its value, and the groups on the way to it; take a key or an entry away; or put an entry into a list.
    location : tuple of str or int
        Where; of "insert" the last step is the position in the list, and the list is made if it is not there.
    value : Any
        Plain data of TOML; nothing for "remove".
    """

    action: Literal["set", "remove", "insert"]
    location: Location
    value: Any = None


class State(NamedTuple):
    """A drive file at one time: its text, and the data in it, which nobody changes."""

    text: str
    data: dict[str, Any]


class Document:
    """A drive file that is edited: its data may be wrong for a while, its text is TOML at any time.

    Comments and the order of the text are kept by tomlkit. Where the text that it gives would say something else than
    the data, the whole file is written anew, without comments.

    Parameters
    ----------
    text : str
        TOML.

    Raises
    ------
    ValueError
        If it is not.
    """

    def __init__(self, text: str) -> None:
        self._states = [State(text, parse_toml(text))]
        self._place = 0
        self.saved = text
        self.lost_comments = False

    @property
    def text(self) -> str:
        """The file as it stands."""
        return self._states[self._place].text

    @property
    def data(self) -> dict[str, Any]:
        """What it holds; not to be changed."""
        return self._states[self._place].data

    @property
    def changed(self) -> bool:
        """Whether it differs from what was saved."""
        return self.text != self.saved

    @property
    def can_undo(self) -> bool:
        """Whether there is an earlier state."""
        return self._place > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a later state."""
        return self._place + 1 < len(self._states)

    def preview(self, edits: Sequence[Edit]) -> dict[str, Any]:
        """Give the data as they would be, and change nothing."""
        data = copy.deepcopy(self.data)
        for edit in edits:
            _apply(data, edit, plain=True)
        return data

    def apply(self, edits: Sequence[Edit]) -> None:
        """Change the drive file by some edits, which are one step of undo.

        Raises
        ------
        LookupError
            If a location leads nowhere.
        """
        data = self.preview(edits)
        if data != self.data:
            self._append(State(self._text_with(edits, data), data))

    def replace(self, text: str) -> None:
        """Put another text in its place, which can be undone.

        Raises
        ------
        ValueError
            If it is not TOML.
        """
        if text != self.text:
            self._append(State(text, parse_toml(text)))

    def undo(self) -> None:
        """Go back to the state before, if there is one."""
        self._place = max(self._place - 1, 0)

    def redo(self) -> None:
        """Go on to the state after, if there is one."""
        self._place = min(self._place + 1, len(self._states) - 1)

    def _append(self, state: State) -> None:
        del self._states[self._place + 1 :]
        self._states.append(state)
        del self._states[:-_MOST_STATES]
        self._place = len(self._states) - 1

    def _text_with(self, edits: Sequence[Edit], data: dict[str, Any]) -> str:
        """The text with the edits, which holds these data."""
        try:
            written = tomlkit.parse(self.text)
            for edit in edits:
                _apply(written, edit, plain=False)
            text = _GROUP_WITHOUT_ROOM.sub(r"\1\n\n\2", tomlkit.dumps(written))
            if tomllib.loads(text) == data:
                return text
        except (TOMLKitError, tomllib.TOMLDecodeError, LookupError, TypeError, ValueError, AttributeError):
            pass  # what tomlkit cannot change is written anew
        self.lost_comments = self.lost_comments or "#" in self.text
        return tomli_w.dumps(data, multiline_strings=False)


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
        container[last] = value
    elif edit.action == "insert":
        container.insert(last, value)
    elif isinstance(last, int) or last in container:
        del container[last]


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
    elif not inline and isinstance(value, dict) and key in ("belt", "contact", "simulation", "limits", "stretch_curve"):
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

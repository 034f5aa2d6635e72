"""The drive file during editing: data, text with comments, and history."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import tomli_w

from beltdyn.parts.text_file import parse_toml
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

_MOST_STATES = 200


class State(NamedTuple):
    """A state of a drive file: its text and its data, not to be changed."""

    text: str
    data: dict[str, Any]


class Document:
    """A drive file being edited: its data may be invalid temporarily, its text is always TOML.

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
        """The present text."""
        return self._states[self._place].text

    @property
    def data(self) -> dict[str, Any]:
        """The present data, not to be changed."""
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
        """Return the data with some edits, without changing the document."""
        return changed_data(self.data, edits)

    def apply(self, edits: Sequence[Edit]) -> None:
        """Apply edits as a single undo step.

        Raises
        ------
        LookupError
            If a location leads nowhere.
        """
        data = self.preview(edits)
        if data != self.data:
            self._append(State(self._text_with(edits, data), data))

    def replace(self, text: str) -> None:
        """Replace the text, as an undo step.

        Raises
        ------
        ValueError
            If it is not TOML.
        """
        if text != self.text:
            self._append(State(text, parse_toml(text)))

    def undo(self) -> None:
        """Return to the previous state, if any."""
        self._place = max(self._place - 1, 0)

    def redo(self) -> None:
        """Advance to the next state, if any."""
        self._place = min(self._place + 1, len(self._states) - 1)

    def _append(self, state: State) -> None:
        del self._states[self._place + 1 :]
        self._states.append(state)
        del self._states[:-_MOST_STATES]
        self._place = len(self._states) - 1

    def _text_with(self, edits: Sequence[Edit], data: dict[str, Any]) -> str:
        """The text with the edits, which holds these data."""
        text = changed_text(self.text, edits, data)
        if text is None:
            self.lost_comments = self.lost_comments or "#" in self.text
            text = tomli_w.dumps(data, multiline_strings=False)
        return text

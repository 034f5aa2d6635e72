"""The drive of one tab: file, selection and actions."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import tomli_w

from beltdyn.app import placing
from beltdyn.app.draft import Draft, draft
from beltdyn.app.forms import System
from beltdyn.app.jobs import Job, Outcome
from beltdyn.app.scene import groups
from beltdyn.app.workspace import EMPTY, Workspace
from beltdyn.errors import ModelError
from beltdyn.parts.text_file import parse_toml
from beltdyn.parts.toml_edits import Edit, changed_data, changed_text

# The drive file during editing: data, text with comments, and history

_MAX_STATES = 200
"""Number of states of a drive file that are kept to be undone: older ones are dropped, to limit memory."""


class State(NamedTuple):
    """A state of a drive file: its text and its data, not to be changed."""

    text: str
    data: dict[str, Any]


class Document:
    """A drive file being edited: its data may be invalid temporarily, its text is always TOML.

    tomlkit keeps comments and order. Where its text would say something else than the data, the whole file is written
    anew, without comments.
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
        """Apply edits as a single undo step."""
        data = self.preview(edits)
        if data != self.data:
            self._append(State(self._text_with(edits, data), data))

    def replace(self, text: str) -> None:
        """Replace the text, as an undo step."""
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
        del self._states[:-_MAX_STATES]
        self._place = len(self._states) - 1

    def _text_with(self, edits: Sequence[Edit], data: dict[str, Any]) -> str:
        """The text with the edits, which holds these data."""
        text = changed_text(self.text, edits, data)
        if text is None:
            self.lost_comments = self.lost_comments or "#" in self.text
            text = tomli_w.dumps(data, multiline_strings=False)
        return text


_MAX_COORDINATE = 1e3
"""Largest coordinate accepted from the canvas, m."""
_MAX_OUTCOMES = 5
"""Number of outcomes of analyses that are kept: the files of older ones are deleted, to limit disk space."""
_ON_PULLEYS: Mapping[str, Callable[[Mapping[str, Any], int, Mapping[str, float]], list[Edit]]] = {
    "move": lambda data, number, to: placing.move(data, number, to["x"], to["y"]),
    "size": lambda data, number, to: placing.resize(data, number, to["radius"]),
    "nudge": lambda data, number, to: placing.nudge(data, number, to["x"], to["y"]),
    "grow": lambda data, number, to: placing.grow(data, number, to["radius"]),
    "flip": lambda data, number, to: placing.flip(data, number),
    "remove": lambda data, number, to: placing.remove(data, number),
    "earlier": lambda data, number, to: placing.shift(data, number, -1),
    "later": lambda data, number, to: placing.shift(data, number, 1),
}
_ON_TENSIONERS: Mapping[str, Callable[[Mapping[str, Any], int, Mapping[str, float]], list[Edit]]] = {
    "pivot": lambda data, number, to: placing.move_pivot(data, number, to["x"], to["y"]),
    "nudge_pivot": lambda data, number, to: placing.nudge_pivot(data, number, to["x"], to["y"]),
    "direction": lambda data, number, to: placing.turn_direction(data, number, to["x"], to["y"]),
}


class Session:
    """The drive of one tab, the analysis being computed, and the last outcomes, latest first."""

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.name: str | None = None
        self.document = Document(EMPTY)
        self.selected: int | None = None
        self.units: System = "mm"
        self.job: Job | None = None
        self.outcomes: list[tuple[str, Outcome]] = []
        self._known: tuple[str, Draft] | None = None

    @property
    def draft(self) -> Draft:
        """The present drive file, checked."""
        if self._known is None or self._known[0] != self.document.text:
            self._known = self.document.text, draft(self.document.data, self.workspace.folder.root)
        return self._known[1]

    @property
    def title(self) -> str:
        """Name of the file, with a mark for unsaved changes."""
        return f"{self.name or 'not saved yet'}{' *' if self.document.changed else ''}"

    def preview(self, edits: Sequence[Edit]) -> Draft:
        """The drive file with some edits, checked up to the layout."""
        return draft(self.document.preview(edits), self.workspace.folder.root, only_laid_out=True)

    def apply(self, edits: Sequence[Edit]) -> None:
        """Change the drive file."""
        before = len(groups(self.document.data, "pulley"))
        self.document.apply(edits)
        pulleys = len(groups(self.document.data, "pulley"))
        if pulleys > before:
            self.selected = next((one.location[1] for one in edits if one.action == "insert"), None)  # type: ignore[assignment]
        self._keep_selection()

    def undo(self) -> None:
        """Undo the last change."""
        self.document.undo()
        self._keep_selection()

    def redo(self) -> None:
        """Redo the undone change."""
        self.document.redo()
        self._keep_selection()

    def choose(self, number: object) -> None:
        """Select a pulley, or nothing."""
        self.selected = number if isinstance(number, int) and not isinstance(number, bool) else None
        self._keep_selection()

    def _keep_selection(self) -> None:
        if self.selected is not None and not 0 <= self.selected < len(groups(self.document.data, "pulley")):
            self.selected = None

    def edits_of(self, action: object, arguments: Mapping[str, object]) -> list[Edit]:
        """Edits of an action reported by the canvas; empty if it is meaningless."""
        to = {key: value for key in ("x", "y", "radius") if (value := _metres(arguments.get(key))) is not None}
        number, data = arguments.get("number"), self.document.data
        number = number if isinstance(number, int) and not isinstance(number, bool) else -1
        try:
            if action == "add":
                return placing.add(self.draft, to["x"], to["y"], self.workspace.folder.root)
            for actions, key in ((_ON_PULLEYS, "pulley"), (_ON_TENSIONERS, "tensioner")):
                if isinstance(action, str) and action in actions and 0 <= number < len(groups(data, key)):
                    return actions[action](data, number, to)
        except KeyError:
            pass  # a number is missing
        return []

    def new_tensioner(self, kind: str) -> list[Edit]:
        """Edits that add a tensioner to the selected pulley, or else to the last one."""
        pulleys, tensioners = (groups(self.document.data, key) for key in ("pulley", "tensioner"))
        number = self.selected if self.selected is not None else len(pulleys) - 1
        return placing.new_tensioner(self.draft, number, kind, len(tensioners)) if number >= 0 else []

    def follow_job(self) -> Job | None:
        """The running analysis, if any. A finished one becomes an outcome; the oldest is removed with its files.

        The page may be shown several times, as where it was loaded again a moment ago.
        """
        job = self.job
        if job is None:
            return None
        job.poll()
        if job.outcome is None:
            return job
        self.job = None
        self.workspace.jobs.discard(job)
        self.outcomes.insert(0, (job.name, job.outcome))
        for _, gone in self.outcomes[_MAX_OUTCOMES:]:
            for file in (gone.result, gone.report, gone.best):
                if file is not None:
                    file.unlink(missing_ok=True)
        del self.outcomes[_MAX_OUTCOMES:]
        return None

    def start(self, text: str, name: str | None = None) -> None:
        """Start from the text of a drive file."""
        try:
            self.document = Document(text)
        except ValueError as error:
            raise ModelError(f"{name or 'the drive file'} is not valid TOML: {error}. Correct the file.") from error
        self.name, self.selected = name, None

    def open(self, name: str) -> None:
        """Open a drive file of the folder."""
        self.start(self.workspace.folder.read(name), name)

    def save(self, name: str | None = None) -> str:
        """Save the drive file, by default under its name, and return its path."""
        target = name or self.name
        if target is None:
            raise ModelError("the drive has no file yet. Give a file name.")
        known = self.document.saved if target == self.name else None
        path = self.workspace.folder.write(target, self.document.text, known)
        self.name, self.document.saved = path.relative_to(self.workspace.folder.root).as_posix(), self.document.text
        return str(path)


def _metres(value: object) -> float | None:
    """A number that the browser sent, if it is one."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value) if abs(value) < _MAX_COORDINATE else None
    return None

"""A drive on the page of one tab: its file, what is chosen, and what is done with it."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from beltdyn.app import placing
from beltdyn.app.document import Document
from beltdyn.app.draft import Draft, draft
from beltdyn.app.jobs import Job, Outcome
from beltdyn.app.scene import groups
from beltdyn.app.workspace import EMPTY, Workspace
from beltdyn.errors import ModelError
from beltdyn.parts.toml_edits import Edit

_FARTHEST = 1e3
"""Coordinate up to which the canvas is believed, m."""
_MOST_RESULTS = 5
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
    """The drive of one tab.

    Parameters
    ----------
    workspace : Workspace
        The folder, and the drive file to begin with.

    Attributes
    ----------
    job : Job or None
        The analysis that is computed.
    outcomes : list of (str, Outcome)
        The last analyses that have ended, by their names, the latest first.
    """

    def __init__(self, workspace: Workspace) -> None:
        self.workspace = workspace
        self.name: str | None = None
        self.document = Document(EMPTY)
        self.selected: int | None = None
        self.job: Job | None = None
        self.outcomes: list[tuple[str, Outcome]] = []
        self._known: tuple[str, Draft] | None = None

    @property
    def draft(self) -> Draft:
        """What the drive file says as it stands."""
        if self._known is None or self._known[0] != self.document.text:
            self._known = self.document.text, draft(self.document.data, self.workspace.folder.root)
        return self._known[1]

    @property
    def title(self) -> str:
        """Name of the file, with a mark where it is not saved."""
        return f"{self.name or 'not saved yet'}{' *' if self.document.changed else ''}"

    def preview(self, edits: Sequence[Edit]) -> Draft:
        """What the drive file would say with some edits, as far as the layout goes."""
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
        """Take the last change back."""
        self.document.undo()
        self._keep_selection()

    def redo(self) -> None:
        """Make the change again that was taken back."""
        self.document.redo()
        self._keep_selection()

    def choose(self, number: object) -> None:
        """Choose a pulley, or none."""
        self.selected = number if isinstance(number, int) and not isinstance(number, bool) else None
        self._keep_selection()

    def _keep_selection(self) -> None:
        if self.selected is not None and not 0 <= self.selected < len(groups(self.document.data, "pulley")):
            self.selected = None

    def edits_of(self, action: object, arguments: Mapping[str, object]) -> list[Edit]:
        """Edits of what was done on the canvas, as the browser tells of it; none where that makes no sense.

        Parameters
        ----------
        action : object
            "move", "size", "nudge" and "grow" (by a step), "flip", "remove", "earlier" or "later" of a pulley; "pivot",
            "nudge_pivot" or "direction" of a tensioner; or "add".
        arguments : mapping
            The number of the pulley or tensioner, and numbers in m.
        """
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
        """Edits that add a tensioner, which carries the chosen pulley if there is one, and else the last."""
        pulleys, tensioners = (groups(self.document.data, key) for key in ("pulley", "tensioner"))
        number = self.selected if self.selected is not None else len(pulleys) - 1
        return placing.new_tensioner(self.draft, number, kind, len(tensioners)) if number >= 0 else []

    def follow_job(self) -> Job | None:
        """The analysis that is computed, if any. One that has ended becomes an outcome; the oldest goes with its files.

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
        for _, gone in self.outcomes[_MOST_RESULTS:]:
            for file in (gone.result, gone.report, gone.best):
                if file is not None:
                    file.unlink(missing_ok=True)
        del self.outcomes[_MOST_RESULTS:]
        return None

    def start(self, text: str, name: str | None = None) -> None:
        """Begin with a drive file.

        Raises
        ------
        ModelError
            If it is not TOML.
        """
        try:
            self.document = Document(text)
        except ValueError as error:
            raise ModelError(
                f"{name or 'the drive file'} is not valid TOML: {error}. Correct the file there."
            ) from error
        self.name, self.selected = name, None

    def open(self, name: str) -> None:
        """Open a drive file of the folder."""
        self.start(self.workspace.folder.read(name), name)

    def save(self, name: str | None = None) -> str:
        """Save the drive file, by default under its name, and say where.

        Raises
        ------
        ModelError
            If there is another file of this name, or it cannot be written.
        """
        target = name or self.name
        if target is None:
            raise ModelError("the drive has no file yet. Give it a name.")
        known = self.document.saved if target == self.name else None
        path = self.workspace.folder.write(target, self.document.text, known)
        self.name, self.document.saved = path.relative_to(self.workspace.folder.root).as_posix(), self.document.text
        return str(path)


def _metres(value: object) -> float | None:
    """A number that the browser sent, if it is one."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value) if abs(value) < _FARTHEST else None
    return None

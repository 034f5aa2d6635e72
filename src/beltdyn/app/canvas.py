"""The canvas in the browser: shows a scene and reports actions on it."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from nicegui.element import Element
from nicegui.events import GenericEventArguments

if TYPE_CHECKING:
    from beltdyn.app.watching import Glimpse


class Canvas(Element, component="canvas.js"):
    """An SVG on which pulleys are placed, dragged and sized.

    Parameters
    ----------
    on_act : callable
        Is given what is done: an action, the number of a pulley or tensioner, numbers in m, and whether it is done or
        still going on.
    on_choose : callable
        Is given the number of the pulley that is chosen, or None.
    """

    def __init__(self, on_act: Callable[[Mapping[str, Any]], None], on_choose: Callable[[object], None]) -> None:
        super().__init__()
        self._props["scene"] = {}
        self._props["selected"] = -1
        self._props["live"] = None
        self.on("act", lambda event: on_act(_told(event)))
        self.on("choose", lambda event: on_choose(_told(event).get("number")))

    def keep(self, text: str, name: str) -> None:
        """Pass the drive file to the browser, which offers it for download if the server ends."""
        self._props["text"], self._props["name"] = text, name

    def show(self, scene: Mapping[str, Any], selected: int | None) -> None:
        """Show a scene with a highlighted pulley."""
        self._props["scene"] = dict(scene)
        self._props["selected"] = -1 if selected is None else selected
        self.update()
        self.run_method("follow", None)

    def follow(self, scene: Mapping[str, Any]) -> None:
        """Show a scene during dragging, until the next call of `show`."""
        self.run_method("follow", scene)

    def watch(self, seen: "Glimpse | None") -> None:
        """Show a snapshot of a run instead of the belt at rest, or the drive again with None."""
        self._props["live"] = None if seen is None else seen.drawn
        self.update()

    def fit(self) -> None:
        """Show the whole drive."""
        self.run_method("fit")


def _told(event: GenericEventArguments) -> Mapping[str, Any]:
    """What the browser sent, if it is a mapping."""
    return event.args if isinstance(event.args, Mapping) else {}

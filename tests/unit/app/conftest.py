"""Drives on the page: a folder with one, and what tabs share."""

from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

from beltdyn.app.jobs import Outcome
from beltdyn.app.session import Session
from beltdyn.app.workspace import Folder, Workspace


@pytest.fixture(scope="session")
def alternator_text() -> str:
    return files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")


@pytest.fixture
def workspace(tmp_path: Path, alternator_text: str) -> Workspace:
    (tmp_path / "drive.toml").write_text(alternator_text, encoding="utf-8")
    return Workspace(Folder(tmp_path), "drive.toml")


@pytest.fixture
def session(workspace: Workspace) -> Session:
    made = Session(workspace)
    made.open("drive.toml")
    return made


class Ended:
    """An analysis that has ended, and was not asked yet."""

    def __init__(self, name: str, ending: Outcome) -> None:
        self.name, self._ending = name, ending
        self.outcome: Outcome | None = None

    def poll(self) -> None:
        self.outcome = self._ending


@pytest.fixture
def ended_job() -> Callable[[str, Outcome], Any]:
    return Ended

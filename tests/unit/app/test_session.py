"""A drive of one tab: selection, what the browser tells, files."""

import math
import random
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from beltdyn.app.jobs import Outcome
from beltdyn.app.session import Session
from beltdyn.app.workspace import EMPTY, Workspace, examples
from beltdyn.errors import ModelError
from beltdyn.model import loads


def test_a_session_begins_empty_and_opens_files(workspace: Workspace, alternator_text: str) -> None:
    session = Session(workspace)
    assert session.title == "not saved yet"
    assert session.document.text == EMPTY
    session.open("drive.toml")
    assert session.document.text == alternator_text
    assert session.title == "drive.toml"
    assert session.draft.drive == loads(alternator_text)


def test_what_is_done_on_the_canvas_becomes_edits(session: Session) -> None:
    session.apply(session.edits_of("move", {"number": 2, "x": 0.01, "y": 0.28, "done": True}))
    assert session.document.data["pulley"][2]["center"] == [0.01, 0.28]
    assert session.title == "drive.toml *"
    session.apply(session.edits_of("pivot", {"number": 0, "x": 0.11, "y": 0.1}))
    assert session.document.data["tensioner"][0]["pivot"] == [0.11, 0.1]
    session.undo()
    session.undo()
    assert not session.document.changed
    session.redo()
    assert session.document.changed


@pytest.mark.parametrize(
    ("action", "arguments"),
    [
        ("move", {}),
        ("move", {"number": 9, "x": 0.0, "y": 0.0}),
        ("move", {"number": -1, "x": 0.0, "y": 0.0}),
        ("move", {"number": 0, "x": math.nan, "y": 0.0}),
        ("move", {"number": 0, "x": "1", "y": 0.0}),
        ("move", {"number": 0, "x": 1e300, "y": 0.0}),
        ("size", {"number": True, "radius": 1.0}),
        ("pivot", {"number": 1, "x": 0.0, "y": 0.0}),
        ("add", {"x": None, "y": 0.0}),
        ("none of these", {"number": 0}),
        ([], {"number": 0}),
    ],
)
def test_nonsense_from_the_browser_changes_nothing(
    session: Session, action: object, arguments: dict[str, object]
) -> None:
    assert session.edits_of(action, arguments) == []


def test_the_selection_stays_within_the_pulleys(session: Session) -> None:
    for wrong in (7, -1, "1", None, True, 1.0):
        session.choose(wrong)
        assert session.selected is None
    session.choose(2)
    session.apply(session.edits_of("remove", {"number": 2}))
    assert session.selected is None
    session.apply(session.edits_of("add", {"x": 0.0, "y": 0.3}))
    assert session.document.data["pulley"][session.selected or 0]["center"] == [0.0, 0.3]


def test_a_file_is_saved_under_its_name_and_another(session: Session, tmp_path: Path) -> None:
    session.apply(session.edits_of("flip", {"number": 0}))
    session.save()
    assert not session.document.changed
    assert tomllib.loads((tmp_path / "drive.toml").read_text(encoding="utf-8"))["pulley"][0]["side"] == "outside"
    assert session.save("other").endswith("other.toml")
    assert session.name == "other.toml"
    with pytest.raises(ModelError, match="already exists"):
        session.save("drive.toml")
    session.start(EMPTY)
    with pytest.raises(ModelError, match="Give a file name"):
        session.save()


def test_a_file_that_is_no_toml_is_one_error(session: Session, tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text("belt = [", encoding="utf-8")
    with pytest.raises(ModelError, match="not valid TOML"):
        session.open("bad.toml")
    assert session.name == "drive.toml"


def test_examples_say_what_they_are_and_can_be_begun_with(session: Session) -> None:
    found = examples()
    assert len(found) >= 12
    for one in found:
        assert 20 < len(one.about) < 700
        assert "#" not in one.about
        session.start(one.text)
        assert session.draft.drive is not None, one.name


def test_a_hundred_random_edits_leave_a_file_that_says_what_the_data_say(session: Session) -> None:
    generator = random.Random(3)
    actions = ("move", "size", "flip", "remove", "earlier", "later", "add", "pivot", "direction")
    for _ in range(100):
        arguments = {"number": generator.randrange(4), "radius": generator.uniform(0.005, 0.1)}
        place = {"x": generator.uniform(-0.3, 0.3), "y": generator.uniform(-0.3, 0.5)}
        session.apply(session.edits_of(generator.choice(actions), {**arguments, **place}))
        assert tomllib.loads(session.document.text) == session.document.data
        assert (session.draft.drive is None) == bool(session.draft.told)
        if generator.random() < 0.2:
            session.undo()


def test_the_last_analyses_are_kept_and_older_ones_go_with_their_files(
    session: Session, tmp_path: Path, ended_job: Callable[..., Any]
) -> None:
    files = [tmp_path / f"{number}.nc" for number in range(7)]
    for file in files:
        file.touch()
        session.job = ended_job(file.name, Outcome("completed", result=file))
        assert session.follow_job() is None
        assert session.follow_job() is None  # once
    assert [name for name, _ in session.outcomes] == [file.name for file in files[:1:-1]]
    assert [file.exists() for file in files] == 2 * [False] + 5 * [True]

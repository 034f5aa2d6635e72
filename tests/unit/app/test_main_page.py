"""The page as a user without a browser sees it."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("nicegui")

from nicegui import ui
from nicegui.testing import User, user_simulation

from beltdyn.app import numbers_view
from beltdyn.app.computing import Answer, Asked, Calculator
from beltdyn.app.jobs import Outcome
from beltdyn.app.main_page import Canvas, Page
from beltdyn.app.numbers_view import table_html
from beltdyn.app.results_view import AnalysisView
from beltdyn.app.session import Session
from beltdyn.app.workspace import Workspace
from beltdyn.parts.toml_edits import Edit
from beltdyn.show.tables import Facts, Table


class Told(Calculator):
    """Answers at once, with what it was asked."""

    def __init__(self) -> None:
        super().__init__()
        self.asked: list[Asked] = []

    async def ask(self, asked: Asked) -> Answer:
        self.asked.append(asked)
        facts = Facts((("speed", f"{asked.speed:g}"), ("<b>load</b>", f"{asked.load:g}")), asked.what)
        return Answer((facts,), ("A warning.",), "", 0.125)


Journey = Callable[[User], Awaitable[None]]


def go(workspace: Workspace, journey: Journey) -> None:
    """Open the page, and do something there."""

    async def run() -> None:
        async with user_simulation(root=lambda: Page(workspace).build()) as user:
            await user.open("/")
            await user.should_see(kind=Canvas)
            try:
                await asyncio.wait_for(journey(user), 20.0)
            except Exception as error:  # what waits for it would keep the loop from ending
                failures.append(error.with_traceback(None) if isinstance(error, TimeoutError) else error)

    failures: list[Exception] = []
    asyncio.run(run())
    if failures:
        raise failures[0]


def canvas(user: User) -> dict[str, Any]:
    (one,) = user.find(Canvas).elements
    return dict(one.props)


def act(user: User, **told: Any) -> None:
    user.find(Canvas).trigger("act", {"done": True, **told})


def marked(user: User, marker: str) -> Any:
    (one,) = user.find(marker=marker).elements
    return one


def enter(user: User, marker: str, text: str) -> None:
    """Type into a field, and leave it."""
    with user:
        marked(user, marker).value = text
    user.find(marker=marker).trigger("change")


def test_the_file_is_shown_with_its_numbers(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        await user.should_see("drive.toml")
        scene = canvas(user)["scene"]
        assert [one["name"] for one in scene["pulleys"]] == ["crank", "tensioner", "alternator"]
        await user.should_see("Pulleys at rest")
        await user.should_see(kind=ui.html, content="crank to tensioner")

    go(workspace, journey)


def test_an_empty_canvas_offers_drives_to_start_with(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        await user.should_see("Start with a drive like yours")
        await user.should_not_see("pulley is missing")
        user.find(marker="start:accessory_drive").click()
        await user.should_see("Pulleys at rest")
        assert [one["sense"] for one in canvas(user)["scene"]["pulleys"]] == [1, -1, 1, -1, 1, -1, 1]
        await user.should_not_see("Start with a drive like yours")

    go(Workspace(workspace.folder), journey)


def test_the_first_pulley_is_no_mistake(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        act(user, action="add", x=0.0, y=0.0)
        await user.should_see("Place the next pulley")
        await user.should_not_see("a closed belt needs at least two")
        act(user, action="add", x=0.3, y=0.0)
        await user.should_see("Pulleys at rest")
        await user.should_not_see("Place the next pulley")

    go(Workspace(workspace.folder), journey)


def test_a_drag_is_followed_and_becomes_one_step_of_undo(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    followed: list[str] = []
    monkeypatch.setattr(Canvas, "follow", lambda _, scene: followed.append(scene["belt"]))

    async def journey(user: User) -> None:
        before = canvas(user)["scene"]
        for x in (0.002, 0.005, 0.01):
            act(user, action="move", number=2, x=x, y=0.27, done=False)
        assert len({before["belt"], *followed}) == 4
        await user.should_not_see("drive.toml *")
        act(user, action="move", number=2, x=0.01, y=0.27)
        await user.should_see("drive.toml *")
        assert canvas(user)["scene"]["pulleys"][2]["x"] == 10.0
        user.find(marker="undo").click()
        assert canvas(user)["scene"] == before
        user.find(marker="redo").click()
        assert canvas(user)["scene"]["pulleys"][2]["x"] == 10.0

    go(workspace, journey)


def test_a_wrong_value_is_told_at_its_field_and_below_the_canvas(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        user.find(Canvas).trigger("choose", {"number": 1})
        await user.should_see(marker="pulley.1.radius")
        enter(user, "pulley.1.radius", "32 kg")
        said = 'pulley[tensioner].radius = "32 kg" must be in units of mm, not "kg". Give the radius of the pulley'
        assert marked(user, "pulley.1.radius").error.startswith(said)
        await user.should_see(said)
        assert canvas(user)["scene"]["belt"] == ""
        enter(user, "pulley.1.radius", "33 mm")
        assert marked(user, "pulley.1.radius").error is None
        await user.should_not_see(said)
        assert canvas(user)["scene"]["pulleys"][1]["r"] == 33.0

    go(workspace, journey)


def test_a_drive_is_laid_out_from_an_empty_canvas_and_saved(workspace: Workspace, tmp_path: Path) -> None:
    async def journey(user: User) -> None:
        user.find(marker="New").click()
        await user.should_see("empty canvas")
        user.find(marker="example:empty_canvas").click()
        await user.should_see("not saved yet")
        for x, y in ((-0.1, 0.0), (0.15, 0.0), (0.0, 0.2)):
            act(user, action="add", x=x, y=y)
        assert canvas(user)["scene"]["valid"]
        assert canvas(user)["selected"] == 2
        await user.should_see("pulley 3")
        user.find(marker="Save").click()
        await user.should_see(marker="file name")
        with user:
            marked(user, "file name").value = "mine"
        user.find(marker="save under name").click()
        await user.should_see("mine.toml")
        assert "pulley 3" in (tmp_path / "mine.toml").read_text(encoding="utf-8")

    go(workspace, journey)


@pytest.mark.parametrize(
    "kind", ["rotary", *(pytest.param(kind, marks=pytest.mark.slow) for kind in ("sliding", "fixed"))]
)
def test_tensioners_are_set_up_in_the_form(workspace: Workspace, kind: str) -> None:
    async def journey(user: User) -> None:
        user.find(marker="tab:tensioner").click()
        await user.should_see("rotary: tensioner")
        user.find(marker="remove:tensioner").click()
        await user.should_not_see("rotary: tensioner")
        user.find(Canvas).trigger("choose", {"number": 1})
        user.find(marker="tab:tensioner").click()
        user.find(marker=f"add:tensioner:{kind}").click()
        await user.should_see(f"{kind}: tensioner")
        await user.should_see(marker=f"tensioner.0.{'direction' if kind != 'rotary' else 'pivot'}")
        assert canvas(user)["scene"]["tensioners"][0]["kind"] == kind
        assert canvas(user)["scene"]["valid"]

    go(workspace, journey)


def test_a_group_takes_a_kind_and_shows_its_keys(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        user.find(Canvas).trigger("choose", {"number": 0})
        await user.should_see(marker="pulley.0.speed.start")
        with user:
            marked(user, "pulley.0.speed").value = "constant"
        await user.should_see(marker="pulley.0.speed.value")
        await user.should_not_see(marker="pulley.0.speed.start")
        await user.should_not_see(marker="add:load:fan")  # the torque of a shaft with prescribed speed is a result
        user.find(Canvas).trigger("choose", {"number": 2})
        user.find(marker="add:load:fan").click()
        await user.should_see(marker="pulley.2.load.1.rated_power")
        assert marked(user, "pulley.2.load.1.rated_power").value == "2000"
        assert canvas(user)["scene"]["valid"]  # a new item is valid

    go(workspace, journey)


def test_a_file_that_cannot_be_opened_is_told(workspace: Workspace, tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text("belt = [", encoding="utf-8")

    async def journey(user: User) -> None:
        user.find(marker="Open").click()
        await user.should_see("bad.toml")
        user.find(marker="file:bad.toml").click()
        assert "bad.toml is not valid TOML" in user.notify.messages[-1]
        await user.should_see("drive.toml")

    go(workspace, journey)


def test_tabs_do_not_mix(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        other = User(user.http_client)
        await other.open("/")
        await other.should_see(kind=Canvas)
        act(other, action="remove", number=1)
        assert len(canvas(other)["scene"]["pulleys"]) == 2
        assert len(canvas(user)["scene"]["pulleys"]) == 3
        act(user, action="flip", number=0)
        assert not canvas(other)["scene"]["pulleys"][0]["outside"]

    go(workspace, journey)


def test_the_drive_is_still_there_after_the_page_was_loaded_again(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        act(user, action="remove", number=1)
        await user.open("/")
        await user.should_see("drive.toml *")
        assert len(canvas(user)["scene"]["pulleys"]) == 2

    go(workspace, journey)


def test_the_drive_file_is_downloaded(workspace: Workspace, alternator_text: str) -> None:
    async def journey(user: User) -> None:
        user.find(marker="Download").click()
        response = await user.download.next()
        assert response.text == alternator_text

    go(workspace, journey)


def test_numbers_follow_speed_and_load(workspace: Workspace) -> None:
    workspace.calculator = calculator = Told()

    async def journey(user: User) -> None:
        await user.should_see("at rest, computed in 0.12 s")
        assert calculator.asked[-1].what == "rest"
        with user:
            marked(user, "what").value = "running"
        await user.should_see("running, computed in 0.12 s")
        assert marked(user, "load").props["loopback"] is False  # the browser moves it, however busy the server is
        with user:
            marked(user, "load").value = 150
        await user.should_see(kind=ui.html, content="1.5")
        await user.should_see("A warning.")
        assert calculator.asked[-1][4:] == (1.0, 1.5)
        asked = len(calculator.asked)
        act(user, action="move", number=2, x=0.0, y=0.0)
        await user.should_see("overlap")
        await user.should_not_see(kind=ui.html, content="1.5")
        assert len(calculator.asked) == asked

    go(workspace, journey)


def test_what_an_answer_waits_for_is_said(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels are compiled once on a machine, which takes longer than any answer."""
    monkeypatch.setattr(numbers_view, "_BUSY_DELAY", 0.0)
    monkeypatch.setattr(numbers_view, "_POLLING_INTERVAL", 0.05)
    compiled = asyncio.Event()

    class Compiles(Told):
        async def ask(self, asked: Asked) -> Answer:
            self._compiles.tell((96, 240))
            await compiled.wait()
            self._compiles.clear()
            return await super().ask(asked)

    workspace.calculator = Compiles()

    async def journey(user: User) -> None:
        await user.should_see("compiling kernels, once on this machine: 96 of 240")
        compiled.set()
        await user.should_see("at rest, computed in 0.12 s")

    go(workspace, journey)


def test_numbers_of_the_drive_before_an_edit_are_marked(workspace: Workspace) -> None:
    """Until those of the present drive are there."""
    edited, computed = asyncio.Event(), asyncio.Event()

    class Waits(Told):
        async def ask(self, asked: Asked) -> Answer:
            if edited.is_set():
                await computed.wait()
            return await super().ask(asked)

    workspace.calculator = Waits()

    def is_marked(user: User) -> bool:
        return any("bd-old" in one.classes for one in user.find(kind=ui.column, marker="numbers").elements)

    async def journey(user: User) -> None:
        with user:
            marked(user, "what").value = "running"
        await user.should_see("running, computed in 0.12 s")
        assert not is_marked(user)
        edited.set()
        enter(user, "belt.ribs", "8")
        await user.should_see("computing …")
        assert is_marked(user)
        assert canvas(user)["tensions"] == []
        computed.set()
        await user.should_see("running, computed in 0.12 s")
        assert not is_marked(user)

    go(workspace, journey)


def test_an_analysis_can_be_started_only_of_a_drive(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        with user:
            marked(user, "what").value = "analyses"
        assert marked(user, "run").enabled
        act(user, action="move", number=2, x=0.0, y=0.0)
        assert not marked(user, "run").enabled
        user.find(marker="undo").click()
        with user:
            marked(user, "analysis").value = "campbell"
        await user.should_see("Number of lightly damped modes at each speed")  # what an option means, below the pointer
        assert marked(user, "option:speed").value == "450..1800 rpm"  # about the 1500 rpm of the drive
        with user:
            marked(user, "option:speed").value = ""
        user.find(marker="run").click()
        await user.should_see("campbell needs speed. Give a value.")

    go(workspace, journey)


def test_what_ends_is_shown_by_every_page_of_a_session(session: Session, ended_job: Callable[..., Any]) -> None:
    """A page that was loaded again shows it too, though the one before is still there for a while, and hears first."""
    session.job = ended_job("run", Outcome("interrupted"))

    def root() -> None:
        for _ in range(2):
            AnalysisView(session, lambda _: None)

    async def journey() -> None:
        async with user_simulation(root=root) as user:
            await user.open("/")
            await user.should_see("run: interrupted", retries=100)
            while len(user.find("run: interrupted").elements) < 2:
                await asyncio.sleep(0.05)
            await user.should_not_see(marker="cancel")

    asyncio.run(asyncio.wait_for(journey(), 20.0))
    assert session.job is None


def test_tables_are_written_with_their_text_escaped() -> None:
    written = table_html(Table("", ("", "a\nb"), (("<i>", "1"),)))
    assert "<td>&lt;i&gt;</td><td>1</td>" in written
    assert table_html(Facts((("a", "b"),))).startswith('<table class="bd-table bd-facts">')


def test_a_drive_is_begun_from_a_pasted_table(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        user.find("Table of pulleys …").click()
        await user.should_see(marker="pasted")
        user.find(marker="use-table").click()
        await user.should_see("the table is empty")
        with user:
            marked(user, "pasted").value = "motor; 0; 0; 100\nfan; 400; 0; 160"
        user.find(marker="use-table").click()
        await user.should_see("Pulleys at rest")
        assert [one["r"] for one in canvas(user)["scene"]["pulleys"]] == [50.0, 80.0]

    go(Workspace(workspace.folder), journey)


def test_fields_and_canvas_are_in_the_chosen_units(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        user.find(Canvas).trigger("choose", {"number": 1})
        await user.should_see(marker="pulley.1.radius")
        assert marked(user, "pulley.1.radius").value == "32"
        enter(user, "pulley.1.radius", "33")
        assert canvas(user)["scene"]["pulleys"][1]["r"] == 33.0
        with user:
            marked(user, "units").value = "SI"
        assert marked(user, "pulley.1.radius").value == "0.033"
        assert canvas(user)["unit"] == {"name": "m", "size": 1000.0}
        enter(user, "pulley.1.radius", "0.034")
        assert canvas(user)["scene"]["pulleys"][1]["r"] == pytest.approx(34.0)
        assert marked(user, "pulley.1.center").value == "0.03, 0.14"

    go(workspace, journey)


def test_empty_fields_and_messages_are_in_the_chosen_units(workspace: Workspace) -> None:
    async def journey(user: User) -> None:
        await user.should_see(marker="belt.length")
        assert marked(user, "belt.length").value == ""
        assert 890.0 < float(marked(user, "belt.length").props["placeholder"]) < 910.0
        enter(user, "belt.length", "500")
        enter(user, "belt.installed_tension", "")
        await user.should_see("belt.length = 500 mm is too short")
        with user:
            marked(user, "units").value = "SI"
        await user.should_see("belt.length = 0.5 m is too short")
        enter(user, "belt.length", "")
        assert 0.89 < float(marked(user, "belt.length").props["placeholder"]) < 0.91

    go(workspace, journey)


def test_an_answer_comes_first_and_is_marked_after_edits(session: Session, ended_job: Callable[..., Any]) -> None:
    """Undone, the edit leaves no mark."""
    answered = Outcome(
        "completed", answer="crank 1500 rpm", verdict=("fail", "1 of 2 limits"), text=session.document.text
    )
    session.job = ended_job("duty", answered)
    views: list[AnalysisView] = []

    async def journey() -> None:
        async with user_simulation(root=lambda: views.append(AnalysisView(session, lambda _: None))) as user:
            await user.open("/")
            for words in ("duty: completed", "crank 1500 rpm", "✗ 1 of 2 limits"):
                await user.should_see(words, retries=100)
            await user.should_not_see("before the last edits")
            session.apply([Edit("set", ("belt", "ribs"), 5)])
            with user:
                views[-1].update()
            await user.should_see("duty: completed, before the last edits")
            session.undo()
            with user:
                views[-1].update()
            await user.should_not_see("before the last edits")

    asyncio.run(asyncio.wait_for(journey(), 20.0))

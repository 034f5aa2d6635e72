"""Numbers that follow each change: the same as those of the analyses, and quick from one to the next."""

import asyncio
from pathlib import Path

import psutil
import pytest

from beltdyn.app import computing
from beltdyn.app.computing import Answer, Asked, Calculator, answer, given_speed
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.show.tables import Facts, Table

HERE = Path()


def table(found: Answer, title: str) -> dict[str, tuple[str, ...]]:
    for part in found.parts:
        if isinstance(part, Table) and part.title.startswith(title):
            return {row[0]: row[1:] for row in part.rows}
    raise AssertionError(f"no table {title}: {found.error}")


def test_the_drive_at_rest(drive_text: str) -> None:
    found = answer(Asked("rest", "a", drive_text, HERE))
    assert found.error == ""
    assert table(found, "Pulleys at rest")["driver"][0] == "prescribed"
    assert any("soft" in warning for warning in found.warnings)


def test_running_at_the_speed_and_loads_of_the_sliders(drive_text: str) -> None:
    first = table(answer(Asked("running", "b", drive_text, HERE)), "Pulleys")
    quicker = table(answer(Asked("running", "b", drive_text, HERE, 1.5, 1.0)), "Pulleys")
    assert float(first["driver"][0]) == pytest.approx(RPM * 12.0, abs=0.01)
    assert float(quicker["driver"][0]) == pytest.approx(RPM * 18.0, abs=0.01)


def test_what_cannot_run_says_why_and_what_follows_runs_again(drive_text: str) -> None:
    stuck = drive_text.replace("inertia = 0.1", 'inertia = 0.1\nload = [{ kind = "resistance", constant = 50.0 }]')
    assert stuck != drive_text
    found = answer(Asked("running", "c", stuck, HERE))
    assert found.parts == ()
    assert "driven" in found.error or "driver" in found.error
    assert answer(Asked("running", "c", drive_text, HERE)).error == ""


def test_the_speed_of_the_file_is_that_at_the_end(drive: Drive) -> None:
    assert given_speed(drive, 0) == pytest.approx(12.0)


def test_a_process_answers_and_one_that_was_killed_is_replaced(drive_text: str) -> None:
    async def ask() -> None:
        calculator = Calculator()
        try:
            wrong = await calculator.ask(Asked("rest", "d", "belt = 3", HERE))
            assert "belt = 3" in wrong.error
            assert calculator._pool is not None
            for process in calculator._pool.processes:
                process.kill()
            said = (await calculator.ask(Asked("rest", "d", "belt = 3", HERE))).error
            assert "ended unexpectedly" in said or "belt = 3" in said
            assert "belt = 3" in (await calculator.ask(Asked("rest", "d", "belt = 3", HERE))).error
        finally:
            calculator.close()

    asyncio.run(ask())


def test_what_a_drive_needs_is_made_ready_before_there_is_a_question(drive_text: str) -> None:
    """A second process begins with it when the drive is at rest, and has ended when all are closed."""

    async def ask() -> None:
        calculator = Calculator()
        try:
            calculator.look_ahead(Asked("rest", "", drive_text, HERE))
            found = await calculator.ask(Asked("rest", "e", drive_text, HERE))
            assert table(found, "Pulleys at rest")["driver"][0] == "prescribed"
            assert calculator._pool is not None
            (process,) = (psutil.Process(one.pid) for one in calculator._pool.processes)
            ahead = calculator._ahead
            assert ahead is not None
            assert ahead.is_alive()
        finally:
            calculator.close()
        assert ahead.exitcode is not None  # at once: what begins still would miss what the server shares with it
        assert psutil.wait_procs([process], timeout=60.0)[1] == []
        assert calculator.compiling is None

    asyncio.run(ask())


def test_facts_travel_between_processes() -> None:
    import pickle

    sent = Answer((Facts((("a", "b"),), "t"),), ("w",), "", 1.0)
    assert pickle.loads(pickle.dumps(sent)) == sent


def test_an_equilibrium_that_takes_too_long_is_a_closed_form(drive_text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(computing, "_LONGEST_SEARCH", 0.0)
    found = answer(Asked("running", "slow", drive_text, HERE))
    assert found.error == ""
    assert found.warnings[0].startswith("no equilibrium is known: the search was ended after 0 s")
    assert table(found, "Spans at rest")

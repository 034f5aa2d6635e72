"""Commands that are told to end at any instant, and in folders of foreign modules: a small part of the campaign."""

import os
import shutil
import signal
from pathlib import Path

import pytest

from tools.campaign import decoys, kills, stops
from tools.campaign.stops import COMMANDS, Ending, fault_of, instants, prepare, run, stopped

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="groups of processes")


def emptied(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


@pytest.mark.parametrize(
    ("code", "output", "errors", "fault"),
    [
        (130, "", "error: interrupted\n", ""),
        (130, "Interrupted. The results computed so far are kept.\n", "", ""),
        (0, "Results: drive.nc\n", "points ━━━━ 2 of 2 0:00:01\n", ""),
        (130, "", "", "0 lines that say so"),
        (-2, "", "", "exit code -2"),
        (0, "", "error: interrupted\n", "1 lines that say so"),
        (130, "", "Traceback (most recent call last):\nerror: interrupted\n", "more than a line"),
    ],
)
def test_the_trial_tells_orderly_ends_from_others(code: int, output: str, errors: str, fault: str) -> None:
    found = fault_of(Ending(code, output, errors, 1.0), signal.SIGINT)
    assert (fault in found) if fault else not found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_check_that_is_told_to_end(number: signal.Signals, tmp_path: Path) -> None:
    """Once while it imports, and once as it works."""
    for instant in (0.1, 0.6):
        assert stopped(COMMANDS["check"], instant, number, tmp_path, again=False) == ""


@pytest.mark.slow
@pytest.mark.parametrize("name", COMMANDS)
def test_commands_that_are_told_to_end(name: str, tmp_path: Path) -> None:
    words = COMMANDS[name]
    prepare(emptied(tmp_path / "whole"))
    run(words, tmp_path / "whole")
    seconds = run(words, tmp_path / "whole").seconds
    found = {
        f"{number.name} at {instant:.2f} s": stopped(words, instant, number, emptied(tmp_path / "stopped"))
        for instant, number in instants(seconds, 8)
    }
    assert {label: fault for label, fault in found.items() if fault} == {}


def test_half_written_files_are_noticed(tmp_path: Path) -> None:
    kills.prepare(tmp_path)
    assert kills.unreadable(tmp_path) == ""
    for name in ("drive-sweep.nc", "drive-optimize.toml", "drive.fmu"):
        (tmp_path / name).write_bytes(b"[belt]\nwid")
        assert kills.unreadable(tmp_path).startswith(name)
        (tmp_path / name).unlink()


@pytest.mark.slow
def test_killed_commands_leave_whole_files_and_begin_again(tmp_path: Path) -> None:
    pytest.importorskip("pythonfmu")
    found = {label: work() for label, work in kills.trials(2, emptied, tmp_path / "killed")}
    assert len(found) == 2 * len(kills.COMMANDS)
    assert {label: fault for label, fault in found.items() if fault} == {}


def test_modules_of_the_working_folder_are_not_run(tmp_path: Path) -> None:
    """By the process of compilation; the trial notices those that are. The slow part has the other routes."""
    assert decoys.foreign("beside", emptied(tmp_path / "beside"), None, open_for=0.0) == ""
    fault = decoys.foreign("unsafe", emptied(tmp_path / "unsafe"), None, open_for=0.0)
    assert fault.startswith("imported from the working folder: ")


@pytest.mark.slow
@pytest.mark.parametrize("route", decoys.ROUTES)
def test_no_route_runs_modules_of_the_working_folder(route: str, tmp_path: Path) -> None:
    if route == "unit":
        pytest.importorskip("pythonfmu")
    if route == "page":
        pytest.importorskip("nicegui")
    assert decoys.foreign(route, emptied(tmp_path / route), tmp_path / "kernels", open_for=20.0) == ""


def test_files_of_commands_are_left_as_they_are(tmp_path: Path) -> None:
    """The trial notices what is left behind."""
    prepare(tmp_path)
    assert stops.leftovers(tmp_path) == []
    (tmp_path / ".drive.0123abcd.nc").touch()
    assert stops.leftovers(tmp_path) == [".drive.0123abcd.nc"]

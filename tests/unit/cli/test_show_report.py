"""`beltdyn report` and `--report`, and what they refuse."""

import importlib
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.cli.app import app
from beltdyn.model import Drive
from beltdyn.results import Run

RunMain = Callable[[list[str]], tuple[int, str, str]]
Refuse = Callable[[list[str]], str]


@pytest.fixture
def result_file(saved_run: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(saved_run, tmp_path / "drive.nc"))


@pytest.fixture
def _quick_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """A page of its mark alone: what is on it is tested elsewhere."""
    page = '<meta name="generator" content="beltdyn report">{}'
    monkeypatch.setattr("beltdyn.show.report.report._page", lambda results, _: page.format(len(results)))


@pytest.mark.usefixtures("_quick_page")
def test_a_report_stands_beside_its_result(run_main: RunMain, result_file: Path) -> None:
    page = result_file.with_name("drive.html")
    assert run_main(["report", str(result_file)]) == (0, f"Report: {page}\n", "")
    both = result_file.with_name("both.html")
    assert run_main(["report", str(result_file), str(result_file), "-o", str(both)])[0] == 0
    assert both.read_text(encoding="utf-8").endswith("2")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["report", "missing.nc"], "missing.nc"),
        (["report", "drive.toml"], "drive.toml"),
        (["report", "drive.nc", "-o", "."], "is a folder, not a file"),
        (["report", "drive.nc", "-o", "drive.nc"], "already exists and was not written by beltdyn for this"),
        (["report", "drive.nc", "-o", "missing/page.html"], "Choose a file in an existing folder"),
        (["report", "drive.nc", "missing.nc"], "missing.nc"),
    ],
)
@pytest.mark.usefixtures("_quick_page")
def test_message(
    words: list[str],
    sentence: str,
    refuse: Refuse,
    result_file: Path,
    drive_file: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(result_file.parent)
    before = {path: path.read_bytes() for path in (result_file, drive_file)}
    message = refuse(words)
    assert sentence in " ".join(message.split())
    assert message.startswith("error: ")
    assert {path: path.read_bytes() for path in result_file.parent.iterdir()} == before


@pytest.mark.usefixtures("_quick_page")
def test_a_run_with_a_report(
    run_main: RunMain, refuse: Refuse, run: Run, drive_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = []

    def simulate(drive: Drive, output: Path) -> Run:
        calls.append(run.save(output))
        return run

    app["simulate"].default_command = None  # it is made of the function
    monkeypatch.setattr(importlib.import_module("beltdyn.transient.simulate"), "simulate", simulate)
    page = drive_file.with_suffix(".html")
    page.write_text("<p>Mine.</p>", encoding="utf-8")
    assert f"{page} already exists" in refuse(["simulate", str(drive_file), "--report"])
    assert not calls  # before anything is computed
    page.unlink()
    code, output, _ = run_main(["simulate", str(drive_file), "--report"])
    assert code == 0
    assert f"Report: {page}" in output
    assert page.is_file()

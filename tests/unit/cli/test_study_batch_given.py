"""Files of commands: drives, and runs that stand for them."""

import shutil
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from beltdyn.analyses import ANALYSES
from beltdyn.cli.study import read_given, takes_runs
from beltdyn.designs.processes import Ending
from beltdyn.model import Drive
from beltdyn.results import Run


@pytest.fixture
def files(saved_run: Path, drive_text: str, tmp_path: Path) -> list[Path]:
    """Two runs, and a drive file."""
    found = [Path(shutil.copy(saved_run, tmp_path / name)) for name in ("one.nc", "two.nc")]
    drive = tmp_path / "three.toml"
    drive.write_text(drive_text, encoding="utf-8")
    return [*found, drive]


def test_a_run_stands_for_its_drive_where_an_analysis_takes_it(files: list[Path], run: Run) -> None:
    modes = ANALYSES["modes"]
    assert takes_runs(modes)
    assert not takes_runs(ANALYSES["steady_state"])
    found = read_given(modes, files[0])
    assert isinstance(found, Run)
    assert found.drive == run.drive
    assert isinstance(read_given(modes, files[2]), Drive)


def test_modes_of_several_runs_and_drives(
    files: list[Path], run_main: Callable[[list[str]], tuple[int, str, str]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each has a result file of its own beside it."""
    asked = dict[Path, Any]()

    def analyse_all(_: object, given: Mapping[Path, Any], *more: object, **options: Any) -> dict[Path, Ending]:
        asked.update(given)
        return {path: Ending("completed") for path in given}

    monkeypatch.setattr("beltdyn.designs.batch.analyse_all", analyse_all)
    code, output, _ = run_main(["modes", *map(str, files)])
    assert code == 0
    assert [path.name for path in asked] == ["one-modes.nc", "two-modes.nc", "three-modes.nc"]
    assert [isinstance(one, Run) for one in asked.values()] == [True, True, False]
    assert output.count("completed") == 3

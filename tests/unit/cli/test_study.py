"""The command `beltdyn study`."""

from pathlib import Path

import pytest

from beltdyn.cli import main
from beltdyn.designs import point_work
from beltdyn.designs.study_columns import columns_of

STUDY = """
drive = "drive.toml"
analysis = "equilibrium"
results = ["hub_load"]

[[number]]
path = "belt.width"
values = "10, 12 mm"
"""


def code_of(*words: str) -> int:
    with pytest.raises(SystemExit) as ended:
        main(list(words))
    return int(ended.value.code or 0)


@pytest.fixture
def study_file(tmp_path: Path, drive_file: Path) -> Path:
    file = tmp_path / "width.toml"
    file.write_text(STUDY, encoding="utf-8")
    return file


def test_results_stand_beside_the_study_and_are_drawn(
    study_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code_of("study", str(study_file), "-j", "1", "--report") == 0
    out = capsys.readouterr().out
    assert "points          2\n" in out
    assert "hub_load[driven]" in out
    assert str(tmp_path / "width.csv") in out
    assert (tmp_path / "width.html").is_file()
    assert code_of("plot", str(tmp_path / "width.nc"), "-o", str(tmp_path / "figures")) == 0
    assert (tmp_path / "figures" / "study_lines.png").is_file()


def test_a_study_without_results_is_an_error(study_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = study_file.read_text(encoding="utf-8").replace("belt.width", "pulley[driver].radius")
    study_file.write_text(text.replace("10, 12 mm", "70, 71 mm"), encoding="utf-8")
    assert code_of("study", str(study_file), "-j", "1") == 3
    captured = capsys.readouterr()
    assert "all points of the study failed" in captured.err
    assert "points          2 of 2, 2 failed" in captured.out
    assert study_file.with_suffix(".csv").read_text(encoding="utf-8").count("\n") >= 3


def test_the_study_file_is_not_overwritten(study_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert code_of("study", str(study_file), "-o", str(study_file)) == 2
    assert "the results would overwrite it" in capsys.readouterr().err


def test_a_wrong_study_is_told_with_its_file(study_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study_file.write_text(STUDY.replace("results =", "result ="), encoding="utf-8")
    assert code_of("study", str(study_file)) == 2
    assert 'Did you mean "results"' in capsys.readouterr().err


@pytest.mark.provokes_internal_errors
def test_internal_errors_have_an_exit_code_of_their_own(
    study_file: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At one of two points: the other has its row."""
    inner, count = columns_of, iter(range(10))
    monkeypatch.setattr(point_work, "columns_of", lambda *given: inner(*given) if next(count) else None)
    assert code_of("study", str(study_file), "-j", "1") == 5
    captured = capsys.readouterr()
    assert "failed at point 1: internal error in designs/point_work.py" in captured.out
    assert "points          2 of 2, 1 failed" in captured.out


@pytest.mark.provokes_internal_errors
def test_a_command_that_fails_by_itself_says_so(
    study_file: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("beltdyn.designs.study.plan_of", lambda *given: None)
    assert code_of("study", str(study_file), "-j", "1") == 5
    err = capsys.readouterr().err
    assert "Traceback" not in err
    assert "internal error in designs/study.py:" in err
    assert f"repeats it: beltdyn study {study_file} -j 1" in err

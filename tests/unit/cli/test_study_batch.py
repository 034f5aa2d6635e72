"""`beltdyn simulate` of several drives: what it refuses beforehand, and what it says of every ending."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from beltdyn.analyses import Analysis
from beltdyn.designs.processes import Ending
from beltdyn.model import Drive
from beltdyn.results import Run, Summary, summarize

RunMain = Callable[[list[str]], tuple[int, str, str]]
Refuse = Callable[[list[str]], str]


@pytest.fixture
def files(tmp_path: Path, drive_text: str) -> list[Path]:
    """Three drive files."""
    names = [tmp_path / f"{name}.toml" for name in ("one", "two", "three")]
    for name in names:
        name.write_text(drive_text, encoding="utf-8")
    return names


@pytest.fixture
def summary(run: Run) -> Summary:
    return summarize(run)


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[tuple[list[Path], Any]]]:
    """Let simulations end as told; what was asked for."""

    def end(*endings: Ending) -> list[tuple[list[Path], Any]]:
        asked: list[tuple[list[Path], Any]] = []

        def analyse_all(
            analysis: Analysis, drives: Mapping[Path, Drive], _: object, jobs: int | None, force: bool
        ) -> dict[Path, Ending]:
            assert analysis.name == "simulate"
            asked.append((list(drives), jobs))
            return dict(zip(drives, endings, strict=True))

        monkeypatch.setattr("beltdyn.designs.batch.analyse_all", analyse_all)
        return asked

    return end


def done(summary: Summary) -> Ending:
    return Ending("completed", summary=summary, warnings=summary.warnings, kept=True)


def words(files: list[Path], *more: str) -> list[str]:
    return ["simulate", *map(str, files), *more]


def test_every_drive_gets_a_line_and_a_file_beside_it(
    run_main: RunMain,
    files: list[Path],
    simulated: Callable[..., Any],
    summary: Summary,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(files[0].parent)
    asked = simulated(*[done(summary)] * 3)
    code, output, message = run_main(words([Path(file.name) for file in files], "--jobs", "2"))
    assert (code, message.count("error")) == (0, 0)
    assert asked == [([Path(file.stem + ".nc") for file in files], 2)]
    for name in ("one", "two", "three"):
        (line,) = (line.split() for line in output.splitlines() if line.startswith(f"{name}.toml"))
        assert line[1:] == [
            "completed",
            "11.9400",
            "rad/s",
            "1200",
            "0.5",
            "s",
            str(len(summary.warnings)),
            f"{name}.nc",
        ]
    assert all(warning in output for warning in summary.warnings)


def test_output_names_a_folder(
    run_main: RunMain, files: list[Path], simulated: Callable[..., Any], tmp_path: Path
) -> None:
    asked = simulated(*[Ending("completed")] * 3)
    code, _, _ = run_main(words(files, "--output", str(tmp_path / "new" / "results")))
    assert code == 0
    assert asked == [([tmp_path / "new" / "results" / f"{file.stem}.nc" for file in files], None)]
    assert (tmp_path / "new" / "results").is_dir()


@pytest.mark.parametrize(
    ("endings", "code"),
    [
        ((Ending("completed"), Ending("failed", "no convergence."), Ending("failed", "no memory.")), 3),
        ((Ending("interrupted"), Ending("failed", "no convergence."), Ending("not started")), 130),
        ((Ending("completed"), Ending("completed"), Ending("not started")), 130),
    ],
)
def test_exit_codes(
    run_main: RunMain, files: list[Path], simulated: Callable[..., Any], endings: tuple[Ending, ...], code: int
) -> None:
    simulated(*endings)
    found, output, message = run_main(words(files))
    assert found == code
    assert ("The results computed so far are kept" in output) is (code == 130)
    for file, ending in zip(files, endings, strict=True):
        assert ending.status in output
        assert (f"error: {file}: {ending.error}" in message) is bool(ending.error)


def test_one_bad_file_stops_everything(refuse: Refuse, files: list[Path], simulated: Callable[..., Any]) -> None:
    asked = simulated()
    files[1].write_text("[belt]\nlength = -1\n", encoding="utf-8")
    missing = files[0].with_name("missing.toml")
    message = refuse(words([*files, missing]))
    assert f"error: {files[1]}: belt.length = -1 must be greater than 0" in message
    assert f"error: {missing}: {missing} cannot be read" not in message
    assert f"error: {missing} cannot be read" in message
    assert asked == []


def test_two_drives_with_one_result_file(
    refuse: Refuse, files: list[Path], simulated: Callable[..., Any], tmp_path: Path
) -> None:
    asked = simulated()
    other = tmp_path / "folder" / "one.toml"
    other.parent.mkdir()
    other.write_bytes(files[0].read_bytes())
    message = refuse(words([files[0], other], "-o", str(tmp_path / "results")))
    assert f"{files[0]} and {other} would share the result file {tmp_path / 'results' / 'one.nc'}" in message
    assert "would share the result file" in refuse(words([files[0], files[0]]))
    assert asked == []
    assert not (tmp_path / "results").exists()


def test_results_over_a_drive_file(refuse: Refuse, files: list[Path], simulated: Callable[..., Any]) -> None:
    asked = simulated()
    hidden = files[0].rename(files[0].with_suffix(".nc"))
    assert "would overwrite it" in refuse(words([hidden, *files[1:]]))
    assert asked == []


def test_output_that_is_a_file(refuse: Refuse, files: list[Path]) -> None:
    assert "cannot be written (Not a directory)" in refuse(words(files, "-o", str(files[0])))


def test_warnings_are_errors_where_strict(
    run_main: RunMain, files: list[Path], simulated: Callable[..., Any], summary: Summary
) -> None:
    sure, doubtful = (replace(summary, warnings=warnings) for warnings in ((), ("the belt is slack.",)))
    simulated(*(done(one) for one in (sure, doubtful, sure)))
    code, _, message = run_main(words(files, "--strict"))
    assert code == 4
    assert "1 warning, which --strict treats as errors" in message
    simulated(*[done(sure)] * 3)
    assert run_main(words(files, "--strict"))[0] == 0


@pytest.mark.parametrize("jobs", ["0", "-1", "many"])
def test_number_of_jobs(refuse: Refuse, files: list[Path], jobs: str) -> None:
    assert "--jobs" in refuse(words(files, f"--jobs={jobs}"))


@pytest.mark.slow
def test_real_runs_with_tables(run_main: RunMain, files: list[Path], drive_text: str) -> None:
    for file in files[:2]:
        file.write_text(drive_text.replace("duration = 1.0", "duration = 0.005"), encoding="utf-8")
    code, output, _ = run_main(words(files[:2], "--csv"))
    assert code == 0
    assert output.count("Tables: ") == 2
    for file in files[:2]:
        assert file.with_suffix(".nc").exists()
        assert (file.with_name(f"{file.stem}-tables") / "pulleys.csv").exists()

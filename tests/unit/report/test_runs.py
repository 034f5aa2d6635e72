from pathlib import Path

import pytest

from beltdyn.model import Drive
from beltdyn.published import two_pulley
from beltdyn.report.runs import RunMissingError, run_all
from beltdyn.solve import BatchProgress, Ending


def short(duration: float, **simulation: object) -> Drive:
    drive = two_pulley(10)
    settings = {"duration": duration, "output_interval": 1e-3, **simulation}
    return drive.replace(simulation=drive.simulation.replace(**settings))


@pytest.mark.slow
def test_runs_go_on_when_one_fails(tmp_path: Path) -> None:
    """A run whose file cannot be written leaves a reason, the others leave their results."""
    (tmp_path / "bad.nc").mkdir()
    stages: list[BatchProgress] = []
    drives = {"good": short(0.01), "bad": short(0.01), "other": short(0.02)}
    runs = run_all(drives, tmp_path, stages.append, jobs=2)
    assert sorted(runs) == ["good", "other"]
    assert (runs["good"].status, runs["good"].drive) == ("completed", drives["good"])
    assert "bad.nc cannot be written" in runs.failures["bad"]
    with pytest.raises(RunMissingError, match="the run bad failed"):
        runs["bad"]
    assert "bad" not in runs
    assert (stages[0].total, stages[-1]) == (3, BatchProgress(3, 3, {}))
    runs.close()


@pytest.mark.parametrize("status", ["interrupted", "not started"])
def test_an_interruption_goes_on_to_the_caller(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, status: str) -> None:
    monkeypatch.setattr("beltdyn.report.runs.simulate_all", lambda *_: {tmp_path / "one.nc": Ending(status)})
    with pytest.raises(KeyboardInterrupt):
        run_all({"one": short(0.01)}, tmp_path)


def test_no_drives_no_runs(tmp_path: Path) -> None:
    runs = run_all({}, tmp_path / "runs")
    assert len(runs) == 0
    assert (tmp_path / "runs").is_dir()

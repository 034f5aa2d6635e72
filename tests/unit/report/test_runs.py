import os
import signal
import threading
import time
from pathlib import Path

import pytest

from beltdyn.model import Drive
from beltdyn.published import two_pulley
from beltdyn.report.runs import RunMissingError, Stage, run_all
from beltdyn.results import open_run


def short(duration: float, **simulation: object) -> Drive:
    drive = two_pulley(10)
    settings = {"duration": duration, "output_interval": 1e-3, **simulation}
    return drive.replace(simulation=drive.simulation.replace(**settings))


@pytest.mark.slow
def test_runs_go_on_when_one_fails(tmp_path: Path) -> None:
    """A run whose file cannot be written leaves a reason, the others leave their results."""
    (tmp_path / "bad.nc").mkdir()
    stages: list[Stage] = []
    drives = {"good": short(0.01), "bad": short(0.01), "other": short(0.02)}
    runs = run_all(drives, tmp_path, stages.append, workers=2)
    assert sorted(runs) == ["good", "other"]
    assert (runs["good"].status, runs["good"].drive) == ("completed", drives["good"])
    assert "bad.nc cannot be written" in runs.failures["bad"]
    with pytest.raises(RunMissingError, match="the run bad failed"):
        runs["bad"]
    assert "bad" not in runs
    assert (stages[0].total, stages[-1]) == (3, Stage(3, 3, ()))
    assert all(len(stage.running) <= 2 for stage in stages)
    runs.close()


@pytest.mark.slow
def test_an_interruption_ends_the_runs_and_keeps_what_was_computed(tmp_path: Path) -> None:
    drives = {name: short(200.0, output_interval=0.01) for name in ("one", "two", "three")}

    def interrupt() -> None:
        while not all((tmp_path / f"{name}.nc").exists() for name in ("one", "two")):
            time.sleep(0.1)
        time.sleep(2.0)
        os.kill(os.getpid(), signal.SIGINT)

    interrupter = threading.Thread(target=interrupt)
    interrupter.start()
    with pytest.raises(KeyboardInterrupt):
        run_all(drives, tmp_path, workers=2)
    interrupter.join()
    for name in ("one", "two"):
        run = open_run(tmp_path / f"{name}.nc")
        assert run.status == "interrupted"
        assert 0 < run.dataset.sizes["time"] < 20_000
        run.dataset.close()
    assert not (tmp_path / "three.nc").exists()


def test_no_drives_no_runs(tmp_path: Path) -> None:
    runs = run_all({}, tmp_path / "runs")
    assert len(runs) == 0
    assert (tmp_path / "runs").is_dir()

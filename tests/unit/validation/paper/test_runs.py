from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from beltdyn.designs.processes import Ending
from beltdyn.errors import SimulationError
from beltdyn.model import Drive, load
from beltdyn.solvers.run_progress import BatchProgress
from validation.paper.runs import RunMissingError, Runs, run_all
from validation.published import two_pulley


def short(duration: float, **simulation: object) -> Drive:
    drive = two_pulley(10)
    settings = {"duration": duration, "output_interval": 1e-3, **simulation}
    return drive.replace(simulation=drive.simulation.replace(**settings))


@pytest.mark.slow
def test_runs_go_on_when_one_fails(tmp_path: Path) -> None:
    """A run whose file cannot be written leaves a reason, the others leave their results."""
    (tmp_path / "bad.nc").mkdir()
    stages: list[BatchProgress] = []
    drives = {"good": short(0.01), "bad": short(0.015), "other": short(0.02), "again": short(0.02)}
    runs = run_all(drives, tmp_path, stages.append, jobs=2)
    assert sorted(runs) == ["good", "other"]
    assert (runs["good"].status, runs["good"].drive) == ("completed", drives["good"])
    assert "bad.nc cannot be written" in runs.failures["bad"]
    with pytest.raises(RunMissingError, match="the run bad failed"):
        runs["bad"]
    assert "bad" not in runs
    assert (len(runs), runs.name_of("again")) == (2, "other")
    assert runs["again"] is runs["other"]
    assert not (tmp_path / "again.nc").exists()
    assert load(tmp_path / "other.toml") == drives["other"]
    assert (stages[0].total, stages[-1]) == (3, BatchProgress(3, 3, {}))


@pytest.mark.parametrize("status", ["interrupted", "not started"])
def test_an_interruption_goes_on_to_the_caller(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, status: str) -> None:
    monkeypatch.setattr("validation.paper.runs.analyse_all", lambda *_, **__: {tmp_path / "one.nc": Ending(status)})
    with pytest.raises(KeyboardInterrupt):
        run_all({"one": short(0.01)}, tmp_path)


def test_no_drives_no_runs(tmp_path: Path) -> None:
    runs = run_all({}, tmp_path / "runs")
    assert len(runs) == 0
    assert (tmp_path / "runs").is_dir()


@pytest.fixture
def kept() -> Runs:
    """Two runs of which nothing was kept, and a second name of the first."""
    return Runs(
        {name: xr.Dataset() for name in ("one", "two")},
        {"one": short(0.01), "two": short(0.02)},
        {"bad": "why"},
        {"first": "one"},
    )


def test_times_are_taken_in_turns_once_each_without_outputs(
    kept: Runs, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    done: list[tuple[float, float]] = []

    def simulate_all(drives: Mapping[Path, Drive], progress: Callable[[BatchProgress], None]) -> dict[Path, Ending]:
        for file, drive in drives.items():
            progress(BatchProgress(len(done) % len(drives), len(drives), {file: 0.0}))
            done.append((drive.simulation.duration, drive.simulation.output_interval))
            xr.Dataset(attrs={"cpu_time": float(len(done))}).to_netcdf(file, engine="h5netcdf")
        return dict.fromkeys(drives, Ending("completed"))

    monkeypatch.setattr("validation.paper.runs.simulate_all", simulate_all)
    told = list[BatchProgress]()
    kept.take_times(["two", "one", "first", "two"], tmp_path, told.append, repeats=3)
    assert done == [(0.02, 0.02), (0.01, 0.01)] * 3
    assert [one.done for one in told] == list(range(6))
    assert {(one.total, one.kind) for one in told} == {(6, "timed runs")}
    assert not list(tmp_path.iterdir())
    times = kept.cpu_times(["two", "first"])
    np.testing.assert_array_equal(times["two"], [1.0, 3.0, 5.0])
    np.testing.assert_array_equal(times["first"], [2.0, 4.0, 6.0])


@pytest.mark.parametrize(
    ("ending", "error"),
    [(Ending("interrupted"), KeyboardInterrupt), (Ending("failed", "it diverges"), SimulationError)],
)
def test_timing_that_is_interrupted_or_fails_ends_all(
    kept: Runs, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, ending: Ending, error: type[BaseException]
) -> None:
    monkeypatch.setattr("validation.paper.runs.simulate_all", lambda drives, _: dict.fromkeys(drives, ending))
    with pytest.raises(error):
        kept.take_times(["one"], tmp_path)


@pytest.mark.slow
def test_processor_times_of_runs_side_by_side(tmp_path: Path) -> None:
    """A run twice as long takes longer in each turn."""
    runs = run_all({"one": short(0.1), "two": short(0.4)}, tmp_path)
    runs.take_times(["one", "two"], tmp_path)
    times = runs.cpu_times(["one", "two"])
    assert times["one"].shape == (2,)
    assert (times["one"] > 0.0).all()
    assert (times["one"] < times["two"]).all()

"""An earlier result file stays until there is a new result to put in its place, whatever ends an analysis."""

import shutil
import signal
from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial, partialmethod
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.analyses import ANALYSES
from beltdyn.cosimulation import fmu
from beltdyn.errors import BeltdynError, ConvergenceError
from beltdyn.model import CalibrationStudy, Drive, OptimizationStudy, ParameterStudy
from beltdyn.results import FileRecorder, Result, Run
from beltdyn.show.plot import animate, save_all
from beltdyn.solvers.run_progress import Progress
from beltdyn.transient.checkpoint import checkpoint_file

LargestFile = Callable[[int], AbstractContextManager[None]]
FULL = 1000
"""Bytes that a file may have on a full disk: too few for any result."""
OLD = 7
"""Outputs of the earlier result."""
LENGTH: dict[str, Any] = {"path": "belt.length", "least": "1.27 m", "largest": "1.275 m"}
OPTIONS: dict[str, dict[str, Any]] = {name: {} for name in ANALYSES} | {
    "sweep": {"pulley": "driver", "from_": "10 rpm", "to": "20 rpm", "duration": "5 ms"},
    "operating_map": {"speed": "60, 120 rpm"},
    "traction": {"slip": "0.01 %"},
    "duty": {"table": "duty.csv"},
    "life": {"table": "duty.csv"},
    "tensioner_sheet": {"tolerance": "1 mm", "wear": "2 mm"},
    "sheet": {"table": "duty.csv", "points": 2},
    "rating": {"service_factor": 1.2},
    "sensitivity": {"of": "largest_tension", "numbers": "belt.length"},
    "modes": {"count": 2},
    "optimize": {"study": OptimizationStudy(number=[LENGTH], goal={"result": "hub_load"}), "most": 2},
    "calibrate": {"study": CalibrationStudy(number=[LENGTH], measurement=[{"table": "slip.csv"}])},
    "campbell": {"speed": "80, 120 rpm", "count": 2},
    "response": {"speed": "80, 120 rpm"},
    "stroke": {"places": "0, 50 mm"},
    "convergence": {"meshes": "12, 16, 20", "repeated": "equilibrium"},
}
"""Analysis -> options that make it short."""


@pytest.fixture(scope="module")
def demo() -> Drive:
    return bd.example("two_pulley")


def short(drive: Drive, duration: float) -> Drive:
    return drive.replace(simulation=drive.simulation.replace(duration=duration))


def fitting(name: str, drive: Drive) -> Drive:
    """The drive with what an analysis asks for."""
    if name == "simulate":
        return short(drive, 0.005)
    if name == "stroke":
        return bd.example("printer_axis")
    if name == "tensioner_sheet":
        slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
        return drive.replace(tensioner=[slide])
    if name == "life":
        line = {"cycles": [1e7, 1e9], "forces": [100.0, 50.0], "bending_force": 0.1, "source": "test"}
        return drive.replace(belt=drive.belt.replace(cord_fatigue=line))
    if name == "rating":
        return drive.with_({"belt.profile": "PJ", "belt.ribs": 3, "belt.installed_tension": "60 N"})
    if name == "response":
        waves = [{"order": 2, "amplitude": 0.02}]
        return drive.replace(pulley=[drive.pulleys[0].replace(harmonics=waves), drive.pulleys[1]])
    return drive


@pytest.fixture(scope="module")
def saved(run: Run, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return run.save(tmp_path_factory.mktemp("saved") / "result.nc")


@pytest.fixture
def earlier(saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A result file, with tables to be read beside it."""
    monkeypatch.chdir(tmp_path)
    Path("duty.csv").write_text("duration [s], driver speed [rpm]\n60, 90\n30, 120\n", encoding="utf-8")
    rows = ["driven torque [N m], pulley_slip[driven] [%]", "-0.5, 0.06", "-1, 0.12", "-2, 0.24"]
    Path("slip.csv").write_text("\n".join(rows), encoding="utf-8")
    return Path(shutil.copy(saved, tmp_path))


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("error", [ConvergenceError("no convergence."), RuntimeError("a fault"), KeyboardInterrupt()])
@pytest.mark.parametrize("name", OPTIONS)
def test_what_ends_before_its_first_result_changes_no_file(
    name: str, error: BaseException, demo: Drive, earlier: Path
) -> None:
    """Errors and Ctrl-C, as soon as the analysis tells of its progress; those that tell nothing give all at the end."""
    if not ANALYSES[name].tells:
        pytest.skip("it tells nothing")

    def end(progress: Progress) -> None:
        raise error

    before = contents(earlier.parent)
    try:
        found = ANALYSES[name].write(fitting(name, demo), earlier, end, True, **OPTIONS[name])
    except type(error):
        pass
    else:
        assert found.status == "interrupted"
    assert contents(earlier.parent) == before


@pytest.mark.parametrize(
    "name",
    [
        one if one in ("equilibrium", "operating_map", "calibrate") else pytest.param(one, marks=pytest.mark.slow)
        for one in OPTIONS
    ],
)
def test_an_interruption_of_the_last_saving_leaves_what_is_complete(
    name: str, demo: Drive, earlier: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C, pressed twice while a file is closed slowly, takes nothing away, and is no traceback."""

    def press(inner: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
        done = inner(*arguments, **options)
        if "completed" in str(open_status(earlier)):
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGINT)
        return done

    for owner, method in ((Result, "save"), (FileRecorder, "close")):
        monkeypatch.setattr(owner, method, partialmethod(partial(press, getattr(owner, method))))
    earlier.unlink()
    found = ANALYSES[name].write(fitting(name, demo), earlier, None, True, **OPTIONS[name])
    assert found.status == "completed"
    assert bd.open_result(earlier).status == "completed"


def open_status(path: Path) -> str:
    """The status of a file, if it is there."""
    if not path.exists():
        return ""
    result = bd.open_result(path)
    status = result.status
    result.dataset.close()
    return status


@pytest.mark.slow
@pytest.mark.parametrize("name", OPTIONS)
def test_a_full_disk_leaves_the_earlier_result(
    name: str, demo: Drive, earlier: Path, largest_file: LargestFile
) -> None:
    """With kernels compiled, an analysis that found its results and has no room for them changes nothing."""
    given = fitting(name, demo)
    ANALYSES[name].write(given, earlier.with_name("compiled.nc"), None, True, **OPTIONS[name])
    before = contents(earlier.parent)
    with largest_file(FULL), pytest.raises(BeltdynError, match="Make room"):
        ANALYSES[name].write(given, earlier, None, True, **OPTIONS[name])
    assert contents(earlier.parent) == before


@pytest.fixture
def study() -> ParameterStudy:
    return ParameterStudy(
        analysis="equilibrium", number=[{"path": "belt.width", "values": "10, 15 mm"}], results=["hub_load"]
    )


def test_a_study_that_has_no_room_leaves_the_earlier_one(
    study: ParameterStudy, demo: Drive, tmp_path: Path, largest_file: LargestFile
) -> None:
    """And goes on where it was when there is room again."""
    path = tmp_path / "study.nc"
    bd.study(study, demo, jobs=1, output=path)
    before = contents(tmp_path)
    more = study.replace(number=[study.numbers[0].replace(values="10, 15, 20 mm")])
    with largest_file(150), pytest.raises(BeltdynError, match="Make room"):
        bd.study(more, demo, jobs=1, output=path)
    assert contents(tmp_path) == before
    found = bd.study(more, demo, jobs=1, output=path)
    assert bool(np.isfinite(found.dataset["hub_load[driven]"]).all())


def test_the_checkpoint_of_an_interrupted_run_stays_with_its_results(demo: Drive, tmp_path: Path) -> None:
    """Until a later run has outputs: then the checkpoint is of another run, and gone."""
    path, drive = tmp_path / "run.nc", short(demo, 0.02)

    def ending_in(phase: str, time: float) -> Callable[[Progress], None]:
        def end(progress: Progress) -> None:
            if progress.phase == phase and progress.time >= time:
                raise KeyboardInterrupt

        return end

    stopped = bd.simulate(drive, path, ending_in("integrating", 0.005), checkpoint=1e-9)
    stopped.dataset.close()
    before = contents(tmp_path)
    assert checkpoint_file(path).name in before
    empty = bd.simulate(drive, path, ending_in("compiling", 0.0))
    assert (empty.status, empty.outputs, empty.path) == ("interrupted", 0, None)
    assert contents(tmp_path) == before
    assert bd.simulate(drive, path, resume=True).status == "completed"


WRITERS: dict[str, Callable[[Run, Path], object]] = {
    "report": lambda run, folder: bd.write_report(run, folder / "report.html"),
    "tables": lambda run, folder: bd.export(run, ["csv"], folder / "run.nc"),
    "vtk": lambda run, folder: bd.export(run, ["vtk"], folder / "run.nc"),
    "mat": lambda run, folder: bd.export(run, ["mat"], folder / "run.nc"),
    "parquet": lambda run, folder: bd.export(run, ["parquet"], folder / "run.nc"),
    "figures": lambda run, folder: save_all([run], folder, ["slip"]),
    "animation": lambda run, folder: animate(run, folder / "drive.gif", frames=2),
    "fmu": lambda run, folder: fmu(run.drive, folder / "drive.fmu"),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
def test_what_has_no_room_leaves_the_earlier_file(
    name: str, run: Run, tmp_path: Path, largest_file: LargestFile
) -> None:
    if name == "parquet":
        pytest.importorskip("pyarrow")
    if name == "fmu":
        pytest.importorskip("pythonfmu")
    WRITERS[name](run, tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert before
    with largest_file(FULL), pytest.raises(BeltdynError, match="Make room"):
        WRITERS[name](run, tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before

"""Runs that are interrupted or killed go on to the same results, to the last bit."""

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from importlib.resources import files
from itertools import cycle
from pathlib import Path

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps, load
from beltdyn.results import Run
from beltdyn.solvers.run_progress import Progress
from beltdyn.transient.checkpoint import CheckpointWarning, checkpoint_file, is_checkpoint, read_checkpoint
from beltdyn.transient.packing import Packing
from beltdyn.transient.simulate import simulate

OFTEN = 1e-9
"""Computing time between checkpoints, s: one after each chunk of steps."""


@pytest.fixture(scope="module")
def alternator() -> Drive:
    """On the mesh that stays, with hysteresis, an arm, and a load that comes in the middle."""
    drive = load(str(files("beltdyn") / "examples" / "alternator_drive.toml"))
    schedule = {"kind": "cosine_ramp", "start": 0.02, "end": 0.03, "value": 1.0}
    changed = {"simulation.duration": 0.05, "pulley[alternator].load[1].schedule": schedule, "belt.elements": 30}
    return drive.with_(changed)


@pytest.fixture(scope="module")
def travelling() -> Drive:
    """On the mesh that travels, from the belt as it is laid."""
    drive = load(str(files("beltdyn") / "examples" / "two_pulley.toml"))
    return drive.with_({"simulation.duration": 0.06})


def stopping_after(time_: float) -> Callable[[Progress], None]:
    def stop(progress: Progress) -> None:
        if progress.phase == "integrating" and progress.time > time_:
            raise KeyboardInterrupt

    return stop


def require_same(found: Run, whole: Run) -> None:
    assert found.status == "completed"
    assert set(found.dataset.variables) == set(whole.dataset.variables)
    for name, variable in whole.dataset.variables.items():
        np.testing.assert_array_equal(found.dataset[name].values, variable.values, strict=True, err_msg=str(name))
    for name in ("steps", "rejected_steps", "newton_iterations", "integrator", "title", "drive"):
        assert found.dataset.attrs[name] == whole.dataset.attrs[name]


@pytest.mark.parametrize("drive", [pytest.param("alternator", marks=pytest.mark.slow), "travelling"])
def test_an_interrupted_run_goes_on_to_the_bit(drive: str, request: pytest.FixtureRequest, tmp_path: Path) -> None:
    """Twice, before and after the load comes."""
    given: Drive = request.getfixturevalue(drive)
    whole, path = simulate(given, tmp_path / "whole.nc"), tmp_path / "run.nc"
    assert not checkpoint_file(tmp_path / "whole.nc").exists()
    stopped = simulate(given, path, stopping_after(0.01), checkpoint=OFTEN)
    assert stopped.status == "interrupted"
    assert stopped.outputs < whole.outputs
    stopped.dataset.close()
    again = simulate(given, path, stopping_after(0.035), checkpoint=OFTEN, resume=True)
    assert again.status == "interrupted"
    again.dataset.close()
    require_same(simulate(given, path, resume=True), whole)
    assert not checkpoint_file(path).exists()


@pytest.mark.slow
@pytest.mark.parametrize("jump", [-1e5, 1e5])
def test_a_run_resumes_whatever_the_clock_says(
    jump: float, travelling: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The clock is set between two readings, and its files seem to be of another day, in the future or the past."""
    whole, path, set_by = simulate(travelling), tmp_path / "run.nc", cycle((0.0, jump))
    now, now_ns = time.time, time.time_ns
    monkeypatch.setattr(time, "time", lambda: now() + next(set_by))
    monkeypatch.setattr(time, "time_ns", lambda: now_ns() + int(1e9 * next(set_by)))
    simulate(travelling, path, stopping_after(0.02), checkpoint=OFTEN).dataset.close()
    for file in (path, checkpoint_file(path)):
        os.utime(file, (now() + jump,) * 2)
    require_same(simulate(travelling, path, resume=True), whole)


@pytest.mark.slow
def test_a_killed_run_goes_on_to_the_bit(alternator: Drive, tmp_path: Path) -> None:
    (tmp_path / "drive.toml").write_text(dumps(alternator), encoding="utf-8")
    given, path = load(tmp_path / "drive.toml"), tmp_path / "run.nc"
    whole = simulate(given, tmp_path / "whole.nc")
    program = (
        f"import beltdyn as bd; bd.simulate(bd.load({str(tmp_path / 'drive.toml')!r}), {str(path)!r}, checkpoint=0.05)"
    )
    process = subprocess.Popen([sys.executable, "-c", program])
    while process.poll() is None and not checkpoint_file(path).exists():
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    require_same(simulate(given, path, resume=True), whole)


@pytest.fixture(scope="module")
def interrupted(travelling: Drive, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of the result file of a run that was interrupted, and of its checkpoint."""
    folder = tmp_path_factory.mktemp("interrupted")
    simulate(travelling, folder / "run.nc", stopping_after(0.005), checkpoint=OFTEN).dataset.close()
    return folder


@pytest.fixture
def stopped(interrupted: Path, tmp_path: Path) -> Path:
    """A copy of the result file, with the checkpoint beside it."""
    shutil.copytree(interrupted, tmp_path, dirs_exist_ok=True)
    return tmp_path / "run.nc"


def test_checkpoints_are_told_from_other_files(stopped: Path) -> None:
    assert is_checkpoint(checkpoint_file(stopped))
    assert not is_checkpoint(stopped)
    assert read_checkpoint(checkpoint_file(stopped)).drive.simulation.duration == 0.06


def test_a_new_run_forgets_the_checkpoint_of_an_earlier_one(travelling: Drive, stopped: Path) -> None:
    simulate(travelling.with_({"simulation.duration": 0.002}), stopped).dataset.close()
    assert not checkpoint_file(stopped).exists()


class _FullFrom:
    """A disk that has no room for checkpoints from the given one on."""

    def __init__(self, number: int) -> None:
        self.number, self.asked, self._pack = number, 0, Packing.pack

    def pack(self, packing: Packing, point: object) -> bytes:
        self.asked += 1
        if self.asked >= self.number:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return self._pack(packing, point)


@pytest.mark.slow
@pytest.mark.parametrize(("number", "whence"), [(1, "its beginning"), (2, "the previous checkpoint")])
def test_a_run_goes_on_where_a_checkpoint_cannot_be_written(
    number: int, whence: str, travelling: Drive, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It warns once, and the checkpoint before stays whole: an interrupted run goes on from it."""
    whole, path, disk = simulate(travelling), tmp_path / "run.nc", _FullFrom(number)
    monkeypatch.setattr(Packing, "pack", lambda packing, point: disk.pack(packing, point))
    with pytest.warns(CheckpointWarning) as said:
        simulate(travelling, path, stopping_after(0.05), checkpoint=OFTEN).dataset.close()
    monkeypatch.undo()
    assert disk.asked > number + 1
    assert len(said) == 1
    text = str(said[0].message)
    assert "(No space left on device). Make room" in text
    assert text.endswith(f"it will resume from {whence}. Another checkpoint is attempted every {OFTEN:g} s.")
    assert not list(tmp_path.glob(".*.checkpoint"))
    if number == 1:
        assert not checkpoint_file(path).exists()
        return
    require_same(simulate(travelling, path, resume=True), whole)


def test_what_is_in_the_place_of_a_checkpoint_stays(travelling: Drive, tmp_path: Path) -> None:
    """A file of others, where the checkpoint would be, is left alone, and the run is complete."""
    path = tmp_path / "run.nc"
    checkpoint_file(path).write_text("mine")
    with pytest.warns(CheckpointWarning, match=r"already exists and was not written by beltdyn") as raised:
        assert simulate(travelling, path, checkpoint=OFTEN).status == "completed"
    assert raised[0].filename == __file__
    assert checkpoint_file(path).read_text() == "mine"


def test_a_run_resumes_until_it_is_complete_and_then_changes_nothing(travelling: Drive, tmp_path: Path) -> None:
    """Where nothing was kept it begins anew: a batch that resumes until all is well comes to its end."""
    path = tmp_path / "run.nc"
    with pytest.warns(CheckpointWarning, match=r"nothing to resume: no run of this drive has begun there. It begins"):
        assert simulate(travelling, path, stopping_after(0.02), resume=True).status == "interrupted"
    assert not checkpoint_file(path).exists()
    with pytest.warns(CheckpointWarning, match=r"ended before its first checkpoint. It begins anew"):
        whole = simulate(travelling, path, resume=True)
    before = path.read_bytes()
    for again in (travelling, whole.drive):
        require_same(simulate(again, path, resume=True), whole)
    assert path.read_bytes() == before
    with pytest.raises(ModelError, match="holds the run of another drive, which would be lost"):
        simulate(travelling.with_({"belt.width": 0.011}), path, resume=True)
    assert path.read_bytes() == before


def test_wrong_options_of_checkpoints_are_refused(travelling: Drive, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="none is given"):
        simulate(travelling, resume=True)
    with pytest.raises(ModelError, match=r"checkpoint = 0 s must be above zero"):
        simulate(travelling, tmp_path / "run.nc", checkpoint=0.0)


@pytest.mark.slow
def test_a_run_without_checkpoints_begins_anew(travelling: Drive, tmp_path: Path) -> None:
    """So that what resumes until all is complete comes to its end."""
    short = {"simulation.duration": 2e-4, "simulation.output_interval": 1e-4, "simulation.field_interval": None}
    other = travelling.with_({"simulation.integrator": "bdf"} | short)
    simulate(other, tmp_path / "run.nc", stopping_after(1e-5)).dataset.close()
    with pytest.warns(CheckpointWarning, match=r'"bdf", whose state is not stored.*It begins anew'):
        assert simulate(other, tmp_path / "run.nc", resume=True).status == "completed"
    simulate(other, tmp_path / "run.nc", resume=True).dataset.close()  # without a warning


def test_another_drive_does_not_go_on(travelling: Drive, stopped: Path) -> None:
    with pytest.raises(ModelError, match="another drive"):
        simulate(travelling.with_({"belt.width": 0.011}), stopped, resume=True)


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (lambda head, content: head + content[:200], "is damaged"),
        (lambda head, content: head + bytes([*content[:-1000], content[-1000] ^ 4, *content[-999:]]), "is damaged"),
        (lambda head, content: b"beltdyn checkpoint 0.0.1 0\n" + content, "was written by another version"),
        (lambda head, content: head + Packing(()).pack([1.0]), "is not a checkpoint of a run"),
    ],
)
def test_what_is_no_checkpoint_is_refused(
    damage: Callable[[bytes, bytes], bytes], said: str, stopped: Path, travelling: Drive
) -> None:
    file = checkpoint_file(stopped)
    head, _, content = file.read_bytes().partition(b"\n")
    file.write_bytes(damage(head + b"\n", content))
    kept = stopped.read_bytes()
    with pytest.raises(ModelError, match=said):
        simulate(travelling, stopped, resume=True)
    assert stopped.read_bytes() == kept


def test_a_file_that_lost_outputs_is_refused(stopped: Path, travelling: Drive) -> None:
    simulate(travelling, stopped.with_name("short.nc"), stopping_after(0.001)).dataset.close()
    stopped.with_name("short.nc").replace(stopped)
    with pytest.raises(ModelError, match=r"it holds \d+ of"):
        simulate(travelling, stopped, resume=True)


def test_a_short_run_goes_on_to_the_bit(travelling: Drive, tmp_path: Path) -> None:
    """Some steps before its end."""
    path, settings = tmp_path / "run.nc", {"simulation.duration": 4e-3, "simulation.output_interval": 2e-4}
    short = travelling.with_(settings)
    stopped = simulate(short, path, stopping_after(1e-3), checkpoint=OFTEN)
    assert stopped.status == "interrupted"
    stopped.dataset.close()
    require_same(simulate(short, path, resume=True), simulate(short))

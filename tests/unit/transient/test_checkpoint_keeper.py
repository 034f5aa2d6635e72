"""Who keeps checkpoints: when they are written, what is said where they cannot be, and what becomes of earlier ones."""

import time
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.transient import checkpoint
from beltdyn.transient.checkpoint import (
    Checkpoint,
    CheckpointWarning,
    Keeper,
    checkpoint_file,
    is_checkpoint,
    read_checkpoint,
    write_checkpoint,
)

EVERY = 10.0
"""Computing time between two checkpoints, s."""


class Run:
    """A run that is recorded to a file, and how often its state was kept; the clock stands unless it is moved."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.path, self.file, self.now, self.kept = folder / "run.nc", folder / "run.nc", 100.0, 0
        self.written = list[Checkpoint]()
        monkeypatch.setattr(time, "perf_counter", lambda: self.now)
        monkeypatch.setattr(checkpoint, "write_checkpoint", self.write)
        self.fails: Any = None

    def keep(self) -> dict[str, Any]:
        self.kept += 1
        return {"number": self.kept}

    def write(self, path: Path, point: Checkpoint) -> None:
        if self.fails is not None:
            raise ModelError(self.fails)
        assert path == checkpoint_file(self.path)
        path.write_bytes(b"beltdyn checkpoint of this run")
        self.written.append(point)

    def look(self, keeper: Keeper, later: float) -> None:
        """Look for a checkpoint after some time, s."""
        self.now += later
        keeper.look(self, SimpleNamespace())  # type: ignore[arg-type]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    return Run(tmp_path, monkeypatch)


def test_checkpoints_are_written_at_intervals(run: Run, drive: Drive) -> None:
    """Of computing time, from the beginning and then from the last one on; the state is kept only then."""
    keeper = Keeper(run.path, EVERY, drive, True)
    for later, number in ((0.9, 0), (0.05, 0), (0.1, 1), (0.9, 1), (0.2, 2), (5.0, 3), (0.5, 3)):
        run.look(keeper, later * EVERY)
        assert (len(run.written), run.kept) == (number, number)
    assert [point.recording["number"] for point in run.written] == [1, 2, 3]
    assert all(point.drive is drive and point.compare_steady for point in run.written)


def test_a_run_in_memory_keeps_none(run: Run, drive: Drive) -> None:
    keeper = Keeper(None, EVERY, drive, False)
    run.look(keeper, 5.0 * EVERY)
    keeper.remove()
    assert run.kept == 0


@pytest.mark.parametrize(("resumes", "stays"), [(False, False), (True, True)])
def test_the_checkpoint_of_an_earlier_run_stays_until_its_results_are_replaced(
    run: Run, drive: Drive, resumes: bool, stays: bool
) -> None:
    """That of the run which resumes stays."""
    earlier = checkpoint_file(run.path)
    earlier.write_bytes(b"beltdyn checkpoint of an earlier run")
    keeper = Keeper(run.path, EVERY, drive, False, resumes=resumes)
    run.file = None  # type: ignore[assignment]  # nothing is written yet
    run.look(keeper, 2.0 * EVERY)
    assert earlier.exists()
    assert not run.written
    run.file = run.path
    run.now -= 2.0 * EVERY
    run.look(keeper, 0.1)
    assert earlier.exists() is stays
    run.look(keeper, 2.0 * EVERY)
    assert b"of this run" in earlier.read_bytes()
    keeper.remove()
    assert not earlier.exists()


def test_what_is_no_checkpoint_is_not_removed(run: Run, drive: Drive) -> None:
    checkpoint_file(run.path).write_text("mine")
    Keeper(run.path, EVERY, drive, False).remove()
    assert checkpoint_file(run.path).read_text() == "mine"


@pytest.fixture
def raised() -> Iterator[list[warnings.WarningMessage]]:
    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always")
        yield raised


@pytest.mark.parametrize(("before", "whence"), [(False, "its beginning"), (True, "the previous checkpoint")])
def test_a_checkpoint_that_cannot_be_written_is_told_once(
    run: Run, drive: Drive, raised: list[warnings.WarningMessage], before: bool, whence: str
) -> None:
    """The run goes on, and tries again when the next one is due."""
    keeper = Keeper(run.path, EVERY, drive, False)
    if before:
        run.look(keeper, 1.1 * EVERY)
    run.fails = "no space left. Make room."
    for number in range(1, 4):
        run.look(keeper, 1.1 * EVERY)
        assert run.kept == number + before
    run.look(keeper, 0.5 * EVERY)
    assert run.kept == 3 + before
    (warning,) = raised
    assert warning.category is CheckpointWarning
    text = str(warning.message)
    assert text.startswith("the run continues without this checkpoint: no space left. Make room. Results are not")
    assert text.endswith(f"it will resume from {whence}. Another checkpoint is attempted every 10 s.")
    run.fails = None
    run.look(keeper, 1.1 * EVERY)
    assert len(run.written) == 1 + before


def test_checkpoints_are_told_by_their_first_line(tmp_path: Path) -> None:
    assert not is_checkpoint(tmp_path / "none.checkpoint")
    assert not is_checkpoint(tmp_path)
    for content, raised in ((b"beltdyn checkpoint 1\n", True), (b"beltdyn checkpoin", False), (b"", False)):
        (tmp_path / "some.checkpoint").write_bytes(content)
        assert is_checkpoint(tmp_path / "some.checkpoint") is raised


def test_what_is_read_is_what_was_written(tmp_path: Path, drive: Drive) -> None:
    """Without an integration, which other tests resume; a file of others in its place stays."""
    path, point = tmp_path / "run.checkpoint", Checkpoint(drive, None, {"spent": 1.5}, True)  # type: ignore[arg-type]
    write_checkpoint(path, point)
    assert read_checkpoint(path) == point
    write_checkpoint(path, Checkpoint(drive, None, {"spent": 2.5}, False))  # type: ignore[arg-type]
    assert read_checkpoint(path).recording == {"spent": 2.5}
    other = tmp_path / "other.checkpoint"
    other.write_text("mine")
    with pytest.raises(ModelError, match="already exists and was not written by beltdyn"):
        write_checkpoint(other, point)
    assert other.read_text() == "mine"
    with pytest.raises(ModelError, match="does not exist: the run is complete, ended before its first checkpoint"):
        read_checkpoint(tmp_path / "none.checkpoint")

"""A result file has one writer; the lock goes with its process."""

import subprocess
import sys
from collections.abc import Callable
from contextvars import Context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import LostOutputError, ModelError
from beltdyn.results import FileRecorder, Layout, Run, open_run
from beltdyn.results.atomic import locked_output
from beltdyn.results.staged_file import StagedFile

WRITER = Path(__file__).with_name("writer_process.py")


def test_second_writer_is_refused(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """By any name of the file; and nothing is changed by the attempt."""
    first = FileRecorder(tmp_path / "result.nc", layout, attributes)
    first.append(make_chunk(np.arange(3.0)))
    before = first.path.read_bytes()
    (tmp_path / "folder").mkdir()
    for name in (tmp_path / "result.nc", tmp_path / "folder" / ".." / "result.nc"):
        with pytest.raises(ModelError, match=r"result\.nc is being written by another run.*Wait"):
            FileRecorder(name, layout, attributes)
    assert first.path.read_bytes() == before
    first.close("completed", {})
    FileRecorder(tmp_path / "result.nc", layout, attributes).close("completed", {})
    assert sorted(file.name for file in tmp_path.iterdir()) == ["folder", "result.nc"]


@pytest.mark.parametrize("link", [Path.symlink_to, Path.hardlink_to], ids=["symbolic", "hard"])
def test_no_writer_of_any_kind_takes_a_file_that_is_written(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], run: Run, link: Any
) -> None:
    """By its name or by a link from elsewhere; a result, a table, anything that is written as a whole."""
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.arange(3.0)))
    (tmp_path / "folder").mkdir()
    other = tmp_path / "folder" / "other.nc"
    link(other, tmp_path / "result.nc")
    for path in (recorder.path, other):
        before = path.read_bytes()
        with pytest.raises(ModelError, match="is being written by another run"):
            run.save(path)
        with pytest.raises(ModelError, match="is being written by another run"), locked_output(path):
            pass
        assert path.read_bytes() == before
    recorder.append(make_chunk(np.arange(3.0, 5.0)))
    recorder.close("completed", {})
    assert open_run(recorder.path).outputs == 5
    run.save(other)
    assert sorted(file.name for file in tmp_path.rglob("*")) == ["folder", "other.nc", "result.nc"]


def test_whoever_holds_the_lock_may_write(tmp_path: Path, run: Run) -> None:
    path = tmp_path / "result.nc"
    with locked_output(path):
        run.save(path)
        with locked_output(path):
            run.save(path)
        with pytest.raises(ModelError, match="is being written"):
            Context().run(run.save, path)
    run.save(path)
    assert list(tmp_path.iterdir()) == [path]


def test_a_lock_that_a_file_names_is_no_file_of_others(tmp_path: Path, run: Run) -> None:
    """A result of others may name any file as its lock: nothing but a lock is opened."""
    mine = tmp_path / ".mine.lock"
    mine.write_text("mine")
    path = run.save(tmp_path / "result.nc")
    with StagedFile(path) as staged:
        staged.commit(owner=str(mine))
    (tmp_path / "link.nc").hardlink_to(path)
    run.save(tmp_path / "link.nc")
    assert mine.read_text() == "mine"


def test_lock_of_a_killed_process_is_gone(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    path = tmp_path / "result.nc"
    command = [sys.executable, str(WRITER), str(path), "7"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        with pytest.raises(ModelError, match="being written by another run"):
            FileRecorder(path, layout, attributes)
        process.kill()
    recorder = FileRecorder(path, layout, attributes)
    recorder.append(make_chunk(np.arange(3.0)))
    recorder.close("completed", {})
    assert open_run(path).status == "completed"
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_is_read_amid_a_write_says_so(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """What a reader meets there may be neither the old contents nor the new ones."""
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.arange(3.0)))
    whole = recorder.path.read_bytes()
    recorder.path.write_bytes(whole[:100])
    with pytest.raises(ModelError, match="A run is writing it, or was killed while doing so: try again"):
        open_run(recorder.path)
    recorder.path.write_bytes(whole)
    recorder.close("completed", {})
    recorder.path.write_bytes(whole[:100])
    with pytest.raises(ModelError, match="it is damaged: run the drive again"):
        open_run(recorder.path)


def test_rows_never_go_into_another_file(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """As where the result was moved away, and another one moved to its place."""
    recorder, other = (FileRecorder(tmp_path / name, layout, attributes) for name in ("result.nc", "other.nc"))
    for one in (recorder, other):
        one.append(make_chunk(np.arange(3.0)))
    other.close("completed", {})
    other.path.replace(recorder.path)
    before = recorder.path.read_bytes()
    with pytest.raises(LostOutputError, match=r"was removed or replaced.*the results are lost"):
        recorder.append(make_chunk(np.arange(3.0)))
    with pytest.raises(LostOutputError, match=r"was removed or replaced.*the results are lost"):
        recorder.close("completed", {})
    assert recorder.path.read_bytes() == before

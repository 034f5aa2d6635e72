"""A result file has one writer; the lock goes with its process."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError, OutputError
from beltdyn.results import FileRecorder, Layout, open_run

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
    with pytest.raises(ModelError, match="A run is writing it, or was killed meanwhile: try again"):
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
    with pytest.raises(OutputError, match="another file has taken its place"):
        recorder.append(make_chunk(np.arange(3.0)))
    with pytest.raises(OutputError, match="another file has taken its place"):
        recorder.close("completed", {})
    assert recorder.path.read_bytes() == before

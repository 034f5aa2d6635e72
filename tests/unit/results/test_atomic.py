"""What may be replaced by a file of ours, and what may not."""

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import FileRecorder, Layout, open_run
from beltdyn.results.atomic import MARK, atomic_path, is_marked, require_replaceable, target_of


def make_text(path: Path) -> None:
    path.write_text("time,torque\n0,1\n", encoding="utf-8")


def make_foreign_hdf5(path: Path) -> None:
    with h5py.File(path, "w") as file:
        file["measured"] = [1.0, 2.0]


def make_empty(path: Path) -> None:
    path.touch()


REGULAR = (make_text, make_foreign_hdf5, make_empty)


@pytest.mark.parametrize("make", REGULAR)
def test_only_results_are_replaced(
    tmp_path: Path, layout: Layout, attributes: Any, make: Callable[[Path], None]
) -> None:
    path = tmp_path / "mine"
    make(path)
    before = path.read_bytes()
    with pytest.raises(ModelError, match=r"mine already exists and was not written by beltdyn.*--force"):
        FileRecorder(path, layout, attributes)
    assert path.read_bytes() == before


def test_results_are_replaced_and_other_files_with_force(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    path = tmp_path / "mine"
    make_text(path)
    for overwrite in (True, False):  # a result now
        recorder = FileRecorder(path, layout, attributes, overwrite)
        recorder.append(make_chunk(np.arange(3.0)))
        recorder.close("completed", {})
        assert open_run(path).status == "completed"
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are a matter of POSIX")
@pytest.mark.parametrize("overwrite", [False, True])
def test_pipes_devices_and_folders_are_never_replaced(
    tmp_path: Path, layout: Layout, attributes: Any, overwrite: bool
) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    for path in (tmp_path / "pipe", tmp_path / "folder", Path(os.devnull)):
        with pytest.raises(ModelError, match=r"cannot be written \(it is a (device or a pipe|folder), not a file\)"):
            FileRecorder(path, layout, attributes, overwrite)
    assert (tmp_path / "pipe").is_fifo()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["folder", "pipe"]


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_links_are_followed(tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]) -> None:
    """They stay, and what they lead to obeys the rule."""
    link, target = tmp_path / "link.nc", tmp_path / "target.nc"
    link.symlink_to(target)
    for _ in range(2):
        recorder = FileRecorder(link, layout, attributes)
        recorder.append(make_chunk(np.arange(3.0)))
        recorder.close("completed", {})
        assert link.is_symlink()
        assert open_run(target).status == "completed"
    make_text(target)
    with pytest.raises(ModelError, match="not written by beltdyn"):
        FileRecorder(link, layout, attributes)
    assert link.is_symlink()
    make_text(target)


def test_marks_are_found_at_both_ends(tmp_path: Path) -> None:
    path, filler = tmp_path / "file", b"\0" * 10_000
    for data, marked in ((b"", False), (filler, False), (MARK.encode() + filler, True), (filler + MARK.encode(), True)):
        path.write_bytes(data)
        assert is_marked(path) is marked
    assert not is_marked(tmp_path)


def test_what_killed_processes_left_is_removed(tmp_path: Path) -> None:
    """By its name, where the file is written again; whoever writes it has locked it."""
    for name in (".d.0123abcd.nc", ".d.fedc9876.nc", ".d.0123abcd.csv", ".e.0123abcd.nc", "d.nc"):
        (tmp_path / name).touch()
    with atomic_path(tmp_path / "d.nc", lambda _: True) as temporary:
        temporary.write_text("new")
    assert sorted(file.name for file in tmp_path.iterdir()) == [".d.0123abcd.csv", ".e.0123abcd.nc", "d.nc"]
    assert (tmp_path / "d.nc").read_text() == "new"


@pytest.mark.skipif(sys.platform == "win32", reason="links need a right there")
def test_links_in_a_circle_are_told(tmp_path: Path) -> None:
    (tmp_path / "a.nc").symlink_to(tmp_path / "b.nc")
    (tmp_path / "b.nc").symlink_to(tmp_path / "a.nc")
    for action in (target_of, lambda path: require_replaceable(path, is_marked)):
        with pytest.raises(ModelError, match=r"a\.nc cannot be written \(Too many levels of symbolic links\)"):
            action(tmp_path / "a.nc")

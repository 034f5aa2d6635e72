"""A full disk ends a run with its reason; what was written before stays readable."""

import errno
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import OutputError
from beltdyn.results import FileRecorder, Layout, staged_file
from beltdyn.results.dataset import open_dataset

LargestFile = Callable[[int], AbstractContextManager[None]]
OUTPUTS = 7
MOST = 300


class Filling:
    """A recorder that is given outputs, each filled with its number."""

    def __init__(self, path: Path, layout: Layout) -> None:
        self.layout, self.outputs = layout, 0
        self.recorder = FileRecorder(path, layout, {"drive": ""})

    def append(self) -> None:
        numbers = np.arange(self.outputs, self.outputs + OUTPUTS)
        rows = {name: self.layout.shape(variable, OUTPUTS) for name, variable in self.layout.recorded.items()}
        shaped = {name: numbers.reshape(-1, *[1] * (len(row) - 1)) for name, row in rows.items()}
        self.recorder.append({name: np.broadcast_to(shaped[name], row) for name, row in rows.items()})
        self.outputs += OUTPUTS

    def append_all(self) -> None:
        for _ in range(MOST):
            self.append()


def fill(path: Path, layout: Layout) -> int:
    """Write until the disk takes no more; check what is left, and count it."""
    filling = Filling(path, layout)
    with pytest.raises(OutputError, match=r"result.nc cannot be written \(.*\)\. Make room"):
        filling.append_all()
    start, recorder = filling.outputs, filling.recorder
    recorder.close("failed", {"steps": 1200, "wall_time": 0.5, "integrator": "generalized_alpha"})
    if not start:
        assert list(path.parent.iterdir()) == []
        return 0
    assert list(path.parent.iterdir()) == [path]
    with open_dataset(path) as dataset:
        assert dataset.sizes["time"] == start
        assert dataset.attrs["status"] == "failed"
        assert int(dataset.attrs["steps"]) == 1200
        for name in dataset.data_vars:
            rows = dataset[name].values.T
            np.testing.assert_array_equal(rows, np.broadcast_to(np.arange(start).astype(rows.dtype), rows.shape))
    with xr.open_dataset(path) as plain:
        plain.load()
    path.unlink()
    return start


@contextmanager
def small_disk(folder: Path, size: int) -> Iterator[Path]:
    """A disk of a size in kB, where one may be mounted."""
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", f"size={size}k", "tmpfs", str(folder)]
    if sys.platform != "linux" or subprocess.run(mount, capture_output=True, check=False).returncode:
        pytest.skip("no disks may be mounted here")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize("size", [10_000, 150_000, 500_000, 2_345_678])
def test_files_of_limited_size(tmp_path: Path, layout: Layout, size: int, largest_file: LargestFile) -> None:
    with largest_file(size):
        outputs = fill(tmp_path / "result.nc", layout)
    assert (outputs > 0) == (size > 1_000_000)


@pytest.mark.slow
def test_files_of_any_limited_size(tmp_path: Path, layout: Layout, largest_file: LargestFile) -> None:
    for size in np.random.default_rng(13).integers(5_000, 4_000_000, 60).tolist():
        with largest_file(size):
            fill(tmp_path / "result.nc", layout)


@pytest.mark.parametrize("size", [64, 1000, pytest.param(3000, marks=pytest.mark.slow)])
def test_small_disks(tmp_path: Path, layout: Layout, size: int) -> None:
    with small_disk(tmp_path / "disk", size) as disk:
        fill(disk / "result.nc", layout)


@pytest.mark.slow
def test_disks_of_many_sizes(tmp_path: Path, layout: Layout) -> None:
    for size in range(100, 4000, 100):
        with small_disk(tmp_path / f"{size}", size) as disk:
            fill(disk / "result.nc", layout)


@pytest.mark.slow
def test_refusal_at_any_write(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each write of an append is refused in turn, half done: the file holds what it held, and nothing more."""
    write_all, left = staged_file._write_all, 0

    def refusing(file: Any, pieces: list[tuple[int, bytes]]) -> None:
        nonlocal left
        for place, data in pieces:
            left -= 1
            write_all(file, [(place, data[: len(data) // 2] if left == 0 else data)])
            if left == 0:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.arange(3.0)))
    monkeypatch.setattr(staged_file, "_write_all", refusing)
    for refused in range(1, 100):
        left = refused
        try:
            recorder.append(make_chunk(np.arange(3.0, 5.0)))
            break
        except OutputError:
            with open_dataset(recorder.path) as dataset:
                np.testing.assert_array_equal(dataset["time"], np.arange(3.0))
                assert all(bool(dataset[name].notnull().all()) for name in dataset.data_vars)
    assert refused > 3
    left = 0
    recorder.close("completed", {})
    with open_dataset(recorder.path) as dataset:
        np.testing.assert_array_equal(dataset["time"], np.arange(5.0))
        assert all(bool(dataset[name].notnull().all()) for name in dataset.data_vars)

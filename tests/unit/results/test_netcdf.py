"""A growing file: outputs are appended, cut back and finished, and never put into another file."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
import pytest

from beltdyn.results import Layout
from beltdyn.results.dataset import checked_outputs
from beltdyn.results.netcdf import GrowingFile
from beltdyn.results.schema import TIMES

Chunk = Callable[[np.ndarray], dict[str, Any]]


@pytest.fixture
def outputs(layout: Layout, make_chunk: Chunk) -> Callable[..., dict[str, Any]]:
    return lambda *times: checked_outputs(layout, make_chunk(np.array(times)))


def test_a_new_file_has_every_variable_and_no_output(layout: Layout, tmp_path: Path) -> None:
    GrowingFile(tmp_path / "run.nc", layout, {"title": "mine"})
    with h5py.File(tmp_path / "run.nc") as file:
        assert file.attrs["title"] == "mine"
        for name, variable in layout.recorded.items():
            assert file[name].shape == layout.shape(variable, 0)
            assert file[name].dtype == np.dtype(variable.dtype)
        for name, values in layout.coordinates.items():
            assert file[name].shape == values.shape


def test_outputs_follow_each_other(layout: Layout, tmp_path: Path, outputs: Callable[..., dict[str, Any]]) -> None:
    path = tmp_path / "run.nc"
    growing = GrowingFile(path, layout, {})
    growing.append(path, outputs(0.0, 0.1))
    growing.append(path, outputs(0.2))
    growing.finish(path, {"status": "completed"})
    expected = outputs(0.0, 0.1, 0.2)
    with h5py.File(path) as file:
        assert file.attrs["status"] == "completed"
        for name in ("time", "span_tension", "nodal_coordinates", "contact_pulley"):
            np.testing.assert_array_equal(file[name], expected[name])


def test_time_grows_until_the_file_is_finished(
    layout: Layout, tmp_path: Path, outputs: Callable[..., dict[str, Any]]
) -> None:
    """Of a dimension that may grow readers look for the length in all its variables, each time they ask for it."""
    path = tmp_path / "run.nc"
    growing = GrowingFile(path, layout, {})
    growing.append(path, outputs(0.0, 0.1))
    with h5netcdf.File(path, "r") as file:
        assert all(file.dimensions[name].isunlimited() for name in TIMES)
        variables = {name: (variable.dimensions, dict(variable.attrs)) for name, variable in file.variables.items()}
    growing.finish(path, {})
    with h5netcdf.File(path, "r") as file:
        assert not any(file.dimensions[name].isunlimited() for name in TIMES)
        found = {name: (variable.dimensions, dict(variable.attrs)) for name, variable in file.variables.items()}
    np.testing.assert_equal(found, variables)


def test_rows_without_their_instant_are_cut(
    layout: Layout, tmp_path: Path, outputs: Callable[..., dict[str, Any]]
) -> None:
    """As an append leaves them that was interrupted before the time was written."""
    path = tmp_path / "run.nc"
    growing = GrowingFile(path, layout, {})
    growing.append(path, outputs(0.0, 0.1))
    with growing._open(path) as staged:
        with h5py.File(staged, "r+") as file:
            file["span_tension"].resize(5, axis=0)
        growing._commit(staged)
    growing.finish(path, {})
    with h5py.File(path) as file:
        assert {file[name].shape[0] for name in (*TIMES, "span_tension", "contact_pulley")} == {2}


def test_another_file_of_that_name_is_left_alone(
    layout: Layout, tmp_path: Path, outputs: Callable[..., dict[str, Any]]
) -> None:
    path, moved = tmp_path / "run.nc", tmp_path / "moved.nc"
    growing = GrowingFile(path, layout, {})
    path.rename(moved)
    shutil.copy(moved, path)
    before = path.read_bytes()
    with pytest.raises(OSError, match="another file has taken its place"):
        growing.append(path, outputs(0.0))
    with pytest.raises(OSError, match="another file has taken its place"):
        growing.finish(path, {"status": "failed"})
    assert path.read_bytes() == before
    growing.append(moved, outputs(0.0))
    with h5py.File(moved) as file:
        assert file["time"].shape == (1,)

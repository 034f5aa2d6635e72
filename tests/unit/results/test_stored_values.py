"""Values in a result file whose bytes are wrong: the error tells of the file, wherever they are read."""

import pickle
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.results.stored_values import open_values


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file with checksums, by which HDF5 notices what is wrong."""
    variables = {"speed": ("time", np.arange(5.0)), "count": ("time", np.arange(5)), "still": ((), 3.0)}
    encoding = {name: {"fletcher32": True, "chunksizes": (5,)} for name in ("speed", "count")}
    dataset = xr.Dataset(variables, {"time": np.linspace(0.0, 1.0, 5)})
    dataset.to_netcdf(tmp_path / "run.nc", engine="h5netcdf", encoding=encoding)
    return tmp_path / "run.nc"


def test_values_are_those_of_the_file(path: Path) -> None:
    with open_values(path) as dataset:
        np.testing.assert_array_equal(dataset["speed"], np.arange(5.0))
        assert dataset["count"].dtype == np.int64
        assert float(dataset["still"]) == 3.0
        assert pickle.loads(pickle.dumps(dataset)).identical(dataset)


@pytest.mark.parametrize("name", ["speed", "count"])
def test_what_cannot_be_read_is_told_of_the_file(path: Path, name: str) -> None:
    content = bytearray(path.read_bytes())
    with h5py.File(path, "r") as file:
        content[file[name].id.get_chunk_info(0).byte_offset + 3] ^= 0xFF
    path.write_bytes(content)
    with open_values(path) as dataset:
        assert float(dataset["still"]) == 3.0
        with pytest.raises(ModelError, match=r"run\.nc cannot be read as a result file.*damaged: run the drive again"):
            dataset[name].isel(time=slice(2, 4)).to_numpy()

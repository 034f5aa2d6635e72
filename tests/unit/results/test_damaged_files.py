"""Damaged result files: each is refused with one message, or every number in it is still right."""

import math
import os
import time
from pathlib import Path
from random import Random
from typing import Any

import h5py
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.results import FileRecorder, Run, open_result, summarize
from beltdyn.results.result import Result
from beltdyn.show import plot
from tools.campaign.damage import damaged

OUTPUTS = 5
COUNT = int(os.environ.get("BELTDYN_DAMAGES", "400"))
"""Damaged files of each kind of result in the slow test."""
LONGEST = 10.0
"""Processor time that a file may take where time is looked at, s."""

LONGEST_MESSAGE = 1000


@pytest.fixture
def files(layout: Any, attributes: Any, statistics: Any, make_chunk: Any, run: Run, tmp_path: Path) -> dict[str, bytes]:
    """Bytes of small result files: of a run that has ended, of one that was killed, and of another analysis."""
    contents = {}
    for name in ("completed", "killed"):
        recorder = FileRecorder(tmp_path / f"{name}.nc", layout, attributes)
        for times in np.split(np.linspace(0.0, 1.0, OUTPUTS), [2, 3]):
            recorder.append(make_chunk(times))
        if name == "completed":
            recorder.close("completed", statistics)
        contents[name] = recorder.path.read_bytes()
        if name == "killed":
            recorder.close("failed", {})
    some = run.dataset[["pulley_speed", "hub_force"]].isel(time=slice(3)).assign_attrs(kind="some")
    saved = Result(some, run.drive).save(tmp_path / "some.nc")
    return contents | {"some": saved.read_bytes()}


def numbers(path: Path) -> xr.Dataset:
    """All that is in a result file; of a run also what is derived and drawn."""
    result = open_result(path)
    try:
        if isinstance(result, Run):
            assert len(summarize(result).pulleys) == 2
            assert isinstance(result.warnings, list)
            for figure in (plot.span_tensions, plot.configuration):
                figure(result)
        return result.dataset.load()
    finally:
        result.dataset.close()
        plt.close("all")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["completed", pytest.param("killed", marks=pytest.mark.slow), "some"])
@pytest.mark.parametrize(
    ("seeds", "longest"),
    [(range(10), math.inf), pytest.param(range(10, COUNT), LONGEST, marks=pytest.mark.slow)],
    ids=["ten", "many"],
)
def test_no_number_changes_unseen(
    files: dict[str, bytes], tmp_path: Path, name: str, seeds: range, longest: float
) -> None:
    path, refused = tmp_path / "result.nc", 0
    path.write_bytes(files[name])
    intact = numbers(path)
    for seed in seeds:
        path.write_bytes(damaged(files[name], Random(seed)))
        begun = time.process_time()
        try:
            assert numbers(path).identical(intact), seed
        except ModelError as error:
            refused += 1
            assert "result.nc" in str(error), seed  # noqa: PT017
            assert len(str(error)) < LONGEST_MESSAGE, seed  # noqa: PT017
        assert time.process_time() - begun < longest, seed
    assert refused > len(seeds) / 2


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("step", [2999, pytest.param(331, marks=pytest.mark.slow)])
def test_every_bit_of_small_parts_counts(files: dict[str, bytes], tmp_path: Path, step: int) -> None:
    """Where HDF5 itself has no checksums: heads of objects, names and attributes."""
    path, data = tmp_path / "result.nc", files["some"]
    for bit in range(0, 8 * 4096, step):
        changed = bytearray(data)
        changed[bit // 8] ^= 1 << bit % 8
        path.write_bytes(changed)
        with pytest.raises(ModelError, match=r"the page of bytes 0 to 4,096 differ"):
            open_result(path)


def test_a_file_that_another_program_changed_is_told(files: dict[str, bytes], tmp_path: Path) -> None:
    """A copy that xarray writes is a file of its own, and is read."""
    path = tmp_path / "result.nc"
    path.write_bytes(files["some"])
    with xr.open_dataset(path, decode_times=False) as plain:
        plain.load().to_netcdf(tmp_path / "copy.nc", engine="h5netcdf")
    assert open_result(tmp_path / "copy.nc").kind == "some"
    with h5py.File(path, "r+") as file:
        file.attrs["comment"] = "mine" * 1000
    with pytest.raises(ModelError, match="another program has modified it"):
        open_result(path)

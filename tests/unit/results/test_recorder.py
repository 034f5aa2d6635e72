from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import LostOutputError, ModelError, OutputError
from beltdyn.results import COORDINATES, VARIABLES, FileRecorder, Layout, MemoryRecorder, Status, open_run, staged_file
from beltdyn.results.recorder import _no_outputs

TIME = np.linspace(0.0, 1.0, 121)
KNOWN = {**VARIABLES, **COORDINATES}


@pytest.fixture
def result(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], statistics: Any
) -> FileRecorder:
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    for time in np.split(TIME, [1, 50, 100]):
        recorder.append(make_chunk(time))
    recorder.close("completed", statistics)
    return recorder


def test_file_and_memory_hold_the_same(
    result: FileRecorder, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], statistics: Any
) -> None:
    memory = MemoryRecorder(layout, attributes)
    for time in np.split(TIME, [1, 50, 100]):
        memory.append(make_chunk(time))
    memory.close("completed", statistics)
    with result.dataset() as dataset:
        xr.testing.assert_identical(dataset, memory.dataset())
        for name in dataset.variables:
            assert dataset[name].dtype == memory.dataset()[name].dtype


def test_dataset_keeps_to_the_schema(result: FileRecorder) -> None:
    with result.dataset() as dataset:
        kept = {
            name: variable
            for name, variable in KNOWN.items()
            if not {"tensioner", "carriage", "tooth", "nip", "roll"} & {*variable.dims}
        }
        assert set(dataset.variables) == set(kept)
        for name, variable in kept.items():
            assert dataset[name].dims == variable.dims
            assert dataset[name].attrs == variable.attributes


def test_tensioners_are_recorded_where_there_are_any(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """In memory and in a file; without them nothing of theirs is there, and none is asked for."""
    tensioned = replace(layout, tensioners=("driven",))
    chunk = make_chunk(TIME) | {"tensioner_position": TIME[:, None], "tensioner_speed": 1.0 + 0.0 * TIME[:, None]}
    chunk["filtered_tensioner_position"] = TIME[:, None]
    file, memory = FileRecorder(tmp_path / "tensioned.nc", tensioned, attributes), MemoryRecorder(tensioned, attributes)
    for recorder in (file, memory):
        recorder.append(chunk)
    with file.dataset() as dataset:
        xr.testing.assert_identical(dataset, memory.dataset())
        assert set(dataset.variables) == {
            name for name, one in KNOWN.items() if not {"carriage", "tooth", "nip", "roll"} & {*one.dims}
        }
        assert dataset["tensioner"].values.tolist() == ["driven"]
    with pytest.raises(ValueError, match=r"missing or unknown variables.*tensioner_position, tensioner_speed"):
        MemoryRecorder(layout, attributes).append(chunk)


def test_result_that_lacks_the_place_of_its_tensioner_is_refused(
    tmp_path: Path, layout: Layout, attributes: Any
) -> None:
    recorder = MemoryRecorder(replace(layout, tensioners=("driven",)), attributes)
    with recorder.dataset() as dataset:
        dataset.drop_vars("tensioner_position").to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(ModelError, match="has no `tensioner_position`"):
        open_run(tmp_path / "other.nc")


def test_plain_xarray_opens_the_file(result: FileRecorder) -> None:
    with xr.open_dataset(result.path, engine="h5netcdf") as dataset:
        assert dataset["time"].dtype == np.float64
        np.testing.assert_array_equal(dataset["time"], TIME)
        assert float(dataset["pulley_speed"].sel(pulley="driver")[-1]) == 12.0
        assert "belt_coordinate" in dataset["normal_force"].coords


def test_file_is_netcdf4(result: FileRecorder, layout: Layout) -> None:
    with h5netcdf.File(result.path, "r") as file:
        assert file.variables["nodal_coordinates"].dimensions == ("field_time", "node", "coordinate")
        assert all(file.variables[name].shape[0] == len(TIME) for name in layout.recorded)


def test_file_has_no_consistency_flags(result: FileRecorder) -> None:
    version_of_superblock = result.path.read_bytes()[8]
    assert version_of_superblock == 0


def test_file_is_readable_while_it_grows(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(TIME[:3]))
    with open_run(recorder.path).dataset as early:
        assert early.sizes["time"] == 3
    recorder.append(make_chunk(TIME[3:5]))
    run = open_run(recorder.path)
    with run.dataset as late:
        assert late.sizes["time"] == 5
        assert run.status == "running"
        assert any("the run is still going, or was killed" in warning for warning in run.warnings)


@pytest.mark.parametrize("status", ["completed", "interrupted", "failed"])
def test_without_outputs_there_is_no_file(tmp_path: Path, layout: Layout, attributes: Any, status: Status) -> None:
    recorder, memory = FileRecorder(tmp_path / "result.nc", layout, attributes), MemoryRecorder(layout, attributes)
    for one in (recorder, memory):
        one.close(status, {"steps": 3})
    assert list(tmp_path.iterdir()) == []
    assert recorder.file is None
    xr.testing.assert_identical(recorder.dataset(), memory.dataset())


@pytest.mark.parametrize(
    "status", ["completed", *(pytest.param(one, marks=pytest.mark.slow) for one in ("interrupted", "failed"))]
)
def test_an_earlier_result_stays_until_there_are_outputs(
    result: FileRecorder, layout: Layout, attributes: Any, make_chunk: Callable[..., Any], status: Status
) -> None:
    before = result.path.read_bytes()
    recorder = FileRecorder(result.path, layout, attributes)
    recorder.revise(layout, attributes)
    recorder.append(_no_outputs(layout))
    assert result.path.read_bytes() == before
    recorder.close(status, {})
    assert result.path.read_bytes() == before
    recorder = FileRecorder(result.path, layout, attributes)
    recorder.append(make_chunk(TIME[:3]))
    assert recorder.file == result.path
    with open_run(result.path).dataset as dataset:
        assert dataset.sizes["time"] == 3
    recorder.close(status, {})


def test_a_file_that_came_meanwhile_stays(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.path.write_text("mine", encoding="utf-8")
    with pytest.raises(OutputError, match="already exists and was not written by beltdyn"):
        recorder.append(make_chunk(TIME))
    recorder.close("failed", {})
    assert recorder.path.read_text(encoding="utf-8") == "mine"
    assert list(tmp_path.iterdir()) == [recorder.path]


@pytest.mark.slow
def test_interrupted_append_is_cut_off(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    result = FileRecorder(tmp_path / "result.nc", layout, attributes)
    result.append(make_chunk(TIME))
    growing = result._file
    assert growing is not None
    with growing._open(result.path) as staged:
        with h5py.File(staged, "r+") as file:
            file["kinetic_energy"].resize(len(TIME) + 7, axis=0)
        growing._commit(staged)
    with result.dataset() as dataset:
        assert dataset.sizes["time"] == len(TIME)
        assert bool(dataset["kinetic_energy"].notnull().all())
    result.append(make_chunk(np.array([2.0])))
    result.close("interrupted", {})
    with xr.open_dataset(result.path) as dataset:
        assert dataset.sizes["time"] == len(TIME) + 1
        assert dataset.attrs["status"] == "interrupted"


def test_variables_are_read_when_used(result: FileRecorder) -> None:
    with open_run(result.path).dataset as dataset:
        assert not dataset["nodal_coordinates"].variable._in_memory


def test_memory_recorder_keeps_copies(layout: Layout, make_chunk: Callable[..., Any]) -> None:
    recorder, chunk = MemoryRecorder(layout, {}), make_chunk(TIME)
    recorder.append(chunk)
    chunk["kinetic_energy"][:] = -1.0
    assert float(recorder.dataset()["kinetic_energy"].min()) >= 0.0


def test_creation_leaves_nothing_else(result: FileRecorder) -> None:
    assert list(result.path.parent.iterdir()) == [result.path]


@pytest.mark.parametrize("place", ["missing/result.nc", "", "file/result.nc"])
def test_unwritable_path_is_a_model_error(tmp_path: Path, layout: Layout, attributes: Any, place: str) -> None:
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(ModelError, match="cannot be written"):
        FileRecorder(tmp_path / place, layout, attributes)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_vanished_file_is_an_error(result: FileRecorder, make_chunk: Callable[..., Any]) -> None:
    result.path.unlink()
    with pytest.raises(LostOutputError, match="was removed"):
        result.append(make_chunk(TIME))
    with pytest.raises(LostOutputError, match="was removed"):
        result.close("completed", {})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda chunk: chunk.pop("time"), "missing or unknown variables.*time"),
        (lambda chunk: chunk.update(color=chunk["time"]), "missing or unknown variables.*color"),
        (lambda chunk: chunk.update(step_size=np.zeros(3)), "step_size has shape"),
        (lambda chunk: chunk.update(hub_force=np.zeros((121, 2))), "hub_force has shape"),
    ],
)
def test_wrong_chunks_are_refused(
    layout: Layout, make_chunk: Callable[..., Any], change: Callable[[Any], Any], message: str
) -> None:
    chunk = make_chunk(TIME)
    change(chunk)
    with pytest.raises(ValueError, match=message):
        MemoryRecorder(layout, {}).append(chunk)


def test_an_append_writes_its_outputs_and_little_more(
    tmp_path: Path,
    layout: Layout,
    attributes: Any,
    make_chunk: Callable[..., Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """However long the file is: what it holds already is neither read nor written again."""
    write_all, written = staged_file._write_all, list[int]()

    def counting(file: Any, pieces: list[tuple[int, bytes]]) -> None:
        written.append(sum(len(data) for _, data in pieces))
        write_all(file, pieces)

    appends, chunk = 20, make_chunk(TIME[:50])
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(chunk)
    begun = recorder.path.stat().st_size
    outputs = sum(np.asarray(chunk[name], variable.dtype).nbytes for name, variable in layout.recorded.items())
    ends = 2 * len(layout.recorded) * staged_file._BLOCK_BYTES  # a variable's rows begin and end within blocks
    monkeypatch.setattr(staged_file, "_write_all", counting)
    for _ in range(appends):
        written.clear()
        recorder.append(chunk)
        assert outputs < sum(written) < outputs + ends + staged_file.RESERVE
    assert outputs + ends + staged_file.RESERVE < recorder.path.stat().st_size < 1.1 * (begun + appends * outputs)

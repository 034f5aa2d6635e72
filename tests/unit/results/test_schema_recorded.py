from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from beltdyn.results import FileRecorder, Layout
from beltdyn.results.schema import InMemory, attribute, names


def test_names_are_text_in_a_file_and_in_a_dataset(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """HDF5 holds them as bytes."""
    recorder = FileRecorder(tmp_path / "result.nc", replace(layout, pulleys=("Räder", "driven")), attributes)
    recorder.append(make_chunk(np.array([0.0])))
    with recorder.dataset() as dataset:
        assert names(dataset, "pulley") == ["Räder", "driven"]
    with h5py.File(recorder.path) as file:
        assert names(file, "pulley") == ["Räder", "driven"]
        assert names(file, "span") == list(layout.spans)


def test_attributes_are_numbers_in_a_file_and_in_a_dataset(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    """A file holds arrays of one."""
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.array([0.0])))
    recorder.close("completed", {"flutter_growth": 7.5})
    with recorder.dataset() as dataset, h5py.File(recorder.path) as file:
        for recorded in (dataset, file):
            assert attribute(recorded, "flutter_growth", 0.0) == 7.5
            assert attribute(recorded, "flutter_rate", -1.0) == -1.0


def test_a_dataset_as_plain_arrays(
    tmp_path: Path, layout: Layout, attributes: Any, make_chunk: Callable[..., Any]
) -> None:
    recorder = FileRecorder(tmp_path / "result.nc", layout, attributes)
    recorder.append(make_chunk(np.array([0.0])))
    with recorder.dataset() as dataset:
        plain = InMemory(dataset)
        assert "pulley_speed" in plain
        assert "nothing" not in plain
        assert plain.attrs is dataset.attrs
        assert names(plain, "pulley") == list(layout.pulleys)
        np.testing.assert_array_equal(plain["pulley_speed"], dataset["pulley_speed"].values)

"""Formats are chosen by name, and all of them are checked before anything is written."""

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.results import Run, export, open_run
from beltdyn.results.result import Result
from beltdyn.state.equilibrium import equilibrium


@pytest.fixture
def result_file(make_run: Callable[..., Run], tmp_path: Path) -> Path:
    return make_run(11).save(tmp_path / "drive.v2.nc")


def test_files_are_named_after_the_result(result_file: Path) -> None:
    files = export(open_run(result_file), ["vtk", "csv", "mat", "parquet"])
    folder = result_file.parent
    assert files[:2] == [folder / "drive.v2-belt.vtkhdf", folder / "drive.v2-pulleys.vtkhdf"]
    assert folder / "drive.v2.mat" in files
    assert {file.suffix for file in files if file.parent == folder / "drive.v2-tables"} == {".csv", ".parquet"}
    assert all(file.is_file() for file in files)


def test_a_result_in_memory_needs_a_name(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="has no file name"):
        export(run, "mat")
    assert export(run, "mat", tmp_path / "mine.nc") == [tmp_path / "mine.mat"]


def test_formats_that_are_none_are_refused(run: Run, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"'ods' is not a result format\. Choose from vtk, csv, mat, xl"):
        export(run, ["csv", "ods"], tmp_path / "drive.nc")
    with pytest.raises(ModelError, match="no format is given"):
        export(run, [], tmp_path / "drive.nc")
    assert list(tmp_path.iterdir()) == []


def test_nothing_is_written_where_one_format_cannot_be(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ModelError, match="pyarrow"):
        export(run, ["vtk", "csv", "mat", "parquet"], tmp_path / "drive.nc")
    (tmp_path / "drive.mat").write_text("mine", encoding="utf-8")
    with pytest.raises(ModelError, match=r"drive.mat already exists"):
        export(run, ["vtk", "csv", "mat"], tmp_path / "drive.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["drive.mat"]


def test_a_drive_at_rest_has_tables_and_no_picture_over_time(drive: Drive, tmp_path: Path) -> None:
    rest: Result = equilibrium(drive)
    with pytest.raises(
        ModelError, match="vtk needs results over time, such as those of `beltdyn simulate`; these are of equilibrium"
    ):
        export(rest, ["mat", "vtk"], tmp_path / "rest.nc")
    assert list(tmp_path.iterdir()) == []
    assert len(export(rest, ["mat", "parquet"], tmp_path / "rest.nc")) > 2

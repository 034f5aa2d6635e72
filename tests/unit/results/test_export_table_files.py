"""MAT and Parquet files and workbooks hold what the CSV tables hold."""

import csv
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree
from zipfile import ZipFile

import numpy as np
import pytest
from pyarrow import parquet
from scipy.io import loadmat, savemat

from beltdyn.errors import ModelError
from beltdyn.results import Run, summarize, write_csv
from beltdyn.results.derived import slips
from beltdyn.results.export import write_mat, write_parquet, write_xlsx

SHEETS = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"


def test_mat_has_a_structure_for_each_table(run: Run, tmp_path: Path) -> None:
    content = loadmat(write_mat(run, tmp_path / "drive.mat"), simplify_cells=True)
    tables = {name for name in content if not name.startswith("__")}
    assert tables == {path.stem for path in write_csv(run, tmp_path / "tables")}
    pulleys, dataset = content["pulleys"], run.dataset
    np.testing.assert_array_equal(pulleys["time"], dataset["time"])
    np.testing.assert_array_equal(pulleys["pulley_speed_driven"], dataset["pulley_speed"][:, 1])
    np.testing.assert_array_equal(pulleys["hub_force_driver_x"], dataset["hub_force"][:, 0, 0])
    np.testing.assert_array_equal(content["spans"]["span_tension_driven_driver"], dataset["span_tension"][:, 1])
    np.testing.assert_array_equal(pulleys["slip_driven"], slips(run)["slip"][:, 1])
    assert list(content["pulley_summary"]["pulley"]) == ["driver", "driven"]
    assert content["pulley_summary"]["hub_load"][1] == summarize(run).pulleys[1].hub_load
    assert all(one.dtype == float for name, one in content["contact"].items() if name != "headings")


def test_mat_tells_headings_with_units_in_order_of_its_columns(run: Run, tmp_path: Path) -> None:
    content = loadmat(write_mat(run, tmp_path / "drive.mat"), simplify_cells=True)
    for path in write_csv(run, tmp_path / "tables"):
        with path.open(newline="", encoding="utf-8") as file:
            headings = next(csv.reader(file))
        table = content[path.stem]
        assert list(table["headings"]) == headings
        assert len(table) == len(headings) + 1


def test_names_that_matlab_cannot_tell_apart_are_numbered(run: Run, tmp_path: Path) -> None:
    dataset = run.dataset.assign_coords(pulley=["Lüfter, groß " + 60 * "x" + end for end in "ab"])
    content = loadmat(write_mat(Run(dataset, run.drive), tmp_path / "drive.mat"), simplify_cells=True)
    speeds = [name for name in content["pulleys"] if name.startswith("pulley_speed")]
    assert len(speeds) == 2
    for number, name in enumerate(speeds):
        assert name.isidentifier()
        assert name.isascii()
        assert len(name) <= 63
        np.testing.assert_array_equal(content["pulleys"][name], run.dataset["pulley_speed"][:, number])


def test_parquet_has_the_columns_of_csv(run: Run, tmp_path: Path) -> None:
    files = write_parquet(run, tmp_path / "new" / "folder")
    tables = write_csv(run, tmp_path / "tables")
    assert [path.stem for path in files] == [path.stem for path in tables]
    for path, table in zip(files, tables, strict=True):
        with table.open(newline="", encoding="utf-8") as file:
            headings, *rows = csv.reader(file)
        read = parquet.read_table(path)
        assert read.column_names == headings
        assert read.num_rows == len(rows)
    pulleys = parquet.read_table(files[0])
    speed = pulleys["pulley_speed driven [rad/s]"].to_numpy()
    np.testing.assert_array_equal(speed, run.dataset["pulley_speed"][:, 1])
    assert parquet.read_table(tmp_path / "new" / "folder" / "losses.parquet")["cause"][0].as_py() == "friction"


def test_other_files_are_left_alone(make_run: Callable[..., Run], tmp_path: Path) -> None:
    run = make_run(11)
    path = tmp_path / "drive.mat"
    for _ in range(2):
        write_mat(run, path)
        write_parquet(run, tmp_path)
    savemat(path, {"mine": 1.0})
    (tmp_path / "spans.parquet").write_text("mine", encoding="utf-8")
    before = {one: one.read_bytes() for one in tmp_path.iterdir()}
    with pytest.raises(ModelError, match=r"drive.mat already exists"):
        write_mat(run, path)
    with pytest.raises(ModelError, match=r"spans.parquet already exists"):
        write_parquet(run, tmp_path)
    assert {one: one.read_bytes() for one in tmp_path.iterdir()} == before
    write_mat(run, path, overwrite=True)
    assert len(write_parquet(run, tmp_path, overwrite=True)) == 7


def test_without_pyarrow_the_message_tells_what_to_install(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ModelError, match=r"pyarrow is not installed\. Install .* its extra beltdyn\[parquet\]"):
        write_parquet(run, tmp_path / "tables")
    assert list(tmp_path.iterdir()) == []


def test_a_workbook_has_a_sheet_for_each_table(run: Run, tmp_path: Path) -> None:
    path = write_xlsx(run, tmp_path / "drive.xlsx")
    tables = {file.stem: file for file in write_csv(run, tmp_path / "tables")}
    with ZipFile(path) as archive:
        book = ElementTree.fromstring(archive.read("xl/workbook.xml"))
        assert [sheet.get("name") for sheet in book.iter(f"{{{SHEETS}}}sheet")] == list(tables)
        first = ElementTree.fromstring(archive.read("xl/worksheets/sheet1.xml"))
    rows = list(first.iter(f"{{{SHEETS}}}row"))
    with tables["pulleys"].open(newline="", encoding="utf-8") as file:
        headings, *lines = csv.reader(file)
    assert len(rows) == 1 + len(lines)
    assert len(rows[0]) == len(headings)
    last = [float(cell.find(f"{{{SHEETS}}}v").text) for cell in rows[-1]]  # type: ignore[union-attr, arg-type]
    np.testing.assert_allclose(last, [float(value) for value in lines[-1] if value not in {"", "nan"}], rtol=1e-9)


def test_a_workbook_replaces_its_own_kind_alone(run: Run, tmp_path: Path) -> None:
    path = write_xlsx(run, tmp_path / "drive.xlsx")
    assert write_xlsx(run, path) == path
    path.write_text("mine", encoding="utf-8")
    with pytest.raises(ModelError, match=r"drive.xlsx already exists"):
        write_xlsx(run, path)

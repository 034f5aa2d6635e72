"""One figure or table with a fault: all others are drawn and written, and the fault is told at the end."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pyarrow.parquet
import pytest
import scipy.io
from matplotlib.figure import Figure

import beltdyn as bd
from beltdyn.app.jobs import _outcome
from beltdyn.errors import InternalError, SimulationError
from beltdyn.results import Result, tables
from beltdyn.show import sheet
from beltdyn.show.plot.figures import FIGURES, save
from beltdyn.show.tables import Pieces

RunMain = Callable[[list[str]], tuple[int, str, str]]

pytestmark = pytest.mark.provokes_internal_errors


@pytest.fixture(scope="module")
def equilibrium() -> Result:
    return bd.equilibrium(bd.example("two_pulley"))


@pytest.fixture
def rest(equilibrium: Result, tmp_path: Path) -> Path:
    return equilibrium.save(tmp_path / "rest.nc")


@pytest.fixture
def broken_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first of two figures has a fault inside of beltdyn."""
    broken = replace(FIGURES["configuration"], arrange=lambda *_: save(None, Path("a.png")))  # type: ignore
    monkeypatch.setitem(FIGURES._kinds, "configuration", broken)


@pytest.fixture
def broken_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """The table of pulleys, the first of two, has a fault inside of beltdyn."""
    table, shown = tables._table_of_names, sheet._tables

    def of_names(dataset: Any, dim: str, columns: Any) -> tables.Table:
        return table(dataset, dim, None if dim == "pulley" else columns)  # type: ignore[arg-type]

    def in_sheet(columns: Any, group: Any) -> Pieces:
        return shown([None] if columns[0].dims == ("pulley",) else columns, group)  # type: ignore[list-item]

    monkeypatch.setattr(tables, "_table_of_names", of_names)
    monkeypatch.setattr(sheet, "_tables", in_sheet)


@pytest.mark.usefixtures("broken_figure")
def test_other_figures_are_drawn(
    rest: Path, tmp_path: Path, run_main: RunMain, monkeypatch: pytest.MonkeyPatch
) -> None:
    code, output, message = run_main(["plot", str(rest), "-o", str(tmp_path / "figures")])
    assert code == InternalError.exit_code
    assert output.endswith(": contact_pressure.png\n")
    assert [one.name for one in (tmp_path / "figures").iterdir()] == ["contact_pressure.png"]
    assert message.startswith("error: internal error in show/plot/figures.py:")
    assert message.count("\n") == 1
    monkeypatch.chdir(tmp_path)
    repeat = message.partition("what repeats it: ")[2].strip()
    with pytest.raises(InternalError, match=r"internal error in show/plot/figures\.py"):
        eval(repeat, {"bd": bd})


@pytest.mark.usefixtures("broken_figure")
def test_a_report_has_the_other_figures(rest: Path, tmp_path: Path, run_main: RunMain) -> None:
    page = tmp_path / "page.html"
    code, output, message = run_main(["report", str(rest), "-o", str(page)])
    assert (code, output) == (InternalError.exit_code, f"Report: {page}\n")
    text = page.read_text(encoding="utf-8")
    assert text.count('<img src="data:') == 1
    assert text.count("internal error in show/plot/figures.py") == 2  # at its place, and above all
    assert "what repeats it: bd.plot.save_all" in message
    ended = _outcome(bd.open_result(rest), tmp_path / "page.nc")
    assert len(ended.pictures) == 1
    assert ended.report is not None
    assert "internal error" in ended.warnings[-1]


@pytest.mark.parametrize("form", ["csv", "mat", "xlsx", "parquet"])
@pytest.mark.usefixtures("broken_table")
def test_other_tables_are_exported(form: str, rest: Path, run_main: RunMain) -> None:
    code, output, message = run_main(["export", str(rest), f"--{form}"])
    assert code == InternalError.exit_code
    assert message.startswith("error: internal error in results/tables.py:")
    written = Path(output.removeprefix("Written: ").strip())
    assert written.is_file()
    if form == "mat":
        assert {"span", "pulley"} & set(scipy.io.loadmat(written)) == {"span"}
    elif form == "parquet":
        assert pyarrow.parquet.read_table(written).num_rows == 2
    elif form == "csv":
        assert written.name == "span.csv"


@pytest.mark.usefixtures("broken_table")
def test_an_analysis_shows_and_writes_all_else(drive_file: Path, run_main: RunMain) -> None:
    """The result file, the other table of the sheet and of the files, and the report."""
    code, output, message = run_main(["equilibrium", str(drive_file), "--csv", "--report"])
    assert code == InternalError.exit_code
    assert "not shown" in output
    assert "driver-driven" in output
    folder = drive_file.parent
    assert sorted(one.name for one in folder.iterdir() if one != drive_file) == [
        "drive-equilibrium-tables",
        "drive-equilibrium.html",
        "drive-equilibrium.nc",
    ]
    assert message.count("error: internal error in ") == message.count("error:") == 3  # sheet, table, report
    assert bd.open_result(folder / "drive-equilibrium.nc").status == "completed"


def test_figures_of_users_are_told_as_theirs(rest: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And leave the others as they are."""
    broken = replace(FIGURES["configuration"], arrange=lambda *_: dict[str, Figure]()["figure"])
    monkeypatch.setitem(FIGURES._kinds, "configuration", broken)
    draw = partial(bd.plot.save_all, bd.open_result(rest), tmp_path / "figures")
    with pytest.raises(SimulationError, match="not part of beltdyn: correct it there") as error:
        draw()
    assert [path.name for path in error.value.completed] == ["contact_pressure.png"]

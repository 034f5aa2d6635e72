"""`beltdyn export`, and what it refuses."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.results import Run

RunMain = Callable[[list[str]], tuple[int, str, str]]
Refuse = Callable[[list[str]], str]


@pytest.fixture(scope="module")
def short(make_run: Callable[..., Run], tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_run(11).save(tmp_path_factory.mktemp("short") / "drive.nc")


@pytest.fixture
def result_file(short: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(short, tmp_path))


@pytest.mark.slow
def test_what_is_written_is_named(run_main: RunMain, result_file: Path) -> None:
    folder = result_file.parent
    names = ("drive-belt.vtkhdf", "drive-pulleys.vtkhdf", "drive.mat")
    written = ", ".join(str(folder / name) for name in names)
    for _ in range(2):
        assert run_main(["export", str(result_file), "--vtk", "--mat"]) == (0, f"Written: {written}\n", "")
    other = folder / "new" / "folder"
    code, output, _ = run_main(["export", str(result_file), "--csv", "--parquet", "-o", str(other)])
    assert code == 0
    assert f"{other / 'drive-tables' / 'pulleys.csv'}, " in output
    assert (other / "drive-tables" / "losses.parquet").is_file()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["drive.nc"], "export needs a format: one or more of --vtk, --csv, --mat, --xlsx, --parquet."),
        (["missing.nc", "--vtk"], "missing.nc"),
        (["mine.vtkhdf", "--vtk"], "mine.vtkhdf"),
        (
            ["drive.nc", "--mat", "--vtk", "-o", "theirs"],
            "drive-belt.vtkhdf already exists and was not",
        ),
        (["drive.nc", "--vtk", "-o", "drive.nc"], "the folder drive.nc cannot be created"),
    ],
)
def test_message(
    words: list[str], sentence: str, refuse: Refuse, result_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = result_file.parent
    monkeypatch.chdir(folder)
    for name in ("mine.vtkhdf", "theirs/drive-belt.vtkhdf"):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text("mine", encoding="utf-8")
    before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    message = refuse(["export", *words])
    assert sentence in " ".join(message.split())
    assert message.startswith("error: ")
    assert {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()} == before


def test_force_replaces_other_files(run_main: RunMain, result_file: Path) -> None:
    result_file.with_suffix(".mat").write_text("mine", encoding="utf-8")
    assert run_main(["export", str(result_file), "--mat"])[0] == 2
    assert run_main(["export", str(result_file), "--mat", "--force"])[0] == 0

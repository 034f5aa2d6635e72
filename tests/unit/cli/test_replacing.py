"""Every command that writes leaves alone what beltdyn did not write."""

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.results import FileRecorder, Layout
from validation.published import demo_text

Refuse = Callable[[list[str]], str]
RunMain = Callable[[list[str]], tuple[int, str, str]]
MINE = "time,torque\n0,1\n"


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A file of the user, by any of the names that commands would write."""
    for name in (
        "mine.csv",
        "drive-tables/pulleys.csv",
        "figures/slip.png",
        "figures/animation.gif",
        "fan_direct_start.toml",
    ):
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(MINE, encoding="utf-8")
    return tmp_path / "mine.csv"


def unharmed(folder: Path) -> bool:
    files = [
        path for path in folder.rglob("*") if path.suffix in (".csv", ".png", ".gif") or path.stem == "fan_direct_start"
    ]
    return len(files) == 5 and all(path.read_text(encoding="utf-8") == MINE for path in files)


def test_runs_sweeps_and_layouts(refuse: Refuse, drive_file: Path, mine: Path) -> None:
    drive = str(drive_file)
    speeds = ["--pulley", "driver", "--from", "10", "--to", "20"]
    for words in (["simulate", drive, "-o", str(mine)], ["sweep", drive, *speeds, "-o", str(mine)]):
        assert "mine.csv already exists and was not written by beltdyn" in refuse(words)
    assert "pulleys.csv already exists" in refuse(["simulate", drive, "--csv"])
    slip = str(mine.with_name("figures") / "slip.png")
    assert "slip.png already exists" in refuse(["check", drive, "--figure", slip])
    assert unharmed(mine.parent)
    assert sorted(path.name for path in mine.parent.glob(".*")) == []


def test_several_runs(refuse: Refuse, drive_file: Path, mine: Path) -> None:
    other = drive_file.with_name("other.toml")
    other.write_text(demo_text(), encoding="utf-8")
    drive_file.with_suffix(".nc").write_text(MINE, encoding="utf-8")
    assert f"{drive_file.stem}.nc already exists" in refuse(["simulate", str(drive_file), str(other)])
    assert unharmed(mine.parent)


def test_demo(refuse: Refuse, mine: Path) -> None:
    assert "fan_direct_start.toml already exists" in refuse(["demo", str(mine.parent)])
    assert unharmed(mine.parent)


def test_forced_layout(run_main: RunMain, drive_file: Path, mine: Path) -> None:
    """And what beltdyn drew may be drawn again."""
    figure = mine.with_name("figures") / "slip.png"
    assert run_main(["check", str(drive_file), "--figure", str(figure), "--force"])[0] == 0
    assert run_main(["check", str(drive_file), "--figure", str(figure)])[0] == 0
    assert figure.read_bytes().startswith(b"\x89PNG")


def test_forced_results_leave_the_drive_file(refuse: Refuse, drive_file: Path) -> None:
    before = drive_file.read_bytes()
    assert "would overwrite it" in refuse(["simulate", str(drive_file), "-o", str(drive_file), "--force"])
    assert drive_file.read_bytes() == before


def test_second_run_of_the_same_file(
    run_main: RunMain, drive_file: Path, layout: Layout, attributes: dict[str, str]
) -> None:
    recorder = FileRecorder(drive_file.with_suffix(".nc"), layout, attributes)
    code, _, message = run_main(["simulate", str(drive_file)])
    assert code == 2
    assert "is being written by another run" in message
    recorder.close("completed", {})


@pytest.mark.skipif(sys.platform == "win32", reason="devices have no such names there")
def test_devices(refuse: Refuse, drive_file: Path) -> None:
    assert "it is a device or a pipe, not a file" in refuse(["simulate", str(drive_file), "-o", "/dev/null", "--force"])


WRONG_TABLES = {
    "duty.csv": "duration [s],nobody speed [rpm]\n1,100\n",
    "measured.csv": "hub_lod[driven] [N]\n50\n",
    "study.toml": 'drive = "DRIVE"\nanalysis = "equilibrium"\nresults = ["hub_lod"]\n[[number]]\npath = "belt.width"\n'
    'values = "10, 12 mm"\n',
    "optimize.toml": '[[number]]\npath = "belt.width"\nleast = "8 mm"\nlargest = "12 mm"\n[goal]\nresult = "hub_lod"\n',
    "calibrate.toml": '[[number]]\npath = "belt.width"\nleast = "8 mm"\nlargest = "12 mm"\n'
    '[[measurement]]\ntable = "measured.csv"\nstate = "rest"\n',
}
"""Tables and studies with a name that is misspelt."""
WRONG_COMMANDS = (
    ["study", "study.toml", "-j", "1"],
    ["operating-map", "DRIVE", "--pulley", "nobody", "--speed", "100..200 rpm"],
    ["duty", "DRIVE", "--table", "duty.csv"],
    ["traction", "DRIVE", "--pulley", "nobody", "--slip", "0.1"],
    ["campbell", "DRIVE", "--pulley", "nobody", "--speed", "100..200 rpm"],
    ["response", "DRIVE", "--pulley", "nobody", "--speed", "100..200 rpm"],
    ["sweep", "DRIVE", "--pulley", "nobody", "--from", "10", "--to", "20"],
    ["optimize", "DRIVE", "--study", "optimize.toml"],
    ["calibrate", "DRIVE", "--study", "calibrate.toml"],
)


@pytest.mark.parametrize("words", WRONG_COMMANDS, ids=lambda words: words[0])
def test_a_misspelt_name_costs_no_results(words: list[str], refuse: Refuse, drive_file: Path, saved_run: Path) -> None:
    """Names and points are checked before old files are touched, with `--force`, too."""
    folder = drive_file.parent
    for name, text in WRONG_TABLES.items():
        (folder / name).write_text(text.replace("DRIVE", drive_file.name), encoding="utf-8")
    old = Path(shutil.copy(saved_run, folder / "old.nc"))
    rows = "point,belt.width [m],hub_load[driven] [N],seconds [s],warnings,failure\n1,0.01,53.5,0.1,,\n"
    old.with_suffix(".csv").write_text(rows, encoding="utf-8")
    before = old.read_bytes()
    files = {name: str(folder / name) for name in WRONG_TABLES} | {"DRIVE": str(drive_file)}
    message = refuse([*(files.get(word, word) for word in words), "--force", "-o", str(old)])
    assert "nobody" in message or "hub_lod" in message
    assert old.read_bytes() == before
    assert old.with_suffix(".csv").read_text(encoding="utf-8") == rows

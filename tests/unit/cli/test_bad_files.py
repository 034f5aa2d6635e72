"""Files that cannot be used, and words that mean nothing."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

Refuse = Callable[[list[str]], str]


def test_missing_file(refuse: Refuse, tmp_path: Path) -> None:
    assert "nix.toml cannot be read: no such file or directory. Check the path." in refuse(
        ["check", str(tmp_path / "nix.toml")]
    )


def test_folder(refuse: Refuse, tmp_path: Path) -> None:
    assert "cannot be read: is a directory" in refuse(["simulate", str(tmp_path)])


def test_binary_file(refuse: Refuse, tmp_path: Path) -> None:
    (tmp_path / "drive.toml").write_bytes(b"\x89PNG\r\n\x1a\n")
    assert "is not UTF-8 text" in refuse(["equilibrium", str(tmp_path / "drive.toml")])


def test_result_file_in_place_of_a_drive(refuse: Refuse, tmp_path: Path) -> None:
    (tmp_path / "drive-steady-state.nc").write_bytes(b"\x89HDF\r\n\x1a\n")
    message = refuse(["life", str(tmp_path / "drive-steady-state.nc")])
    assert "drive-steady-state.nc is a result file, not a drive file. Give the TOML file of the drive." in message


def test_empty_file(refuse: Refuse, tmp_path: Path) -> None:
    (tmp_path / "drive.toml").write_text("")
    message = refuse(["check", str(tmp_path / "drive.toml")])
    assert [line.split(" is missing. Give the group")[0] for line in message.splitlines()] == [
        "error: belt",
        "error: pulley",
    ]


def test_results_over_the_drive_file(refuse: Refuse, drive_file: Path) -> None:
    before = drive_file.read_bytes()
    assert "would overwrite it" in refuse(["simulate", str(drive_file), "-o", str(drive_file)])
    assert drive_file.read_bytes() == before


def test_new_never_overwrites(refuse: Refuse, drive_file: Path) -> None:
    before = drive_file.read_bytes()
    assert "already exists" in refuse(["new", str(drive_file)])
    assert drive_file.read_bytes() == before


def test_new_where_nothing_can_be_written(refuse: Refuse, drive_file: Path) -> None:
    assert "drive.toml cannot be created (File exists)" in refuse(["new", str(drive_file / "other.toml")])


def test_demo_where_nothing_can_be_written(refuse: Refuse, drive_file: Path) -> None:
    assert "cannot be created" in refuse(["demo", str(drive_file)])


def test_plot_of_no_result(refuse: Refuse, drive_file: Path) -> None:
    assert str(drive_file) in refuse(["plot", str(drive_file)])
    assert "nix.nc" in refuse(["plot", str(drive_file.with_name("nix.nc"))])


def test_unknown_command(refuse: Refuse) -> None:
    assert 'Did you mean "simulate"?' in refuse(["simulat"])


def test_unknown_option(refuse: Refuse, drive_file: Path) -> None:
    assert "--outptu" in refuse(["simulate", str(drive_file), "--outptu", "x.nc"])


def test_no_file(refuse: Refuse) -> None:
    assert "FILE" in refuse(["check"])


def test_a_real_process_shows_no_traceback(drive_file: Path) -> None:
    drive_file.write_text("[belt]\nlength = -1\n", encoding="utf-8")
    command = [sys.executable, "-c", "from beltdyn.cli import main; main()", "check", str(drive_file)]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    assert process.returncode == 2
    assert process.stdout == ""
    assert process.stderr.startswith("error: belt.length = -1 must be greater than 0.")
    assert "Traceback" not in process.stderr

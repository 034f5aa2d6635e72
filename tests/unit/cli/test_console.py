"""Output on terminals that do not know all signs, and names of files that are no text."""

import io
import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from beltdyn.cli import main
from beltdyn.results import Run
from beltdyn.results.atomic import is_marked


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, list[str]], tuple[int, bytes]]:
    """Exit code and output of a command on a terminal with an encoding."""

    def run_command(encoding: str, words: list[str]) -> tuple[int, bytes]:
        out = io.BytesIO()
        for name in ("stdout", "stderr"):
            monkeypatch.setattr(sys, name, io.TextIOWrapper(out, encoding=encoding, write_through=True))
        with pytest.raises(SystemExit) as end:
            main(words)
        return int(end.value.code or 0), out.getvalue()

    return run_command


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "cp437", "utf-8"])
@pytest.mark.parametrize("words", [["--help"], ["simulate", "--help"], ["check", "DRIVE"], ["check", "missing.toml"]])
def test_any_terminal_is_written_to(
    said: Callable[[str, list[str]], tuple[int, bytes]], drive_file: Path, encoding: str, words: list[str]
) -> None:
    code, out = said(encoding, [word.replace("DRIVE", str(drive_file)) for word in words])
    assert code == (2 if "missing.toml" in words else 0)
    assert out.decode(encoding)


def test_signs_are_spelled(said: Callable[[str, list[str]], tuple[int, bytes]], drive_file: Path) -> None:
    drive_file.write_text(drive_file.read_text(encoding="utf-8").replace('"driver"', '"ä° – x²"', 1), encoding="utf-8")
    assert b"a deg - x2" in said("ascii", ["check", str(drive_file)])[1]
    assert "ä° - x²".encode("latin-1") in said("latin-1", ["check", str(drive_file)])[1]


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere names of files are text")
def test_names_that_are_no_text(said: Callable[[str, list[str]], tuple[int, bytes]], run: Run, tmp_path: Path) -> None:
    """The bytes of the name come out as they are; reports and figures show a sign for them."""
    path = tmp_path / os.fsdecode(b"r\xff\xfe.nc")
    run.save(path)
    code, out = said("utf-8", ["report", str(path)])
    assert code == 0
    assert b"r\xff\xfe.html" in out
    assert is_marked(path.with_suffix(".html"))
    code, out = said("utf-8", ["plot", str(path), "--figures", "span_tensions"])
    assert code == 0, out
    code, out = said("ascii", ["export", str(path), "--csv", "--vtk", "--mat"])
    assert code == 0, out

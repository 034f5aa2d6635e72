"""Texts and TOML, within bounds."""

import os
from pathlib import Path

import pytest

from beltdyn.parts import text_file
from beltdyn.parts.text_file import parse_toml, read_text


@pytest.mark.parametrize(
    ("data", "text"), [(b"a\nb", "a\nb"), (b"\xef\xbb\xbfa\r\nb\r\n", "a\nb\n"), ("ä".encode(), "ä"), (b"", "")]
)
def test_texts_are_the_same_from_any_system(tmp_path: Path, data: bytes, text: str) -> None:
    (tmp_path / "file").write_bytes(data)
    assert read_text(tmp_path / "file", 100) == text


def test_a_text_may_be_as_long_as_the_limit(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"x" * 1000)
    assert len(read_text(tmp_path / "file", 1000)) == 1000
    with pytest.raises(ValueError, match="it has 1,000 bytes; the limit is 999"):
        read_text(tmp_path / "file", 999)


def test_what_is_no_text_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "latin").write_bytes("ä".encode("latin-1"))
    with pytest.raises(UnicodeDecodeError):
        read_text(tmp_path / "latin", 100)
    with pytest.raises(ValueError, match="is a directory"):
        read_text(tmp_path, 100)
    with pytest.raises(FileNotFoundError):
        read_text(tmp_path / "nowhere", 100)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are a matter of POSIX")
def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(ValueError, match="it is a device or a pipe, not a file"):
        read_text(tmp_path / "pipe", 100)


@pytest.mark.parametrize(
    ("text", "deep"),
    [
        ("x = " + "[" * 32 + "]" * 32, False),
        ("x = " + "[" * 33 + "]" * 33, True),
        ("a" + ".a" * 32 + " = 1", False),
        ("a" + ".a" * 33 + " = 1", True),
        ("x = '" + "[" * 100 + "'", False),
        ('x = """' + "{" * 100 + '"""', False),
        ("x = 1 # " + "[" * 100, False),
        ("x = [[1], [2]]\n" * 1 + "y = " + "[[1], " * 10 + "[2]" + "]" * 10, False),
    ],
)
def test_depth_counts_brackets_and_dots_outside_of_texts_and_comments(text: str, deep: bool) -> None:
    if deep:
        with pytest.raises(ValueError, match="it is nested too deeply"):
            parse_toml(text)
    else:
        assert parse_toml(text)


def test_a_long_text_is_not_parsed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_file, "LONGEST_TOML", 10)
    assert parse_toml("abc = 1234") == {"abc": 1234}
    with pytest.raises(ValueError, match=r"it is longer than 10 characters\. Move long tables to CSV files"):
        parse_toml("abc = 12345")


def test_a_number_of_many_digits_is_refused() -> None:
    """Python reads no whole number of more than 4300 digits."""
    with pytest.raises(ValueError, match="or has a number with too many digits"):
        parse_toml("x = " + "1" * 5000)

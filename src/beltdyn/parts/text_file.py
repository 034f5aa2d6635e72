"""Read text files and parse TOML, with size limits."""

import os
import re
import stat
import tomllib
from pathlib import Path
from typing import Any, BinaryIO

LONGEST_TOML = 4_000_000
"""Bytes of the longest drive file or catalogue."""

LONGEST_TABLE = 100_000_000
"""Bytes of the longest CSV file."""

_NO_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
_DEEPEST = 32
_NO_STRUCTURE = re.compile(
    r'"""(?:\\.|[^\\])*?"""|' r"'''.*?'''|" r'"(?:\\.|[^"\\\n])*"|' r"'[^'\n]*'|" r"(?P<comment>\#[^\n]*)", re.DOTALL
)
_DOTTED = re.compile(r"[\w\-]+(?:[ \t]*\.[ \t]*[\w\-]+)*")
_BRACKET = re.compile(r"[\[\]{}]")


def as_text(name: str) -> str:
    """The name of a file as text, with a replacement character for undecodable bytes."""
    return name.encode(errors="surrogateescape").decode(errors="replace")


def read_text(path: Path, longest: int) -> str:
    """Read a UTF-8 text file.

    Parameters
    ----------
    path, longest
        As for `read_bytes`.

    Returns
    -------
    str
        The text, without a byte order mark.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError
        As `read_bytes`; or if it is no text in UTF-8 (`UnicodeDecodeError`).
    """
    return read_bytes(path, longest).decode("utf-8-sig").replace("\r\n", "\n")


def read_bytes(path: Path, longest: int) -> bytes:
    """Read a file up to a limit of size.

    Parameters
    ----------
    path : Path
        The file.
    longest : int
        The limit, bytes.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError
        If it is not a regular file, is too long, or its name is invalid.
    """
    with open_file(path) as file:
        data, size = file.read(longest + 1), os.fstat(file.fileno()).st_size
    if len(data) > longest:
        raise ValueError(f"it has {max(size, len(data)):,} bytes; the limit is {longest:,}")
    return data


def open_file(path: Path) -> BinaryIO:
    """Open a regular file for reading; a pipe would block the reader.

    Raises
    ------
    OSError
        If it cannot be opened.
    ValueError
        If it is not a regular file, or its name is invalid.
    """
    if path.is_dir():  # which some systems do not open
        raise ValueError("is a directory")
    file = os.open(path, os.O_RDONLY | _NO_WAITING)
    if not stat.S_ISREG(os.fstat(file).st_mode):
        os.close(file)
        raise ValueError("it is a device or a pipe, not a file")
    return os.fdopen(file, "rb")


def parse_toml(text: str) -> dict[str, Any]:
    """Parse TOML.

    Parameters
    ----------
    text : str
        The text.

    Returns
    -------
    dict
        Its tables.

    Raises
    ------
    ValueError
        If it is not TOML, is too long, nests too deeply, or holds too long a number.
    """
    if len(text) > LONGEST_TOML:
        raise ValueError(f"it is longer than {LONGEST_TOML:,} characters. Move long tables to CSV files")
    if _depth(text) > _DEEPEST:
        raise ValueError("it is nested too deeply")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except (ValueError, RecursionError) as error:
        raise ValueError("it is nested too deeply, or has a number with too many digits") from error


def _depth(text: str) -> int:
    """Largest number of brackets around a value, or of dots in a key; the parser needs its square in memory."""
    bare = _NO_STRUCTURE.sub(lambda found: "" if found["comment"] else "s", text)
    deepest = max((key.group().count(".") for key in _DOTTED.finditer(bare)), default=0)
    depth = 0
    for bracket in _BRACKET.finditer(bare):
        depth = depth + 1 if bracket.group() in "[{" else max(depth - 1, 0)
        deepest = max(deepest, depth)
    return deepest

"""Output of the command line, and its style."""

import codecs
import sys
from collections.abc import Iterable
from pathlib import Path
from unicodedata import normalize

from rich.console import Console
from rich.measure import Measurement
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

_WIDEST = 200
"""Columns of the widest table that is not wrapped."""


_SPELLED = {
    "°": " deg",
    "–": "-",
    "—": "-",
    "−": "-",
    "…": "...",
    "·": "*",
    "×": "x",
    "µ": "u",
    "μ": "u",
    "→": "->",
    "≤": "<=",
    "≥": ">=",
    "≈": "~",
    "±": "+-",
    "‘": "'",
    "’": "'",
    "“": '"',
    "”": '"',
    "•": "*",
    "√": "sqrt",
}
"""Signs that have no place on some terminals, as these spell them."""
_SPELLING, _BYTES = "beltdyn.spelling", range(0xDC80, 0xDD00)


def take_any_terminal() -> None:
    """Let standard output and standard error replace characters unknown to their encoding, without an error.

    Bytes of file names that are no text go out as they are.
    """
    codecs.register_error(_SPELLING, _spell)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors=_SPELLING)


def _spell(error: UnicodeError) -> tuple[str | bytes, int]:
    """The next sign in other signs; see `codecs.register_error`."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    sign = error.object[error.start]
    if ord(sign) in _BYTES:
        return bytes([ord(sign) - 0xDC00]), error.start + 1
    plain = normalize("NFKD", sign).encode("ascii", errors="ignore").decode()
    return _SPELLED.get(sign) or plain or "?", error.start + 1


def show(text: str = "") -> None:
    """Write a line on standard output, as it is."""
    Console().print(text, markup=False, highlight=False, soft_wrap=True)


def show_table(title: str, headings: Iterable[str], rows: Iterable[Iterable[str]]) -> None:
    """Write a table whose first column holds names and whose other columns hold numbers, all of them whole."""
    table = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False)
    for index, heading in enumerate(headings):
        table.add_column(heading, justify="right" if index else "left", header_style="dim")
    for row in rows:
        table.add_row(*map(Text, row))
    console = Console()
    table.collapse_padding = Measurement.get(console, console.options, table).maximum >= console.width
    needed = console.measure(table, options=console.options.update_width(_WIDEST)).maximum
    Console(width=max(console.width, needed)).print(table)


def show_grid(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> None:
    """Write a table of texts; the last column is broken at words, the others stay whole."""
    *short, last = headings
    table = Table(box=None, pad_edge=False)
    for heading in short:
        table.add_column(heading, no_wrap=True, header_style="dim")
    table.add_column(last, header_style="dim")
    for row in rows:
        table.add_row(*map(Text, row))
    Console().print(table)


def show_paragraphs(paragraphs: Iterable[str]) -> None:
    """Write paragraphs broken at words, set in by two spaces."""
    for paragraph in paragraphs:
        Console().print(Padding(Text(paragraph), (0, 0, 0, 2)))


def show_facts(facts: Iterable[tuple[str, str]]) -> None:
    """Write facts, one line each with name and value."""
    rows = list(facts)
    width = max((len(name) for name, _ in rows), default=0)
    for name, fact in rows:
        Console().print(Text.assemble((name.ljust(width), "dim"), "  ", fact), soft_wrap=True)


def show_warnings(warnings: Iterable[str]) -> None:
    """Write warnings on standard output, as part of the result."""
    for warning in warnings:
        line = Text.assemble(("warning: ", "bold yellow"), warning)
        Console().print(line, soft_wrap=True)


def show_error(message: str) -> None:
    """Write the lines of an error on standard error."""
    for line in message.splitlines():
        Console(stderr=True).print(Text.assemble(("error: ", "bold red"), line), soft_wrap=True)


def lines_of_file(file: Path, error: Exception) -> list[str]:
    """The lines of an error of one of several files, each with the name of the file."""
    return [line if line.startswith(f"{file} ") else f"{file}: {line}" for line in str(error).splitlines()]

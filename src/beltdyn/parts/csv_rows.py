"""Rows of CSV files from programs, spreadsheets and loggers: encodings, separators, decimal commas, headings."""

import codecs
import csv
import re
from collections import Counter
from pathlib import Path
from typing import NamedTuple

from beltdyn.parts.messages import reason
from beltdyn.parts.quantity import is_unit
from beltdyn.parts.text_file import LONGEST_TABLE, read_bytes

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
"""Separators of cells, and their names."""

NUMERIC = re.compile(r"\s*[-+]?[.,]?\d")
"""The start of a numeric cell."""

_NUMBER = re.compile(r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?")

_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")
_POINT = re.compile(r"\s*[+-]?\d*\.\d+(?:[eE][+-]?\d+)?\s*")
_BINARY = re.compile(r"[\x00-\x08\x0e-\x1f]")
_IN_BRACKETS = re.compile(r".*\[(?P<unit>[^\]]*)\]\s*")


class CsvRow(NamedTuple):
    """A line of a file."""

    line: int
    """Its number, counted from 1."""
    cells: list[str]
    """The cells; numbers with decimal points."""


class CsvRows(NamedTuple):
    """The lines of a file without empty lines and comments."""

    separator: str
    rows: list[CsvRow]


def read_rows(path: Path, hint: str = "") -> CsvRows:
    """Read the lines of a CSV file that are neither empty nor comments.

    Text is UTF-8, with or without a byte-order mark, UTF-16 with one, or else Windows-1252, of which Latin-1 is a part.
    Cells are separated by tabs or semicolons if these are in more than half of the lines, and else by commas. Where no
    comma separates and no number has a decimal point, numbers may have decimal commas.

    Parameters
    ----------
    path : Path
        The file.
    hint : str
        What a message adds where there is no such file.

    Raises
    ------
    ValueError
        If it cannot be read as CSV: what goes behind the name of the file.
    """
    try:
        lines = _decoded(read_bytes(path, LONGEST_TABLE)).splitlines()
    except UnicodeDecodeError as error:
        raise ValueError("is not a text file. Save it as CSV in UTF-8") from error
    except (OSError, ValueError) as error:
        raise ValueError(f"cannot be read: {reason(error)}{hint}") from error
    separator = _separator(lines)
    reader = csv.reader(lines, delimiter=separator)
    try:
        found = [CsvRow(reader.line_num, row) for row in reader if any(map(str.strip, row)) and row[0][:1] != "#"]
    except csv.Error as error:
        raise ValueError(f"is not valid CSV in line {reader.line_num}: {error}. Correct this line") from error
    cells = [cell for row in found for cell in row.cells]
    if separator != "," and not any(map(_POINT.fullmatch, cells)):
        found = [CsvRow(line, [_with_point(cell) for cell in row]) for line, row in found]
    return CsvRows(separator, found)


def without_preamble(rows: list[CsvRow]) -> list[CsvRow]:
    """Drop the preamble of loggers above the headings: first lines with fewer cells than most lines."""
    width = max(Counter(len(row.cells) for row in rows).items(), key=lambda item: (item[1], item[0]), default=(0, 0))[0]
    first = next((place for place, row in enumerate(rows) if len(row.cells) >= width), 0)
    return rows[first:]


def row_of_units(cells: list[str]) -> list[str] | None:
    """The units of a row such as ``s; [rpm]; (N m)``, empty for "-"; None if it is not a row of units.

    One unit that is known makes it one, where no cell is a number but 1: others are refused when they are used.
    """
    units = [cell.strip().strip("[]()").strip() for cell in cells]
    units = ["" if unit in ("-", "1") else unit for unit in units]
    known = any(unit == "%" or is_unit(unit) for unit in units)
    return units if known and not any(map(_NUMBER.fullmatch, units)) else None


def unit_in_brackets(heading: str) -> str:
    """The unit that ends a heading such as ``speed [rpm]``; empty without one."""
    match = _IN_BRACKETS.fullmatch(heading)
    return match["unit"] if match and is_unit(match["unit"]) else ""


def _decoded(data: bytes) -> str:
    """A text, whatever it is encoded in."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = data.decode("utf-16")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("cp1252")
    if control := _BINARY.search(text):
        raise UnicodeDecodeError("utf-8", data, control.start(), control.end(), "no text")
    return text


def _separator(lines: list[str]) -> str:
    """What separates the cells of a file."""
    filled = [line for line in lines if line.strip() and not line.startswith("#")]
    most = (mark for mark in ("\t", ";") if 2 * sum(mark in line for line in filled) > len(filled))
    return next(most, ",")


def _with_point(cell: str) -> str:
    return cell.replace(",", ".") if _COMMA.fullmatch(cell) else cell

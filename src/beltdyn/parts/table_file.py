"""Points of a table, from keys or a CSV file, and their rules."""

import codecs
import csv
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pydantic import ValidationInfo

from beltdyn.errors import ModelError
from beltdyn.parts.messages import reason
from beltdyn.parts.quantity import is_unit, to_si
from beltdyn.parts.text_file import LONGEST_TABLE, read_bytes, shorten

# Rows of CSV files from programs, spreadsheets and loggers: encodings, separators, decimal commas, headings

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
    """Read the lines of a CSV file that are neither empty nor comments; see `rows_of`.

    Text is UTF-8, with or without a byte-order mark, UTF-16 with one, or else Windows-1252, of which Latin-1 is a part.
    """
    try:
        text = decoded(read_bytes(path, LONGEST_TABLE))
    except UnicodeDecodeError as error:
        raise ValueError("is not a text file. Save it as CSV in UTF-8") from error
    except (OSError, ValueError) as error:
        raise ValueError(f"cannot be read: {reason(error)}{hint}") from error
    return rows_of(text)


def rows_of(text: str) -> CsvRows:
    """Lines of a text in CSV that are neither empty nor comments.

    Cells are separated by tabs or semicolons if these are in more than half of the lines, and else by commas. Where no
    comma separates and no number has a decimal point, numbers may have decimal commas.
    """
    lines = text.splitlines()
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


def decoded(data: bytes) -> str:
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


# Tables that a user gives to an analysis: CSV files with headings, such as "driver speed [rpm]"

_HEADING = re.compile(r"\s*(?P<what>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*")


class HeadedColumn(NamedTuple):
    """A column of a table."""

    what: str
    """What its heading says, without the unit."""
    unit: str
    """The unit in brackets; empty without."""
    path: Path
    cells: list[tuple[int, str]]
    """Numbers of lines, and what stands there."""

    def values(self, unit: str) -> list[float]:
        """Numbers in an SI unit, or as they are where either has none; those in % as parts of one."""
        return [self._number(line, cell, unit) for line, cell in self.cells]

    def _number(self, line: int, cell: str, unit: str) -> float:
        try:
            number = to_si(f"{float(cell)!r} {self.unit}", unit) if self.unit and unit else float(cell)
            if self.unit == "%" and not unit:
                number *= 0.01
            if not np.isfinite(number):
                raise ValueError("must be a finite number")
        except ValueError as error:
            where = f'{self.path}, line {line}: "{cell.strip()}" below "{self.what}"'
            raise ModelError(f"{where} {error}. Correct this line.") from error
        return number


def read_headed(option: str, path: Path) -> list[HeadedColumn]:
    """Read a table."""
    try:
        rows = without_preamble(read_rows(path).rows)
    except ValueError as error:
        raise ModelError(f'{option} = "{path}" {error}.') from error
    if len(rows) < 2:
        raise ModelError(f'{option} = "{path}" has no rows. Give a line of headings, and lines of numbers below.')
    headings, body = rows[0].cells, rows[1:]
    for number, line in body:
        if len(line) != len(headings):
            raise ModelError(f"{path}, line {number}: {len(line)} cells but {len(headings)} headings.")
    if body[1:] and (units := row_of_units(body[0].cells)):
        pairs = zip(headings, units, strict=True)
        headings, body = [f"{name} [{unit}]" if unit and " [" not in name else name for name, unit in pairs], body[1:]
    columns = list(_columns(path, headings, body))
    whole = [one.what if not one.unit or is_unit(one.unit) else f"{one.what}[{one.unit}]" for one in columns]
    twice = [name for place, name in enumerate(whole) if name in whole[:place]]
    if twice:
        raise ModelError(f'{path} has the heading "{twice[0]}" twice. Remove one of the columns.')
    return columns


def _columns(path: Path, headings: list[str], rows: list[CsvRow]) -> Iterator[HeadedColumn]:
    for place, heading in enumerate(headings):
        match = _HEADING.fullmatch(heading)
        what, unit = (match["what"], match["unit"] or "") if match else (heading.strip(), "")
        yield HeadedColumn(what, unit, path, [(number, line[place]) for number, line in rows])


_MOST_ROWS = 250_000
"""Lines of the longest table of a drive, which takes some seconds to read."""


def take_file(data: Any, info: ValidationInfo, first: str, second: str) -> Any:
    """Replace the key ``file`` of a table by the two columns of that CSV file."""
    if not names_file(data, (first, second)):
        return data
    told, rows = read_table(data["file"], _base(info), 2)
    columns, units = zip(*rows, strict=True), data.get("units", told)
    if not (isinstance(units, Sequence) and len(units) == 2 and all(isinstance(unit, str) for unit in units)):
        raise ValueError(f'units = {shorten(units)} must be the units of both columns, such as ["rpm", "N m"]')
    read = [with_unit(column, unit) for column, unit in zip(columns, units, strict=True)]
    return without_file(data) | dict(zip((first, second), read, strict=True))


def take_grid(data: Any, info: ValidationInfo, rows: str, columns: str, values: str) -> Any:
    """Replace the key ``file`` of a table over two quantities by the contents of that CSV file.

    Its first line has the columns' arguments behind a first cell of any content; each other line has the argument of a
    row, and then its values.
    """
    if not names_file(data, (rows, columns, values)):
        return data
    head, *body = read_table(data["file"], _base(info), None).rows
    units = data.get("units", ("", "", ""))
    if not (isinstance(units, Sequence) and len(units) == 3 and all(isinstance(unit, str) for unit in units)):
        raise ValueError(
            f'units = {shorten(units)} must be those of {rows}, {columns} and {values}, such as ["deg", "rpm", "N m"]'
        )
    return without_file(data) | {
        rows: with_unit([line[0] for line in body], units[0]),
        columns: with_unit(head[1:], units[1]),
        values: [with_unit(line[1:], units[2]) for line in body],
    }


def names_file(data: Any, keys: Sequence[str]) -> bool:
    """Whether a given table names a file; an error if it also has any of some keys."""
    if not isinstance(data, Mapping) or "file" not in data:
        if isinstance(data, Mapping) and "units" in data:
            raise ValueError("units applies to the columns of a file. Write the units with the numbers, or give file")
        return False
    if any(key in data for key in keys):
        raise ValueError(f"file and {' and '.join(keys)} exclude each other. Keep the file or the keys")
    return True


def without_file(data: Mapping[str, Any]) -> dict[str, Any]:
    """The other keys of a table that names a file."""
    return {key: value for key, value in data.items() if key not in ("file", "units")}


def with_unit(numbers: Sequence[float], unit: str) -> list[float | str]:
    """Numbers as a user would write them in a unit; without a unit as they are."""
    return [f"{number!r} {unit}" if unit else number for number in numbers]


def _base(info: ValidationInfo) -> Path | None:
    return (info.context or {}).get("base")


def check_points(first: str, arguments: Sequence[float], second: str, values: Sequence[object]) -> None:
    """Check that the points of a table are a function."""
    if len(arguments) != len(values):
        raise ValueError(
            f"{first} has {len(arguments)} numbers but {second} has {len(values)}. Give one {second[:-1]} for each "
            f"{first[:-1]}"
        )
    for earlier, later in pairwise(arguments):
        if later <= earlier:
            raise ValueError(
                f"{first} must increase, but {later:g} follows {earlier:g}. Sort the points by {first[:-1]}"
            )


def describe_file(schema: dict[str, Any], keys: Sequence[str], content: str) -> None:
    """Add the keys ``file`` and ``units``, which are replaced by others on reading, to the JSON schema of a table."""
    schema["properties"]["file"] = {"type": "string", "description": f"the path of a CSV file with {content}"}
    schema["properties"]["units"] = {
        "type": "array",
        "items": {"type": "string"},
        "description": f"the units of {', '.join(keys)} in the file; by default those of its headings, or SI",
    }
    others = [key for key in schema.pop("required", []) if key not in keys]
    if others:
        schema["required"] = others
    schema["oneOf"] = [{"required": ["file"]}, {"required": list(keys)}]


class NumberTable(NamedTuple):
    """The contents of a CSV file of numbers."""

    units: tuple[str, ...]
    """Units of the columns by its headings, empty if not given."""
    rows: list[list[float]]


def read_table(name: object, base: Path | None, width: int | None) -> NumberTable:
    """Read the rows of a CSV file.

    Lines that are empty or start with ``#`` are skipped, and so is a head: all lines above the first numbers whose
    first cell does not begin as a number does. Units are in brackets behind headings, such as ``speed [rpm]``, or in a
    row of their own below them.
    """
    if not isinstance(name, str | Path):
        raise ValueError(f"file = {shorten(name)} must be the path of a CSV file, as text")
    try:
        separator, lines = read_rows((base or Path()) / name, ". Relative paths start at the folder of the drive file")
    except ValueError as error:
        raise ValueError(f'file = "{shorten(name)}" {error}') from error
    if len(lines) > _MOST_ROWS:
        raise ValueError(
            f'file = "{shorten(name)}" has {len(lines):,} lines; the limit is {_MOST_ROWS:,}. Omit points: '
            "a table is linear between points"
        )
    head: list[CsvRow] = []
    if width is None and lines:
        lines[0].cells[0] = "0"
        width = max(len(lines[0].cells), 2)
    elif width is not None:
        end = next((place for place, row in enumerate(lines) if _is_data(row.cells, width)), len(lines))
        head, lines = lines[:end], lines[end:]
    rows: list[list[float]] = []
    for line, cells in lines:
        numbers = _numbers(cells, width)
        if numbers is None:
            fault = _fault(cells, width, SEPARATORS[separator], show=bool(rows))
            raise ValueError(f'file = "{shorten(name)}", line {line}{fault}. Correct this line')
        rows.append(numbers)
    if not rows:
        raise ValueError(f'file = "{shorten(name)}" has no numbers. Give one line per point')
    return NumberTable(_units(head, len(rows[0])), rows)


def _is_data(cells: list[str], width: int) -> bool:
    """Whether a line is no part of a head: it holds numbers, or should."""
    return _numbers(cells, width) is not None or bool(NUMERIC.match(cells[0]))


def _units(head: list[CsvRow], width: int) -> tuple[str, ...]:
    """Units that the last line of a head tells."""
    if not head or len(head[-1].cells) != width:
        return ("",) * width
    cells = head[-1].cells
    return tuple((row_of_units(cells) if head[1:] else None) or map(unit_in_brackets, cells))


def _fault(cells: list[str], width: int | None, separator: str, *, show: bool) -> str:
    """What is wrong with a line; what is no table may be anything, and is not shown."""
    wrong = [place for place, cell in enumerate(cells, 1) if _numbers([cell], 1) is None]
    if show and wrong and len(cells) == width:
        return f', column {wrong[0]}: "{shorten(cells[wrong[0] - 1], 40)}" is not a number'
    many = f"two numbers separated by a {separator}" if width == 2 else f"{width} numbers separated by {separator}s"
    said = f'"{shorten(",".join(cells), 40)}" ' if show else ""
    return f": {said}is not {many}"


def _numbers(cells: list[str], width: int | None) -> list[float] | None:
    """Numbers of a line; None if there are others than so many."""
    try:
        numbers = [float(cell) for cell in cells]
    except ValueError:
        return None
    return numbers if len(numbers) == width else None

"""Points of a table, from keys or a CSV file, and their rules."""

from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import ValidationInfo

from beltdyn.parts.csv_rows import NUMERIC, SEPARATORS, CsvRow, read_rows, row_of_units, unit_in_brackets
from beltdyn.parts.error_location import shorten

_MOST_ROWS = 250_000
"""Lines of the longest table of a drive, which takes some seconds to read."""


def take_file(data: Any, info: ValidationInfo, first: str, second: str) -> Any:
    """Replace the key ``file`` of a table by the two columns of that CSV file.

    Parameters
    ----------
    data : object
        What a user gave for a table; returned as it is if it names no file.
    info : ValidationInfo
        Its context may hold ``base``, the folder that a relative path starts from.
    first, second : str
        The keys of the columns.

    Returns
    -------
    object
        The same table with its columns, as text with units where the key ``units``, or else the head of the file,
        gives those of the columns.

    Raises
    ------
    ValueError
        If there are columns beside the file, or the file cannot be read.
    """
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

    Parameters
    ----------
    data, info
        As for `take_file`; ``units`` are those of rows, columns and values.
    rows, columns, values : str
        The keys of both arguments, and of the values.

    Returns
    -------
    object
        The same table with these keys; the values are a list of rows.

    Raises
    ------
    ValueError
        If one of these keys is there beside the file, or the file cannot be read.
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
    """Check that the points of a table are a function.

    Parameters
    ----------
    first, second : str
        The keys of the columns.
    arguments, values : sequence of float
        The columns.

    Raises
    ------
    ValueError
        If the columns differ in length, or the first is not ascending.
    """
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
    """Add the keys ``file`` and ``units``, which are replaced by others on reading, to the JSON schema of a table.

    Parameters
    ----------
    schema : dict
        Changed in place.
    keys : sequence of str
        The keys that the file replaces.
    content : str
        What the file holds.
    """
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

    Parameters
    ----------
    name : object
        Path of the file, as the user wrote it.
    base : Path or None
        Folder that a relative path starts from; None for the working directory.
    width : int or None
        Numbers in a row.  None for a grid, whose rows are as long as its first line; the first cell of that is read as
        zero.

    Raises
    ------
    ValueError
        If the file cannot be read, or is not a table of such rows.
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

"""Points of a table: from a CSV file of two columns, and what they must obey."""

import csv
from collections.abc import Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

from pydantic import ValidationInfo

from beltdyn.parts.error_location import shorten
from beltdyn.parts.messages import reason
from beltdyn.parts.text_file import LONGEST_TABLE, read_text


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
        The same table with its columns.

    Raises
    ------
    ValueError
        If there are columns beside the file, or the file cannot be read.
    """
    if not isinstance(data, Mapping) or "file" not in data:
        return data
    if first in data or second in data:
        raise ValueError(f"file excludes {first} and {second}: keep one of the two forms")
    columns = read_table(data["file"], (info.context or {}).get("base"))
    others = {key: value for key, value in data.items() if key != "file"}
    return others | dict(zip((first, second), columns, strict=True))


def check_points(first: str, arguments: Sequence[float], second: str, values: Sequence[float]) -> None:
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
        If the columns differ in length, or the first one does not increase.
    """
    if len(arguments) != len(values):
        raise ValueError(
            f"{first} has {len(arguments)} numbers and {second} has {len(values)}: each {first[:-1]} needs one "
            f"{second[:-1]}"
        )
    for earlier, later in pairwise(arguments):
        if later <= earlier:
            raise ValueError(
                f"{first} must increase, but {later:g} follows {earlier:g}. Sort the points by {first[:-1]}"
            )


def describe_file(schema: dict[str, Any], first: str, second: str, content: str) -> None:
    """Add the key ``file``, which is replaced by two columns on reading, to the JSON schema of a table.

    Parameters
    ----------
    schema : dict
        Changed in place.
    first, second : str
        The keys of the columns.
    content : str
        What the columns of the file hold.
    """
    schema["properties"]["file"] = {"type": "string", "description": f"a CSV file of two columns, {content}"}
    others = [key for key in schema.pop("required", []) if key not in (first, second)]
    if others:
        schema["required"] = others
    schema["oneOf"] = [{"required": ["file"]}, {"required": [first, second]}]


def read_table(name: object, base: Path | None) -> tuple[list[float], list[float]]:
    """Read the two columns of a CSV file.

    Lines that are empty or start with ``#`` are skipped, and so is one header line.

    Parameters
    ----------
    name : object
        Path of the file, as the user wrote it.
    base : Path or None
        Folder that a relative path starts from; None for the working directory.

    Returns
    -------
    first, second : list of float
        The columns.

    Raises
    ------
    ValueError
        If the file cannot be read, or is not a table of two columns of numbers.
    """
    if not isinstance(name, str | Path):
        raise ValueError(f"file = {shorten(name)} must be the path of a CSV file, as text")
    rows = _rows(name, base)
    if rows and _numbers(rows[0][1]) is None:
        rows = rows[1:]
    points: list[tuple[float, float]] = []
    for line, cells in rows:
        numbers = _numbers(cells)
        if numbers is None:
            what = f'"{shorten(",".join(cells), 40)}" ' if points else ""  # what is no table may be anything
            raise ValueError(
                f'file = "{shorten(name)}", line {line}: {what}is not two numbers with a comma between. '
                "Correct this line"
            )
        points.append(numbers)
    return [first for first, _ in points], [second for _, second in points]


def _rows(name: str | Path, base: Path | None) -> list[tuple[int, list[str]]]:
    """Lines of the file that are not empty or comments, each with its number."""
    reader = csv.reader(_text(name, base).splitlines())
    try:
        return [(reader.line_num, row) for row in reader if row and not row[0].startswith("#")]
    except csv.Error as error:
        raise ValueError(
            f'file = "{shorten(name)}", line {reader.line_num}, is not CSV: {error}. Correct this line'
        ) from error


def _text(name: str | Path, base: Path | None) -> str:
    path = (base or Path()) / name
    try:
        return read_text(path, LONGEST_TABLE)
    except UnicodeDecodeError as error:
        raise ValueError(f'file = "{shorten(name)}" is not a CSV text file. Save it as CSV in UTF-8') from error
    except (OSError, ValueError) as error:
        raise ValueError(
            f'file = "{shorten(name)}" cannot be read: {reason(error)}. A relative path starts at the folder of '
            "the drive file"
        ) from error


def _numbers(cells: list[str]) -> tuple[float, float] | None:
    try:
        first, second = (float(cell) for cell in cells)
    except ValueError:
        return None
    return first, second

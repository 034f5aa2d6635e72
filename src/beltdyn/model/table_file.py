"""Points of a profile from a CSV file of two columns."""

import csv
from pathlib import Path

from beltdyn.model.messages import reason


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
        raise ValueError(f"file = {name!r} must be the path of a CSV file, as text")
    rows = _rows(name, base)
    if rows and _numbers(rows[0][1]) is None:
        rows = rows[1:]
    points = []
    for line, cells in rows:
        numbers = _numbers(cells)
        if numbers is None:
            raise ValueError(
                f'file = "{name}", line {line}: "{",".join(cells)[:40]}" is not two numbers with a comma between. '
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
        raise ValueError(f'file = "{name}", line {reader.line_num}, is not CSV: {error}. Correct this line') from error


def _text(name: str | Path, base: Path | None) -> str:
    path = (base or Path()) / name
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(f'file = "{name}" is not a CSV text file. Save it as CSV in UTF-8') from error
    except (OSError, ValueError) as error:
        raise ValueError(
            f'file = "{name}" cannot be read: {reason(error)}. A relative path starts at the folder of the drive file'
        ) from error


def _numbers(cells: list[str]) -> tuple[float, float] | None:
    try:
        first, second = (float(cell) for cell in cells)
    except ValueError:
        return None
    return first, second

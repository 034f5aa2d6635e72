"""Tables that a user gives to an analysis: CSV files with headings, such as "driver speed [rpm]".

Above the headings there may be lines with fewer cells, and below them a row of units, as loggers write them.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from beltdyn.errors import ModelError
from beltdyn.parts.csv_rows import CsvRow, read_rows, row_of_units, without_preamble
from beltdyn.parts.quantity import to_si

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
        """Numbers in an SI unit, or as they are where either has none; those in % as parts of one.

        Raises
        ------
        ModelError
            If a cell is no number, or the unit is another one.
        """
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
    """Read a table.

    Parameters
    ----------
    option
        Name of the option that names it, for messages.
    path
        The CSV file.

    Raises
    ------
    ModelError
        If it cannot be read, has no rows, or lines of other lengths than its headings.
    """
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
    return list(_columns(path, headings, body))


def _columns(path: Path, headings: list[str], rows: list[CsvRow]) -> Iterator[HeadedColumn]:
    for place, heading in enumerate(headings):
        match = _HEADING.fullmatch(heading)
        what, unit = (match["what"], match["unit"] or "") if match else (heading.strip(), "")
        yield HeadedColumn(what, unit, path, [(number, line[place]) for number, line in rows])

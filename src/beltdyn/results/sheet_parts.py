"""Parts of a sheet."""

import re
from typing import NamedTuple

_NUMBER = re.compile(r"[<>]?\s*[-+−]?[\d.]|[–-]?$|nan|-?inf")


class Table(NamedTuple):
    """A table whose first column holds names.

    Attributes
    ----------
    title : str
        What stands above it, or nothing.
    headings : tuple of str
        Name and unit of each column, in two lines where a column is narrow.
    rows : tuple of tuple of str
        Its rows.
    """

    title: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def has_words(self, column: int) -> bool:
        """Whether a column holds words, and not numbers alone."""
        return any(_NUMBER.match(row[column]) is None for row in self.rows)


class Facts(NamedTuple):
    """Names and their values.

    Attributes
    ----------
    facts : tuple of (str, str)
        Such as ``("efficiency", "96.04%")``.
    title : str
        What stands above them, or nothing.
    """

    facts: tuple[tuple[str, str], ...]
    title: str = ""


class Sheet(NamedTuple):
    """The tables and facts of a result.

    Attributes
    ----------
    title : str
        The name of the drive, or what the result is; may be empty.
    parts : tuple of Table or Facts
        In the order in which they are read.
    """

    title: str
    parts: tuple[Table | Facts, ...]

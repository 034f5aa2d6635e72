"""Parts of a sheet: tables and facts, and sheets as plain text."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from beltdyn.errors import BeltdynError, classified

_GAP = 2
"""Characters between two columns."""
_NUMBER = re.compile(r"[<>]?\s*[-+−]?[\d.]|[–-]?$|nan|-?inf")


class Table(NamedTuple):
    """A table whose first column holds names."""

    title: str
    """What stands above it, or nothing."""
    headings: tuple[str, ...]
    """Name and unit of each column, in two lines where a column is narrow."""
    rows: tuple[tuple[str, ...], ...]
    """Its rows."""

    def has_words(self, column: int) -> bool:
        """Whether a column holds words, and not numbers alone."""
        return any(_NUMBER.match(row[column]) is None for row in self.rows)

    @property
    def column_widths(self) -> list[int]:
        """Characters of the widest cell or line of the heading of each column, with the gap to the next one."""
        lines = (heading.splitlines() for heading in self.headings)
        cells = zip(*self.rows, strict=True) if self.rows else ((),) * len(self.headings)
        return [_GAP + max(map(len, (*one, *column)), default=0) for one, column in zip(lines, cells, strict=True)]

    def without(self, headings: Iterable[str]) -> "Table":
        """The table without columns of some headings."""
        left_out = set(headings)
        kept = [number for number, heading in enumerate(self.headings) if heading not in left_out]
        rows = tuple(tuple(row[number] for number in kept) for row in self.rows)
        return Table(self.title, tuple(self.headings[number] for number in kept), rows)

    def blocks(self, characters: int) -> "Iterator[Table]":
        """The table in blocks of columns that are at most so many characters wide, each with the names in front."""
        widths, first = self.column_widths, 1
        while first < len(widths):
            room, last = characters - widths[0] - widths[first], first + 1
            while last < len(widths) and widths[last] <= room:
                room, last = room - widths[last], last + 1
            whole = slice(first, last)
            rows = tuple((row[0], *row[whole]) for row in self.rows)
            title = self.title if first == 1 else f"{self.title}, continued".lstrip(", ")
            yield Table(title, (self.headings[0], *self.headings[whole]), rows)
            first = last


class Facts(NamedTuple):
    """Names and their values."""

    facts: tuple[tuple[str, str], ...]
    """Such as ``("efficiency", "96.04%")``."""
    title: str = ""
    """What stands above them, or nothing."""


class Sheet(NamedTuple):
    """The tables and facts of a result."""

    title: str
    """The name of the drive, or what the result is; may be empty."""
    parts: tuple[Table | Facts, ...]
    """In the order in which they are read."""
    errors: tuple[BeltdynError, ...] = ()
    """Of parts that have a fault, each of which stands among the facts, too."""


Pieces = tuple[Table | Facts, ...]


def sheet_of(title: str, pieces: Iterable[Callable[[], Pieces]], source: str) -> Sheet:
    """A sheet of pieces; in place of one that has a fault stands what repeats it."""
    made, errors = list[Table | Facts](), list[BeltdynError]()
    for piece in pieces:
        try:
            made += piece()
        except Exception as error:
            errors.append(classified(error, f"from beltdyn.show.sheet import sheet; sheet({source})"))
            made.append(Facts((("not shown", str(errors[-1])),)))
    return Sheet(title, tuple(made), tuple(errors))


def as_text(sheet: Sheet) -> str:
    """A sheet as plain text."""
    parts = ([sheet.title] if sheet.title else []) + ["\n".join(_lines(part)) for part in sheet.parts]
    return "\n\n".join(parts)


def _lines(part: Table | Facts) -> list[str]:
    """The lines of a table, names to the left and numbers to the right, or of facts."""
    title = [part.title] if part.title else []
    if isinstance(part, Facts):
        width = max((len(name) for name, _ in part.facts), default=0)
        return title + [f"{name:{width}}  {fact}" for name, fact in part.facts]
    headings = [heading.split("\n") for heading in part.headings]
    deep = max(map(len, headings))
    rows = [*zip(*([""] * (deep - len(one)) + one for one in headings), strict=True), *part.rows]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return title + [
        "  ".join(f"{cell:{'>' if number else '<'}{width}}" for number, (cell, width) in enumerate(cells)).rstrip()
        for cells in (tuple(zip(row, widths, strict=True)) for row in rows)
    ]


# Tables of several results in columns beside each other


def merged(tables: Sequence[Table], marks: Sequence[str]) -> Table | None:
    """One table of tables with the same rows and headings, of which columns that differ stand beside each other.

    A column gets the mark of its table in its heading. None where rows or headings are not the same.
    """
    first, *others = tables
    rows = [row[0] for row in first.rows]
    if any(one.headings != first.headings or [row[0] for row in one.rows] != rows for one in others):
        return None
    headings, columns = [first.headings[0]], [rows]
    for number, heading in enumerate(first.headings[1:], 1):
        cells = [[row[number] for row in one.rows] for one in tables]
        same = all(one == cells[0] for one in cells)
        for mark, column in [("", cells[0])] if same else zip(marks, cells, strict=True):
            headings.append(f"{heading}\n{mark}" if mark else heading)
            columns.append(column)
    return Table(_shared_title(tables), tuple(headings), tuple(zip(*columns, strict=True)))


def _shared_title(tables: Sequence[Table]) -> str:
    """The title of tables, without what differs in brackets behind it."""
    titles = list(dict.fromkeys(one.title for one in tables))
    shortened = titles if len(titles) == 1 else dict.fromkeys(title.partition(" (")[0] for title in titles)
    return " / ".join(shortened)


def side_by_side(groups: Sequence[Sequence[Table]], marks: Sequence[str]) -> tuple[list[Table], list[list[Table]]]:
    """Tables of several results, a group each, in columns beside each other; and those of each that have no match."""
    rest, found = [list(group) for group in groups], list[Table]()
    for one in groups[0]:
        others = [next((other for other in group if other.headings == one.headings), None) for group in rest[1:]]
        known = [other for other in others if other is not None]
        table = merged([one, *known], marks) if len(known) == len(others) else None
        if table is not None:
            found.append(table)
            for group, own in zip(rest, (one, *known), strict=True):
                group.remove(own)
    return found, rest


def facts_beside(groups: Sequence[Sequence[tuple[str, str]]], marks: Sequence[str]) -> Table:
    """Facts of several results, a group each, as a table with a column for each result."""
    known = [dict(group) for group in groups]
    names = dict.fromkeys(name for group in groups for name, _ in group)
    rows = tuple((name, *(one.get(name, "–") for one in known)) for name in names)
    return Table("", ("", *marks), rows)

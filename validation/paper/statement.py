"""What the paper says, what we find, and the verdict."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import groupby

Value = float | int | str


class Verdict(StrEnum):
    """Whether a statement holds."""

    HOLDS = "holds"
    FAILS = "does not hold"
    OPEN = "cannot be decided from the text"


def verdict(condition: bool) -> Verdict:
    """Give the verdict of a criterion that is met or not.

    Parameters
    ----------
    condition : bool
        Whether it is met.
    """
    return Verdict.HOLDS if condition else Verdict.FAILS


def judged(holds: bool, fails: bool) -> Verdict:
    """Give the verdict of a criterion that is met, or whose contrary is, or that is undecided in between.

    Parameters
    ----------
    holds, fails : bool
        Whether the criterion is met, and whether its contrary is.
    """
    if holds:
        return Verdict.HOLDS
    return Verdict.FAILS if fails else Verdict.OPEN


_SCATTER = 0.2
"""Part by which forces at an instant change with time steps and meshes, about."""


def clearly_below(value: float, limit: float) -> Verdict:
    """Judge whether a force, or a difference of forces, is below a limit: undecided where they are within a fifth.

    Forces at an instant carry ripple, which changes with the time steps.

    Parameters
    ----------
    value, limit : float
        Both in one unit.
    """
    return judged(holds=value < (1.0 - _SCATTER) * limit, fails=limit < (1.0 - _SCATTER) * value)


def all_hold(verdicts: Iterable[Verdict]) -> Verdict:
    """Give the verdict of a statement that holds if all its parts do, and not if one does not.

    Parameters
    ----------
    verdicts : iterable of Verdict
        Those of the parts.
    """
    found = set(verdicts)
    if Verdict.FAILS in found:
        return Verdict.FAILS
    return Verdict.OPEN if Verdict.OPEN in found else Verdict.HOLDS


@dataclass(frozen=True, slots=True)
class Number:
    """A number with its name and unit.

    Attributes
    ----------
    name : str
        What it is.
    value : float, int or str
        The number, or words in its place.
    unit : str
        SI unit, "%" for a fraction that is shown in per cent, or empty.
    digits : int
        Significant digits of a float.
    """

    name: str
    value: Value
    unit: str = ""
    digits: int = 3


@dataclass(frozen=True, slots=True)
class Finding:
    """What we find with some settings.

    Attributes
    ----------
    settings : str
        Which ones, such as "as published".
    numbers : sequence of Number
        What was measured.
    verdict : Verdict
        What follows from them by the statement's criterion.
    """

    settings: str
    numbers: Sequence[Number]
    verdict: Verdict


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement about results and what becomes of it here.

    Attributes
    ----------
    name : str
        Identifier, unique on the page.
    title : str
        The statement in a few words.
    quote : str
        The paper's words, with the mark ... where some are left out; empty for a check of our own.
    page : int or None
        Page of the paper.
    criterion : str
        When the statement holds, in numbers.
    findings : sequence of Finding
        The first ones have published settings and give the verdict.
    remark : str
        What else a reader should know.
    published : int
        How many findings have published settings; more than one where the paper does not say which it took.
    departures : sequence of str
        Names of departures from the printed text that bear on it.
    """

    name: str
    title: str
    quote: str
    page: int | None
    criterion: str
    findings: Sequence[Finding]
    remark: str = ""
    published: int = 1
    departures: Sequence[str] = ()

    @property
    def verdict(self) -> Verdict:
        """The verdict of all findings with published settings; open where they disagree."""
        verdicts = {finding.verdict for finding in self.findings[: self.published]}
        return verdicts.pop() if len(verdicts) == 1 else Verdict.OPEN

    @property
    def ours(self) -> bool:
        """Whether it is a check of our own, which no words of the paper claim."""
        return not self.quote

    @property
    def tables(self) -> list[list[Finding]]:
        """Successive findings that list the same numbers, which fit into one table; those without numbers left out."""
        found = (finding for finding in self.findings if finding.numbers)
        return [list(group) for _, group in groupby(found, lambda finding: [number.name for number in finding.numbers])]

    @property
    def contested(self) -> bool:
        """Whether other settings lead to another verdict."""
        return any(finding.verdict is not self.verdict for finding in self.findings)


@dataclass(frozen=True, slots=True)
class Picture:
    """A figure of the page.

    Attributes
    ----------
    source : str
        The picture as a data URI.
    caption : str
        What it shows.
    """

    source: str
    caption: str


@dataclass(frozen=True, slots=True)
class Table:
    """A table whose first column holds names.

    Attributes
    ----------
    caption : str
        What it shows.
    headings : sequence of str
        One for each column, with units.
    rows : sequence of sequences
        The values.
    """

    caption: str
    headings: Sequence[str]
    rows: Sequence[Sequence[Value]]


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the page.

    Attributes
    ----------
    name : str
        Identifier, unique on the page.
    title : str
        Its heading.
    introduction : str
        What was run, how numbers are defined.
    statements : sequence of Statement
        In the paper's order.
    pictures : sequence of Picture
        Shown beside the statements.
    tables : sequence of Table
        Shown below them.
    """

    name: str
    title: str
    introduction: str
    statements: Sequence[Statement] = ()
    pictures: Sequence[Picture] = ()
    tables: Sequence[Table] = ()

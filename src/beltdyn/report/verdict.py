"""Key numbers of results against their limits, and the verdict."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.parts.finding import listing
from beltdyn.results import KeyNumber, Result, Run, key_numbers
from beltdyn.results.incidents import Incident, incidents

_WHOLE, _HUGE = 1e4, 1e9
"""Between these a number is written without an exponent."""


class SideBySide(NamedTuple):
    """A key number of all results.

    Attributes
    ----------
    name : str
        Its name.
    key : str
        Key of its limit in the drive file.
    numbers : list of KeyNumber or None
        One for each result; None where a result does not know it.
    """

    name: str
    key: str
    numbers: list[KeyNumber | None]

    def difference(self, number: int) -> str:
        """By how much a result differs from the first, in words; nothing where that is not known."""
        first, other = self.numbers[0], self.numbers[number]
        if number == 0 or first is None or other is None or not np.isfinite([first.value, other.value]).all():
            return ""
        if first.value == 0.0:
            return (
                ""
                if other.value == 0.0
                else f"{in_unit(other.value - first.value, first.unit, '+')} relative to the first"
            )
        return f"{other.value / first.value - 1.0:+z.1%} relative to the first"


def compared(results: Sequence[Result]) -> list[SideBySide]:
    """Set the key numbers of results side by side.

    Parameters
    ----------
    results : sequence of Result
        One or more.

    Returns
    -------
    list of SideBySide
        Those that any of them knows.
    """
    known = [{one.key: one for one in key_numbers(result)} for result in results]
    names = {key: one.name for numbers in known for key, one in numbers.items()}
    return [SideBySide(name, key, [numbers.get(key) for numbers in known]) for key, name in names.items()]


def verdict(results: Sequence[Result]) -> tuple[str, str]:
    """Compare results with their limits.

    Parameters
    ----------
    results : sequence of Result
        One or more.

    Returns
    -------
    kind : {"pass", "fail", "open"}
        "fail" also after gross slip or a slack span at any time, "open" if no limit is given, or a
        tensioner was on a stop.
    words : str
        In a sentence.
    """
    judged = [one.passes for result in results for one in key_numbers(result) if one.passes is not None]
    kept = sum(judged)
    happened = [one for result in results for one in _incidents(result)]
    said = listing(list(map(str, happened))) if happened else ""
    if not judged:
        return "open", f"No limits are given{said and f'; {said}'}"
    if kept < len(judged):
        broken = listing([_broken(one) for result in results for one in key_numbers(result) if one.passes is False])
        return "fail", f"{kept} of {len(judged)} limits are met: {broken}{said and f'; {said}'}"
    words = f"All {kept} limits are met" if kept > 1 else "The limit is met"
    if not happened:
        return "pass", words
    return ("fail" if any(one.severe for one in happened) else "open"), f"{words}, but {said}"


def _broken(number: KeyNumber) -> str:
    """A key number that is beyond its limit."""
    assert number.limit is not None
    return f"{number.name} {in_unit(number.value, number.unit)} (limit {in_unit(number.limit, number.unit)})"


def _incidents(result: Result) -> tuple[Incident, ...]:
    """Events of a run; empty for other results."""
    if not isinstance(result, Run) or result.outputs == 0:
        return ()
    with result.recorded() as recorded:
        return incidents(recorded, result.drive)


def limit_in_words(number: KeyNumber | None) -> str:
    """Write the limit of a key number; a dash where there is none."""
    if number is None or number.limit is None:
        return "–"
    return f"at {'most' if number.at_most else 'least'} {in_unit(number.limit, number.unit)}"


def in_unit(value: float, unit: str, sign: str = "") -> str:
    """Format a key number with four digits and its unit.

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Its unit, "1" for a pure number, "%" for a share.
    sign : str
        "+" to write the sign of a positive number too.
    """
    if np.isnan(value):
        return "–"
    if unit == "%":
        return f"{100.0 * value:{sign}.3g} %"
    rounded = float(f"{value:.4g}")
    number = f"{rounded:{sign}.0f}" if _WHOLE <= abs(rounded) < _HUGE else f"{value:{sign}.4g}"
    return f"{number} {unit}".removesuffix(" 1")

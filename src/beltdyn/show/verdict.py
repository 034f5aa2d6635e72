"""Key numbers of results against the limits of their drives, and the verdict."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.parts.messages import listing
from beltdyn.results.incidents import Incident, incidents
from beltdyn.results.limits import KeyNumber, has_limits, key_numbers, unjudged
from beltdyn.results.result import Result
from beltdyn.results.run import Run

_WHOLE, _HUGE = 1e4, 1e9
"""Between these a number is written without an exponent."""


class SideBySide(NamedTuple):
    """A key number of all results."""

    name: str
    """Its name."""
    key: str
    """Key of its limit in the drive file."""
    numbers: list[KeyNumber | None]
    """One for each result; None where a result does not know it."""

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
    """Set the key numbers of results side by side."""
    known = [{one.key: one for one in key_numbers(result)} for result in results]
    names = {key: one.name for numbers in known for key, one in numbers.items()}
    return [SideBySide(name, key, [numbers.get(key) for numbers in known]) for key, name in names.items()]


def verdict(results: Sequence[Result]) -> tuple[str, str]:
    """Compare results with their limits: "pass", "fail" or "open", and why."""
    numbers = [number for result in results for number in key_numbers(result) if number.passes is not None]
    broken = [number for number in numbers if not number.passes]
    events = [event for result in results for event in _incidents(result)]
    reserves = [*map(str, events), *(f"{key} is not judged here" for key in _unjudged(results))]
    but = listing(reserves) if reserves else ""
    if broken:
        words = f"{len(numbers) - len(broken)} of {len(numbers)} limits are met: {listing(list(map(_broken, broken)))}"
        return "fail", f"{words}{but and f'; {but}'}"
    if not numbers:
        return "open", but[:1].upper() + but[1:] if _unjudged(results) else f"No limits are given{but and f'; {but}'}"
    words = f"All {len(numbers)} limits are met" if len(numbers) > 1 else "The limit is met"
    if not reserves:
        return "pass", words
    return ("fail" if any(event.severe for event in events) else "open"), f"{words}, but {but}"


def unjudged_in_words(results: Sequence[Result]) -> list[str]:
    """Limits that no result judges, each with what does."""
    return [f"{key}: judged by {command}" for key, command in _unjudged(results).items()]


def _unjudged(results: Sequence[Result]) -> dict[str, str]:
    """Limits that no result judges, in words -> the command that does."""
    judged = {number.key for result in results for number in key_numbers(result) if number.passes is not None}
    limits = {key: command for result in results for key, command in unjudged(result).items()}
    return {key.replace("_", " "): command for key, command in limits.items() if key not in judged}


def limit_rows(result: Result) -> list[tuple[str, ...]]:
    """Name, value, place, limit and verdict of each limit of the drive file."""
    rows: list[tuple[str, ...]] = []
    if not has_limits(result.drive.limits):
        return rows
    for number in key_numbers(result):
        if number.limit is not None and number.passes is not None:
            value = in_unit(number.value, number.unit)
            rows.append((number.name, value, number.where, limit_in_words(number), _MARKS[number.passes]))
    return rows + [(key, "–", "", "", f"not judged here, but by {what}") for key, what in _unjudged([result]).items()]


_MARKS = {True: "met", False: "broken"}


def _broken(number: KeyNumber) -> str:
    """A key number that is beyond its limit."""
    assert number.limit is not None
    return f"{number.name} {in_unit(number.value, number.unit)} (limit {in_unit(number.limit, number.unit)})"


def _incidents(result: Result) -> tuple[Incident, ...]:
    """Events of a run; empty for other results."""
    if not isinstance(result, Run) or result.outputs == 0:
        return ()
    with result.recorded() as recorded:
        return incidents(recorded, result.prepared)


def limit_in_words(number: KeyNumber | None) -> str:
    """Write the limit of a key number; a dash where there is none."""
    if number is None or number.limit is None:
        return "–"
    return f"at {'most' if number.at_most else 'least'} {in_unit(number.limit, number.unit)}"


def in_unit(value: float, unit: str, sign: str = "") -> str:
    """Format a key number with four digits and its unit."""
    if np.isnan(value):
        return "–"
    if np.isinf(value):
        return f"{'−' * (value < 0.0)}∞ {unit}"
    if unit == "%":
        return f"{100.0 * value:{sign}.3g} %"
    rounded = float(f"{value:.4g}")
    number = f"{rounded:{sign}.0f}" if _WHOLE <= abs(rounded) < _HUGE else f"{value:{sign}.4g}"
    return f"{number} {unit}".removesuffix(" 1")

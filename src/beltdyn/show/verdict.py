"""Key numbers of results against the limits of their drives, and the verdict."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from beltdyn.parts.messages import listing
from beltdyn.results.incidents import Incident, incidents
from beltdyn.results.limits import KeyNumber, judging_commands, key_numbers
from beltdyn.results.result import Result
from beltdyn.results.run import Run

_MIN_PLAIN, _MAX_PLAIN = 1e4, 1e9
"""Sizes between which a number is written in full: four significant digits would give it an exponent."""


class SideBySide(NamedTuple):
    """A key number of all results."""

    name: str
    """Its name."""
    key: str
    """Key of its limit in the drive file."""
    numbers: list[KeyNumber | None]
    """One for each result; None where a result does not know it."""

    @property
    def limited(self) -> bool:
        """Whether a drive gives a limit of it."""
        return any(number is not None and number.limit is not None for number in self.numbers)

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
    known = list(map(key_numbers, results))
    unjudged = list(_unjudged(results, known))
    judged = [number for numbers in known for number in numbers if number.passes is not None]
    broken = [number for number in judged if not number.passes]
    events = [event for result in results for event in _incidents(result)]
    reserves = [*map(str, events), *(f"{name} is not judged here" for name in unjudged)]
    but = listing(reserves) if reserves else ""
    if broken:
        words = f"{len(judged) - len(broken)} of {len(judged)} limits are met: {listing(list(map(_broken, broken)))}"
        return "fail", f"{words}{but and f'; {but}'}"
    if not judged:
        return "open", but[:1].upper() + but[1:] if unjudged else f"No limits are given{but and f'; {but}'}"
    words = f"All {len(judged)} limits are met" if len(judged) > 1 else "The limit is met"
    if not reserves:
        return "pass", words
    return ("fail" if any(event.severe for event in events) else "open"), f"{words}, but {but}"


def unjudged_in_words(results: Sequence[Result]) -> list[str]:
    """Limits that no result judges, each with what does."""
    known = list(map(key_numbers, results))
    return [f"{name}: judged by {command}" for name, command in _unjudged(results, known).items()]


def _unjudged(results: Sequence[Result], known: Sequence[Sequence[KeyNumber]]) -> dict[str, str]:
    """Limits that no key number of the results judges, in words -> the command that does."""
    judged = {number.key for numbers in known for number in numbers if number.passes is not None}
    commands = {key: what for result in results for key, what in judging_commands(result.drive.limits).items()}
    return {key.replace("_", " "): what for key, what in commands.items() if key not in judged}


def limit_rows(result: Result) -> list[tuple[str, ...]]:
    """Name, value, place, limit and verdict of each limit of the drive file."""
    rows: list[tuple[str, ...]] = []
    if not judging_commands(result.drive.limits):
        return rows
    numbers = key_numbers(result)
    for number in numbers:
        if number.limit is not None and number.passes is not None:
            rows.append(
                (number.name, value_in_words(number), number.where, limit_in_words(number), _MARKS[number.passes])
            )
    unjudged = _unjudged([result], [numbers])
    return rows + [(name, "–", "", "", f"not judged here, but by {what}") for name, what in unjudged.items()]


_MARKS = {True: "met", False: "broken"}


def _broken(number: KeyNumber) -> str:
    """A key number that is beyond its limit."""
    assert number.limit is not None
    return f"{number.name} {value_in_words(number)} (limit {in_unit(number.limit, number.unit)})"


def _incidents(result: Result) -> tuple[Incident, ...]:
    """Events of a run; empty for other results."""
    if not isinstance(result, Run) or result.outputs == 0:
        return ()
    with result.recorded() as recorded:
        return incidents(recorded, result.prepared)


def value_in_words(number: KeyNumber) -> str:
    """Write the value of a key number."""
    return "outside the rating" if number.is_outside_rating else in_unit(number.value, number.unit)


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
    number = f"{rounded:{sign}.0f}" if _MIN_PLAIN <= abs(rounded) < _MAX_PLAIN else f"{value:{sign}.4g}"
    return f"{number} {unit}".removesuffix(" 1")

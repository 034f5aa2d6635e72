"""What is said of limits and differences."""

import pytest

from beltdyn.report.verdict import SideBySide, in_unit, limit_in_words, verdict
from beltdyn.results import KeyNumber, Run


def number(value: float, limit: float | None = None) -> KeyNumber:
    return KeyNumber("largest_hub_load", value, "N", "driver", limit)


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        ({}, ("open", "No limit is judged")),
        ({"largest_hub_load": 1e4}, ("pass", "The limit is kept")),
        ({"largest_hub_load": 1e4, "least_margin": 99.0}, ("fail", "1 of 2 limits are kept")),
    ],
)
def test_the_verdict(run: Run, limits: dict[str, float], said: tuple[str, str]) -> None:
    assert verdict([Run(run.dataset, run.drive.replace(limits=limits))]) == said


@pytest.mark.parametrize(
    ("first", "other", "words"),
    [(100.0, 110.0, "+10.0% to the first"), (0.0, 2.0, "+2 N to the first"), (0.0, 0.0, ""), (float("nan"), 1.0, "")],
)
def test_differences(first: float, other: float, words: str) -> None:
    assert SideBySide("", "", [number(first), number(other)]).difference(1) == words


def test_a_result_that_does_not_know_a_number_does_not_differ() -> None:
    assert SideBySide("", "", [number(1.0), None]).difference(1) == ""


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [(0.0123, "%", "1.23 %"), (1234.56, "N", "1235 N"), (1.5, "1", "1.5"), (float("nan"), "N", "–")],
)
def test_numbers_have_units(value: float, unit: str, words: str) -> None:
    assert in_unit(value, unit) == words


def test_limits_in_words() -> None:
    assert limit_in_words(number(1.0, 5.0)) == "at most 5 N"
    assert limit_in_words(number(1.0)) == limit_in_words(None) == "–"

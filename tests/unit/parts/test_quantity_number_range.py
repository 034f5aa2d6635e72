"""Ranges and lists of numbers as text."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.parts.quantity import Numbers, numbers_in


def test_a_range_is_divided_equally() -> None:
    np.testing.assert_allclose(numbers_in("speed", "600..1200 rpm", "rad/s", 3), np.array([20, 30, 40]) * np.pi)
    np.testing.assert_allclose(numbers_in("speed", "600..1200rpm", "rad/s", 2), np.array([20, 40]) * np.pi)
    np.testing.assert_allclose(numbers_in("slip", "0..20 %", "", 5), [0.0, 0.05, 0.1, 0.15, 0.2])


def test_a_list_is_sorted() -> None:
    np.testing.assert_allclose(numbers_in("load", "1, 0.5,2", "", 40), [0.5, 1.0, 2.0])
    np.testing.assert_allclose(numbers_in("places", "-20 mm, 0 mm, 3 cm", "m", 40), [-0.02, 0.0, 0.03])
    np.testing.assert_allclose(numbers_in("speed", "3 rad/s", "rad/s", 40), [3.0])


@pytest.mark.parametrize(
    ("text", "unit", "words"),
    [
        ("fast", "rad/s", r"speed = 'fast' must be a range such as '700..6000 rpm', or numbers separated by commas"),
        ("1..2", "rad/s", "has no unit"),
        ("1..2 m", "rad/s", "must be in units of rad/s"),
        ("1, 1 rpm", "rad/s", "contains the same number twice"),
        ("1..1", "", "contains the same number twice"),
    ],
)
def test_what_is_no_range(text: str, unit: str, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        numbers_in("speed", text, unit, 5)


def test_a_number_without_its_unit_is_asked_for_it() -> None:
    with pytest.raises(ModelError, match=r"has no unit\. Write it after the last number, such as .800 rpm"):
        numbers_in("speed", "80", "rad/s", 2)


@pytest.mark.parametrize("given", [[20.0, 10.0], np.array([20.0, 10.0]), (10, 20), range(10, 21, 10)])
def test_arrays_and_lists_are_in_si_units(given: Numbers) -> None:
    np.testing.assert_array_equal(numbers_in("speed", given, "rad/s", 5), [10.0, 20.0])


@pytest.mark.parametrize("given", [[], [np.nan], [[1.0, 2.0]], ["10 rpm"], None])
def test_what_is_no_array_of_numbers(given: Numbers) -> None:
    with pytest.raises(ModelError, match="must be 1 to 10,000 finite numbers in rad/s, or a text with a unit"):
        numbers_in("speed", given, "rad/s", 5)
    with pytest.raises(ModelError, match="the same number twice"):
        numbers_in("speed", [1.0, 1.0], "rad/s", 5)


@pytest.mark.parametrize("count", [1, 10_001])
def test_so_many_points(count: int) -> None:
    with pytest.raises(ModelError, match=f"{count} points of load"):
        numbers_in("load", "0..1", "", count)

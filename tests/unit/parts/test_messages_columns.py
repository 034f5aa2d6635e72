"""Columns of numbers, and numbers in sentences."""

import pytest

from beltdyn.parts.messages import aligned, beyond, plain


@pytest.mark.parametrize(
    ("values", "written"),
    [
        ([0.5004, -0.5], ["0.5004", "-0.5000"]),
        ([12345.6, 1.0], ["12346", "1"]),
        ([99.0, float("nan"), -1e-12], ["99.00", "–", "0.00"]),
        ([0.0, 0.0], ["0", "0"]),
        ([], []),
    ],
)
def test_a_column_has_as_many_decimals_in_all_rows(values: list[float], written: list[str]) -> None:
    assert aligned(values) == written


@pytest.mark.parametrize(
    ("value", "written"), [(21968.3, "21970"), (0.0012345, "0.001234"), (105.0, "105"), (-2.0, "-2")]
)
def test_a_number_in_a_sentence_has_no_exponent(value: float, written: str) -> None:
    assert plain(value) == written


@pytest.mark.parametrize(
    ("present", "wanted", "digits", "rounded"),
    [(1.0, 1.004, 2, 1.1), (21968.0, 22005.0, 3, 22100.0), (1.1e-4, 1.04e-4, 1, 1e-4), (2.0, 2.0, 2, 2.0)],
)
def test_a_wanted_value_is_rounded_away_from_the_present_one(
    present: float, wanted: float, digits: int, rounded: float
) -> None:
    assert beyond(present, wanted, digits) == pytest.approx(rounded, rel=1e-12)

"""Columns of numbers, and numbers in sentences."""

import numpy as np
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
    [
        (1.0, 1.004, 2, 1.1),
        (1.0, 1.00001, 3, 1.01),
        (22.0, 21.999, 2, 21.0),
        (553.58, 553.59, 4, 553.7),
        (21968.0, 22005.0, 3, 22100.0),
        (1.1e-4, 1.04e-4, 1, 1e-4),
        (2.0, 2.0, 2, 2.0),
    ],
)
def test_a_wanted_value_is_rounded_away_from_the_present_one(
    present: float, wanted: float, digits: int, rounded: float
) -> None:
    assert beyond(present, wanted, digits) == pytest.approx(rounded, rel=1e-12)


@pytest.mark.parametrize("digits", [1, 2, 3, 4])
def test_advice_differs_from_the_present_value_as_it_is_written(digits: int) -> None:
    """Also where both are nearly the same, and never falls short of the value wanted by more than half a percent."""
    random = np.random.default_rng(digits)
    for present in 10.0 ** random.uniform(-6.0, 8.0, 300):
        for wanted in present * (1.0 + 10.0 ** random.uniform(-7.0, 1.0, 5) * random.choice([-0.09, 1.0], 5)):
            advised = beyond(present, wanted, digits)
            assert f"{advised:.{max(digits, 2)}g}" != f"{present:.{max(digits, 2)}g}"
            assert (advised - wanted) * np.sign(wanted - present) >= -0.006 * abs(wanted)

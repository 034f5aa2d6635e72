import pytest

from validation.paper.numbers import power_of_ten, shown
from validation.paper.statement import Value


@pytest.mark.parametrize(
    ("value", "unit", "digits", "text"),
    [
        (0.0123456, "rad/s", 3, "0.0123\u202frad/s"),
        (0.20308174, "m", 6, "0.203082\u202fm"),
        (-12.0, "", 3, "−12.0"),
        (20536.4, "N/m", 3, "20536\u202fN/m"),
        (1.2e-5, "N", 3, "1.20×10⁻⁵\u202fN"),
        (3e7, "", 2, "3.0×10⁷"),
        (0.15, "%", 3, "15.0\u202f%"),
        (0.0, "J", 3, "0\u202fJ"),
        (float("nan"), "", 3, "not known"),
        (14277, "", 3, "14277"),
        ("unequal 20", "", 3, "unequal 20"),
    ],
)
def test_values_are_rounded_to_their_digits(value: Value, unit: str, digits: int, text: str) -> None:
    assert shown(value, unit, digits) == text


def test_powers_of_ten() -> None:
    assert (power_of_ten(1e4), power_of_ten(1e-2)) == ("10⁴", "10⁻²")

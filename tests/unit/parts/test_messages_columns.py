"""Columns of numbers."""

import pytest

from beltdyn.parts.messages import aligned


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

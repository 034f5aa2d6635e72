"""Units in which numbers are shown."""

import math

import pytest
import xarray as xr

from beltdyn.results.schema import in_words


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (50.0 * math.pi, "rad/s", "1500 rpm"),
        (0.5 * math.pi, "rad", "90 °"),
        (0.0125, "m", "12.5 mm"),
        (1.25, "m", "1.25 m"),
        (0.5, "1", "0.5"),
        ("idle", "1", "idle"),
    ],
)
def test_a_value_in_words(value: float | str, unit: str, words: str) -> None:
    assert in_words(xr.DataArray(value, attrs={"units": unit})) == words

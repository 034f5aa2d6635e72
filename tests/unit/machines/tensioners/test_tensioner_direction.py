"""Directions are unit vectors, whatever the length that a user gives them."""

from math import cos, nextafter, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.errors import ModelError
from beltdyn.model import FixedTensioner

ANGLES = st.integers(-3141, 3141).map(lambda thousandths: 1e-3 * thousandths)
"""Angles, rad, none of them with a component so small that it is refused as a slip."""


def direction(x: float, y: float) -> tuple[float, float]:
    return FixedTensioner(kind="fixed", pulley="idler", direction=(x, y)).direction


@given(angle=ANGLES, length=st.floats(1e-6, 1e6))
def test_a_direction_has_the_length_one(angle: float, length: float) -> None:
    found = direction(length * cos(angle), length * sin(angle))
    assert found == pytest.approx((cos(angle), sin(angle)), rel=1e-14, abs=1e-15)
    assert np.hypot(*found) == pytest.approx(1.0, rel=4e-16)


@given(angle=ANGLES, length=st.floats(1e-6, 1e6))
def test_a_direction_that_is_written_and_read_again_is_the_same(angle: float, length: float) -> None:
    """To the last digit: it is not divided by a length that rounding has left beside one."""
    found = direction(length * cos(angle), length * sin(angle))
    assert direction(*found) == found


@pytest.mark.parametrize("length", [1.0 + 1e-14, 1.0 - 1e-14])
def test_more_than_rounding_is_taken_out(length: float) -> None:
    assert direction(0.0, length) == (0.0, 1.0)
    assert direction(0.0, nextafter(1.0, 2.0)) == (0.0, nextafter(1.0, 2.0))


def test_no_direction() -> None:
    with pytest.raises(ModelError, match="has zero length: at least one component must differ from zero"):
        direction(0.0, 0.0)

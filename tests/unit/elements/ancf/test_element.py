import numpy as np
import pytest
from numpy.polynomial import Polynomial

from beltdyn.elements.ancf.element import bends, slopes

PLACES = np.linspace(0.0, 1.0, 7)
CUBIC = Polynomial([0.3, -0.7, 11.0, -130.0])


@pytest.mark.parametrize("xi", PLACES)
def test_a_cubic_is_met_exactly(length: float, xi: float) -> None:
    first = CUBIC.deriv()
    vectors = (CUBIC(0.0), first(0.0), CUBIC(length), first(length))
    assert np.dot(slopes(xi, length), vectors) == pytest.approx(first(xi * length), rel=1e-12)
    assert np.dot(bends(xi, length), vectors) == pytest.approx(CUBIC.deriv(2)(xi * length), rel=1e-12)


@pytest.mark.parametrize("xi", PLACES)
def test_a_shift_neither_slopes_nor_bends(length: float, xi: float) -> None:
    for factors in (slopes(xi, length), bends(xi, length)):
        assert factors[0] == -factors[2]

"""The Bezier form of the centreline against the cubic Hermite shape functions of the paper (Eq. 6 at y = 0)."""

import numpy as np
import pytest

from beltdyn.ancf.shape_functions import slopes
from beltdyn.contact.bezier import bernstein, bernstein_rates, combine, shape_functions
from beltdyn.model import Belt
from beltdyn.system.build import belt_system

XI = [0.0, 0.2, 0.5, 0.9, 1.0]
ROUNDING = 1e-14


@pytest.mark.parametrize("xi", XI)
def test_weights_add_up_to_one_and_their_rates_to_zero(xi: float) -> None:
    assert sum(bernstein(xi)) == pytest.approx(1.0, abs=ROUNDING)
    assert sum(bernstein_rates(xi)) == pytest.approx(0.0, abs=ROUNDING)


@pytest.mark.parametrize("xi", XI)
def test_rates_are_derivatives(xi: float) -> None:
    step = 1e-5
    difference = (np.array(bernstein(xi + step)) - bernstein(xi - step)) / (2 * step)
    np.testing.assert_allclose(bernstein_rates(xi), difference, atol=1e-9)  # truncation, the step squared


def test_curve_starts_and_ends_at_its_outer_control_points() -> None:
    control = np.array([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0], [6.0, 8.0]])
    assert combine(control, bernstein(0.0)) == (0.0, 1.0)
    assert combine(control, bernstein(1.0)) == (6.0, 8.0)


@pytest.mark.parametrize("xi", XI)
def test_slopes_are_those_of_the_hermite_shape_functions(xi: float) -> None:
    length = 0.7
    belt = Belt(
        length=3 * length,
        width=0.01,
        thickness=0.01,
        density=1e3,
        youngs_modulus=1e7,
        poissons_ratio=0.3,
        elements=3,
    )
    basis = belt_system(belt).control[0, 0]
    rates = shape_functions(basis, bernstein_rates(xi))
    np.testing.assert_allclose(rates, length * np.array(slopes(xi, length)), atol=ROUNDING)
    assert shape_functions(basis, bernstein(0.0)) == (1.0, 0.0, 0.0, 0.0)

"""Bezier curves of any degree: Bernstein polynomials, and the Hermite shape functions of the paper (Eq. 6 at y = 0)."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.contact.contact_zone import (
    MAX_DEGREE,
    combine,
    fill_bernstein,
    fill_bernstein_rates,
    fill_shape_functions,
    second_rate,
)
from beltdyn.elements.ancf.element import slopes
from beltdyn.model import Belt
from beltdyn.system.build import belt_system

XI = [0.0, 0.2, 0.5, 0.9, 1.0]
DEGREES = [1, 2, 3, 5, MAX_DEGREE]
ROUNDING = 1e-14


def bernstein(xi: float, degree: int) -> FloatArray:
    weights = np.full(degree + 1, np.nan)
    fill_bernstein(xi, weights)
    return weights


def rates(xi: float, degree: int) -> FloatArray:
    values = np.full(degree + 1, np.nan)
    fill_bernstein_rates(xi, values)
    return values


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("xi", XI)
def test_weights_add_up_to_one_and_their_rates_to_zero(xi: float, degree: int) -> None:
    assert bernstein(xi, degree).sum() == pytest.approx(1.0, abs=ROUNDING)
    assert rates(xi, degree).sum() == pytest.approx(0.0, abs=ROUNDING * degree)


@pytest.mark.parametrize("xi", XI)
def test_weights_of_a_cubic(xi: float) -> None:
    rest = 1.0 - xi
    np.testing.assert_allclose(bernstein(xi, 3), [rest**3, 3 * xi * rest**2, 3 * xi**2 * rest, xi**3], atol=ROUNDING)


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("xi", XI)
def test_rates_are_derivatives(xi: float, degree: int) -> None:
    step = 1e-5
    difference = (bernstein(xi + step, degree) - bernstein(xi - step, degree)) / (2 * step)
    # truncation: the third derivative, below (2 p)^3, times the step squared over six
    np.testing.assert_allclose(rates(xi, degree), difference, atol=1e-10 * degree**3)


@pytest.mark.parametrize("degree", DEGREES)
@pytest.mark.parametrize("xi", XI)
def test_the_second_rate_of_a_curve_is_the_derivative_of_its_first(xi: float, degree: int) -> None:
    control, step = np.random.default_rng(degree).normal(size=(degree + 1, 2)), 1e-5
    difference = (rates(xi + step, degree) - rates(xi - step, degree)) @ control / (2 * step)
    # truncation: the fourth derivative, below (2 p)^4, times the step squared over six
    np.testing.assert_allclose(second_rate(control, xi, np.full(degree + 1, np.nan)), difference, atol=1e-9 * degree**4)


@pytest.mark.parametrize("degree", DEGREES)
def test_curve_starts_and_ends_at_its_outer_control_points(degree: int) -> None:
    control = np.random.default_rng(degree).normal(size=(degree + 1, 2))
    assert combine(control, bernstein(0.0, degree)) == tuple(control[0])
    assert combine(control, bernstein(1.0, degree)) == tuple(control[-1])


@pytest.mark.parametrize("xi", XI)
def test_a_curve_of_a_higher_degree_is_the_same_curve(
    elevate: Callable[[FloatArray, int], FloatArray], xi: float
) -> None:
    control = np.random.default_rng(0).normal(size=(4, 2))
    raised = elevate(control, 5)
    assert combine(raised, bernstein(xi, 5)) == pytest.approx(combine(control, bernstein(xi, 3)), abs=ROUNDING)
    assert combine(raised, rates(xi, 5)) == pytest.approx(combine(control, rates(xi, 3)), abs=5 * ROUNDING)


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
    basis, shape = belt_system(belt).control[0, 0], np.empty(4)
    fill_shape_functions(basis, rates(xi, 3), shape)
    np.testing.assert_allclose(shape, length * np.array(slopes(xi, length)), atol=ROUNDING)
    fill_shape_functions(basis, bernstein(0.0, 3), shape)
    np.testing.assert_array_equal(shape, [1.0, 0.0, 0.0, 0.0])

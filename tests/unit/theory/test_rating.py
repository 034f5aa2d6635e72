"""The rating law against its parts: force at rest of bending, ratio, wrap, and factors as tables print them."""

from math import log, pi

import numpy as np
import pytest

from beltdyn.theory.rating import (
    RatingLaw,
    belts_factor,
    least_tension,
    pulleys_factor,
    rated_force,
    ratio_factor,
    ratio_force,
    wrap_factor,
)

LAW = RatingLaw(force=1000.0, bending=50.0, centrifugal=0.1, speed=100.0)


def test_each_term_takes_off_its_part() -> None:
    assert rated_force(LAW, 1e12, 1.0) == pytest.approx(1000.0 - 0.1)
    assert rated_force(LAW, 0.1, 10.0) == pytest.approx(1000.0 - 50.0 / 0.1 - 0.1 * 100.0 - 100.0)


def test_the_ratio_term_is_the_law_on_the_equivalent_diameter() -> None:
    factor = float(ratio_factor(2.0, 5.6))
    gained = float(rated_force(LAW, 0.1, 10.0) + ratio_force(LAW, 0.1, 2.0, 5.6))
    assert gained == pytest.approx(float(rated_force(LAW, factor * 0.1, 10.0)))


def test_two_pulleys_harm_a_belt_as_two_of_the_equivalent_diameter() -> None:
    exponent, ratio = 5.6, 1.7
    both = 1.0 + ratio**-exponent
    assert 2.0 * float(ratio_factor(ratio, exponent)) ** -exponent == pytest.approx(both)


@pytest.mark.parametrize(
    ("least", "largest", "printed"),
    [
        *((1.02, 1.04, 1.0136), (1.05, 1.08, 1.0276), (1.09, 1.12, 1.0419), (1.13, 1.18, 1.0567)),
        *((1.19, 1.24, 1.0719), (1.25, 1.34, 1.0875), (1.35, 1.50, 1.1036), (1.51, 1.99, 1.1202), (2.0, 1e9, 1.1373)),
    ],
)
def test_the_ratio_factor_of_the_standard(least: float, largest: float, printed: float) -> None:
    """GB/T 13575.1 prints one K for each range of the ratio."""
    low, high = ratio_factor(np.array([least, largest]), 5.4)
    assert low - 1e-3 < printed < high + 1e-3


def test_the_ratio_factor_lies_between_one_and_its_bound() -> None:
    factors = ratio_factor(np.array([1.0, 1.5, 3.0, 1e6]), 6.6)
    assert factors[0] == pytest.approx(1.0)
    assert factors[-1] == pytest.approx(2.0 ** (1.0 / 6.6))
    assert np.all(np.diff(factors) > 0.0)
    assert factors[-1] == pytest.approx(1.1106, abs=1e-3)  # RMA IP-20


@pytest.mark.parametrize(
    ("degrees", "printed"),
    [(180, 1.0), (170, 0.98), (160, 0.95), (150, 0.92), (140, 0.89), (130, 0.86), (120, 0.82), (110, 0.78), (90, 0.69)],
)
def test_the_wrap_factor_of_the_standard(degrees: float, printed: float) -> None:
    """As printed with two digits in GB/T 13575.1."""
    assert float(wrap_factor(degrees * pi / 180.0)) == pytest.approx(printed, abs=0.006)


def test_factors_of_belts_and_pulleys_as_printed() -> None:
    assert [belts_factor(one) for one in (1, 3, 6)] == [1.0, 0.95, 0.90]
    assert belts_factor(2) == pytest.approx(0.975)
    assert [pulleys_factor(one) for one in range(2, 9)] == [1.0, 0.91, 0.86, 0.81, 0.78, 0.76, 0.75]


def test_the_least_tension_for_half_a_turn() -> None:
    """T1 / T2 is 5 = e^(mu theta) of mu = 0.512 in the groove, the mean tension 0.75 F; m v^2 comes on top."""
    assert least_tension(100.0, pi, 0.0, 10.0) == pytest.approx(75.0)
    tight, slack = 75.0 + 50.0, 75.0 - 50.0
    assert log(tight / slack) / pi == pytest.approx(0.512, abs=1e-3)
    assert least_tension(100.0, pi, 0.2, 10.0) == pytest.approx(75.0 + 20.0)
    assert least_tension(100.0, 2.0, 0.0, 10.0) > 75.0

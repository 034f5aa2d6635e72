"""The law of hysteresis: fast and slow rates, and derivatives."""

from itertools import product

import numpy as np
import pytest

from beltdyn.elements.planar_curve import CREEPING, hysteretic


@pytest.mark.parametrize(("strain", "rate"), list(product((-0.3, 0.2), (-5.0, 0.04, 9.0))))
def test_fast_rates_meet_a_share_of_the_strain(strain: float, rate: float) -> None:
    found = hysteretic(7.0, strain, 1e6 * rate, 4.0, 0.1)
    assert found.stress == pytest.approx(7.0 * abs(strain) * np.sign(rate), rel=1e-6)


def test_slow_rates_are_damped_in_proportion() -> None:
    """With the time l / v."""
    found = hysteretic(7.0, 0.2, 1e-6, 4.0, 0.1)
    assert found.stress == pytest.approx(7.0 * 1e-6 * 0.1 / np.hypot(2.0, CREEPING), rel=1e-6)
    assert found.stress == pytest.approx(found.by_rate * 1e-6, rel=1e-6)


def test_without_strain_and_rate_there_is_no_stress() -> None:
    assert hysteretic(7.0, 0.0, 0.0, 4.0, 0.1) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize(("strain", "rate"), list(product((-0.3, 0.2), (-5.0, 0.04, 9.0))))
def test_derivatives_of_the_law(strain: float, rate: float) -> None:
    found, step = hysteretic(7.0, strain, rate, 4.0, 0.1), 1e-6
    for number, slope in enumerate((found.by_strain, found.by_rate, found.by_square)):
        moved = [(np.array([strain, rate, 4.0]) + sign * step * np.eye(3)[number]).tolist() for sign in (1, -1)]
        up, down = (hysteretic(7.0, x, velocity, square, 0.1).stress for x, velocity, square in moved)
        assert slope == pytest.approx((up - down) / (2 * step), rel=1e-6, abs=1e-8)

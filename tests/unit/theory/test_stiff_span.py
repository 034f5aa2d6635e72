"""Force across a span: limits of string and beam, and the differential equation between them."""

from math import pi

import numpy as np
import pytest

from beltdyn.theory.stiff_span import deflection_force, stretching

LENGTH, TENSION = 0.5, 200.0


def test_a_string() -> None:
    assert deflection_force(0.01, LENGTH, TENSION) == pytest.approx(4.0 * TENSION * 0.01 / LENGTH)
    assert deflection_force(0.01, LENGTH, TENSION, 1e-9) == pytest.approx(4.0 * TENSION * 0.01 / LENGTH, rel=1e-4)


@pytest.mark.parametrize("tension", [1e-9, 1e-3])
def test_a_beam(tension: float) -> None:
    """F = 48 EI w / l^3 as the tension vanishes, and more by about 12/pi^2 of 4 T w / l / 1.2 with it."""
    bending = 3.0
    beam = 48.0 * bending * 0.01 / LENGTH**3
    assert deflection_force(0.01, LENGTH, tension, bending) == pytest.approx(beam, rel=1e-4)


@pytest.mark.parametrize("bending", [0.02, 0.5, 10.0])
def test_between_them_by_the_series_of_the_hinged_span(bending: float) -> None:
    """w = 2 F / l * sum over odd n of 1 / (T k^2 + EI k^4), k = n pi / l: another way to the same deflection."""
    k = np.arange(1, 200_001, 2) * pi / LENGTH
    per_force = 2.0 / LENGTH * np.sum(1.0 / (TENSION * k**2 + bending * k**4))
    assert deflection_force(per_force, LENGTH, TENSION, bending) == pytest.approx(1.0, rel=1e-6)


def test_the_stretch_of_two_straight_halves() -> None:
    exact = 2.0 * np.hypot(0.5 * LENGTH, 0.005) - LENGTH
    assert stretching(0.005, LENGTH) == pytest.approx(exact, rel=2e-4)

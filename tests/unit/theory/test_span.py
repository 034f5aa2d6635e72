"""A span: limits of string and beam, sag, and the differential equation between them."""

from math import pi, sqrt, tan

import numpy as np
import pytest

from beltdyn.theory.span import deflection_force, lowest_frequency, sag_parameter, stretching, symmetric_root

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


@pytest.mark.parametrize("parameter", [0.1, 1.0, 10.0, 60.0, 1e4])
def test_root_solves_the_equation(parameter: float) -> None:
    half = 0.5 * symmetric_root(parameter)
    assert tan(half) == pytest.approx(half - 4.0 / parameter * half**3, rel=1e-9)
    assert 0.5 * pi < half < 1.5 * pi


def test_limits_of_the_root() -> None:
    """A straight string; one wave of a sine in the Rayleigh quotient at small sag; an inextensible one, tan x = x."""
    assert symmetric_root(0.0) == pi
    assert symmetric_root(1e-3) == pytest.approx(pi * sqrt(1.0 + 8e-3 / pi**4), rel=1e-8)
    assert symmetric_root(4.0 * pi**2) == pytest.approx(2.0 * pi)
    assert symmetric_root(1e9) == pytest.approx(2.0 * 4.493409458, rel=1e-6)


def test_frequency_of_a_straight_beam_under_tension() -> None:
    wave = pi / 0.4
    expected = wave * sqrt((300.0 + 0.05 * wave**2) / 0.1) / (2.0 * pi)
    assert lowest_frequency(0.4, 300.0, 0.1, bending=0.05) == pytest.approx(expected)


def test_a_slack_span_swings_first_without_being_stretched() -> None:
    """Two half waves, from lambda = 2 pi on."""
    parameter = sag_parameter(2.0, 1.0, 5.0, 1e5)
    assert parameter == pytest.approx(0.4**2 * 1e5 / (5.0 * 1.02))
    assert lowest_frequency(1.0, 5.0, 0.2, sag_parameter=parameter) == pytest.approx(sqrt(5.0 / 0.2))

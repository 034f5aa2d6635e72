from math import pi, sqrt, tan

import pytest

from beltdyn.theory.sagging_span import lowest_frequency, sag_parameter, symmetric_root


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

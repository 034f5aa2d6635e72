"""Sliding over an arc."""

from math import exp, pi

import pytest

from beltdyn.theory.creep import capstan_ratio, sliding_angle, tight_tension


def test_ratio() -> None:
    assert capstan_ratio(0.3, pi) == pytest.approx(exp(0.3 * pi))
    assert capstan_ratio(0.3, 1.0) * capstan_ratio(0.3, 2.0) == pytest.approx(capstan_ratio(0.3, 3.0))


@pytest.mark.parametrize("speed", [0.0, 10.0])
def test_angle_and_tension_belong_together(speed: float) -> None:
    tight = tight_tension(20.0, 0.4, 2.0, mass_per_length=0.1, speed=speed)
    assert sliding_angle(tight, 20.0, 0.4, mass_per_length=0.1, speed=speed) == pytest.approx(2.0)


def test_a_belt_in_flight_is_not_held() -> None:
    assert tight_tension(10.0, 0.4, 2.0, mass_per_length=0.1, speed=10.0) == pytest.approx(10.0)

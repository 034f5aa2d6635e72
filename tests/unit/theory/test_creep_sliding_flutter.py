"""Waves of a belt that slides on its pulley, by formulas."""

from math import pi, sqrt

import pytest

from beltdyn.theory.creep import SlidingBelt, fastest_flutter, flutter_at

BELT = SlidingBelt(mass_per_length=0.1, axial_stiffness=1e4, radius=0.08, stiffness=1e7, damping=10.0, friction=1.2)


def test_nothing_grows_without_friction() -> None:
    assert fastest_flutter(BELT._replace(friction=0.0)).rate <= 0.0


def test_waves_on_a_large_pulley() -> None:
    """Weak coupling: sqrt(mu omega a / R) / sqrt(8) at omega = sqrt(k_p / m) = q a, to the order of a / omega R."""
    large = BELT._replace(radius=1e3, damping=0.0)
    speed, frequency = sqrt(1e4 / 0.1), sqrt(1e7 / 0.1)
    found = flutter_at(large, frequency / speed)
    assert found.rate == pytest.approx(sqrt(1.2 * frequency * speed / 1e3 / 8.0), rel=1e-2)
    assert found.frequency == pytest.approx(frequency / (2.0 * pi), rel=1e-2)


def test_the_fastest_is_near_those_in_tune() -> None:
    found = fastest_flutter(BELT)
    assert 0.5 < found.wave_number / sqrt(1e7 / 1e4) < 1.5
    assert found.rate >= flutter_at(BELT, sqrt(1e7 / 1e4)).rate > 0.0

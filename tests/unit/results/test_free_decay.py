"""Rates of decay of free vibrations, and that of the time integrator."""

import numpy as np
import pytest

from beltdyn.results.free_decay import Decay, free_decay, without_integrator

TIME = np.linspace(0.0, 0.5, 501)


@pytest.mark.parametrize(("rate", "frequency"), [(20.0, 52.3), (3.0, 20.0), (8.0, 111.0)])
def test_a_free_vibration(rate: float, frequency: float) -> None:
    values = (
        100.0 + 3.0 * np.exp(-rate * TIME) * np.sin(2.0 * np.pi * frequency * TIME + 1.0) + 5.0 * np.exp(-5.0 * TIME)
    )
    found = free_decay(TIME, values)
    assert found is not None
    assert found.frequency == pytest.approx(frequency, rel=2e-3)
    assert found.rate == pytest.approx(rate, rel=0.02)


def test_what_is_no_free_vibration() -> None:
    wave = np.sin(2.0 * np.pi * 52.3 * TIME)
    beating = (1.0 + 0.8 * np.cos(2.0 * np.pi * 6.0 * TIME)) * np.exp(-3.0 * TIME)
    for values in (wave, np.random.default_rng(0).normal(size=501), 5.0 * np.exp(-5.0 * TIME), beating * wave):
        assert free_decay(TIME, 100.0 + values) is None
    assert free_decay(TIME[:30], np.exp(-TIME[:30]) * wave[:30]) is None
    assert free_decay(TIME, np.where(TIME > 0.4, np.nan, wave)) is None


@pytest.mark.parametrize("radius", [0.0, 0.6, 1.0])
@pytest.mark.parametrize("step", [2e-4, 4e-3])
def test_what_the_integrator_makes_of_a_vibration(radius: float, step: float) -> None:
    """Steps of the published recursion, with the equation of motion at their ends."""
    frequency, rate = 40.0, 6.0
    square, damping = (2.0 * np.pi * frequency) ** 2 + rate**2, 2.0 * rate
    am, af = (2.0 * radius - 1.0) / (radius + 1.0), radius / (radius + 1.0)
    gamma = 0.5 + af - am
    beta = 0.25 * (gamma + 0.5) ** 2
    ends = np.array([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [square, damping, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0]])
    ends[0, 3], ends[1, 3], ends[3] = -(step**2) * beta, -step * gamma, [0.0, 0.0, af - 1.0, 1.0 - am]
    begins = np.array(
        [
            [1.0, step, 0.0, step**2 * (0.5 - beta)],
            [0.0, 1.0, 0.0, step * (1.0 - gamma)],
            [0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, af, -am],
        ]
    )
    factors = np.linalg.eigvals(np.linalg.solve(ends, begins))
    factors = factors[np.abs(factors) > 1e-9]
    seen = factors[np.argmin(np.abs(np.log(factors + 0j) / step - (2j * np.pi * frequency - rate)))]
    exponent = np.log(seen) / step
    found = without_integrator(radius, Decay(abs(exponent.imag) / (2.0 * np.pi), -exponent.real, 1.0, 1.0), step)
    assert found.frequency == pytest.approx(frequency)
    assert found.rate == pytest.approx(rate)
    assert step < 1e-3 or abs(-exponent.real / rate - 1.0) > 0.02

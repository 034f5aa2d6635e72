"""Input shapers: what they leave of a vibration, by their formulas and by integration of an oscillator."""

import numpy as np
import pytest
from scipy.linalg import expm

from beltdyn.theory.input_shaping import EI_TOLERANCE, SHAPERS, Shaper, fitted_shaper, residual_vibration


def vibration_behind(shaper: Shaper, frequency: float, damping: float) -> float:
    """Amplitude behind the last impulse of an oscillator that is struck by the impulses one after the other."""
    omega = 2.0 * np.pi * frequency
    matrix = np.array([[0.0, 1.0], [-(omega**2), -2.0 * damping * omega]])
    state, before = np.zeros(2), 0.0
    for time, size in zip(shaper.times, shaper.amplitudes, strict=True):
        state = expm(matrix * (time - before)) @ state + np.array([0.0, size])
        before = time
    damped = omega * np.sqrt(1.0 - damping**2)
    single = 1.0 / damped
    return float(np.hypot(state[0], (state[1] + damping * omega * state[0]) / damped) / single)


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.1])
@pytest.mark.parametrize("name", SHAPERS)
def test_what_a_shaper_leaves_is_what_an_oscillator_does(name: str, damping: float) -> None:
    shaper = SHAPERS[name](40.0, damping)
    frequencies = np.linspace(20.0, 70.0, 11)
    expected = [vibration_behind(shaper, each, damping) for each in frequencies]
    assert residual_vibration(shaper, frequencies, damping) == pytest.approx(expected, abs=1e-12)
    assert shaper.amplitudes.sum() == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(("name", "left"), [("ZV", 0.0), ("MZV", 0.0), ("EI", EI_TOLERANCE)])
def test_at_its_own_frequency(name: str, left: float) -> None:
    """Without damping exactly what the name says; EI vanishes on both sides of it."""
    shaper = SHAPERS[name](50.0, 0.0)
    assert residual_vibration(shaper, np.array([50.0]), 0.0)[0] == pytest.approx(left, abs=1e-15)
    if name == "EI":
        around = residual_vibration(shaper, np.linspace(40.0, 60.0, 2001), 0.0)
        assert around[:1000].min() < 1e-3
        assert around[1001:].min() < 1e-3


def test_longer_shapers_bear_larger_errors_of_the_frequency() -> None:
    """Published: ZV stays below 5 % within 3 % of its frequency, EI within some 20 %."""
    off = np.linspace(0.8, 1.2, 401)
    widths = []
    for name in SHAPERS:
        kept = residual_vibration(SHAPERS[name](1.0, 0.0), off, 0.0) <= EI_TOLERANCE + 1e-12
        widths.append(kept.mean() * 0.4)
    assert widths == sorted(widths)
    assert widths[0] == pytest.approx(2.0 * 0.0318, abs=2e-3)  # cos(pi f / 2) = 0.05
    assert widths[2] == pytest.approx(0.4, abs=0.02)


@pytest.mark.parametrize("name", SHAPERS)
def test_a_fitted_shaper_is_the_best_of_its_kind(name: str) -> None:
    frequencies = np.array([40.0, 44.0, 47.0])
    frequency, left, shaper = fitted_shaper(name, frequencies, 0.03)
    assert 40.0 < frequency < 47.0
    assert left == residual_vibration(shaper, frequencies, 0.03).max()
    for other in (0.98 * frequency, 1.02 * frequency):
        assert residual_vibration(SHAPERS[name](other, 0.03), frequencies, 0.03).max() > left
    single, alone, _ = fitted_shaper(name, np.array([40.0]), 0.0)
    assert single == 40.0
    assert alone == pytest.approx(EI_TOLERANCE if name == "EI" else 0.0, abs=1e-12)

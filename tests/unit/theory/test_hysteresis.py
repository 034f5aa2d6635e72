import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.theory.hysteresis import bending_loss, stretch_loss

FACTOR = 0.15


def cycle_of_sine(stiffness: float, low: float, high: float) -> float:
    """Work of the stress E' x + E'' dx/d(omega t) over a cycle of the strain x between two values."""
    angle = np.linspace(0.0, 2.0 * np.pi, 100, endpoint=False)
    amplitude = 0.5 * (high - low)
    strain, rate = 0.5 * (low + high) + amplitude * np.sin(angle), amplitude * np.cos(angle)
    stress: FloatArray = stiffness * (strain + FACTOR * rate)
    return float(np.mean(stress * rate) * 2.0 * np.pi)


def test_losses_are_those_of_a_sine_between_the_same_values() -> None:
    radii = np.array([0.05, 0.1])
    expected = [cycle_of_sine(0.03, 0.0, 1.0 / radius) for radius in radii]
    np.testing.assert_allclose(bending_loss(0.03, FACTOR, radii), expected, rtol=1e-12)
    assert stretch_loss(6e4, FACTOR, 500.0, 100.0) == pytest.approx(cycle_of_sine(6e4, 100.0 / 6e4, 500.0 / 6e4))

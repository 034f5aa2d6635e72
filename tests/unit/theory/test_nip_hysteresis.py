import numpy as np
import pytest
from scipy.integrate import solve_bvp

from beltdyn.arrays import FloatArray
from beltdyn.theory.nip import BENDING_SHARE, bending_loss, compression_loss, deepest, stretch_loss

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


@pytest.mark.parametrize("stiffness", [0.2, 1.0, 4.0, 100.0])
def test_the_deepest_place_is_that_of_a_beam_on_springs(stiffness: float) -> None:
    """The boundary value problem of the depth and its first three derivatives, in lengths sqrt(EI / T)."""

    def slopes(_: FloatArray, y: FloatArray) -> FloatArray:
        return np.stack([y[1], y[2], y[3], 1.0 + y[2] - stiffness * y[0]])

    def ends(begin: FloatArray, end: FloatArray) -> FloatArray:
        """No depth and the span's curvature exp(s) at the first contact; far along the arc the depth stays."""
        return np.array([begin[0], begin[3] - 1.0 - begin[2], end[0] - 1.0 / stiffness, end[1]])

    along = np.linspace(0.0, 30.0 / min(1.0, stiffness**0.5), 3001)
    solved = solve_bvp(slopes, ends, along, np.zeros((4, along.size)), tol=1e-8, max_nodes=200_000)
    assert solved.success
    assert deepest(stiffness) == pytest.approx(stiffness * solved.y[0].max(), rel=1e-4)  # between points of the curves


def test_compression_of_a_limp_belt_loses_what_a_cycle_of_its_springs_does() -> None:
    """Between no force and T / R a meter, of springs of the stiffness k."""
    radii, tension, stiffness = np.array([0.05, 0.1]), 400.0, 2e7
    expected = [cycle_of_sine(stiffness, 0.0, tension / (radius * stiffness)) for radius in radii]
    found = compression_loss(tension, 1e-6, stiffness, FACTOR, radii)
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def test_compression_of_a_stiff_belt_goes_by_its_bending() -> None:
    """With T sqrt(EI / k) / R^2, the parameter of Childs and Cowburn: twice as much by 4 EI, within 10 %."""
    radii = np.array([0.05])
    one, other = (compression_loss(400.0, bending, 1e10, FACTOR, radii)[0] for bending in (0.1, 0.4))
    assert other / one == pytest.approx(2.0, rel=0.1)
    assert one > BENDING_SHARE * FACTOR * 400.0**2 / (1e10 * 0.05**2)

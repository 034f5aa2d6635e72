"""Green's law of tension and its inverse."""

import numpy as np
import pytest

from beltdyn.theory.stretch import stretch, stretch_with_penetration, tangent_stiffness, tension

STIFFNESS = 2e4


def test_inverse() -> None:
    g = np.array([0.8, 0.99, 1.0, 1.001, 1.5, 3.0])
    np.testing.assert_allclose(stretch(tension(g, STIFFNESS), STIFFNESS), g, rtol=1e-12)


def test_slope() -> None:
    g, step = np.array([0.9, 1.0, 1.2]), 1e-6
    slope = (tension(g + step, STIFFNESS) - tension(g - step, STIFFNESS)) / (2 * step)
    np.testing.assert_allclose(tangent_stiffness(g, STIFFNESS), slope, rtol=1e-9)


def test_hookes_law_at_small_strain() -> None:
    assert float(tension(1.0 + 1e-6, STIFFNESS)) == pytest.approx(1e-6 * STIFFNESS, rel=1e-5)


@pytest.mark.parametrize("excess", [1.0, 1.001, 1.4])
@pytest.mark.parametrize("sinking", [0.0, 1e-7, 1e-2])
def test_a_belt_that_sinks_in_is_as_long_as_its_path(excess: float, sinking: float) -> None:
    length, path = 1.2, excess * 1.2
    g = stretch_with_penetration(length, path, STIFFNESS, sinking)
    assert g * length + sinking * float(tension(g, STIFFNESS)) * g == pytest.approx(path, rel=4 * np.finfo(float).eps)
    assert 1.0 <= g <= path / length

"""Green's law of tension and its inverse."""

import numpy as np
import pytest

from beltdyn.theory.stretch import stretch, tangent_stiffness, tension

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

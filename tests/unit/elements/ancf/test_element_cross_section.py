import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf.element import add_shear_curvature, nodal_shear, shear_gradient

GRADIENTS = [(1.0, 0.0, 0.0, 1.0), (0.9, 0.3, -0.1, 1.2), (-0.4, 1.1, -0.9, -0.8), (0.2, -1.3, 0.7, 0.1)]


@pytest.mark.parametrize("shear_angle", [-1.0, -0.1, 0.0, 0.3])
@pytest.mark.parametrize("turn", [-2.0, 0.0, 0.7])
def test_sine_of_the_shear_angle(shear_angle: float, turn: float) -> None:
    """A section that leans back by the shear angle, whatever the stretch, the thickness and the direction."""
    lean = turn + shear_angle
    shear = nodal_shear(1.3 * np.cos(turn), 1.3 * np.sin(turn), -0.8 * np.sin(lean), 0.8 * np.cos(lean))
    assert shear.sine == pytest.approx(np.sin(shear_angle), abs=1e-15)
    assert shear.cosine == pytest.approx(np.cos(shear_angle), abs=1e-15)
    assert (shear.stretch, shear.thickness) == pytest.approx((1.3, 0.8))


def by_differences(function: FloatArray, step: float) -> FloatArray:
    """Fourth-order first derivatives from values at -2, -1, 1, 2 steps, stacked along the first axis."""
    return np.asarray(np.tensordot([1.0, -8.0, 8.0, -1.0], function, 1) / (12.0 * step))


@pytest.mark.parametrize("gradients", GRADIENTS)
def test_derivatives_of_the_sine(gradients: tuple[float, float, float, float]) -> None:
    """A step of 1e-3 leaves some 1e-11 of truncation, with |r_x| and |r_y| near 1."""
    step, curvature = 1e-3, np.zeros((12, 12))
    shear = nodal_shear(*gradients)
    add_shear_curvature(shear, 3.0, curvature, 2)
    for column in range(4):
        around = [nodal_shear(*(gradients + k * step * np.eye(4)[column])) for k in (-2, -1, 1, 2)]
        slope = by_differences(np.array([near.sine for near in around]), step)
        assert shear_gradient(shear)[column] == pytest.approx(float(slope), abs=1e-10)
        bend = by_differences(np.array([shear_gradient(near) for near in around]), step)
        np.testing.assert_allclose(curvature[2:6, 2 + column], 3.0 * bend, atol=3e-9)
    curvature[2:6, 2:6] = 0.0
    assert not curvature.any()


def test_curvature_is_added(unloaded: FloatArray) -> None:
    shear = nodal_shear(*unloaded[2:6])
    once, twice = np.ones((12, 12)), np.zeros((12, 12))
    add_shear_curvature(shear, 1.0, once, 8)
    add_shear_curvature(shear, 0.5, twice, 8)
    add_shear_curvature(shear, 0.5, twice, 8)
    np.testing.assert_allclose(once, 1.0 + twice)

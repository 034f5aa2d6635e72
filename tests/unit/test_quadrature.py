import numpy as np
import pytest

from beltdyn.quadrature import gauss_points, trapezoid_points

ROUNDING = 1e-15


@pytest.mark.parametrize("count", range(1, 11))
def test_exact_up_to_degree_2n_minus_1(count: int) -> None:
    points, weights = gauss_points(count)
    for degree in range(2 * count):
        assert weights @ points**degree == pytest.approx(1.0 / (degree + 1), abs=ROUNDING)
    beyond = 2 * count
    assert weights @ points**beyond < 1.0 / (beyond + 1) - ROUNDING


@pytest.mark.parametrize("count", range(1, 11))
def test_points_lie_inside_and_symmetric(count: int) -> None:
    points, weights = gauss_points(count)
    assert np.all((points > 0.0) & (points < 1.0))
    np.testing.assert_allclose(points + points[::-1], 1.0, atol=ROUNDING)
    np.testing.assert_allclose(weights, weights[::-1], atol=ROUNDING)


def test_trapezoidal_rule() -> None:
    points, weights = trapezoid_points()
    np.testing.assert_array_equal(points, [0.0, 1.0])
    np.testing.assert_array_equal(weights, [0.5, 0.5])
    assert not points.flags.writeable
    assert not weights.flags.writeable


def test_points_are_shared_and_cannot_be_changed() -> None:
    points, weights = gauss_points(4)
    assert gauss_points(4)[0] is points
    for array in (points, weights):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0.0

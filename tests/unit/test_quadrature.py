import numpy as np
import pytest

from beltdyn.quadrature import gauss_points, lobatto_points, running_integral

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


def test_each_call_has_arrays_of_its_own() -> None:
    gauss_points(4).points[:] = 0.0
    assert np.all(gauss_points(4).points > 0.0)


@pytest.mark.parametrize("count", range(2, 9))
def test_lobatto_is_exact_up_to_degree_2n_minus_3(count: int) -> None:
    points, weights = lobatto_points(count)
    assert points[0] == 0.0
    assert points[-1] == 1.0
    for degree in range(2 * count - 2):
        assert weights @ points**degree == pytest.approx(1.0 / (degree + 1), abs=ROUNDING)
    beyond = 2 * count - 2
    assert weights @ points**beyond > 1.0 / (beyond + 1) + ROUNDING


def test_two_lobatto_points_are_the_trapezoidal_rule() -> None:
    points, weights = lobatto_points(2)
    np.testing.assert_array_equal(points, [0.0, 1.0])
    np.testing.assert_array_equal(weights, [0.5, 0.5])


def test_the_running_integral_of_a_straight_line_is_exact() -> None:
    places = np.array([1.0, 1.5, 3.0])
    np.testing.assert_allclose(running_integral(2.0 * places, places), places**2 - 1.0, rtol=ROUNDING)

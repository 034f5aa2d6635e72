"""The angle between two links, and a spring on it, against angles known by construction and against differences."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.elements.three_node_beam import add_spring, bend_angle, spring_energy

STIFFNESS = 3.0
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5 lengths, relative to the largest entry."""


def force(e: FloatArray, i: int = 2) -> tuple[FloatArray, FloatArray]:
    gradient, tangent = np.zeros(12), np.zeros((12, 12))
    add_spring(e, i, STIFFNESS, gradient, tangent)
    return gradient, tangent


@pytest.mark.parametrize("direction", [0.0, 1.0, 3.0, -2.0])
@pytest.mark.parametrize("bend", [-3.1, -pi / 2, 0.0, 1e-9, 0.3, 3.1])
def test_angle_is_that_of_the_links_wherever_they_point(
    polyline: Callable[..., FloatArray], direction: float, bend: float
) -> None:
    """Also where their directions lie on both sides of the cut of the arctangent; lengths do not matter."""
    e = polyline(np.array([0.5, direction, direction + bend, 0.2, 0.1]), np.array([1.0, 0.7, 1.6, 1.0, 1.0]))
    rounding = 1e-15
    assert bend_angle(e, 2) == pytest.approx(bend, abs=5 * rounding)
    assert spring_energy(e, 2, STIFFNESS) == pytest.approx(STIFFNESS * bend_angle(e, 2) ** 2 / 2.0)


@pytest.mark.parametrize("i", [0, 2, 6])
def test_derivatives(deformed: FloatArray, slope: Callable[..., FloatArray], i: int) -> None:
    gradient, tangent = force(deformed, i)
    by_differences = slope(lambda e: spring_energy(e, i, STIFFNESS), deformed)
    np.testing.assert_allclose(gradient, by_differences, atol=DIFFERENCES * np.abs(gradient).max())
    by_differences = slope(lambda e: force(e, i)[0], deformed)
    np.testing.assert_allclose(tangent, by_differences, atol=DIFFERENCES * np.abs(tangent).max())


def test_right_angle(link: float, polyline: Callable[..., FloatArray]) -> None:
    """A moment k pi / 2 on either link, by couples of forces normal to them."""
    e = polyline(np.array([0.0, 0.0, pi / 2, pi / 2, pi / 2]))
    size = STIFFNESS * pi / 2 / link
    expected = np.zeros((6, 2))
    expected[1], expected[2], expected[3] = (0.0, size), (size, -size), (-size, 0.0)
    np.testing.assert_allclose(force(e)[0], expected.ravel(), atol=1e-13 * size)

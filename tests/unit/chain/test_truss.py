"""A link against the law of its strain measure, N = EA (s^2 - 1) s / 2 at stretch s, and against differences."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.chain.truss import add_truss, truss_energy

AXIAL = 1e4
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5 lengths, relative to the largest entry."""


def force(e: FloatArray, link: float, i: int = 2) -> tuple[FloatArray, FloatArray]:
    gradient, tangent = np.zeros(12), np.zeros((12, 12))
    add_truss(e, i, AXIAL, link, gradient, tangent)
    return gradient, tangent


@pytest.mark.parametrize("stretch", [0.7, 1.0, 1.003, 1.4])
@pytest.mark.parametrize("direction", [0.0, 0.6, 2.5, -1.2])
def test_tension(link: float, polyline: Callable[..., FloatArray], stretch: float, direction: float) -> None:
    e = polyline(np.full(5, direction), stretch)
    pull = AXIAL * (stretch**2 - 1.0) * stretch / 2.0
    along = np.array([np.cos(direction), np.sin(direction)])
    expected = np.zeros((6, 2))
    expected[1], expected[2] = -pull * along, pull * along
    np.testing.assert_allclose(force(e, link)[0], expected.ravel(), atol=1e-12 * AXIAL)
    energy = AXIAL * link * (stretch**2 - 1.0) ** 2 / 8.0
    assert truss_energy(e, 2, AXIAL, link) == pytest.approx(energy, abs=1e-15 * AXIAL)


@pytest.mark.parametrize("i", [0, 2, 8])
def test_derivatives(link: float, deformed: FloatArray, slope: Callable[..., FloatArray], i: int) -> None:
    gradient, tangent = force(deformed, link, i)
    by_differences = slope(lambda e: truss_energy(e, i, AXIAL, link), deformed)
    np.testing.assert_allclose(gradient, by_differences, atol=DIFFERENCES * np.abs(gradient).max())
    by_differences = slope(lambda e: force(e, link, i)[0], deformed)
    np.testing.assert_allclose(tangent, by_differences, atol=DIFFERENCES * np.abs(tangent).max())


def test_it_adds(link: float, deformed: FloatArray) -> None:
    gradient, tangent = np.ones(12), np.ones((12, 12))
    add_truss(deformed, 2, AXIAL, link, gradient, tangent)
    once = force(deformed, link)
    np.testing.assert_allclose(gradient - 1.0, once[0], atol=1e-15 * AXIAL)
    np.testing.assert_allclose(tangent - 1.0, once[1], atol=1e-15 * AXIAL / link)

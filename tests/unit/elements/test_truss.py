"""A link against the law of its strain measure, N = EA (s^2 - 1) s / 2 at stretch s, and against differences."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.kind import Section
from beltdyn.elements.truss import TRUSS, Truss, add_link, link_energy, lumped_mass
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green

AXIAL = 1e4
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5 lengths, relative to the largest entry."""


def force(e: FloatArray, link: float, i: int = 2) -> tuple[FloatArray, FloatArray]:
    gradient, tangent = np.zeros(12), np.zeros((12, 12))
    add_link(e, i, Green(AXIAL), link, gradient, tangent)
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
    assert link_energy(e, 2, Green(AXIAL), link) == pytest.approx(energy, abs=1e-15 * AXIAL)


@pytest.mark.parametrize("i", [0, 2, 8])
def test_derivatives(link: float, deformed: FloatArray, slope: Callable[..., FloatArray], i: int) -> None:
    gradient, tangent = force(deformed, link, i)
    by_differences = slope(lambda e: link_energy(e, i, Green(AXIAL), link), deformed)
    np.testing.assert_allclose(gradient, by_differences, atol=DIFFERENCES * np.abs(gradient).max())
    by_differences = slope(lambda e: force(e, link, i)[0], deformed)
    np.testing.assert_allclose(tangent, by_differences, atol=DIFFERENCES * np.abs(tangent).max())


def test_it_adds(link: float, deformed: FloatArray) -> None:
    gradient, tangent = np.ones(12), np.ones((12, 12))
    add_link(deformed, 2, Green(AXIAL), link, gradient, tangent)
    once = force(deformed, link)
    np.testing.assert_allclose(gradient - 1.0, once[0], atol=1e-15 * AXIAL)
    np.testing.assert_allclose(tangent - 1.0, once[1], atol=1e-15 * AXIAL / link)


def section(**values: Any) -> Section:
    return Section(Green(0.0), *[0.0] * 7)._replace(**values)


def test_an_element_is_one_link(link: float, deformed: FloatArray) -> None:
    truss, work, e = Truss(section(stretch=Green(AXIAL)), gauss_points(1)), blank(TRUSS.workspace), deformed[2:6].copy()
    TRUSS.force(truss, e, link, True, work)
    gradient, tangent = force(deformed, link)
    np.testing.assert_array_equal(work.gradient, gradient[2:6])
    np.testing.assert_array_equal(work.tangent, tangent[2:6, 2:6])
    assert TRUSS.energy(truss, e, link) == link_energy(deformed, 2, Green(AXIAL), link)


def test_kinetic_energy_of_a_translation(link: float) -> None:
    velocity = np.tile([3.0, -4.0], 2)
    energy = 0.5 * velocity @ lumped_mass(section(mass=0.1), link) @ velocity
    assert energy == pytest.approx(0.5 * 0.1 * link * 25.0)


@pytest.mark.parametrize("angle", [0.01, 0.2])
def test_a_cubic_that_misses_the_circle_as_much(angle: float) -> None:
    """R a^2 / 8 of a link over the angle a is R b^4 / 384 of a cubic over b."""
    cubic = TRUSS.cubic_angle(np.array([angle]))
    assert cubic**4 / 384 == pytest.approx(angle**2 / 8)

import numpy as np
import pytest

from beltdyn.ancf.elastic_force import elastic_workspace, element_energy, element_force
from beltdyn.ancf.section import Section
from beltdyn.arrays import FloatArray
from beltdyn.quadrature import gauss_points


@pytest.fixture
def deformed(unloaded: FloatArray, length: float) -> FloatArray:
    """Stretched, bent, sheared and thickened."""
    deformation = np.random.default_rng(0).uniform(-0.1, 0.1, 12)
    deformation[[0, 1, 6, 7]] *= length
    return unloaded + deformation


def test_nothing_but_the_coordinates_matters(
    deformed: FloatArray, unloaded: FloatArray, section: Section, length: float
) -> None:
    """The scratch arrays and what stood in the results before leave no trace."""
    work, results = elastic_workspace(), []
    for before in (unloaded, deformed, -deformed):
        gradient, tangent = np.full(12, np.nan), np.full((12, 12), np.nan)
        element_force(before, section, length, *gauss_points(4), True, work, gradient, tangent)
        element_force(deformed, section, length, *gauss_points(4), True, work, gradient, tangent)
        results.append((gradient, tangent))
    for gradient, tangent in results[1:]:
        np.testing.assert_array_equal(gradient, results[0][0])
        np.testing.assert_array_equal(tangent, results[0][1])


def test_force_without_tangent(deformed: FloatArray, section: Section, length: float) -> None:
    """The same force; the tangent is left alone."""
    force, alone, tangent, kept = np.empty(12), np.empty(12), np.empty((12, 12)), np.ones((12, 12))
    element_force(deformed, section, length, *gauss_points(4), True, elastic_workspace(), force, tangent)
    element_force(deformed, section, length, *gauss_points(4), False, elastic_workspace(), alone, kept)
    np.testing.assert_allclose(alone, force, rtol=1e-13, atol=1e-13 * np.abs(force).max())
    np.testing.assert_array_equal(kept, 1.0)


@pytest.mark.parametrize("points", [2, 3, 4, 10])
def test_uniform_strain_needs_few_points(unloaded: FloatArray, section: Section, length: float, points: int) -> None:
    """A stretched element, its ends pulled by E A alpha1 (G - 1) |r_x| / 2, whatever the quadrature."""
    unloaded = unloaded.copy()
    unloaded[[2, 6, 8]] *= 1.1
    gradient, tangent = np.empty(12), np.empty((12, 12))
    element_force(unloaded, section, length, *gauss_points(points), True, elastic_workspace(), gradient, tangent)
    pull = section.axial * 0.5 * (1.1**2 - 1.0) * 1.1
    expected = np.zeros(12)
    expected[[0, 6]] = -pull, pull
    np.testing.assert_allclose(gradient, expected, atol=1e-12 * pull)
    energy = element_energy(unloaded, section, length, *gauss_points(points))
    assert energy == pytest.approx(section.axial * length / 8.0 * (1.1**2 - 1.0) ** 2)


def test_thickness_carries_its_own_stiffness(unloaded: FloatArray, section: Section, length: float) -> None:
    """A thickened belt pushes on r_y of both nodes alike, with E A to which no factor applies."""
    thick = unloaded.copy()
    thick[[5, 11]] = 1.2
    gradient, tangent = np.empty(12), np.empty((12, 12))
    element_force(thick, section, length, *gauss_points(4), True, elastic_workspace(), gradient, tangent)
    expected = np.zeros(12)
    expected[[5, 11]] = 0.5 * section.thickness * length * 0.5 * (1.2**2 - 1.0) * 1.2
    np.testing.assert_allclose(gradient, expected, atol=1e-12 * section.thickness)

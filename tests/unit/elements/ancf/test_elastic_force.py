import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.ancf import ANCF
from beltdyn.elements.ancf.elastic_force import element_energy, element_force
from beltdyn.elements.ancf.element import Ancf
from beltdyn.elements.kind import Section
from beltdyn.quadrature import gauss_points


@pytest.fixture
def deformed(unloaded: FloatArray, length: float) -> FloatArray:
    """Stretched, bent, sheared and thickened."""
    deformation = np.random.default_rng(0).uniform(-0.1, 0.1, 12)
    deformation[[0, 1, 6, 7]] *= length
    return unloaded + deformation


def forces(e: FloatArray, section: Section, length: float, points: int = 4) -> tuple[FloatArray, FloatArray]:
    work = blank(ANCF.workspace)
    element_force(Ancf(section, gauss_points(points)), e, length, True, work)
    return work.gradient, work.tangent


def test_nothing_but_the_coordinates_matters(
    deformed: FloatArray, unloaded: FloatArray, section: Section, length: float
) -> None:
    """The scratch arrays and what stood in the results before leave no trace."""
    work, element, results = blank(ANCF.workspace), Ancf(section, gauss_points(4)), []
    for before in (unloaded, deformed, -deformed):
        work.gradient[:], work.tangent[:] = np.nan, np.nan
        element_force(element, before, length, True, work)
        element_force(element, deformed, length, True, work)
        results.append((work.gradient.copy(), work.tangent.copy()))
    for gradient, tangent in results[1:]:
        np.testing.assert_array_equal(gradient, results[0][0])
        np.testing.assert_array_equal(tangent, results[0][1])


def test_force_without_tangent(deformed: FloatArray, section: Section, length: float) -> None:
    """The same force; the tangent is left alone."""
    work, (force, _) = blank(ANCF.workspace), forces(deformed, section, length)
    work.tangent[:] = 1.0
    element_force(Ancf(section, gauss_points(4)), deformed, length, False, work)
    np.testing.assert_allclose(work.gradient, force, rtol=1e-13, atol=1e-13 * np.abs(force).max())
    np.testing.assert_array_equal(work.tangent, 1.0)


@pytest.mark.parametrize("points", [2, 3, 4, 10])
def test_uniform_strain_needs_few_points(unloaded: FloatArray, section: Section, length: float, points: int) -> None:
    """A stretched element, its ends pulled by E A alpha1 (G - 1) |r_x| / 2, whatever the quadrature."""
    unloaded = unloaded.copy()
    unloaded[[2, 6, 8]] *= 1.1
    gradient, _ = forces(unloaded, section, length, points)
    pull = section.axial * 0.5 * (1.1**2 - 1.0) * 1.1
    expected = np.zeros(12)
    expected[[0, 6]] = -pull, pull
    np.testing.assert_allclose(gradient, expected, atol=1e-12 * pull)
    energy = element_energy(Ancf(section, gauss_points(points)), unloaded, length)
    assert energy == pytest.approx(section.axial * length / 8.0 * (1.1**2 - 1.0) ** 2)


def test_thickness_carries_its_own_stiffness(unloaded: FloatArray, section: Section, length: float) -> None:
    """A thickened belt pushes on r_y of both nodes alike, with E A to which no factor applies."""
    thick = unloaded.copy()
    thick[[5, 11]] = 1.2
    gradient, _ = forces(thick, section, length)
    expected = np.zeros(12)
    expected[[5, 11]] = 0.5 * section.thickness * length * 0.5 * (1.2**2 - 1.0) * 1.2
    np.testing.assert_allclose(gradient, expected, atol=1e-12 * section.thickness)

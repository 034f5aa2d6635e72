import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.polynomial import Polynomial

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf import element_mass
from beltdyn.elements.ancf.element import bends, slopes
from beltdyn.elements.kind import Section
from beltdyn.quadrature import gauss_points

PLACES = np.linspace(0.0, 1.0, 7)
CUBIC = Polynomial([0.3, -0.7, 11.0, -130.0])


@pytest.mark.parametrize("xi", PLACES)
def test_a_cubic_is_met_exactly(length: float, xi: float) -> None:
    first = CUBIC.deriv()
    vectors = (CUBIC(0.0), first(0.0), CUBIC(length), first(length))
    assert np.dot(slopes(xi, length), vectors) == pytest.approx(first(xi * length), rel=1e-12)
    assert np.dot(bends(xi, length), vectors) == pytest.approx(CUBIC.deriv(2)(xi * length), rel=1e-12)


@pytest.mark.parametrize("xi", PLACES)
def test_a_shift_neither_slopes_nor_bends(length: float, xi: float) -> None:
    for factors in (slopes(xi, length), bends(xi, length)):
        assert factors[0] == -factors[2]


@given(velocity=arrays(np.float64, 12, elements=st.floats(-10.0, 10.0)))
def test_kinetic_energy_is_that_of_the_velocity_field(velocity: FloatArray, section: Section, length: float) -> None:
    """Hermite cubics on the centerline, linear functions on the sections; four Gauss points are exact."""
    xi, weights = gauss_points(4)
    hermite = np.array(
        [
            1.0 - 3.0 * xi**2 + 2.0 * xi**3,
            length * (xi - 2.0 * xi**2 + xi**3),
            3.0 * xi**2 - 2.0 * xi**3,
            length * (xi**3 - xi**2),
        ]
    )
    vectors = velocity.reshape(6, 2)
    centerline = hermite.T @ vectors[[0, 1, 3, 4]]
    section_rate = np.outer(1.0 - xi, vectors[2]) + np.outer(xi, vectors[5])
    density = section.mass * np.sum(centerline**2, axis=1) + section.rotary_inertia * np.sum(section_rate**2, axis=1)
    expected = 0.5 * length * weights @ density
    energy = 0.5 * velocity @ element_mass(section, length) @ velocity
    assert energy == pytest.approx(expected, rel=1e-12, abs=1e-16)  # no differences are taken that cancel

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf.belt_element import element_mass
from beltdyn.elements.kind import Section
from beltdyn.quadrature import gauss_points


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

"""Verified: the constant mass matrix of the belt element (kinetic energy of Eq. 2).

Against: mass, momentum and kinetic energy of a rigid bar of length L and thickness h that moves in its plane.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.arrays import FloatArray
from beltdyn.elements.ancf import element_mass
from beltdyn.model import Belt
from beltdyn.system.state import belt_section

SPEEDS = st.integers(-1000, 1000).map(lambda tenths: 0.1 * tenths)
EXACT = 1e-13  # a dozen roundings


@pytest.fixture(scope="module")
def mass(belt: Belt, element_length: float) -> FloatArray:
    return element_mass(belt_section(belt), element_length)


@given(angle=st.floats(-np.pi, np.pi), speed=st.tuples(SPEEDS, SPEEDS), spin=SPEEDS)
def test_rigid_motion(
    belt: Belt,
    element_length: float,
    unloaded: FloatArray,
    mass: FloatArray,
    angle: float,
    speed: tuple[float, float],
    spin: float,
) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    quarter = np.array([[0.0, -1.0], [1.0, 0.0]])
    vectors = unloaded.reshape(6, 2) @ turn.T
    shift = np.kron([1, 0, 0, 1, 0, 0], np.eye(2)).reshape(2, 6, 2)
    about_origin = vectors @ quarter.T
    velocity = spin * about_origin + np.tensordot(speed, shift, 1)
    momentum = mass @ velocity.ravel()

    total = belt.density * belt.area * element_length
    center = turn @ (element_length / 2.0, 0.0)
    of_center = spin * quarter @ center + speed
    inertia = total * (element_length**2 + belt.thickness**2) / 12.0
    size = total * (np.abs(of_center).max() + np.abs(speed).max() + abs(spin) * element_length)
    fast = np.abs(velocity).max()
    linear = [np.sum(direction * momentum.reshape(6, 2)) for direction in shift]
    np.testing.assert_allclose(linear, total * of_center, rtol=0.0, atol=EXACT * size)
    angular = total * (center[0] * of_center[1] - center[1] * of_center[0]) + inertia * spin
    assert about_origin.ravel() @ momentum == pytest.approx(angular, abs=EXACT * size)
    kinetic = 0.5 * total * of_center @ of_center + 0.5 * inertia * spin**2
    assert 0.5 * velocity.ravel() @ momentum == pytest.approx(kinetic, abs=EXACT * size * fast)


def test_any_motion_has_kinetic_energy(mass: FloatArray) -> None:
    np.testing.assert_array_equal(mass, mass.T)
    assert np.linalg.eigvalsh(mass).min() > 0.0

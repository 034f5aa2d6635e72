"""Lumped masses of pieces against the mass of the belt and the kinetic energy of its motions."""

import numpy as np
import pytest

from beltdyn.chain.chain_force import LINKS
from beltdyn.chain.inertia import lumped_mass

MASS, LENGTH = 0.1, 0.3


def test_masses_of_the_points() -> None:
    link = MASS * LENGTH / LINKS
    points = np.array([0.5, 1.0, 1.0, 0.5, 0.0, 0.0]) * link
    np.testing.assert_allclose(lumped_mass(MASS, LENGTH), np.diag(np.repeat(points, 2)), atol=1e-17)


def test_kinetic_energy_of_a_translation() -> None:
    velocity = np.tile([3.0, -4.0], 6)
    energy = 0.5 * velocity @ lumped_mass(MASS, LENGTH) @ velocity
    assert energy == pytest.approx(0.5 * MASS * LENGTH * 25.0)


def test_points_of_a_ring_have_equal_masses() -> None:
    masses, pieces = np.zeros(4 * LINKS), 4
    for first in range(0, pieces * LINKS, LINKS):
        points = (first + np.arange(6)) % masses.size
        masses[points] += np.diag(lumped_mass(MASS, LENGTH))[::2]
    np.testing.assert_allclose(masses, MASS * LENGTH / LINKS)

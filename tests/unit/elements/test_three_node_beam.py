"""An element of two links: derivatives, rigid motions, and elements put together against sums over a ring of links."""

from collections.abc import Callable
from math import pi
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray, blank
from beltdyn.elements.kind import Section
from beltdyn.elements.three_node_beam import LINKS, THREE_NODE_BEAM, ThreeNodeBeam
from beltdyn.quadrature import gauss_points
from beltdyn.stretch import Green

AXIAL, BENDING = 1e4, 0.02
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5 lengths, relative to the largest entry."""


def section(**values: Any) -> Section:
    return Section(Green(0.0), *[0.0] * 7)._replace(**values)


def element(e: FloatArray, length: float, bending: float = BENDING) -> tuple[float, FloatArray, FloatArray]:
    """Energy, gradient and tangent of an element, of four points."""
    beam, work = (
        ThreeNodeBeam(section(stretch=Green(AXIAL), bending=bending), gauss_points(1)),
        blank(THREE_NODE_BEAM.workspace),
    )
    work.gradient[:], work.tangent[:] = np.nan, np.nan
    THREE_NODE_BEAM.force(beam, e, length, True, work)
    return THREE_NODE_BEAM.energy(beam, e, length), work.gradient, work.tangent


@pytest.fixture
def deformed(deformed: FloatArray) -> FloatArray:
    """The first four points."""
    return deformed[:8].copy()


@pytest.fixture
def straight(straight: FloatArray) -> FloatArray:
    return straight[:8].copy()


@pytest.fixture
def length(link: float) -> float:
    return LINKS * link


@pytest.mark.parametrize("bending", [0.0, BENDING, 50.0])
def test_derivatives(deformed: FloatArray, length: float, slope: Callable[..., FloatArray], bending: float) -> None:
    _, gradient, tangent = element(deformed, length, bending)
    by_differences = slope(lambda e: element(e, length, bending)[0], deformed)
    np.testing.assert_allclose(gradient, by_differences, atol=DIFFERENCES * np.abs(gradient).max())
    by_differences = slope(lambda e: element(e, length, bending)[1], deformed)
    np.testing.assert_allclose(tangent, by_differences, atol=DIFFERENCES * np.abs(tangent).max())


@pytest.mark.parametrize("angle", [0.0, 0.4, pi, -2.0])
def test_rigid_motion(deformed: FloatArray, length: float, angle: float) -> None:
    """Energy stays, forces turn along."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    energy, gradient, _ = element(deformed, length)
    moved = (deformed.reshape(4, 2) @ turn.T + [0.7, -0.3]).ravel()
    energy_moved, gradient_moved, _ = element(moved, length)
    assert energy_moved == pytest.approx(energy, rel=1e-12)
    turned = (gradient.reshape(4, 2) @ turn.T).ravel()
    np.testing.assert_allclose(gradient_moved, turned, atol=1e-11 * np.abs(gradient).max())


def test_forces_balance(deformed: FloatArray, length: float) -> None:
    gradient = element(deformed, length)[1].reshape(4, 2)
    place = deformed.reshape(4, 2)
    size = np.abs(gradient).sum()
    np.testing.assert_allclose(gradient.sum(axis=0), 0.0, atol=1e-14 * size)
    moment = np.sum(place[:, 0] * gradient[:, 1] - place[:, 1] * gradient[:, 0])
    assert moment == pytest.approx(0.0, abs=1e-14 * size)


@pytest.mark.parametrize("bending", [0.0, BENDING])
def test_straight_unstretched_element_is_free_of_force(straight: FloatArray, length: float, bending: float) -> None:
    energy, gradient, tangent = element(straight, length, bending)
    rounding = 1e-14 * AXIAL
    assert energy == pytest.approx(0.0, abs=rounding * length)
    np.testing.assert_allclose(gradient, 0.0, atol=rounding)
    turning = np.stack([-straight[1::2], straight[::2]], axis=1).ravel()
    np.testing.assert_allclose(tangent @ turning, 0.0, atol=rounding)


@pytest.mark.parametrize("elements", [3, 6, 7])
def test_elements_make_a_ring(link: float, elements: int) -> None:
    """A regular polygon of m stretched sides has m times the energy of a side and a spring, every one counted once."""
    sides, stretch = LINKS * elements, 1.05
    turn = 2.0 * pi / sides
    radius = stretch * link / (2.0 * np.sin(turn / 2.0))
    angle = turn * np.arange(sides)
    points = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    total, gradient = 0.0, np.zeros_like(points)
    for first in range(0, sides, LINKS):
        four = (first + np.arange(4)) % sides
        energy, force, _ = element(points[four].ravel(), LINKS * link)
        total += energy
        gradient[four] += force.reshape(4, 2)
    side = AXIAL * link * (stretch**2 - 1.0) ** 2 / 8.0
    assert total == pytest.approx(sides * (side + BENDING / link * turn**2 / 2.0), rel=1e-12)
    pull = AXIAL * (stretch**2 - 1.0) * stretch / 2.0
    outward = 2.0 * pull * np.sin(turn / 2.0) * points / radius
    np.testing.assert_allclose(gradient, outward, atol=1e-12 * AXIAL)  # the springs' forces on equal bends cancel


def test_masses_of_the_points(link: float) -> None:
    """Half of each link at its ends; a translation has the kinetic energy of the belt's mass."""
    mass = THREE_NODE_BEAM.mass(section(mass=0.1), LINKS * link)
    np.testing.assert_allclose(mass, 0.1 * link * np.diag(np.repeat([0.5, 1.0, 0.5, 0.0], 2)), atol=1e-17)
    velocity = np.tile([3.0, -4.0], 4)
    assert 0.5 * velocity @ mass @ velocity == pytest.approx(0.5 * 0.1 * LINKS * link * 25.0)

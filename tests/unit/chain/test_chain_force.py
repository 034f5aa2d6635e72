"""A piece of chain: derivatives, rigid motions, and pieces put together against sums over all links of a ring."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.chain.chain_force import LINKS, chain_energy, chain_force

AXIAL, BENDING = 1e4, 0.02
DIFFERENCES = 1e-8
"""Central differences with a step of 1e-5 lengths, relative to the largest entry."""


def piece(e: FloatArray, length: float, bending: float = BENDING) -> tuple[float, FloatArray, FloatArray]:
    gradient, tangent = np.full(12, np.nan), np.full((12, 12), np.nan)
    chain_force(e, AXIAL, bending, length, gradient, tangent)
    return chain_energy(e, AXIAL, bending, length), gradient, tangent


@pytest.fixture
def length(link: float) -> float:
    return LINKS * link


@pytest.mark.parametrize("bending", [0.0, BENDING, 50.0])
def test_derivatives(deformed: FloatArray, length: float, slope: Callable[..., FloatArray], bending: float) -> None:
    _, gradient, tangent = piece(deformed, length, bending)
    by_differences = slope(lambda e: piece(e, length, bending)[0], deformed)
    np.testing.assert_allclose(gradient, by_differences, atol=DIFFERENCES * np.abs(gradient).max())
    by_differences = slope(lambda e: piece(e, length, bending)[1], deformed)
    np.testing.assert_allclose(tangent, by_differences, atol=DIFFERENCES * np.abs(tangent).max())


@pytest.mark.parametrize("angle", [0.0, 0.4, pi, -2.0])
def test_rigid_motion(deformed: FloatArray, length: float, angle: float) -> None:
    """Energy stays, forces turn along."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    energy, gradient, _ = piece(deformed, length)
    moved = (deformed.reshape(6, 2) @ turn.T + [0.7, -0.3]).ravel()
    energy_moved, gradient_moved, _ = piece(moved, length)
    assert energy_moved == pytest.approx(energy, rel=1e-12)
    turned = (gradient.reshape(6, 2) @ turn.T).ravel()
    np.testing.assert_allclose(gradient_moved, turned, atol=1e-11 * np.abs(gradient).max())


def test_forces_balance(deformed: FloatArray, length: float) -> None:
    gradient = piece(deformed, length)[1].reshape(6, 2)
    place = deformed.reshape(6, 2)
    size = np.abs(gradient).sum()
    np.testing.assert_allclose(gradient.sum(axis=0), 0.0, atol=1e-14 * size)
    moment = np.sum(place[:, 0] * gradient[:, 1] - place[:, 1] * gradient[:, 0])
    assert moment == pytest.approx(0.0, abs=1e-14 * size)


@pytest.mark.parametrize("bending", [0.0, BENDING])
def test_straight_unstretched_piece_is_free_of_force(straight: FloatArray, length: float, bending: float) -> None:
    energy, gradient, tangent = piece(straight, length, bending)
    rounding = 1e-14 * AXIAL
    assert energy == pytest.approx(0.0, abs=rounding * length)
    np.testing.assert_allclose(gradient, 0.0, atol=rounding)
    turning = np.stack([-straight[1::2], straight[::2]], axis=1).ravel()
    np.testing.assert_allclose(tangent @ turning, 0.0, atol=rounding)


def test_truss_does_not_resist_bending(polyline: Callable[..., FloatArray], length: float) -> None:
    bent = polyline(np.array([0.0, 1.0, -0.5, 0.3, 0.4]))
    energy, gradient, _ = piece(bent, length, bending=0.0)
    assert energy == pytest.approx(0.0, abs=1e-14 * AXIAL * length)
    np.testing.assert_allclose(gradient, 0.0, atol=1e-14 * AXIAL)
    assert piece(bent, length)[0] > 1e-3


@pytest.mark.parametrize("pieces", [3, 4, 7])
def test_pieces_make_a_ring(link: float, pieces: int) -> None:
    """A regular polygon of m stretched sides has m times the energy of a side and a spring, every one counted once."""
    sides, stretch = LINKS * pieces, 1.05
    turn = 2.0 * pi / sides
    radius = stretch * link / (2.0 * np.sin(turn / 2.0))
    angle = turn * np.arange(sides)
    points = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    total, gradient = 0.0, np.zeros_like(points)
    for first in range(0, sides, LINKS):
        six = (first + np.arange(6)) % sides
        energy, force, _ = piece(points[six].ravel(), LINKS * link)
        total += energy
        gradient[six] += force.reshape(6, 2)
    side = AXIAL * link * (stretch**2 - 1.0) ** 2 / 8.0
    assert total == pytest.approx(sides * (side + BENDING / link * turn**2 / 2.0), rel=1e-12)
    pull = AXIAL * (stretch**2 - 1.0) * stretch / 2.0
    outward = 2.0 * pull * np.sin(turn / 2.0) * points / radius
    np.testing.assert_allclose(gradient, outward, atol=1e-12 * AXIAL)  # the springs' forces on equal bends cancel

"""The velocity of a belt that flows through a mesh that stays."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.elements.quintic import QUINTIC
from beltdyn.system.frame import Staying, Travelling, add_flow, staying

LENGTH, MASS = 0.3, 0.25


@pytest.fixture
def flow() -> tuple[Staying, FloatArray]:
    frame = staying(QUINTIC.control(LENGTH)[None], np.array([LENGTH]), MASS)
    frame.speed[0] = 7.0
    return frame, np.random.default_rng(3).normal(size=12)


def polynomial(e: FloatArray, length: float) -> FloatArray:
    """Coefficients of the powers of x of both components, from the six vectors."""
    powers = np.arange(6)
    rows = [
        np.where(powers == 0, 1.0, 0.0),
        np.where(powers == 1, 1.0, 0.0),
        np.where(powers == 2, 2.0, 0.0),
        length**powers,
        powers * length ** np.maximum(powers - 1, 0),
        powers * (powers - 1) * length ** np.maximum(powers - 2, 0),
    ]
    return np.linalg.solve(np.array(rows), e.reshape(6, 2))


def test_it_is_the_speed_times_the_derivative_along_the_belt(flow: tuple[Staying, FloatArray]) -> None:
    frame, e = flow
    velocity = np.zeros(12)
    frame.speed[0] = 7.0
    add_flow(frame, 0, QUINTIC.vectors, np.zeros(0), e, velocity)
    slope = np.polynomial.polynomial.polyder(polynomial(e, LENGTH))
    found = polynomial(velocity, LENGTH)
    np.testing.assert_allclose(found[:5], 7.0 * slope, atol=1e-9 * np.abs(slope).max())
    np.testing.assert_allclose(found[5], 0.0, atol=1e-9 * np.abs(slope).max())


def test_momentum_is_the_integral_of_the_squared_slope(flow: tuple[Staying, FloatArray]) -> None:
    frame, e = flow
    slope = np.polynomial.polynomial.polyder(polynomial(e, LENGTH))
    square = sum(np.polynomial.polynomial.polymul(slope[:, axis], slope[:, axis]) for axis in (0, 1))
    integral = np.polynomial.polynomial.polyval(LENGTH, np.polynomial.polynomial.polyint(square))
    vectors = e.reshape(6, 2)
    found = np.einsum("ax,ab,bx->", vectors, frame.inertia[0], vectors)
    assert found == pytest.approx(MASS * integral, rel=1e-10)


def test_a_travelling_mesh_adds_nothing() -> None:
    velocity = np.ones(12)
    add_flow(Travelling(), 0, QUINTIC.vectors, np.zeros(0), np.ones(12), velocity)
    assert np.all(velocity == 1.0)

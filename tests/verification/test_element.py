"""Verified: elastic energy, force and tangent of one belt element (Eqs. 8-16).

Against: invariance under rigid motion, which the energy must have, and finite differences of energy and force.
"""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt

Evaluate = Callable[[Belt, FloatArray], tuple[float, FloatArray, FloatArray]]

ROUNDING = float(np.finfo(float).eps)
DEFORMATIONS = arrays(np.float64, 12, elements=st.floats(-0.2, 0.2))
ANGLES = st.floats(-np.pi, np.pi)
SHIFTS = st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))


@pytest.fixture(scope="module")
def scale(element_length: float) -> FloatArray:
    """Size of the coordinates: m for r, 1 for the gradients."""
    return np.tile([element_length, element_length, 1, 1, 1, 1], 2)


@pytest.fixture(scope="module")
def deform(unloaded: FloatArray, scale: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Coordinates with a deformation of up to 20 %: stretched, bent, sheared, thickened."""
    return lambda deformation: unloaded + scale * deformation


def rotation(angle: float) -> FloatArray:
    """Matrix that turns all six vectors of an element."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.kron(np.eye(6), turn)


def move(e: FloatArray, angle: float, shift: tuple[float, float]) -> FloatArray:
    moved = rotation(angle) @ e
    moved[[0, 6]] += shift[0]
    moved[[1, 7]] += shift[1]
    return moved


@given(angle=ANGLES, shift=SHIFTS)
def test_rigid_motion_gives_neither_energy_nor_force(
    evaluate: Evaluate,
    belt: Belt,
    unloaded: FloatArray,
    scale: FloatArray,
    element_length: float,
    angle: float,
    shift: tuple[float, float],
) -> None:
    energy, force, _ = evaluate(belt, move(unloaded, angle, shift))
    # Places far from the origin are rounded to ROUNDING * 10 m, which the element takes for strain.
    strain = 10.0 * ROUNDING * (1.0 + np.abs(shift).max() / element_length)
    stiffness = belt.youngs_modulus * belt.area
    assert energy <= stiffness * element_length * strain**2
    assert np.abs(force * scale).max() <= stiffness * element_length * strain


@given(deformation=DEFORMATIONS)
def test_force_and_tangent_are_derivatives(
    evaluate: Evaluate,
    belt: Belt,
    deform: Callable[[FloatArray], FloatArray],
    scale: FloatArray,
    deformation: FloatArray,
) -> None:
    """Central differences of fourth order; a step of 1e-3 leaves some 1e-12 of truncation and of rounding."""
    _, force, tangent = evaluate(belt, deform(deformation))
    force, tangent = scale * force, np.outer(scale, scale) * tangent
    for column in range(12):
        step = 1e-3 * np.eye(12)[column]
        near, far = ([evaluate(belt, deform(deformation + sign * k * step)) for sign in (1.0, -1.0)] for k in (1, 2))
        by_energy = (8.0 * (near[0][0] - near[1][0]) - (far[0][0] - far[1][0])) / 12e-3
        by_force = scale * (8.0 * (near[0][1] - near[1][1]) - (far[0][1] - far[1][1])) / 12e-3
        assert force[column] == pytest.approx(by_energy, abs=1e-7 * np.abs(tangent).max())
        np.testing.assert_allclose(tangent[:, column], by_force, rtol=0.0, atol=1e-7 * np.abs(tangent).max())


@given(deformation=DEFORMATIONS)
def test_tangent_is_symmetric(
    evaluate: Evaluate, belt: Belt, deform: Callable[[FloatArray], FloatArray], deformation: FloatArray
) -> None:
    tangent = evaluate(belt, deform(deformation))[2]
    np.testing.assert_allclose(tangent, tangent.T, rtol=0.0, atol=100.0 * ROUNDING * np.abs(tangent).max())


@given(deformation=DEFORMATIONS, angle=ANGLES, shift=SHIFTS)
def test_a_moved_observer_sees_the_same(
    evaluate: Evaluate,
    belt: Belt,
    deform: Callable[[FloatArray], FloatArray],
    scale: FloatArray,
    deformation: FloatArray,
    angle: float,
    shift: tuple[float, float],
) -> None:
    """What a shift rounds away is a strain of up to 1e-13; its effect is bounded by the tangent."""
    e, turn = deform(deformation), rotation(angle)
    energy, force, tangent = evaluate(belt, e)
    moved = evaluate(belt, move(e, angle, shift))
    outer = np.outer(scale, scale)
    stiffness = np.abs(outer * tangent).max()
    assert moved[0] == pytest.approx(energy, abs=1e-12 * stiffness)
    np.testing.assert_allclose(scale * moved[1], scale * (turn @ force), rtol=0.0, atol=1e-11 * stiffness)
    np.testing.assert_allclose(outer * moved[2], outer * (turn @ tangent @ turn.T), rtol=0.0, atol=1e-11 * stiffness)

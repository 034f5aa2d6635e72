"""Verified: the stiffness of a belt element at small strain, and the factors alpha1 and alpha2 on it (Eqs. 14, 15).

Against: E A alpha1, E I alpha2 and k_s G A alpha2 of the linear theory of beams.
"""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.model import Belt

Stiffness = Callable[[Belt], float]
SMALL = 1e-4  # strain; the next order adds 1.5 SMALL
FACTORS = [1e-3, 1e-2, 1.0, 30.0]


@pytest.fixture
def stretch(evaluate: Callable[..., tuple[float, ...]], unloaded: FloatArray, element_length: float) -> Stiffness:
    """Axial stiffness, from the energy of a uniform stretch."""
    e = unloaded.copy()
    e[[2, 6, 8]] *= 1.0 + SMALL
    return lambda belt: evaluate(belt, e)[0] / (0.5 * SMALL**2 * element_length)


@pytest.fixture
def bend(evaluate: Callable[..., tuple[float, ...]], unloaded: FloatArray, element_length: float) -> Stiffness:
    """Bending stiffness, from the energy of an arc whose angle is 100 SMALL, section across the tangent."""
    e, angle = unloaded.copy(), 100.0 * SMALL
    radius = element_length / angle
    e[6:] = (
        *(radius * np.sin(angle), radius * (1.0 - np.cos(angle))),
        *(np.cos(angle), np.sin(angle)),
        *(-np.sin(angle), np.cos(angle)),
    )
    return lambda belt: evaluate(belt, e)[0] / (0.5 * (angle / element_length) ** 2 * element_length)


@pytest.fixture
def shear(evaluate: Callable[..., tuple[float, ...]], unloaded: FloatArray, element_length: float) -> Stiffness:
    """Shear stiffness, from the energy of sections that lean by SMALL against a straight centerline."""
    e = unloaded.copy()
    e[[4, 10]], e[[5, 11]] = -np.sin(SMALL), np.cos(SMALL)
    return lambda belt: evaluate(belt, e)[0] / (0.5 * SMALL**2 * element_length)


@pytest.mark.parametrize("alpha1", FACTORS)
@pytest.mark.parametrize("alpha2", FACTORS)
def test_stiffness(
    belt: Belt,
    stretch: Stiffness,
    bend: Stiffness,
    shear: Stiffness,
    measured: Callable[..., None],
    alpha1: float,
    alpha2: float,
) -> None:
    changed = belt.replace(axial_factor=alpha1, bending_factor=alpha2)
    ratios = {
        "EA": stretch(changed) / (belt.youngs_modulus * belt.area * alpha1),
        "EI": bend(changed) / (belt.youngs_modulus * belt.second_moment * alpha2),
        "kGA": shear(changed) / changed.shear_stiffness,
    }
    measured(**{name: ratio - 1.0 for name, ratio in ratios.items()})
    assert ratios == pytest.approx(dict.fromkeys(ratios, 1.0), rel=1e-3)


@pytest.mark.parametrize("factor", FACTORS)
def test_each_factor_acts_on_its_own_terms_and_linearly(
    belt: Belt, stretch: Stiffness, bend: Stiffness, shear: Stiffness, factor: float
) -> None:
    """To rounding: a straight stretch holds no bending, and leaning sections no stretch."""
    whole = belt.replace(axial_factor=1.0, bending_factor=1.0)
    assert stretch(whole.replace(axial_factor=factor)) == pytest.approx(factor * stretch(whole), rel=1e-12)
    assert stretch(whole.replace(bending_factor=factor)) == pytest.approx(stretch(whole), rel=1e-12)
    assert shear(whole.replace(bending_factor=factor)) == pytest.approx(factor * shear(whole), rel=1e-12)
    assert shear(whole.replace(axial_factor=factor)) == pytest.approx(shear(whole), rel=1e-12)
    # The arc's cubic is 1e-11 longer in places than the arc, which alpha1 feels.
    assert bend(whole.replace(bending_factor=factor)) == pytest.approx(factor * bend(whole), rel=1e-6)
    assert bend(whole.replace(axial_factor=factor)) == pytest.approx(bend(whole), rel=1e-6)

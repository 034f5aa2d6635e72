"""An arm: what of its motion lengthens the path, its inertia about the pivot and its weight."""

from math import pi

import numpy as np
import pytest

from beltdyn.machines.tensioners import tensioner_center, tensioner_row
from beltdyn.model import RotaryTensioner

PIVOT = np.array([0.1, 0.1])
CENTER = np.array([0.4, 0.5])
"""The arm is 0.5 m long, along (0.6, 0.8); turned counter-clockwise its end moves along (-0.8, 0.6)."""
ARM = RotaryTensioner(
    kind="rotary", pulley="idler", pivot=(0.1, 0.1), inertia=0.3, mass=0.8, center_of_mass=0.4, preload=5.0
)


@pytest.mark.parametrize("gradient", [(1.0, 0.0), (0.0, 1.0), (1.5, -0.5)])
def test_the_path_grows_by_the_part_of_its_gradient_across_the_arm(gradient: tuple[float, float]) -> None:
    x, y = gradient
    assert ARM.leverage(CENTER, np.array(gradient)) == pytest.approx(-0.8 * x + 0.6 * y, rel=1e-15)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_coordinate_turns_the_arm_the_way_that_lengthens_the_path(side: float) -> None:
    gradient = side * np.array([-0.4, 0.3])
    values = ARM.values(CENTER, gradient)
    assert values["sense"] == side
    assert values["length"] == pytest.approx(0.5, rel=1e-15)
    row = tensioner_row(ARM, 3, CENTER, gradient)
    at = tensioner_center(row, 0.2)
    angle = np.arctan2(at.y - PIVOT[1], at.x - PIVOT[0])
    assert angle == pytest.approx(np.arctan2(0.8, 0.6) + side * 0.2, rel=1e-14)
    assert row.pulley == 3
    assert gradient @ (at.dx, at.dy) > 0.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_arm_that_hardly_lengthens_the_path_is_refused(side: float) -> None:
    """As one that points along the bisector of the spans does; a thousandth of its motion is the least."""
    along, across = np.array([0.6, 0.8]), side * np.array([-0.8, 0.6])
    for part in (0.0, 0.5e-3):
        with pytest.raises(ValueError, match=r"its rotation hardly changes the length of the path\. Move its pivot"):
            ARM.leverage(CENTER, along + part * across)
    assert ARM.leverage(CENTER, along + 1.5e-3 * across) == pytest.approx(side * 1.5e-3, rel=1e-12)


def test_an_arm_without_length_is_refused() -> None:
    with pytest.raises(ValueError, match='the pivot of the tensioner of "idler" is the center of the pulley'):
        ARM.leverage(PIVOT, np.array([1.0, 0.0]))


def test_inertia_about_the_pivot() -> None:
    """The pulley counts as a point mass at the end of the arm (Steiner)."""
    assert ARM.moved_inertia(CENTER, 1.5) == pytest.approx(0.3 + 1.5 * 0.25, rel=1e-15)


def test_a_mass_at_the_end_weighs_about_the_pivot_as_arm_and_pulley_do() -> None:
    moment = 1.5 * 9.81 * ARM.reach(CENTER) + 0.8 * 9.81 * 0.4 * ARM.reach(CENTER)
    assert ARM.weighing_mass(1.5) * 9.81 * ARM.reach(CENTER) == pytest.approx(moment, rel=1e-15)


def test_an_arm_has_a_pivot_and_its_coordinate_is_an_angle() -> None:
    assert ARM.anchor == (0.1, 0.1)
    assert ARM.turns
    assert ARM.written(pi / 8) == "22.5°"

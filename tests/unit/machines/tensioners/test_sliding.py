"""A slide: what of its motion lengthens the path, its inertia and its weight."""

import numpy as np
import pytest

from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE
from beltdyn.model import SlidingTensioner

SLIDE = SlidingTensioner(kind="sliding", pulley="idler", direction=(3.0, 4.0), mass=2.0, preload=20.0)
CENTER = np.array([0.3, -0.2])


@pytest.mark.parametrize("gradient", [(1.0, 0.0), (0.0, 1.0), (1.5, -0.5)])
def test_the_path_grows_by_the_part_of_its_gradient_along_the_slide(gradient: tuple[float, float]) -> None:
    x, y = gradient
    assert SLIDE.leverage(CENTER, np.array(gradient)) == pytest.approx(0.6 * x + 0.8 * y, rel=1e-15)


@pytest.mark.parametrize("part", [0.5, 0.0, -1.5, -1e3])
def test_a_slide_that_hardly_lengthens_the_path_is_refused(part: float) -> None:
    """So is one that shortens it; a thousandth of its motion is the least."""
    assert LEAST_LEVERAGE == 1e-3
    gradient = part * 1e-3 * np.array([0.6, 0.8])
    with pytest.raises(ValueError, match=f"lengthens the path by {part * 1e-3:.3g} m. Choose a direction"):
        SLIDE.values(CENTER, gradient)


@pytest.mark.parametrize("part", [1.0 + 1e-9, 1.5])
def test_a_slide_that_lengthens_it_a_little_is_taken(part: float) -> None:
    gradient = part * 1e-3 * np.array([0.6, 0.8])
    assert SLIDE.leverage(CENTER, gradient) == pytest.approx(part * 1e-3, rel=1e-12)
    np.testing.assert_array_equal(SLIDE.values(CENTER, gradient)["center"], CENTER)


def test_pulley_and_slide_move_and_weigh_as_one() -> None:
    """m a = F and m g = F, with the mass of both."""
    assert SLIDE.moved_inertia(CENTER, 1.5) == SLIDE.weighing_mass(1.5) == 3.5
    assert SLIDE.reach(CENTER) == 1.0


def test_a_slide_has_no_pivot_and_its_coordinate_is_a_length() -> None:
    assert SLIDE.anchor is None
    assert not SLIDE.turns
    assert SLIDE.written(0.01234567) == "0.01235 m"

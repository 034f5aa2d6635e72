import numpy as np
import pytest

from beltdyn.model import Path
from beltdyn.model.path import Obstacle, Surroundings, crossings, distance_from_belt, obstacle


def path(*circles: tuple[float, float, float]) -> Path:
    table = np.array(circles)
    return Path(table[:, :2], table[:, 2])


def around(laid: Path, offset: float = 0.0) -> Surroundings:
    return Surroundings(np.abs(laid.radii) - offset, offset, offset)


def test_open_belt_does_not_cross() -> None:
    assert crossings(path((0, 0, 0.1), (0.5, 0, 0.05))) == []


def test_crossed_belt_crosses_once() -> None:
    assert crossings(path((0, 0, 0.1), (0.5, 0, -0.1))) == [(0, 1)]


def test_a_loop_around_a_pulley_that_the_belt_misses() -> None:
    laid = path((0, 0, 0.1), (0.5, 0.4, 0.05), (1, 0, 0.1), (0.5, 1, 0.1))
    assert crossings(laid) == [(0, 1)]
    assert laid.total_turning == pytest.approx(4 * np.pi)


def test_free_way() -> None:
    laid = path((0, 0, 0.1), (0.25, -0.05, -0.04), (0.8, 0, 0.2))
    assert obstacle(laid, around(laid)) is None


def test_span_through_a_pulley() -> None:
    laid = path((-3, -0.5, 0.1), (0, 0, 1), (3, -0.5, 0.1))
    assert obstacle(laid, around(laid)) == Obstacle("span", 2, 1)


@pytest.mark.parametrize(("gap", "found"), [(1.01, None), (0.99, Obstacle("span", 2, 1))])
def test_belt_needs_room_on_its_side_and_on_the_pulley(gap: float, found: Obstacle | None) -> None:
    """An idler on the back of the lower span comes near the upper one, whose inside faces its free side."""
    offset, radius = 0.01, 0.03
    center = 0.1 - gap * (radius + 3 * offset)
    laid = path((0, 0, 0.1), (0.5, center, -(radius + offset)), (1, 0, 0.1))
    assert obstacle(laid, around(laid, offset)) == found


@pytest.mark.parametrize(("gap", "found"), [(1.01, None), (0.99, Obstacle("arc", 1, 3))])
def test_belt_on_one_pulley_and_on_another(gap: float, found: Obstacle | None) -> None:
    """Two idlers press the spans towards each other: both offsets count on both."""
    offset, radius = 0.01, 0.05
    half = gap * (radius + 2 * offset)
    laid = path((-0.5, 0, 0.2), (0, -half, -(radius + offset)), (0.5, 0, 0.2), (0, half, -(radius + offset)))
    assert obstacle(laid, around(laid, offset)) == found


@pytest.mark.parametrize(
    ("center", "distance"),
    [
        ((0.5, 0.2), 0.2 - 0.1 - 0.003),  # over the upper span, beside its back
        ((0.5, 0.05), 0.1 - 0.05 - 0.002),  # below it, beside its inside
        ((-0.3, 0.0), 0.3 - 0.1 - 0.003),  # behind the first pulley
    ],
)
def test_distance_of_a_part_from_the_belt(center: tuple[float, float], distance: float) -> None:
    laid = path((0, 0, 0.1), (1, 0, 0.1))
    surroundings = Surroundings(np.array([0.09, 0.09]), inside=0.002, back=0.003)
    assert distance_from_belt(laid, surroundings, center, 0.01) == pytest.approx(distance - 0.01)

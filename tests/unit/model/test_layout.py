import pytest

from beltdyn.model import Pulley
from beltdyn.model.layout import lay_path

Circle = tuple[str, float, float, float]


def pulleys(*circles: Circle) -> list[Pulley]:
    return [Pulley(name=name, center=(x, y), radius=radius, inertia=1) for name, x, y, radius in circles]


A: Circle = ("a", 0, 0, 0.1)
B: Circle = ("b", 1, 0, 0.1)
C: Circle = ("c", 1, 1, 0.1)
D: Circle = ("d", 0, 1, 0.1)


def test_counter_clockwise_order_is_accepted_from_any_start() -> None:
    lengths = [lay_path(pulleys(*order)).length for order in ((A, B, C, D), (C, D, A, B))]
    assert lengths[0] == pytest.approx(lengths[1])


def test_two_pulleys_have_no_wrong_order() -> None:
    assert lay_path(pulleys(A, B)).length == pytest.approx(lay_path(pulleys(B, A)).length)


@pytest.mark.parametrize("order", [(A, D, C, B), (A, C, B, D), (A, B, D, C)])
def test_wrong_order_tells_the_right_one(order: tuple[Circle, ...]) -> None:
    with pytest.raises(ValueError, match='List them so: "a", "b", "c", "d"'):
        lay_path(pulleys(*order))


@pytest.mark.parametrize("position", [0, 1, 2, 3, 4])
def test_pulley_inside(position: int) -> None:
    circles = [A, B, C, D]
    circles.insert(position, ("e", 0.5, 0.4, 0.1))
    with pytest.raises(ValueError, match='pulley "e" is not touched'):
        lay_path(pulleys(*circles))


def test_pulley_that_a_span_only_grazes() -> None:
    with pytest.raises(ValueError, match='pulley "e" is not touched'):
        lay_path(pulleys(A, ("e", 0.5, 0, 0.1), B, C, D))


def test_large_pulley_that_a_span_would_cut() -> None:
    with pytest.raises(ValueError, match='between "right" and "left" would run through pulley "large"'):
        lay_path(pulleys(("left", -3, -0.5, 0.1), ("large", 0, 0, 1), ("right", 3, -0.5, 0.1)))


@pytest.mark.parametrize("distance", [0.0, 0.1, 0.2])
def test_overlapping_pulleys(distance: float) -> None:
    with pytest.raises(ValueError, match='"a" and "b" overlap'):
        lay_path(pulleys(A, ("b", distance, 0, 0.1)))


def test_one_pulley() -> None:
    with pytest.raises(ValueError, match="needs two or more"):
        lay_path(pulleys(A))

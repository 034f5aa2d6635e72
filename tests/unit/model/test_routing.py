import numpy as np
import pytest

from beltdyn.model import Belt, Pulley
from beltdyn.model.path import Path
from beltdyn.model.routing import lay_path as lay

Circle = tuple[str, float, float, float]


def pulleys(*circles: Circle) -> list[Pulley]:
    return [Pulley(name=name, center=(x, y), radius=radius, inertia=1) for name, x, y, radius in circles]


BELT = Belt(length=1, width=0.02, thickness=0.005, density=1000, youngs_modulus=1e8, poissons_ratio=0.3)


def lay_path(listed: list[Pulley], **changes: float | bool) -> Path:
    return lay(listed, BELT.replace(**changes))


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
    with pytest.raises(ValueError, match='List them as "a", "b", "c", "d"'):
        lay_path(pulleys(*order))


@pytest.mark.parametrize("position", [0, 1, 2, 3, 4])
def test_pulley_inside(position: int) -> None:
    circles = [A, B, C, D]
    circles.insert(position, ("e", 0.5, 0.4, 0.1))
    with pytest.raises(ValueError, match='does not touch pulley "e"'):
        lay_path(pulleys(*circles))


def test_pulley_that_a_span_only_grazes() -> None:
    with pytest.raises(ValueError, match='does not touch pulley "e"'):
        lay_path(pulleys(A, ("e", 0.5, 0, 0.1), B, C, D))


def test_large_pulley_that_a_span_would_cut() -> None:
    with pytest.raises(ValueError, match='between "right" and "left" would run through pulley "large"'):
        lay_path(pulleys(("left", -3, -0.5, 0.1), ("large", 0, 0, 1), ("right", 3, -0.5, 0.1)))


@pytest.mark.parametrize("distance", [0.0, 0.1, 0.2])
def test_overlapping_pulleys(distance: float) -> None:
    with pytest.raises(ValueError, match='"a" and "b" overlap'):
        lay_path(pulleys(A, ("b", distance, 0, 0.1)))


def test_one_pulley() -> None:
    with pytest.raises(ValueError, match="needs at least two"):
        lay_path(pulleys(A))


def sided(*circles: tuple[str, float, float, float, str]) -> list[Pulley]:
    return [Pulley(name=name, center=(x, y), radius=r, side=side, inertia=1) for name, x, y, r, side in circles]


LEFT, RIGHT = ("left", 0.0, 0.0, 0.1, "inside"), ("right", 1.0, 0.0, 0.1, "inside")
BACK = ("idler", 0.5, -0.1, 0.05, "outside")


def test_idler_on_the_back() -> None:
    path = lay_path(sided(LEFT, BACK, RIGHT))
    assert path.total_turning == pytest.approx(2 * np.pi)
    np.testing.assert_array_equal(path.radii, [0.1, -0.05, 0.1])


def test_offsets_add_to_the_radii_of_their_side() -> None:
    path = lay_path(sided(LEFT, BACK, RIGHT), pitch_offset=0.002, back_offset=0.003)
    np.testing.assert_allclose(path.radii, [0.102, -0.053, 0.102], rtol=1e-15)


def test_crossed() -> None:
    path = lay_path(sided(LEFT, ("right", 1.0, 0.0, 0.1, "outside")), crossed=True)
    assert path.total_turning == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize(
    ("circles", "belt", "words"),
    [
        pytest.param(
            (LEFT, ("idler", 0.24, -0.1, 0.155, "outside"), RIGHT),
            {"pitch_offset": 0.005, "back_offset": 0.005},
            ('between "left" and "idler"', "above 0.265 m", "it is 0.26 m", "Move them apart"),
            id="no tangent",
        ),
        pytest.param(
            (LEFT, ("right", 1.0, 0.0, 0.1, "outside")),
            {},
            ("would cross itself", '"left" to "right"', 'Set side = "inside" for "right"', "belt.crossed = true"),
            id="crossing",
        ),
        pytest.param(
            (LEFT, RIGHT), {"crossed": True}, ("no spans cross", 'side = "outside"'), id="crossed without crossing"
        ),
        pytest.param(
            (LEFT, ("idler", 0.5, -0.3, 0.05, "outside"), RIGHT),
            {},
            ("would cross itself", 'Set side = "inside" for "idler"', 'move "idler" against the back of the belt'),
            id="idler out of reach",
        ),
        pytest.param(
            (LEFT, RIGHT, BACK),
            {},
            ("would cross itself", 'List the pulleys as "left", "idler", "right"'),
            id="idler in the wrong span",
        ),
        pytest.param(
            (("left", 0.0, 0.0, 0.1, "outside"), ("right", 1.0, 0.0, 0.1, "outside")),
            {},
            ("-1 times counter-clockwise", "not once", "Check the order and the sides"),
            id="all on the back",
        ),
        pytest.param(
            (LEFT, ("idler", 0.5, -0.15, 0.05, "outside"), RIGHT),
            {},
            ('does not touch pulley "idler"', "Move it inwards"),
            id="idler that a span only grazes",
        ),
        pytest.param(
            (LEFT, BACK, RIGHT, ("guide", 0.5, 0.0, 0.045, "outside")),
            {"pitch_offset": 0.005},
            ('the belt on "idler" would run through pulley "guide"', "Move them apart"),
            id="idlers too close for the belt between them",
        ),
    ],
)
def test_layouts_that_no_belt_can_take(
    circles: tuple[tuple[str, float, float, float, str], ...], belt: dict[str, float | bool], words: tuple[str, ...]
) -> None:
    with pytest.raises(ValueError, match="belt") as caught:
        lay_path(sided(*circles), **belt)
    for part in words:
        assert part in str(caught.value)


def test_reversed_serpentine_is_told_its_order() -> None:
    top = ("top", 0.5, 0.5, 0.1, "inside")
    with pytest.raises(ValueError, match='List the pulleys as "left", "idler", "right", "top"'):
        lay_path(sided(LEFT, top, RIGHT, BACK))

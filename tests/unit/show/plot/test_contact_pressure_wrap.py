import numpy as np
import pytest

from beltdyn.show.plot.contact_pressure import unwrap

BELT = np.linspace(0.5, 9.5, 10)
LENGTH = 10.0


def _touching(*points: int) -> np.ndarray:
    return np.isin(np.arange(10), points)


def test_part_in_the_middle() -> None:
    wrap = unwrap(BELT, _touching(3, 4, 5), LENGTH, speed=1.0)
    assert wrap.points.tolist() == [3, 4, 5]
    assert wrap.distance.tolist() == [0.0, 1.0, 2.0]


def test_part_across_the_joint_is_contiguous() -> None:
    wrap = unwrap(BELT, _touching(8, 9, 0, 1), LENGTH, speed=1.0)
    assert wrap.points.tolist() == [8, 9, 0, 1]
    assert wrap.distance == pytest.approx([0.0, 1.0, 2.0, 3.0])


def test_free_points_between_touching_ones_are_kept() -> None:
    assert unwrap(BELT, _touching(9, 2), LENGTH, speed=1.0).points.tolist() == [9, 0, 1, 2]


def test_clockwise_motion_enters_at_the_other_end() -> None:
    wrap = unwrap(BELT, _touching(8, 9, 0), LENGTH, speed=-1.0)
    assert wrap.points.tolist() == [0, 9, 8]
    assert wrap.distance == pytest.approx([0.0, 1.0, 2.0])


def test_single_point() -> None:
    wrap = unwrap(BELT, _touching(7), LENGTH, speed=1.0)
    assert (wrap.points.tolist(), wrap.distance.tolist()) == ([7], [0.0])


def test_whole_belt() -> None:
    assert len(unwrap(BELT, np.ones(10, dtype=bool), LENGTH, speed=1.0).points) == 10


def test_nothing_touches() -> None:
    wrap = unwrap(BELT, _touching(), LENGTH, speed=1.0)
    assert wrap.points.size == wrap.distance.size == 0

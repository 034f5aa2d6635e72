"""The order in which the points of a table are found."""

from beltdyn.solve.steady_running.operating_points import serpentine


def test_each_point_is_next_to_the_one_before() -> None:
    assert list(serpentine((2, 3))) == [(0, 0), (0, 1), (0, 2), (1, 2), (1, 1), (1, 0)]
    assert list(serpentine((3,))) == [(0,), (1,), (2,)]

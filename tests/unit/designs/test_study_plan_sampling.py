"""Points in the unit cube: each method covers it as it should."""

import numpy as np
import pytest

from beltdyn.designs.study_plan import combinations, one_at_a_time, unit_points


@pytest.mark.parametrize("sampling", ["latin_hypercube", "sobol", "saltelli"])
def test_the_seed_makes_the_points(sampling: str) -> None:
    points = unit_points(sampling, 3, 16, 5)
    assert np.array_equal(points, unit_points(sampling, 3, 16, 5))
    assert not np.array_equal(points, unit_points(sampling, 3, 16, 6))
    assert points.min() >= 0.0
    assert points.max() <= 1.0


def test_a_latin_hypercube_has_one_point_in_each_slice() -> None:
    points = unit_points("latin_hypercube", 4, 20, 0)
    assert all(sorted((20 * column).astype(int)) == list(range(20)) for column in points.T)


def test_more_points_of_sobol_begin_with_the_same() -> None:
    assert np.array_equal(unit_points("sobol", 3, 64, 1)[:32], unit_points("sobol", 3, 32, 1))


def test_saltellis_design_takes_each_column_of_a_from_b() -> None:
    first, second, *mixed = unit_points("saltelli", 3, 8, 0).reshape(5, 8, 3)
    for column, one in enumerate(mixed):
        assert np.array_equal(one[:, column], second[:, column])
        others = [k for k in range(3) if k != column]
        assert np.array_equal(one[:, others], first[:, others])


def test_combinations_change_the_last_number_first() -> None:
    found = combinations([np.array([1, 2], dtype=object), np.array(["a", "b"], dtype=object)])
    assert found.tolist() == [[1, "a"], [1, "b"], [2, "a"], [2, "b"]]


def test_one_at_a_time_holds_the_base_once() -> None:
    found = one_at_a_time([np.array([1, 2, 3], dtype=object), np.array([5, 6], dtype=object)], [2, 5])
    assert found.tolist() == [[2, 5], [1, 5], [3, 5], [2, 6]]

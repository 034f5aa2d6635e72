"""Rainflow counting, by the example of ASTM E1049-85 and by histories whose cycles are known."""

from collections import Counter

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.results.damage import Cycles, rainflow, rainflow_of_turn, turning_points

EXAMPLE = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
"""Fig. 6 of the standard."""
histories = st.lists(st.integers(-20, 20), min_size=1, max_size=30).map(lambda values: np.array(values, dtype=float))


def counts(cycles: Cycles) -> dict[float, float]:
    """Number of cycles of each range."""
    found = Counter[float]()
    for size, number in zip(cycles.range.tolist(), cycles.number.tolist(), strict=True):
        found[size] += number
    return dict(found)


def test_the_example_of_the_standard() -> None:
    assert counts(rainflow(EXAMPLE)) == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}


def test_points_on_the_way_change_nothing() -> None:
    fine = np.interp(np.linspace(0, len(EXAMPLE) - 1, 10 * (len(EXAMPLE) - 1) + 1), np.arange(len(EXAMPLE)), EXAMPLE)
    held = np.repeat(EXAMPLE, 3)
    assert counts(rainflow(fine)) == counts(rainflow(held)) == counts(rainflow(EXAMPLE))
    np.testing.assert_array_equal(turning_points(held), 3 * np.arange(len(EXAMPLE)))


def test_constant_amplitude() -> None:
    wave = np.tile([10.0, 2.0], 100)
    cycles = rainflow_of_turn(wave)
    assert counts(cycles) == {8.0: 100.0}
    np.testing.assert_array_equal(cycles.low, 2.0)
    np.testing.assert_array_equal(cycles.high, 10.0)


def test_places_of_the_peaks() -> None:
    """A small cycle on the flank of a large one: each belongs to its own peak."""
    cycles = rainflow_of_turn(np.array([0.0, 4.0, 3.0, 9.0]))
    assert counts(cycles) == {1.0: 1.0, 9.0: 1.0}
    assert set(zip(cycles.range.tolist(), cycles.at.tolist(), strict=True)) == {(1.0, 1), (9.0, 3)}


def test_small_cycles_are_left_out() -> None:
    cycles = rainflow_of_turn(np.array([0.0, 4.0, 3.0, 9.0]))
    assert counts(cycles.above(0.2)) == {9.0: 1.0}


@pytest.mark.parametrize("history", [[], [1.0], [2.0, 2.0, 2.0]])
def test_without_a_turn_there_is_no_cycle(history: list[float]) -> None:
    assert rainflow(np.array(history)).number.size == rainflow_of_turn(np.array(history)).number.sum() == 0


@given(histories)
def test_a_turn_has_a_whole_cycle_for_each_peak(history: np.ndarray) -> None:
    """Wherever a repeating history begins, the cycles are the same, whole, and as many as peaks."""
    cycles = rainflow_of_turn(history)
    closed = np.append(history, history[0])
    way = np.abs(np.diff(closed)).sum()
    assert 2.0 * (cycles.range * cycles.number).sum() == pytest.approx(way)
    for shift in range(len(history)):
        assert counts(rainflow_of_turn(np.roll(history, shift))) == counts(cycles)
    np.testing.assert_array_equal(history[cycles.at], cycles.high)


@given(histories)
def test_the_whole_way_is_counted(history: np.ndarray) -> None:
    cycles = rainflow(history)
    assert 2.0 * (cycles.range * cycles.number).sum() == pytest.approx(np.abs(np.diff(history)).sum())

"""Output instants: multiples of an interval and the end, counted and found without a list of them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.model.simulation import Instants


def listed(instants: Instants) -> np.ndarray:
    return instants[np.arange(instants.count)]


@pytest.mark.parametrize(
    ("interval", "end", "expected"),
    [
        (0.1, 0.3, [0.0, 0.1, 0.2, 0.3]),  # three tenths are a little less than 0.3 as numbers
        (0.1, 0.35, [0.0, 0.1, 0.2, 0.3, 0.35]),
        (0.1, 0.1, [0.0, 0.1]),
        (0.7, 0.7 * 3, [0.0, 0.7, 1.4, 2.1]),
        (1.0, 2.0 + 1e-10, [0.0, 1.0, 2.0 + 1e-10]),  # one that is nearer to the end than a billionth of it is the end
        (1.0, 2.0 + 1e-6, [0.0, 1.0, 2.0, 2.000001]),
    ],
)
def test_multiples_and_the_end(interval: float, end: float, expected: list[float]) -> None:
    assert listed(Instants(interval, end)) == pytest.approx(expected, rel=1e-12, abs=1e-15)
    assert listed(Instants(interval, end))[-1] == end


def test_instants_from_a_beginning_on() -> None:
    instants = Instants(0.1, 2.35, begin=2.0)
    assert listed(instants) == pytest.approx([2.0, 2.1, 2.2, 2.3, 2.35])
    np.testing.assert_array_equal(instants.counts_until(listed(instants)), np.arange(1, 6))
    assert instants.until(1.99) == 0


@given(number=st.integers(1, 10**6), interval=st.floats(1e-6, 1.0))
def test_whole_multiples_have_no_short_interval_at_the_end(number: int, interval: float) -> None:
    instants = Instants(interval, number * interval)
    assert instants.count == number + 1
    assert instants[np.array([0, number])].tolist() == [0.0, number * interval]


@given(interval=st.floats(0.01, 2.0), end=st.floats(2.0, 10.0), stride=st.integers(1, 7))
def test_instants_ascend_and_fields_are_every_few_of_them_and_the_last(
    interval: float, end: float, stride: int
) -> None:
    instants = Instants(interval, end, stride)
    numbers = np.arange(instants.count)
    assert np.all(np.diff(listed(instants)) > 0.0)
    fields = instants.has_fields(numbers)
    assert np.count_nonzero(fields) == instants.fields
    assert fields[0]
    assert fields[-1]
    assert np.all(np.diff(numbers[fields])[:-1] == stride)


@given(interval=st.floats(0.01, 2.0), end=st.floats(2.0, 10.0), time=st.floats(-1.0, 11.0))
def test_how_many_lie_before_a_time(interval: float, end: float, time: float) -> None:
    instants = Instants(interval, end)
    assert instants.until(time) == pytest.approx(np.count_nonzero(listed(instants) <= time + 1e-11), abs=0)


def test_an_instant_lies_on_itself() -> None:
    instants = Instants(0.1, 0.35)
    np.testing.assert_array_equal(instants.counts_until(listed(instants)), np.arange(1, instants.count + 1))
    assert instants.until(0.35 - 1e-9) == instants.count - 1

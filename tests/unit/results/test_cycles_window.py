"""Means over cycles: what repeats drops out, and straight lines are exact however they are recorded."""

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.results.cycles import Cycle, Window, plain_window

UNEVEN = np.array([0.0, 0.1, 0.15, 0.4, 0.7, 0.75, 1.0])


def recorded(**values: FloatArray) -> xr.Dataset:
    return xr.Dataset({name: (("time", "pulley")[: value.ndim], value) for name, value in values.items()})


def sine_window(fine: int = 4001) -> tuple[FloatArray, Window]:
    """Four seconds, with two turns of 0.7 s of the belt, then one wave of 0.3 s, that is no part of them."""
    time = np.linspace(0.0, 4.0, fine)
    return time, Window(time, (Cycle(time / 0.7, 2.0), Cycle(time / 0.3, 1.0)), turns=2)


def test_a_window_is_as_long_as_all_of_its_cycles() -> None:
    time, window = sine_window()
    assert window.end == 4.0
    assert window.start == pytest.approx(4.0 - 1.4 - 0.3)
    assert time[window.first - 1] < window.start * (1.0 - 1e-12) <= time[window.first]


def test_cycles_that_get_quicker_are_counted_by_their_phase() -> None:
    """Phase t^2: the last three of sixteen cycles began at sqrt(13) s."""
    time = np.linspace(0.0, 4.0, 4001)
    assert Window(time, (Cycle(time**2, 3.0),)).start == pytest.approx(np.sqrt(13.0), abs=1e-7)


def test_waves_of_both_cycles_drop_out_at_any_phase() -> None:
    time, window = sine_window()
    for phase in (0.0, 1.0, 2.0):
        turn, wave = (np.sin(2.0 * np.pi * time / period + phase) for period in (0.7, 0.3))
        assert window.mean(recorded(y=5.0 + turn + wave), "y") == pytest.approx(
            5.0, abs=1e-5
        )  # outputs every 1/300 wave


def test_the_mean_of_a_line_is_that_of_the_middle() -> None:
    """Of both windows, one after the other: half of each before the end."""
    time, window = sine_window()
    lines = np.stack([3.0 * time, 1.0 - time], axis=1)
    middle = 4.0 - 0.5 * (1.4 + 0.3)
    np.testing.assert_allclose(window.mean_of(lines), [3.0 * middle, 1.0 - middle], rtol=1e-9)


@pytest.mark.parametrize("start", [0.0, 0.1, 0.22, 0.7, 0.9])
def test_values_between_outputs_lie_on_straight_lines(start: float) -> None:
    """The integral of a polygon from an instant within one of its sides."""
    values = np.array([2.0, -1.0, 4.0, 0.0, 3.0, 3.0, -5.0])
    corners = np.unique(np.append(start, UNEVEN[start < UNEVEN]))
    expected = np.trapezoid(np.interp(corners, UNEVEN, values), corners) / (1.0 - start)
    window = plain_window(UNEVEN, start)
    assert window.start == pytest.approx(start)
    assert window.mean(recorded(y=values), "y") == pytest.approx(expected)
    assert window.product(recorded(y=values, two=np.full(7, 2.0)), "y", "two") == pytest.approx(2.0 * expected)


def test_without_a_start_all_counts() -> None:
    window = plain_window(UNEVEN)
    assert (window.start, window.end, window.first, window.turns) == (0.0, 1.0, 0, 0)
    assert window.mean(recorded(y=UNEVEN), "y") == pytest.approx(0.5)


@pytest.mark.parametrize("start", [0.0, 0.22, 0.7])
def test_the_rate_is_what_was_gained_over_the_time(start: float) -> None:
    angle = np.array([0.0, 1.0, 1.5, 2.0, 7.0, 7.0, 9.0])
    expected = (9.0 - np.interp(start, UNEVEN, angle)) / (1.0 - start)
    assert plain_window(UNEVEN, start).rate(recorded(angle=angle), "angle") == pytest.approx(expected)


def test_the_rate_of_an_integral_is_the_mean_of_what_was_integrated() -> None:
    time, window = sine_window()
    power = 5.0 + np.sin(2.0 * np.pi * time / 0.7) + 2.0 * time
    work = 5.0 * time - 0.7 / (2.0 * np.pi) * np.cos(2.0 * np.pi * time / 0.7) + time**2
    rate, mean = window.rate(recorded(work=work), "work"), window.mean(recorded(power=power), "power")
    assert rate == pytest.approx(float(mean), rel=1e-6)


def test_one_output_is_its_own_mean_and_has_no_rate() -> None:
    window = plain_window(np.array([3.0]))
    assert window.mean(recorded(y=np.array([[7.0, 8.0]])), "y").tolist() == [7.0, 8.0]
    assert window.rate(recorded(y=np.array([[7.0, 8.0]])), "y").tolist() == [0.0, 0.0]


def test_running_means_have_their_windows_around_them() -> None:
    time, window = sine_window()
    means = window.running_means(np.sin(2.0 * np.pi * time / 0.7) + time)
    known = time > 0.5 * 1.7 + 1e-9
    inner = known & (time <= 4.0 - 0.5 * 1.7)
    assert np.isnan(means[time < 0.5 * 1.7 - 1e-9]).all()
    np.testing.assert_allclose(means[inner], time[inner], atol=2e-3)  # the first whole window ends with an output
    np.testing.assert_allclose(means[time > 4.0 - 0.5 * 1.7], 4.0 - 0.5 * 1.7, rtol=1e-6)


def test_running_means_over_nothing_are_the_values() -> None:
    values = np.array([1.0, 4.0, np.nan])
    means = Window(np.arange(3.0), ()).running_means(values)
    np.testing.assert_array_equal(means, values)
    assert means is not values


def test_a_phase_that_stands_for_a_while() -> None:
    """A drive that stops for two seconds: the last turn began when it stopped, or before."""
    time = np.linspace(0.0, 4.0, 401)
    phase = np.clip(time, 0.0, 1.0) + np.clip(time - 3.0, 0.0, 1.0)
    assert Window(time, (Cycle(phase, 1.5),)).start == pytest.approx(0.5)
